"""Demands of many designs at once."""

import time

import numpy as np
import pytest

import slipstick as ss
from support import EXAMPLES, block, pulse, suite

PEAK = "peak_sliding_displacement_m"


def tank() -> ss.Model:
    return ss.Model.read(EXAMPLES / "studies" / "tank.toml")


def test_demands_are_those_of_run_bit_for_bit() -> None:
    records = suite()
    designs = {"slider.radius": np.array([1.0, 2.0, 4.0]), "slider.kinetic_friction": [0.03, 0.04, 0.05]}
    table = ss.demands(tank(), records, designs, check=1.0)
    assert table["record"] == [name for name in records for _ in range(3)]
    assert table["status"] == ["ok"] * 9 and np.array_equal(table["slider.radius"], [1.0, 2.0, 4.0] * 3)
    alone = [
        ss.run(tank().with_({"slider.radius": f"{radius} m", "slider.kinetic_friction": friction}), motion)
        for motion in records.values()
        for radius, friction in zip(*designs.values(), strict=True)
    ]
    assert table[PEAK].tolist() == [response.summary[PEAK] for response in alone]
    acceleration = table["storey1_peak_acceleration_m_per_s2"].tolist()
    assert acceleration == [r.summary["storeys"][0]["peak_acceleration_m_per_s2"] for r in alone]


def test_designs_in_units_and_columns() -> None:
    model = block().with_({"slider.radius": "2 m"})
    by_text = ss.demands(model, pulse(), {"slider.radius": ["1 m", "200 cm"]}, columns=[PEAK], check=0.0)
    assert by_text.columns == [PEAK] and by_text.units == {PEAK: "m"} and len(by_text) == 2
    by_number = ss.demands(model, {"a": pulse()}, {"slider.radius": [1.0, 2.0], "slider.tilt": 0.0}, columns=[PEAK])
    assert by_text == by_number
    unit = pytest.importorskip("pint").UnitRegistry()
    assert ss.demands(model, pulse(), {"slider.radius": np.array([1, 2]) * unit.m}, columns=[PEAK]) == by_text


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ({"vary": {}}, "^vary: expected at least one path"),
        ({"vary": {"slider.raduis": [1.0]}}, 'nearest is "slider.radius"'),
        ({"vary": {"slider.radius": [1.0, 2.0], "slider.tilt": [0.0] * 3}}, "^slider.(radius|tilt): expected "),
        ({"vary": {"slider.radius": []}}, "^slider.radius: expected "),
        ({"vary": {"slider.radius": ["1 kg"]}}, "^slider.radius: expected a length"),
        ({"columns": ["peak"]}, "^columns: expected columns among run, "),
        ({"check": 2.0}, "^check: expected a share"),
        ({"records": {}}, "^records: expected at least one motion"),
        ({"jobs": 0}, "^jobs: "),
    ],
)
def test_demands_that_cannot_be_are_told(arguments: dict[str, object], told: str) -> None:
    given = {"records": pulse(), "vary": {"slider.radius": [1.0, 2.0]}, **arguments}
    with pytest.raises(ss.InputError, match=told):
        ss.demands(block(), **given)  # type: ignore[arg-type]


def test_a_run_without_an_answer_is_one_row() -> None:
    table = ss.demands(block(), pulse(), {"slider.kinetic_friction": [0.05, 0.5, 0.06]})
    assert np.isnan(table[PEAK]).tolist() == [False, True, False]
    assert "kinetic" in table["status"][1]


def test_demands_serve_as_a_vectorised_objective() -> None:
    optimize = pytest.importorskip("scipy.optimize")
    motion = suite()["taft-021"].scaled(pga="0.3 g")

    def objective(x: np.ndarray) -> np.ndarray:
        designs = {"slider.kinetic_friction": x[0], "slider.static_friction": x[0], "slider.radius": x[1]}
        table = ss.demands(tank(), motion, designs, columns=[PEAK, "block.peak_acceleration_m_per_s2"], check=0.0)
        return np.asarray(table["block.peak_acceleration_m_per_s2"] + 100.0 * np.maximum(table[PEAK] - 0.1, 0.0))

    found = optimize.differential_evolution(
        objective, [(0.02, 0.12), (1.0, 4.0)], vectorized=True, updating="deferred", maxiter=5, seed=1, polish=False)
    assert found.fun < objective(np.array([[0.1], [1.0]]))[0]


def test_demands_go_at_the_pace_of_a_study() -> None:
    motion, count = suite()["taft-021"], 2000
    friction = np.linspace(0.02, 0.05, count)
    ss.demands(tank(), motion, {"slider.kinetic_friction": friction[:10]})
    start = time.perf_counter()
    table = ss.demands(tank(), motion, {"slider.kinetic_friction": friction}, jobs=1, check=0.0)
    seconds = time.perf_counter() - start
    plan = ss.Plan(tank(), {"a": motion}, {"slider.kinetic_friction": friction}, method="grid", bounds=None)
    start = time.perf_counter()
    study = ss.study(plan, jobs=1)
    assert seconds < 1.2 * (time.perf_counter() - start)
    assert np.array_equal(study.table[PEAK], table[PEAK])
