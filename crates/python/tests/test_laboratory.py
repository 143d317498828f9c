"""Tests of a laboratory: equal to the command bit for bit."""

import pickle
from pathlib import Path

import numpy as np
import pytest

import slipstick as ss
from support import EXAMPLES, block, command

LABORATORY = EXAMPLES / "laboratory"
TABLE, SENSORS = LABORATORY / "shaking-table.csv", LABORATORY / "sensors.toml"
PULL_BACK = LABORATORY / "pull-back.csv"
CYCLIC = [LABORATORY / f"cyclic-{hz}hz.csv" for hz in ["0.1", "0.25", "1"]]


def mock_up(folder: Path) -> Path:
    """A block of the made tests, as a file."""
    path = folder / "mock-up.toml"
    path.write_text(
        '[block]\nmass = "124 kg"\n[slider]\nstatic_friction = 0.165\nkinetic_friction = 0.153\n'
        'tilt = "1 mrad"\n'
    )
    return path


def test_a_comparison_is_that_of_the_command(tmp_path: Path) -> None:
    path = mock_up(tmp_path)
    bounds = {"peak_ratio.sliding_displacement": (0.5, 1.5), "correlation.block_acceleration": (0.9, None)}
    found = ss.compare(TABLE, ss.Model.read(path), mapping=SENSORS, within=bounds)
    texts = ["peak_ratio.sliding_displacement=0.5..1.5", "correlation.block_acceleration=0.9.."]
    options = ["--mapping", SENSORS, *(word for text in texts for word in ["--within", text])]
    printed = command("compare", TABLE, path, *options, "--json", "-q")
    assert found._core._summary_json() == printed
    assert found.text() == command("compare", TABLE, path, *options, "-q")
    assert found.holds and len(found.verdict) == 3
    figures = found.tables["figures"]
    ratio = figures["peak_ratio"][figures["quantity"].index("sliding_displacement")]
    summary = {of["quantity"]: of for of in found.summary["quantities"]}
    assert ratio == summary["sliding_displacement"]["peak_ratio"]
    curve = found.curves["sliding_displacement"]
    assert np.abs(curve["predicted"]).max() == summary["sliding_displacement"]["predicted_peak"]
    again = ss.run(ss.Model.read(path), found.motion).summary
    assert again["peak_sliding_displacement_m"] == pytest.approx(np.abs(curve["predicted"]).max(), rel=1e-3)
    missed = ss.compare(
        TABLE, ss.Model.read(path), mapping=SENSORS, within={"correlation.block_acceleration": "2..3"}
    )
    assert not missed.holds and missed != found


def test_columns_of_arrays_are_those_of_the_file(tmp_path: Path) -> None:
    model = ss.Model.read(mock_up(tmp_path))
    lines = TABLE.read_text().splitlines()
    values = np.array([[float(word) for word in line.split(",")] for line in lines[1:]]).T
    columns = dict(zip(lines[0].split(","), values, strict=True))
    mapping = {
        "time": "t [s]",
        "table_acceleration": "A0 [g]",
        "block_acceleration": "A1 [g] * -1",
        "sliding_displacement": "D1 [mm]",
    }
    of_file = ss.compare(TABLE, model, mapping=SENSORS)
    assert ss.compare(columns, model, mapping=mapping).tables == of_file.tables
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(columns)
    frame["remark"] = "as seen"
    assert ss.compare(frame, model, mapping=mapping).tables == of_file.tables


