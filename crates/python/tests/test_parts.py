"""Tables of a model as calls, examples, schema and units."""

import inspect
import pickle

import numpy as np
import pytest

import slipstick as ss
from slipstick import _parts
from support import EXAMPLES, block, command, pulse, suite


def test_parts_make_the_model_of_its_keys() -> None:
    made = ss.Model(
        name="Tank",
        block=ss.Block(mass="325 kg"),
        slider=ss.Slider(static_friction=0.06, kinetic_friction=0.05, stop=ss.Stop(gap="100 mm", stiffness="2 kN/mm")),
        storey=[ss.Storey(mass="201 kg", frequency="2.15 Hz", damping_ratio=0.01)],
        contents=[ss.Contents(floor=1, mass="1 kg", static_friction=0.4, kinetic_friction=0.3)],
        motion=ss.Sweep(from_="1 Hz", to="2 Hz", kind="linear", amplitude="0.1 g", duration="3 s", dt="0.01 s"),
        analysis=ss.Analysis(tail="1 s"),
    )
    plain = ss.Model({
        "name": "Tank", "block.mass": "325 kg", "slider.static_friction": 0.06, "slider.kinetic_friction": 0.05,
        "slider.stop": {"gap": "100 mm", "stiffness": "2 kN/mm"},
        "storey": [{"mass": "201 kg", "frequency": "2.15 Hz", "damping_ratio": 0.01}],
        "contents": [{"floor": 1, "mass": "1 kg", "static_friction": 0.4, "kinetic_friction": 0.3}],
        "motion.sweep": {"from": "1 Hz", "to": "2 Hz", "kind": "linear", "amplitude": "0.1 g", "duration": "3 s", "dt": "0.01 s"},
        "analysis.tail": "1 s",
    })
    assert made == plain
    assert ss.Model({"block": {"mass": "325 kg"}}, slider=ss.Slider(static_friction=0.1, kinetic_friction=0.08)) == block()
    assert block().with_({"storey": [ss.Storey(mass="1 t", frequency="1 Hz", damping_ratio=0.1)]}).storeys == 1
    part = ss.Slider(radius="2 m")
    assert part == {"radius": "2 m"} and repr(part) == "Slider({'radius': '2 m'})"
    assert pickle.loads(pickle.dumps(part)) == part


def test_parts_have_the_keys_of_the_schema() -> None:
    schema = ss.schema()
    for name, cls in vars(_parts).items():
        if not (inspect.isclass(cls) and issubclass(cls, _parts.Part)) or cls is _parts.Part:
            continue
        table = schema
        for key in cls._PATH.split("."):
            table = table["properties"][key]
            table = table.get("items", table)
        keywords = {key.rstrip("_") for key in inspect.signature(cls.__init__).parameters} - {"self"}
        assert keywords == set(table["properties"]), name
        assert getattr(ss, name) is cls


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda: ss.Slider(radius="2"), "^slider.radius: expected a length with its unit"),
        (lambda: ss.Slider(radius=True), "^slider.radius: expected a length with its unit"),
        (lambda: ss.Slider(radius="2 kg"), "^slider.radius: expected"),
        (lambda: ss.Storey(mass="1 m"), "^storey.mass: expected"),
        (lambda: ss.Sine(frequency="1 s"), "^motion.sine.frequency: expected"),
        (lambda: ss.Model(block=ss.Block(mass="1 t")), "slider"),
        (lambda: ss.Model({"block.mass": "1 t"}, block=ss.Block(mass="1 t")), "^block.mass: expected one value, found two"),
        (lambda: ss.Model(blok=ss.Block(mass="1 t")), 'nearest is "block.mass"'),
        (lambda: ss.Model.example("mockup"), '^name: expected one of "block", "mock-up"'),
    ],
)
def test_parts_that_cannot_be_are_told(call: object, told: str) -> None:
    with pytest.raises(ss.InputError, match=told):
        call()  # type: ignore[operator]


def test_a_keyword_that_is_none_is_told() -> None:
    with pytest.raises(TypeError, match="static_fricton"):
        ss.Slider(static_fricton=0.1)  # type: ignore[call-arg]


