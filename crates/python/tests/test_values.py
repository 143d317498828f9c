"""Values that go in: of NumPy, pint and the standard library; changed, compared, asked for."""

import copy
import json
import os
import pickle
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import slipstick as ss
from support import EXAMPLES, block, quick_pulse


@pytest.mark.parametrize(
    "value",
    [0.05, np.float64(0.05), np.array(0.05), Fraction(1, 20), Decimal("0.05"), "0.05", np.str_("0.05")],
    ids=lambda value: type(value).__name__,
)
def test_numbers_of_every_kind_are_the_same(value: object) -> None:
    model = block().with_({"slider.kinetic_friction": value})
    assert model.value("slider.kinetic_friction") == 0.05
    assert model == block().with_({"slider.kinetic_friction": 0.05})
    made = {"block.mass": "325 kg", "slider.static_friction": 0.1, "slider.kinetic_friction": value}
    assert ss.Model(made) == model
    counted = model.with_({"contents": [dict(floor=np.int64(0), mass="1 kg", static_friction=np.float32(0.5),
                                             kinetic_friction=np.float16(0.25))]})
    assert counted.value("contents.1.static_friction") == 0.5


def test_quantities_of_pint_are_texts() -> None:
    unit = pytest.importorskip("pint").UnitRegistry()
    for number in [2.0, np.float64(2.0), Fraction(2), np.array(2.0)]:
        assert block().with_({"slider.radius": number * unit.m}).value("slider.radius") == 2.0


@pytest.mark.parametrize(
    "value", [np.ma.masked, np.ma.array(0.05, mask=True), np.array([0.05]), [0.05], object(), 1j, np.nan]
)
def test_what_is_no_number_is_refused(value: object) -> None:
    with pytest.raises(ss.InputError, match="slider.kinetic_friction"):
        block().with_({"slider.kinetic_friction": value})


def test_a_bare_number_of_what_has_a_dimension_is_in_si() -> None:
    texts = ss.Model({
        "block.mass": "325 kg", "slider.static_friction": 0.1, "slider.kinetic_friction": 0.08, "slider.radius": "2 m",
        "slider.tilt": "1 mrad", "storey.1.mass": "201 kg", "storey.1.frequency": "2.15 Hz", "storey.1.damping_ratio": 0.01,
    })
    numbers = ss.Model(
        block=ss.Block(mass=325),
        slider=ss.Slider(static_friction=0.1, kinetic_friction=0.08, radius=np.float32(2.0), tilt=1e-3),
        storey=[ss.Storey(mass=np.int64(201), frequency=2.15, damping_ratio=0.01)],
    )
    assert numbers == texts and numbers.values["slider.radius"] == "2.0 m"
    assert texts.with_({"slider.radius": 2}) == texts != texts.with_({"slider.radius": 2.5})
    # What is a ratio without a unit stays one.
    frame = {"frame.period": 0.8, "storey": [{"mass": 1e3, "stiffness": k, "damping_ratio": 0.05} for k in (2.0, 1.0)]}
    relative = block().with_(frame)
    assert relative.value("frame.period") == 0.8 and relative.values["storey.1.stiffness"] == "2.0"
    with pytest.raises(ss.InputError, match="^slider.radius: "):
        block().with_({"slider.radius": np.nan})