def test_cyclic_tests_are_identified_as_by_the_command(tmp_path: Path) -> None:
    found = ss.identify.cyclic(CYCLIC, mass="124 kg")
    out = tmp_path / "out"
    printed = command("identify", "cyclic", *CYCLIC, "--mass", "124 kg", "--json", "-q", "--out", out)
    assert found._core._summary_json() == printed
    assert found.holds
    friction = found.estimates["slider.kinetic_friction"]
    assert friction.low < friction.value < friction.high and 0.15 < friction.value < 0.156
    assert found.model is not None and found.model.toml == (out / "model.toml").read_text()
    assert len(found.tables["cycles"]) == sum(len(test["cycles"]) for test in found.summary["tests"])
    assert set(found.curves) == {str(path) for path in CYCLIC}
    forces = ss.identify.cyclic(CYCLIC[2], without=["spring"], mapping={"zero": "as measured"})
    assert "slider.kinetic_friction_force.positive" in forces.estimates and forces.model is None


def test_friction_that_follows_the_speed_is_identified_as_by_the_command() -> None:
    files = [LABORATORY / f"bearing-{hz}hz.csv" for hz in ["0.005", "0.05", "0.5"]]
    found = ss.identify.cyclic(files, normal_force="800 kN", law="slow-fast-rate")
    options = ["--normal-force", "800 kN", "--law", "slow-fast-rate", "--json", "-q"]
    assert found._core._summary_json() == command("identify", "cyclic", *files, *options)
    assert found.holds and found.model is None
    rate = found.estimates["slider.kinetic_friction.rate"]
    assert rate.low < 25.0 < rate.high and rate.unit == "s/m"
    points, curve = found.tables["friction_by_speed"], found.tables["friction_curve"]
    assert len(points) > len(found.tables["cycles"]) and len(curve) == 61
    assert (curve["low"] < curve["kinetic_friction"]).all()
    assert "friction-by-speed" in found.figures


def test_friction_that_follows_the_pressure_is_identified_as_by_the_command() -> None:
    files = [LABORATORY / f"load-{load:04}kn.csv" for load in [400, 800, 1600]]
    forces = ["400 kN", "800 kN", "1600 kN"]
    found = ss.identify.cyclic(files, normal_force=forces, area="0.04 m2", reference_pressure="20 MPa")
    options = ["--normal-force", ",".join(forces), "--area", "0.04 m2", "--reference-pressure", "20 MPa"]
    assert found._core._summary_json() == command("identify", "cyclic", *files, *options, "--json", "-q")
    exponent = found.estimates["slider.pressure.exponent"]
    assert exponent.low < 0.2 < exponent.high
    points, curve = found.tables["friction_by_pressure"], found.tables["pressure_curve"]
    assert len(points) == len(found.tables["cycles"]) and len(curve) == 61
    assert (curve["low"] < curve["kinetic_friction"]).all()
    assert "friction-by-pressure" in found.figures
    with pytest.raises(ss.InputError, match="^normal_force: expected one force, or one for each of 3 tests"):
        ss.identify.cyclic(files, normal_force=forces[:2], area="0.04 m2")


def test_free_vibration_is_identified_as_by_the_command() -> None:
    found = ss.identify.free_vibration(PULL_BACK, start="1 s")
    printed = command("identify", "free-vibration", PULL_BACK, "--start", "1 s", "--json", "-q")
    assert found._core._summary_json() == printed
    assert found.estimates["storey.1.frequency"].value == pytest.approx(1.625, rel=1e-2)
    curve = found.curves["storey1_acceleration"]
    assert curve.columns == ["time_s", "measured", "fitted"]


def test_a_shaking_table_record_is_identified_as_by_the_command(tmp_path: Path) -> None:
    path, seen = mock_up(tmp_path), []
    fit = {"slider.kinetic_friction": None, "slider.tilt": "-5 mrad..5 mrad"}
    found = ss.identify.shaking_table(
        TABLE, ss.Model.read(path), fit, mapping=SENSORS, progress=lambda *at: seen.append(at)
    )
    words = ["slider.kinetic_friction", "slider.tilt=-5 mrad..5 mrad"]
    options = ["--fit", ",".join(words), "--mapping", SENSORS, "--json", "-q", "--out", tmp_path / "out"]
    assert found._core._summary_json() == command("identify", "shaking-table", TABLE, path, *options)
    assert found.model is not None and found.model.value("slider.tilt") == pytest.approx(1.5e-3, rel=0.2)


