"""Derivatives of demands."""

import json
import pickle
from pathlib import Path

import numpy as np
import pytest

import slipstick as ss
from support import EXAMPLES, block, command, pulse, suite

PATHS = ["slider.kinetic_friction", "slider.radius"]


def taft() -> tuple[ss.Model, ss.Motion]:
    model = ss.Model.read(EXAMPLES / "taft.toml")
    return model, ss.run(model).motion


def test_a_derivative_is_the_difference_of_runs() -> None:
    model, motion = taft()
    demand = "peak_sliding_displacement_m"
    found = ss.sensitivity(model, motion, PATHS, demand=demand)
    table = found.table
    assert table["path"] == PATHS and table["demand"] == [demand] * 2
    for row, path in enumerate(PATHS):
        value = model.value(path)
        assert value is not None
        h = 1e-6 * value
        more, less = (
            ss.run(model.with_({path: f"{x!r} m" if path == "slider.radius" else x}), motion).summary[demand]
            for x in (value + h, value - h)
        )
        derivative = table["derivative"][row]
        error = table["error"][row]
        assert abs(derivative - (more - less) / (2 * h)) <= error and 0.0 < error < 1e-4 * abs(derivative)
        assert table["relative"][row] == pytest.approx(derivative * value / table["demand_value"][row])
    assert list(table["events_change"]) == [False, False]
    [record] = found.summary["records"]
    assert record["holds"] and record["closest_call"] > 0.0 and record["analyses"] == 2 * 2 + 3


def test_the_answer_is_that_of_the_command(tmp_path: Path) -> None:
    model = ss.Model.read(EXAMPLES / "taft.toml")
    found = ss.sensitivity(model, None, PATHS)
    asked = ["--vary", ",".join(PATHS), "--json", "-q", "--out", tmp_path / "out"]
    assert found._core._summary_json() == command("sensitivity", EXAMPLES / "taft.toml", *asked)
    assert found.table.to_csv() == (tmp_path / "out" / "sensitivity.csv").read_text()
    assert "<svg" in found._repr_html_() and found.figures["tornado"] in found._repr_html_()


def test_many_motions_have_one_tornado() -> None:
    pytest.importorskip("matplotlib").use("Agg")
    model = ss.Model.read(EXAMPLES / "taft.toml")
    records = suite()
    found = ss.sensitivity(model, records, PATHS, scale_to="0.4 g")
    assert set(found.table["record"]) == set(records)
    assert pickle.loads(pickle.dumps(found)) == found
    axes = found.plot("residual_sliding_displacement_m", height=0.5)
    assert len(axes.patches) == 2 and axes.patches[0].get_height() == 0.5
    assert found.plot(ax=axes) is axes
    with pytest.raises(ss.InputError, match="^demand: expected one of peak_sliding"):
        found.plot("drift")


def test_a_pair_is_derived_too() -> None:
    pair = ss.Motion([0.0, 2.0, -2.0, 0.0], y=[0.0, 1.0, 1.0, 0.0], dt=0.5, units="m/s2")
    found = ss.sensitivity(block(), pair, "slider.kinetic_friction", demand="sliding_path_m")
    assert found.table["derivative"][0] < 0.0


def test_all_numbers_of_the_model_are_derived_where_no_path_is_named() -> None:
    found = ss.sensitivity(block(), pulse(), demand="peak_sliding_displacement_m")
    assert {"block.mass", "slider.kinetic_friction"} <= set(found.table["path"])


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ({"vary": "slider.radius"}, "^vary: expected keys that stand in the model as one number"),
        ({"vary": "slider.raduis"}, 'nearest is "slider.radius"'),
        ({"vary": "block.mass", "demand": "slip_count"}, "^demand: expected a demand that is a number"),
        ({"vary": "block.mass", "records": {}}, "^records: expected at least one motion"),
    ],
)
def test_what_cannot_be_derived_is_told(arguments: dict[str, object], told: str) -> None:
    with pytest.raises(ss.InputError, match=told):
        ss.sensitivity(**{"model": block(), "records": pulse(), **arguments})  # type: ignore[arg-type]


def test_json_of_the_answer_has_no_nan() -> None:
    model = block().with_({"slider.damper": "0 N s/m"})
    found = ss.sensitivity(model, pulse(), ["slider.damper", "block.mass"])
    assert "NaN" not in found._core._summary_json() and json.loads(found._core._summary_json())
    # A demand that there is not has no derivative: nothing says how near the gap is.
    there = np.isfinite(found.table["demand_value"])
    assert not there.all() and np.isfinite(found.table["derivative"][there]).all()