def test_one_rule_for_values_in_every_call() -> None:
    pandas = pytest.importorskip("pandas")
    records = {"a": quick_pulse(), "b": quick_pulse().scaled(0.5)}
    radii = np.array([1.0, 2.0])
    frame = pandas.DataFrame({"slider.radius": radii, "block.mass": [300.0, 400.0]})
    listed = ["1 m", "200 cm"]
    columns = [pytest.importorskip(name) for name in ("polars", "pyarrow")]
    columns = [columns[0].Series(radii), columns[1].array(radii), columns[1].chunked_array([radii])]
    for values in (radii, frame["slider.radius"], radii.tolist(), [1, "2 m"], *columns):
        given = {"slider.radius": values}
        text = {"slider.radius": listed}
        assert ss.spectrum(block(), records, given).table == ss.spectrum(block(), records, text).table
        over = {"block.mass": [300.0]}
        assert ss.spectrum(block(), records, over, vary=given).table == ss.spectrum(block(), records, over, vary=text).table
        assert ss.study(ss.Plan(block(), records, given)).table == ss.study(ss.Plan(block(), records, text)).table
        assert ss.demands(block(), records, given) == ss.demands(block(), records, text)
    by_number = ss.ida(block(), records, scale_to=[1.0, 2.0], limit=0.05)
    assert by_number == ss.ida(block(), records, scale_to="1 m/s2, 2 m/s2", limit="50 mm")
    assert by_number.summary["limit"] == 0.05
    hunted = ss.ida(block(), records, between=(0.5, 20.0), limit=0.001)
    assert hunted.table == ss.ida(block(), records, between="0.5 m/s2..20 m/s2", limit="1 mm").table
    scaled = ss.suite(block(), records, scale_to=3.0)
    assert scaled.table == ss.suite(block(), records, scale_to="3 m/s2").table
    levels = [ss.Plan(block(), records, scale_to=levels) for levels in ([1.0, 2.0], ["1 m/s2", "2 m/s2"], np.array([1, 2]))]
    tables = [ss.study(plan).table for plan in levels]
    assert tables[0] == tables[1] == tables[2] and set(tables[0]["level"]) == {1.0, 2.0}
    # Distributions: what has the path's dimension is in SI, the rest is not.
    for numbers, texts in [
        ({"lognormal": [2.0, 0.2], "truncated": [1.0, 3.0]}, {"lognormal": ["2 m", 0.2], "truncated": ["1 m", "3 m"]}),
        ({"normal": [2.0, 0.1]}, {"normal": ["2 m", "10 cm"]}),
        ({"linspace": [1.0, 2.0, 8]}, {"linspace": ["1 m", "2 m", 8]}),
    ]:
        plans = [ss.Plan(block(), records, {"slider.radius": of}, samples=8, seed=1) for of in (numbers, texts)]
        assert ss.study(plans[0]).table == ss.study(plans[1]).table
    # Rows of a frame belong together.
    table = ss.demands(block(), records, frame)
    assert len(table) == 4 and table["block.mass"].tolist() == [300.0, 400.0] * 2
    in_two = ss.study(ss.Plan(block(), records, frame)).table
    assert np.array_equal(in_two["peak_sliding_displacement_m"], table["peak_sliding_displacement_m"])
    frame.attrs["units"] = {"block.mass": "t", "slider.radius": "m"}
    assert ss.demands(block(), records, frame)["block.mass"].tolist() == [300e3, 400e3] * 2
    with pytest.raises(ss.InputError, match="^vary: expected values by path, .*found a frame, whose rows belong together"):
        ss.spectrum(block(), records, vary=frame)


def test_every_unit_is_one_that_pint_reads() -> None:
    unit = pytest.importorskip("pint").UnitRegistry()
    pyarrow = pytest.importorskip("pyarrow")
    t = np.arange(0.0, 3.0, 0.01)
    pair = ss.Motion(np.sin(6 * t), y=np.sin(4 * t), dt=0.01, units="m/s2")
    model = block().with_({"slider.radius": "2 m", "slider.damping_ratio": 0.02})
    response = ss.run(model, pair)
    table = ss.demands(model, pair, {"slider.damping_ratio": 0.02, "block.mass": "1 t"}, scale_to=2.0)
    tables = [table, ss.Table(response.history), response.events.table, pair.components["x"].spectrum([1.0]), ss.suite(model, [pair]).table]
    for one in [*tables, response.history]:
        for name, of in one.units.items():
            # Their size in SI is 1 and what the column's name says.
            assert unit(of).to_base_units().magnitude == 1.0, (name, of)
            if name.endswith("_m_per_s2"):
                assert of == "m/s²"
    said = {field.metadata[b"unit"].decode() for field in pyarrow.table(table).schema if field.metadata}
    assert said == set(table.units.values()) and "m/s²" in said


def test_results_are_read_only() -> None:
    response = ss.run(block(), quick_pulse())
    found = ss.ida(block(), {"a": quick_pulse()}, scale_to=[1.0, 2.0])
    for summary in (response.summary, found.summary):
        for change in (
            lambda s: s.update(x=1), lambda s: s.__setitem__("x", 1), lambda s: s["warnings"].append(1), lambda s: s.pop("warnings"),
        ):
            with pytest.raises(TypeError, match="a result does not change"):
                change(summary)
        own = copy.deepcopy(summary)
        own["warnings"].append(1)
        own["x"] = 1
        assert "x" not in summary and type(pickle.loads(pickle.dumps(summary))) is dict
        assert json.loads(json.dumps(summary)) == summary
    assert response.summary["checks"]["closest_call"] is None or isinstance(response.summary["checks"]["closest_call"], dict)