def test_examples_are_those_of_the_command(tmp_path: object, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(str(tmp_path))
    for name in ["block", "mock-up", "tank-sloshing"]:
        command("init", name, "--example", name)
        assert ss.Model.example(name) == ss.Model.read(f"{name}.toml")


def test_schema_and_units_are_those_of_the_command() -> None:
    import json

    assert ss.schema() == json.loads(command("schema"))
    assert ss.schema(plan=True) == json.loads(command("schema", "--plan"))
    units = ss.units()
    told = command("schema", "--units")
    assert all(unit in told for unit in units["unit"])
    assert units["in_si"][units["unit"].index("t")] == 1000.0


def test_a_run_of_many_records_is_a_suite() -> None:
    model = ss.Model.read(EXAMPLES / "taft.toml")
    assert ss.run(model, suite()) == ss.suite(model, suite())
    with pytest.raises(ss.InputError, match="^history: expected one motion beside it"):
        ss.run(model, suite(), history=False)  # type: ignore[call-overload]


def test_every_result_has_a_picture_and_a_plot() -> None:
    pytest.importorskip("matplotlib").use("Agg")
    model = ss.Model.read(EXAMPLES / "taft.toml")
    records = suite()
    response = ss.run(model)
    plan = ss.Plan(model.with_({"slider.bounds": None}), records, {"slider.radius": ["1 m", "2 m", "3 m"]}, method="grid")
    results = [
        response, response.motion, ss.suite(model, records), ss.study(plan),
        ss.spectrum(model, records, {"slider.radius": "1..3 m:3"}),
        ss.ida(model, records, scale_to="0.2..0.27 g:29", limit="40 mm", bounds="nominal"),
        ss.sensitivity(model, records, "slider.radius"),
    ]
    results.append(ss.fragility(results[-2]))
    for result in results:
        assert "<svg" in result._repr_html_(), result  # type: ignore[attr-defined]
        assert result.plot() is not None, result  # type: ignore[attr-defined]
    # What each kind draws by itself, and what its axes say.
    suite_, study_, spectrum_, ida_ = results[2:6]
    fragility_ = results[-1]
    curve = fragility_.plot()  # type: ignore[attr-defined]
    table = fragility_.table  # type: ignore[attr-defined]
    assert list(curve.lines[0].get_ydata()) == list(table["probability"]) and len(curve.collections) == 1
    assert curve.get_ylabel() == "Probability of exceedance" and curve.get_xlabel() == "PGA (g)"
    drawn = spectrum_.plot().lines  # type: ignore[attr-defined]
    shares = [f"peak_sliding_displacement_m_p{share}" for share in (16, 50, 84)]
    bounds = list(dict.fromkeys(spectrum_.table["friction"]))  # type: ignore[attr-defined]
    for line, (name, share) in zip(drawn, [(name, share) for name in bounds for share in shares], strict=True):
        rows = [bound == name for bound in spectrum_.table["friction"]]  # type: ignore[attr-defined]
        assert np.allclose(line.get_ydata(), 1e3 * spectrum_.table[share][rows])  # type: ignore[attr-defined]
    assert study_.plot().get_xlabel() == "radius (m)"  # type: ignore[attr-defined]
    assert study_.plot().get_ylabel() == "Peak sliding displacement (mm)"  # type: ignore[attr-defined]
    assert len(ida_.plot().lines) == len(records) + 1  # type: ignore[attr-defined]
    assert suite_.plot().get_xlabel() == "record"  # type: ignore[attr-defined]
    front = ss.design(model.with_({"slider.bounds": None}), records, {"slider.radius": "1..3 m:4"}, gap="300 mm")
    axes = front.plot()
    assert np.allclose(axes.lines[0].get_xdata(), 1e3 * front.table["displacement_m"])
    assert axes.get_ylabel() == "Acceleration not exceeded in 50 % of the records (g)"
    axes = results[3].plot("slider.radius", by="record", color="k", lw=2)  # type: ignore[attr-defined]
    assert axes.lines[0].get_color() == "k" and len(axes.lines) == len(records)
    assert response.plot.loop(ax=axes, lw=3) is axes and axes.lines[-1].get_linewidth() == 3
    assert ss.run(block(), pulse(), history=False)._repr_html_()