def test_results_pickle_and_compare(tmp_path: Path) -> None:
    model = ss.Model.read(mock_up(tmp_path))
    for found in [
        ss.compare(TABLE, model, mapping=SENSORS),
        ss.identify.free_vibration(PULL_BACK),
        ss.identify.cyclic(CYCLIC[0], mass="124 kg"),
    ]:
        back = pickle.loads(pickle.dumps(found))
        assert back == found and hash(back) == hash(found)
        assert back.text("us") == found.text("us") and dict(back.figures) == dict(found.figures)
        assert back.curves == found.curves and back.verdict == found.verdict
        pages = [one.report(tmp_path / "page.html").read_bytes() for one in [found, back]]
        assert pages[0] == pages[1] and pages[0].startswith(b"<!DOCTYPE html>")


def test_curves_are_drawn(tmp_path: Path) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    found = ss.compare(TABLE, ss.Model.read(mock_up(tmp_path)), mapping=SENSORS)
    assert len(found.plot()) == 2
    _, ax = matplotlib.pyplot.subplots()
    assert found.plot("sliding_displacement", ax=ax) is ax and "mm" in ax.get_ylabel()
    assert ss.identify.cyclic(CYCLIC[0]).plot()[0].get_xlabel() == "Displacement (mm)"
    matplotlib.pyplot.close("all")


@pytest.mark.parametrize(
    ("call", "error", "told"),
    [
        (lambda: ss.compare("nowhere.csv", block()), FileNotFoundError, "nowhere.csv"),
        (lambda: ss.compare(PULL_BACK, block()), ss.RecordError, "table_acceleration"),
        (lambda: ss.compare(TABLE, block(), mapping={"time": "q [s]"}), ss.InputError, "q"),
        (lambda: ss.compare(TABLE, block(), within={"peak_rato.force": "0..1"}), ss.InputError, "peak_ratio"),
        (lambda: ss.compare({"time_s": [0, 1], "force_n": [0]}, block()), ss.RecordError, "force_n"),
        (lambda: ss.identify.cyclic(CYCLIC[0], mass="124 kgg"), ss.InputError, "mass"),
        (lambda: ss.identify.cyclic(CYCLIC[0], mass="1 kg", model=block()), ss.InputError, "both"),
        (lambda: ss.identify.cyclic(CYCLIC[0], normal_force="-1 N"), ss.InputError, "normal_force"),
        (lambda: ss.identify.cyclic(CYCLIC[0], law="rate"), ss.InputError, "slow-fast-rate"),  # type: ignore[arg-type]
        (lambda: ss.identify.cyclic(PULL_BACK), ss.RecordError, "displacement"),
        (lambda: ss.identify.free_vibration(TABLE, mapping=SENSORS), ss.InputError, "channel"),
        (lambda: ss.identify.free_vibration(PULL_BACK, start="1 m"), ss.InputError, "start"),
        (
            lambda: ss.identify.shaking_table(TABLE, block(), ["slider.kinetic_frction"], mapping=SENSORS),
            ss.InputError,
            "nearest",
        ),
        (
            lambda: ss.identify.shaking_table(
                TABLE, block(), {"slider.kinetic_friction": "2..1"}, mapping=SENSORS
            ),
            ss.InputError,
            "LEAST",
        ),
    ],
)
def test_tests_that_cannot_be_are_told(call: object, error: type[Exception], told: str) -> None:
    with pytest.raises(error, match=told):
        call()  # type: ignore[operator]


def test_a_test_that_tells_nothing_is_told() -> None:
    still = {"time_s": np.arange(100) * 0.01, "displacement_m": np.zeros(100), "force_n": np.ones(100)}
    with pytest.raises(ss.StudyError, match="no sliding"):
        ss.identify.cyclic(still)
