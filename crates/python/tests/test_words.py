"""What is wrong is said in words of Python, and of the argument that is wrong."""

import re
from pathlib import Path

import numpy as np
import pytest

import slipstick as ss
from support import EXAMPLES, block, pulse, suite

SHELL = ["--", "[motion]", "/tmp", "slipstick-"]


def told(call: object) -> str:
    with pytest.raises((ss.InputError, ss.RecordError, ss.StudyError)) as caught:
        call()  # type: ignore[operator]
    return str(caught.value)


def test_errors_are_in_words_of_python(tmp_path: Path) -> None:
    bare, columns = tmp_path / "bare.txt", tmp_path / "two.csv"
    bare.write_text("0.1\n0.2\n")
    columns.write_text("time_s,north_g,east_g\n0,0,1\n1,2,3\n")
    motions = {"a": pulse()}
    in_two = ss.Motion([0.0, 0.2, -0.2, 0.0], y=[0.0, 0.1, -0.1, 0.0], dt=0.1, units="g")
    two = {"a": pulse(), "b": ss.Motion([0.0, 0.3, -0.2, 0.0], dt=0.4, units="g")}
    table = ss.ida(block(), two, scale_to="0.1..0.6 g:4", limit="9 mm").table
    levels = {"level": [0.1, 0.2, 0.3], "peak_sliding_displacement_m": [0.001, 0.002, 0.2]}
    runs = ss.Table(levels)
    other = tmp_path / "study"
    ss.study(ss.Plan(block(), motions), other)
    calls = {
        'units = "g" and dt = "0.01 s"': lambda: ss.read_record(bare),
        'channel = "north_g"': lambda: ss.read_record(columns),
        "^motion: expected a motion, for the model": lambda: ss.run(block()),
        "^jobs: expected a number of threads, or -1 for all, found 0": lambda: ss.ida(
            block(), motions, scale_to="1 g", jobs=0),
        "^over: expected one value, found several": lambda: ss.spectrum(
            block(), motions, {"slider.radius": "1 m", "block.mass": "1 t"}),
        "give units g": lambda: ss.fragility(runs, limit="9 mm", measure="PGA"),
        "force=True": lambda: ss.study(ss.Plan(block(), motions, scale=[2.0]), other),
        "^dt: expected a finite time step > 0, found -1": lambda: ss.Motion([0, 1], dt=-1.0, units="g"),
        "^vary.slider.radius.values.1: expected a length": lambda: ss.study(
            ss.Plan(block(), motions, {"slider.radius": ["1 kg"]}, method="grid")),
        "^measure: expected records that can be scaled to PGA, found PGA = 0 of quiet$": lambda: ss.study(
            ss.Plan(block(), {"quiet": pulse().scaled(0.0)}, measure="PGA", scale_to=["1 g"])),
        "^b: expected the other component of a, found the same motion$": lambda: ss.study(
            ss.Plan(block(), motions, second={"b": pulse()})),
        r"^records: expected motions: .*, found the path 'a.txt' \(read_record or read_suite reads it\)$": lambda: ss.ida(
            block(), "a.txt", limit="9 mm"),  # type: ignore[arg-type]
        "^records: expected a motion in place 2, found the path": lambda: ss.Plan(
            block(), [pulse(), Path("a.txt")]),  # type: ignore[list-item]
        r"^records: expected a motion as 'a', found an array \(Motion\(array, ": lambda: ss.suite(
            block(), {"a": np.zeros(3)}),  # type: ignore[dict-item]
        "^motion: expected motions: .*, found an array": lambda: ss.run(
            block(), np.zeros(3)),  # type: ignore[call-overload]
        "^vary: expected arrays by path, {path: array}, or a frame of designs, found list$": lambda: ss.demands(
            block(), pulse(), [1.0]),
        "^slider.radius: expected finite numbers, found NaN in row 1$": lambda: ss.demands(
            block(), pulse(), {"slider.radius": [1.0, np.nan]}),
        "^vary.slider.radius: expected finite numbers, found NaN in row 1$": lambda: ss.study(
            ss.Plan(block(), motions, {"slider.radius": [1.0, np.nan]})),
        "^over slider.radius: expected finite numbers, found NaN in row 1$": lambda: ss.spectrum(
            block(), motions, {"slider.radius": [1.0, np.nan]}),
        "^scale_to: expected finite numbers, found NaN in row 0$": lambda: ss.ida(block(), motions, scale_to=[np.nan, 1.0]),
        r"^model: expected a Model, found the path 'a.toml' \(Model.read reads it\)$": lambda: ss.run(
            "a.toml", pulse()),  # type: ignore[call-overload]
        "^models 'a': expected a Model, found Motion$": lambda: ss.suite(
            {"a": pulse()}, motions),  # type: ignore[dict-item]
        "^motion: expected a motion, found the path 'a.txt'": lambda: block().to_opensees(
            "a.txt", "10 kN/mm"),  # type: ignore[arg-type]
        "^pairs: expected together, for slider.tilt_y is of motions in two directions, found \"separate\"$": lambda: ss.suite(
            block().with_({"slider.tilt_y": 1e-3}), [in_two], pairs="separate"),
        "^pairs: expected together, for slider.tilt_y is of": lambda: ss.study(
            ss.Plan(block().with_({"slider.tilt_y": 1e-3}), [in_two], pairs="separate")),
        r"^model: expected a Model, found the path 'a.toml' \(Model.read reads it\)": lambda: ss.compare(
            {"time_s": [0.0, 1.0]}, "a.toml"),  # type: ignore[arg-type]
        "^measured: expected columns by name: a dict of arrays, or a frame of any library, found Motion$": lambda: ss.compare(
            pulse(), block()),
        "^measured time_s: expected values without a mask": lambda: ss.compare(
            {"time_s": np.ma.array([0.0, 1.0], mask=[False, True])}, block()),
        "^tests: expected columns by name: .*, found None$": lambda: ss.identify.cyclic(None),  # type: ignore[arg-type]
        "^model: expected a Model, found 3$": lambda: ss.identify.free_vibration({}, model=3),  # type: ignore[arg-type]
        "^ops: expected the module openseespy.opensees with a model in it, found None$": lambda: ss.Model.from_opensees(
            None, {}, mass_unit="1 t", nodes={}, damping_ratio=0.02),
        '^source: expected a column among level, exceeded, .*, found "exceded"; nearest is "exceeded"$': lambda: ss.fragility(
            {"level": [0.1, 0.2], "exceded": [1, 2], "runs": [4, 4]}, measure="PGA", units="g"),
        '^source: expected a column among .*, found "levl"; nearest is "level"$': lambda: ss.fragility(
            {"levl": [0.1, 0.2], "exceeded": [1, 2], "runs": [4, 4]}, measure="PGA", units="g"),
        '^demand: .*, found "peak_sliding_displacement_m"; nearest is "peak_sliding_displacment_m"$': lambda: ss.fragility(
            {"level": [0.1, 0.2], "peak_sliding_displacment_m": [1, 2]}, measure="PGA", units="g", limit="1 m"),
        "^columns: expected columns among run, .*; nearest is \"peak_sliding_displacement_m\"$": lambda: ss.demands(
            block(), pulse(), {"block.mass": 1e3}, columns=["peak_sliding_displacemnt_m"]),
        "^jobs: expected a whole number, found 'all'$": lambda: ss.suite(
            block(), motions, jobs="all"),  # type: ignore[arg-type]
        "^progress: expected a callable of runs done and planned, a bar such as tqdm, or False, found 3$": lambda: ss.ida(
            block(), motions, progress=3),  # type: ignore[arg-type]
        "^history: expected True or False, found 'no'$": lambda: ss.run(
            block(), pulse(), history="no"),  # type: ignore[call-overload]
        "^column: expected text, found 3$": lambda: runs[3],  # type: ignore[index]
        "^frame: expected columns of one length, 1 as 'a', found 2 in 'b'$": lambda: ss.Table({"a": [1], "b": [1, 2]}),
        "^table: expected a table among ida, found 'idas'; nearest is \"ida\"$": lambda: ss.ida(
            block(), two, scale_to="1 g").plot(table="idas"),
        "^samples: expected a number of samples beside distributions, found none$": lambda: ss.Plan(
            block(), motions, {"slider.radius": {"uniform": [1.0, 2.0]}}),
    }
    for expected, call in calls.items():
        text = told(call)
        assert not [word for word in SHELL if word in text.replace(str(tmp_path), "")], text
        assert re.search(expected, text), text
    assert "cloud" in str(ss.fragility(table, fit_to="cloud", limit="9 mm", floor="1 mm"))
    assert "--" not in str(ss.fragility(table, fit_to="cloud", limit="9 mm", floor="1 mm"))


