"""The script for OpenSees, and how far it is from exact."""

from importlib.util import find_spec

import pytest

import slipstick as ss
from support import EXAMPLES, block, pulse

ALIKE = {"slider.static_friction": 0.05, "slider.kinetic_friction": 0.05}


def taft() -> tuple[ss.Model, ss.Motion]:
    motion = ss.read_record(EXAMPLES / "records" / "taft-111.txt", units="g", dt="0.01 s")
    return ss.Model.read(EXAMPLES / "taft.toml").with_(ALIKE), motion.scaled(pga="0.3 g")


def test_the_script_is_python_with_the_numbers_of_the_model() -> None:
    model, motion = taft()
    names: dict[str, object] = {}
    text = model.to_opensees(motion, "10 kN/mm")
    head = text[: text.index("\ndef build")].replace("import openseespy.opensees as ops", "")
    exec(compile(head, "script", "exec"), names)
    assert names["K_INIT"] == 1e7 and names["MASSES"] == [325.0, 201.0]
    assert names["FRICTION"] == [pytest.approx(0.05 * 526 * 9.80665)] * 2
    assert names["SPRING"] == pytest.approx(526 * 9.80665 / 2.0)
    # The model's tail of 5 s is there too.
    assert names["TIMES"][-1] == pytest.approx(motion.duration_s + 5.0)  # type: ignore[index]
    compile(text, "script", "exec")


@pytest.mark.parametrize(
    ("keys", "k_init", "told"),
    [
        ({}, "10 kN/mm", "slider.static_friction"),
        ({**ALIKE, "slider.tilt": "1 mrad"}, "10 kN/mm", "slider.tilt"),
        ({**ALIKE, "slider.stop": {"gap": "0.1 m", "stiffness": "1 kN/mm", "damping_ratio": 0.1}},
         "10 kN/mm", "slider.stop.damper"),
        (ALIKE, "10 kN", "k_init"),
        (ALIKE, "-1 kN/mm", "k_init"),
        (ALIKE, True, "k_init"),
    ],
)
def test_what_cannot_be_expressed_is_refused(keys: dict[str, object], k_init: object, told: str) -> None:
    with pytest.raises(ss.InputError, match=told) as caught:
        block().with_(keys).to_opensees(pulse(), k_init)  # type: ignore[arg-type]
    assert caught.value.path == told


def test_a_bare_stiffness_is_in_si() -> None:
    model = block().with_(ALIKE)
    assert model.to_opensees(pulse(), 1e7) == model.to_opensees(pulse(), "10 kN/mm")


def frame() -> ss.Model:
    storey = {"mass": "100 kg", "stiffness": "40 kN/m", "damping_ratio": 0.05}
    slider = {**{"static_friction": 0.05, "kinetic_friction": 0.05}, "radius": "1 m", "damper": "200 N s/m"}
    return ss.Model({"block": {"mass": "200 kg"}, "slider": slider, "storey": [storey] * 3})


@pytest.mark.skipif(find_spec("openseespy") is None, reason="openseespy is not installed")
@pytest.mark.parametrize("storeys", [0, 1, 3])
def test_opensees_comes_near_where_its_spring_is_stiff(storeys: int) -> None:
    model, motion = taft()
    model = {0: block().with_(ALIKE), 1: model, 3: frame()}[storeys]
    found = ss.audit.regularisation(model, motion, ["100 kN/mm", "1 N/mm"], steps=4)
    soft, stiff = found.errors()
    assert soft[0] == 1e3 and stiff[0] == 1e8
    assert stiff[1] is not None and abs(stiff[1]) < 0.02
    assert stiff[2] is not None and abs(stiff[2]) < 0.05
    assert soft[1] is not None and abs(soft[1]) > abs(stiff[1])
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    assert found.plot().get_xscale() == "log"
    matplotlib.pyplot.close("all")


STOP = {"gap": {"positive": "40 mm", "negative": "30 mm"}}
SURFACES = [
    {"radius": "0.4 m", "friction": 0.03, "travel": "60 mm"},
    {"radius": "1.6 m", "friction": 0.055, "travel": "600 mm"},
]
TRIPLE = {
    "effective_radius": ["1 m", "0.1 m", "0.1 m", "1.05 m"],
    "friction": [0.045, 0.02, 0.02, 0.08],
    "travel": ["150 mm", "50 mm", "50 mm", "200 mm"],
}
CONTENTS = {"floor": 1, "mass": "50 kg", "static_friction": 0.1, "kinetic_friction": 0.1}
EXPONENTIAL = {"slow": 0.03, "fast": 0.055, "rate": "30 s/m"}
PIECES = {"velocity": ["0 m/s", "0.1 m/s"], "coefficient": [0.03, 0.05]}


@pytest.mark.skipif(find_spec("openseespy") is None, reason="openseespy is not installed")
@pytest.mark.parametrize(
    ("slider", "more", "vertical"),
    [
        ({"static_friction": 0.03, "kinetic_friction": EXPONENTIAL, "radius": "2 m"}, {}, False),
        ({"static_friction": 0.03, "kinetic_friction": PIECES, "spring": "3 kN/m"}, {}, False),
        ({**ALIKE, "radius": "2 m"}, {}, True),
        ({**ALIKE, "radius": "2 m", "stop": {**STOP, "stiffness": "0.5 kN/mm"}}, {}, False),
        ({**ALIKE, "radius": "2 m", "stop": {**STOP, "restitution": 0.5}}, {}, False),
        ({"surface": SURFACES}, {}, False),
        ({"triple": TRIPLE}, {}, False),
        ({**ALIKE, "radius": "2 m"}, {"contents": [CONTENTS]}, False),
        ({**ALIKE, "radius": "2 m"}, {"contents": [CONTENTS]}, True),
    ],
)
def test_opensees_comes_near_with_every_device(
    slider: dict[str, object], more: dict[str, object], vertical: bool
) -> None:
    slider = {key.removeprefix("slider."): value for key, value in slider.items()}
    storey = {"mass": "201 kg", "frequency": "2.15 Hz", "damping_ratio": 0.01}
    model = ss.Model({"block": {"mass": "325 kg"}, "slider": slider, "storey": [storey], **more})
    _, motion = taft()
    if vertical:
        along = motion.acceleration_m_per_s2
        motion = ss.Motion(along, dt=0.01, units="m/s2", vertical=0.5 * along[::-1])
    stiff, steps, bound = "200 kN/mm", 5, 0.03
    if "surface" in slider or "triple" in slider:
        stiff = "10 kN/mm"  # TripleFrictionPendulum does not converge with stiffer springs
    if "restitution" in slider.get("stop", {}):  # type: ignore[operator]
        # An impact on that spring takes some steps, and time that a rigid stop does not take.
        stiff, steps, bound = "20 kN/mm", 20, 0.1
    found = ss.audit.regularisation(model, motion, ["500 N/mm", stiff], steps=steps)
    soft, near = found.errors()
    assert near[1] is not None and abs(near[1]) < bound, found.errors()
    assert near[2] is not None and abs(near[2]) < 0.02, found.errors()
    assert soft[1] is not None and soft[2] is not None
    assert abs(soft[1]) + abs(soft[2]) > abs(near[1]) + abs(near[2]), found.errors()