def test_motions_go_wherever_motions_go() -> None:
    one, other = quick_pulse(), quick_pulse().scaled(0.5)
    named = {"1": one, "2": other}
    calls = [
        lambda r: ss.suite(block(), r), lambda r: ss.run(block(), r), lambda r: ss.ida(block(), r, scale_to=2.0),
        lambda r: ss.spectrum(block(), r, {"slider.radius": [1.0, 2.0]}), lambda r: ss.sensitivity(block(), r, "block.mass"),
        lambda r: ss.design(block(), r, {"slider.radius": [1.0, 2.0]}, gap=0.5, sensitivity=0),
    ]
    for call in calls:
        assert call([one, other]) == call((one, other)) == call(named)
    of_list = ss.demands(block(), [one, other], {"block.mass": 300.0})
    assert of_list == ss.demands(block(), named, {"block.mass": 300.0}) and of_list["record"] == ["1", "2"]
    assert ss.ida(block(), one, scale_to=2.0) == ss.ida(block(), {"motion": one}, scale_to=2.0)
    assert ss.study(ss.Plan(block(), [one, other])).table == ss.study(ss.Plan(block(), named)).table


def test_each_design_has_its_own_intensity() -> None:
    records = {"a": quick_pulse(), "b": quick_pulse().scaled(0.5)}
    designs = {"slider.kinetic_friction": [0.05, 0.06, 0.07]}
    scale, levels = [1.0, 2.0, -1.5], ["0.2 g", 3.0, "4 m/s2"]
    table = ss.demands(block(), records, designs, scale=scale, check=1.0)
    assert table["scale"].tolist() == scale * 2
    by_level = ss.demands(block(), records, designs, measure="PGA", scale_to=levels, check=1.0)
    in_si = [0.2 * 9.80665, 3.0, 4.0]
    assert by_level["level"].tolist() == in_si * 2 and by_level.units["level"] == "m/s²"
    assert np.allclose(by_level["PGA_m_per_s2" if "PGA_m_per_s2" in by_level else "pga_m_per_s2"], in_si * 2, rtol=1e-14)
    for row in range(6):
        model = block().with_({"slider.kinetic_friction": designs["slider.kinetic_friction"][row % 3]})
        motion = list(records.values())[row // 3]
        alone = ss.run(model, motion.scaled(scale[row % 3])).summary["peak_sliding_displacement_m"]
        assert table["peak_sliding_displacement_m"][row] == alone
        factor = float(by_level["scale"][row])
        assert factor == in_si[row % 3] / motion.pga_m_per_s2
        alone = ss.run(model, motion.scaled(factor)).summary["peak_sliding_displacement_m"]
        assert by_level["peak_sliding_displacement_m"][row] == alone
    assert ss.demands(block(), records, {"block.mass": 300.0}, scale_to=[1.0, 2.0, 3.0])["level"].tolist() == [1.0, 2.0, 3.0] * 2
    for wrong, told in [
        ({"scale": [1.0, 2.0]}, "^scale: expected 3 values, as many as designs, found 2$"),
        ({"scale": 2.0, "scale_to": 1.0}, "^scale: expected scale or scale_to, found both$"),
        ({"measure": "PGA"}, '^measure: expected scale_to beside it, found "PGA"$'),
        ({"scale_to": [1.0, -2.0, 1.0]}, "^scale_to: expected levels > 0, found -2 in row 1$"),
        ({"scale_to": "0.1 m"}, "^scale_to: expected an acceleration"),
        ({"scale_to": 1.0, "measure": "PGAA"}, "^measure: "),
    ]:
        with pytest.raises(ss.InputError, match=told):
            ss.demands(block(), records, designs, **wrong)  # type: ignore[arg-type]


def test_a_fragility_of_own_counts_and_capacities() -> None:
    levels, exceeded = [0.1, 0.2, 0.3, 0.4], [1, 4, 9, 14]
    table = ss.Table({"level": levels, "runs": [20] * 4, "exceeded": exceeded}, {"level": "g"})
    of_table = ss.fragility(table, measure="PGA")
    of_counts = ss.fragility(levels=levels, exceeded=exceeded, runs=20, measure="PGA", units="g")
    assert of_counts.table == of_table.table and of_counts.summary["median"] == of_table.summary["median"]
    # By SciPy, the likelihood of 20 draws at each level made largest.
    assert of_counts.summary["median"] / 9.80665 == pytest.approx(0.31066493, rel=1e-7)
    assert of_counts.summary["dispersion"] == pytest.approx(0.61437074, rel=1e-7)
    texts = ss.fragility(levels=[f"{level} g" for level in levels], exceeded=np.array(exceeded), runs=[20] * 4, measure="PGA")
    in_si = ss.fragility(levels=9.80665 * np.array(levels), exceeded=exceeded, runs=20, measure="PGA")
    for other in (texts, in_si):
        assert other.summary["median"] == pytest.approx(of_table.summary["median"], rel=1e-12)
    # The median of a lognormal sample is the geometric mean where all are reached.
    capacities = np.array([1.0, 2.0, 4.0])
    found = ss.fragility(capacities=capacities, measure="Sa(1 s)")
    assert found.summary["median"] == pytest.approx(2.0, rel=1e-9)
    censored = ss.fragility(capacities=capacities, reached=[True, True, False], measure="Sa(1 s)")
    assert censored.summary["median"] > 2.0
    for wrong, told in [
        ({}, "^source: expected a source of runs, or levels"),
        ({"source": table, "levels": levels}, "found both source and levels$"),
        ({"levels": levels, "exceeded": exceeded}, "^runs: expected runs beside levels, exceeded, found none$"),
        ({"levels": levels, "exceeded": [1], "runs": 20}, "^exceeded: expected 4 values, as many as levels, found 1$"),
        ({"levels": levels, "capacities": levels, "exceeded": exceeded, "runs": 3}, "^levels: expected counts at levels, or cap"),
        ({"levels": [0.1, np.nan, 0.3, 0.4], "exceeded": exceeded, "runs": 20}, "^levels: expected finite numbers, found NaN in row 1"),
        ({"levels": levels, "exceeded": exceeded, "runs": 20, "measure": None}, "^measure: expected the measure of the levels"),
    ]:
        with pytest.raises(ss.InputError, match=told):
            ss.fragility(**{"measure": "PGA", **wrong})  # type: ignore[arg-type]


def test_a_column_that_is_none_is_told_with_the_nearest() -> None:
    table = ss.demands(block(), quick_pulse(), {"block.mass": 300.0})
    with pytest.raises(KeyError, match="nearest is .*peak_sliding_displacement_m"):
        table["peak_sliding_displacment_m"]


def test_one_key_twice_is_refused() -> None:
    keys = {"slider.static_friction": 0.1, "slider.kinetic_friction": 0.1}
    with pytest.raises(ss.InputError, match="^block.mass: expected one value, found two$"):
        ss.Model({"block.mass": "1 t", "block": {"mass": "2 t"}, **keys})
    with pytest.raises(ss.InputError, match="^slider.radius: expected one value, found two$"):
        block().with_({"slider.radius": "1 m", "slider": {"radius": "2 m"}})


def test_equal_values_are_equal_models() -> None:
    metres, millimetres = (block().with_({"slider.radius": text}) for text in ["2.1 m", "2100 mm"])
    assert metres == millimetres and hash(metres) == hash(millimetres)
    assert metres != block().with_({"slider.radius": "2.2 m"})
    assert ss.Model.from_toml(metres.toml) == metres


def test_keys_are_removed_and_storeys_added() -> None:
    model = block().with_({"slider.radius": "2 m", "slider.damping_ratio": 0.02})
    assert model.with_({"slider.radius": None, "slider.damping_ratio": None}) == block()
    with pytest.raises(ss.InputError, match="slider.gap: expected a key that stands in the model"):
        model.with_({"slider.gap": None})
    storey = {"mass": "1 t", "stiffness": "4 kN/mm", "damping_ratio": 0.02}
    one = model.with_({"storey": [storey]})
    two = one.with_({f"storey.2.{key}": value for key, value in storey.items()})
    assert (one.storeys, two.storeys) == (1, 2) and two.with_({"storey.2": None}) == one
    assert two.with_({"storey": None}) == model
    with pytest.raises(ss.InputError, match="storey.4.mass: expected a number from 1 to 3"):
        two.with_({"storey.4.mass": "1 t"})


def test_a_path_that_no_model_has_is_told() -> None:
    with pytest.raises(ss.InputError, match='slider.raduis.*nearest is "slider.radius"'):
        block().value("slider.raduis")
    assert block().value("slider.radius") is None


def test_a_model_finds_its_record_from_everywhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    expected = ss.run(ss.Model.read(EXAMPLES / "taft.toml"))
    monkeypatch.chdir(EXAMPLES)
    read = ss.Model.read("taft.toml")
    text = ss.Model.from_toml(Path("taft.toml").read_text(encoding="utf-8"))
    monkeypatch.chdir(tmp_path)
    for model in [read, text, pickle.loads(pickle.dumps(read))]:
        assert ss.run(model).events == expected.events
    assert read == expected.model and os.getcwd() == str(tmp_path)