def test_notices_call_records_by_their_names() -> None:
    found = ss.study(ss.Plan(block(), {"one": pulse(), "other": pulse()}))
    assert found.notices == ["one and other are the same motion: it counts twice"]


@pytest.mark.parametrize("name", ["up", "Z", "a/b", "H-DLTDWN", "v.1"])
def test_a_record_may_have_any_name(name: str) -> None:
    # The file of the plan is no vertical component, whatever it is called.
    assert ss.study(ss.Plan(block(), {name: pulse()})).table["record"] == [name]


def test_minus_one_job_is_all() -> None:
    found = [ss.ida(block(), {"a": pulse()}, scale_to="0.1..0.3 g:3", limit="1 mm", jobs=jobs) for jobs in (-1, 1)]
    assert found[0].table == found[1].table


def test_one_ida_has_one_fragility() -> None:
    model = ss.Model.read(EXAMPLES / "taft.toml")
    ida = ss.ida(model, suite(), scale_to="0.2..0.27 g:29", limit="40 mm", bounds="nominal")
    curves = [ss.fragility(ida), ss.fragility(ida, limit="40 mm"), ss.fragility(ida.table, limit="40 mm", measure="PGA")]
    assert len({curve.summary["median"] for curve in curves}) == 1


def test_a_plan_file_becomes_a_plan(tmp_path: Path) -> None:
    model = ss.Model.read(EXAMPLES / "studies" / "tank.toml")
    plan = ss.Plan(
        model, suite(), {"slider.kinetic_friction": {"uniform": [np.float64(0.02), 0.05]},
                         "slider.radius": ("1 m", "2 m")},
        samples=np.int64(16), seed=3, measure="PGA", scale_to=["0.2 g", "0.4 g"], bounds="nominal", name="A",
    )
    path = plan.write(tmp_path)
    read = ss.Plan.read(path)
    bare = {"motion": None}  # Its record is looked for beside the file.
    assert read.model.with_(bare) == model.with_(bare) and read.records == plan.records and read.name == "A"
    assert ss.study(read).table == ss.study(plan).table
    path.write_text(path.read_text().replace('"count" = 16', '"count" = 0'))
    with pytest.raises(ss.InputError) as caught:
        ss.Plan.read(path)
    assert caught.value.path == "sampling.count" and caught.value.line


def test_quantities_of_numpy_and_pint_in_requests() -> None:
    unit = pytest.importorskip("pint").UnitRegistry()
    records = {"a": pulse(), "b": pulse().scaled(0.5)}
    by_text = ss.spectrum(block(), records, {"slider.radius": "1, 2, 3 m"}, friction="0.05, 0.06")
    for radii in [np.array([1, 2, 3]) * unit.m, [1.0 * unit.m, 200 * unit.cm, "3 m"]]:
        friction = np.linspace(0.05, 0.06, 2)
        assert ss.spectrum(block(), records, {"slider.radius": radii}, friction=friction).table == by_text.table
