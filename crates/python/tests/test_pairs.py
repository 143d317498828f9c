"""Pairs of components: motions in two directions wherever the command takes ``--second``, with the same bits."""

import json
import re
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import slipstick as ss
from support import EXAMPLES, command

MODEL = EXAMPLES / "taft.toml"
#: Records as far as they are strong: a run in two directions costs by the sample.
SAMPLES = {"taft-021": 1500, "taft-111": 1500, "el-centro-180": 1200}
FOLDER = tempfile.TemporaryDirectory(prefix="slipstick-pairs-")


def first_samples(name: str) -> Path:
    """A file of the first samples of a record of the examples, one a line."""
    path = Path(FOLDER.name) / f"{name}.txt"
    lines = (EXAMPLES / "records" / path.name).read_text(encoding="utf-8").splitlines(keepends=True)
    path.write_text("".join(lines[: SAMPLES[name]]), encoding="utf-8")
    return path


#: The last two are of no one station: a pair of other lengths.
X, Y = ([first_samples(name) for name in names] for names in (("taft-021", "el-centro-180"), ("taft-111", "taft-021")))
READ: dict[str, Any] = {"units": "g", "dt": 0.01}
PEAK = "peak_sliding_displacement_m"


def model() -> ss.Model:
    return ss.Model.read(MODEL)


def pairs() -> dict[str, ss.Motion]:
    """Each pair as one motion, by the name that the command gives it: a stem stands twice among the files."""
    return {f"{x} + {y}": ss.read_record(x, y=y, **READ) for x, y in zip(X, Y, strict=True)}


def apart() -> tuple[dict[str, ss.Motion], dict[str, ss.Motion]]:
    """The same as records and their other components."""
    first, second = ({str(file): ss.read_record(file, **READ) for file in files} for files in (X, Y))
    return first, second


def by_command(kind: str, folder: Path, *asked: str) -> str:
    """What the command answers of the same pairs."""
    files = [word for x, y in zip(X, Y, strict=True) for word in ("--records", x, "--second", y)]
    return command(kind, MODEL, *files, "--units", "g", "--dt", "0.01 s", *asked, "--json", "-q", "--out", folder)


def figures(told: Any) -> Any:
    """All of an answer but what was noticed of its records, which of one motion says along which axis."""
    if isinstance(told, dict):
        return {key: figures(value) for key, value in told.items() if key not in ("warnings", "notes", "notices")}
    return [figures(value) for value in told] if isinstance(told, list) else told


CASES: list[tuple[str, Callable[..., ss.Assessment], list[Any], dict[str, Any], list[str], str]] = [
    ("run", ss.suite, [], {"scale": 2.0}, ["--scale", "2"], "runs"),
    (
        "run",
        ss.suite,
        [],
        {"code_spectrum": "sds = 1 g, sd1 = 0.6 g, tl = 8 s", "periods": "0.4 s..4 s"},
        ["--code-spectrum", "sds = 1 g, sd1 = 0.6 g, tl = 8 s", "--periods", "0.4 s..4 s"],
        "runs",
    ),
    (
        "run",
        ss.suite,
        [],
        {
            "code_spectrum": "sds = 1 g, sd1 = 0.6 g, tl = 8 s",
            "code": "asce7-22",
            "code_values": ["R = 4", "I_e = 1.5"],
            "hazard": ["MCE_R", "DE=0.5"],
            "periods": "0.4 s..4 s",
        },
        ["--code-spectrum", "sds = 1 g, sd1 = 0.6 g, tl = 8 s", "--periods", "0.4 s..4 s", "--code", "asce7-22"]
        + ["--code-values", "R = 4, I_e = 1.5", "--hazard", "MCE_R", "--hazard", "DE=0.5"],
        "runs",
    ),
    (
        "spectrum",
        ss.spectrum,
        [{"slider.radius": "1..3 m:3"}],
        {"measure": "RotD50(1.2 s)", "scale_to": "0.3 g"},
        ["--over", "slider.radius=1..3 m:3", "--measure", "RotD50(1.2 s)", "--scale-to", "0.3 g"],
        "spectrum",
    ),
    (
        "sensitivity",
        ss.sensitivity,
        ["slider.radius"],
        {"measure": "PGV", "scale_to": "0.3 m/s"},
        ["--vary", "slider.radius", "--measure", "PGV", "--scale-to", "0.3 m/s"],
        "sensitivity",
    ),
    (
        "ida",
        ss.ida,
        [],
        {"measure": "RotD100(1.2 s)", "scale_to": "0.1..0.8 g:8", "limit": "40 mm"},
        ["--measure", "RotD100(1.2 s)", "--scale-to", "0.1..0.8 g:8", "--limit", "40 mm"],
        "ida",
    ),
    ("ida", ss.ida, [], {"limit": "40 mm", "bounds": "lower"}, ["--limit", "40 mm", "--bounds", "lower"], "ida"),
    (
        "design",
        ss.design,
        [{"slider.radius": "1..3 m:5"}],
        {"friction": "0.02..0.06:3", "gap": "250 mm", "scale": 2.0, "sensitivity": 0},
        ["--vary", "slider.radius=1..3 m:5", "--friction", "0.02..0.06:3", "--gap", "250 mm", "--scale", "2"]
        + ["--sensitivity", "0"],
        "front",
    ),
]


@pytest.mark.parametrize(("kind", "call", "arguments", "keywords", "asked", "table"), CASES)
def test_motions_in_two_directions_are_the_pairs_of_the_command(
    tmp_path: Path,
    kind: str,
    call: Callable[..., ss.Assessment],
    arguments: list[Any],
    keywords: Mapping[str, Any],
    asked: list[str],
    table: str,
) -> None:
    found = call(model(), pairs(), *arguments, **keywords)
    assert figures(found.summary) == figures(json.loads(by_command(kind, tmp_path, *asked)))
    assert found.tables[table].to_csv() == (tmp_path / f"{table}.csv").read_text()
    first, second = apart()
    beside = call(model(), first, *arguments, second=second, **keywords)
    assert beside.tables == found.tables and figures(beside.summary) == figures(found.summary)


def test_several_motions_in_two_directions_are_a_suite() -> None:
    found = ss.run(model(), pairs())
    assert found == ss.suite(model(), pairs())
    assert found.table["record"][0] == next(iter(pairs()))
    assert "peak_sliding_displacement_100_30_m" in found.table


@pytest.mark.parametrize(
    ("call", "keywords"),
    [(ss.suite, {"scale": 2.0}), (ss.ida, {"scale_to": "0.1..0.8 g:8", "limit": "40 mm", "bounds": "nominal"})],
)
def test_components_of_a_motion_are_run_separately(
    call: Callable[..., ss.Assessment], keywords: Mapping[str, Any]
) -> None:
    # Components of one length: together the shorter has the times of the longer.
    name, pair = next(iter(pairs().items()))
    found = call(model(), {name: pair, "again": pair}, pairs="separate", **keywords).table
    x, y = (next(iter(components.values())) for components in apart())
    beside = call(model(), {"1x": x, "2x": x}, second={"1y": y, "2y": y}, pairs="separate", **keywords).table
    assert list(dict.fromkeys(found["record"]))[:2] == [f"{name} {axis}" for axis in "xy"]
    assert list(dict.fromkeys(found["pair"]))[0] == f"{name} x"
    numbers = [name for name in beside if isinstance(beside[name], np.ndarray)]
    assert found.columns == beside.columns and PEAK in numbers or "demand" in numbers
    for name in numbers:
        assert np.array_equal(found[name], beside[name], equal_nan=True), name


def test_a_fragility_of_pairs_takes_each_once() -> None:
    asked: dict[str, Any] = {"scale_to": "0.1..0.8 g:15", "limit": "40 mm", "bounds": "nominal"}
    first, second = apart()
    found = ss.fragility(ss.ida(model(), pairs(), **asked), fit_to="capacities")
    beside = ss.fragility(ss.ida(model(), first, second=second, **asked), fit_to="capacities")
    assert found.summary == beside.summary and found.table == beside.table


def test_a_study_of_motions_in_two_directions_is_that_of_the_command(tmp_path: Path) -> None:
    vary = {"slider.radius": ["1 m", "2 m"]}
    asked: dict[str, Any] = {"method": "grid", "measure": "RotD50(1.2 s)", "scale_to": ["0.2 g", "0.4 g"]}
    found = ss.study(ss.Plan(model(), pairs(), vary, **asked))
    first, second = apart()
    beside = ss.study(ss.Plan(model(), first, vary, second=second, **asked))
    # The names of motions, of records those of the first components.
    assert list(dict.fromkeys(found.table["record"])) == list(pairs())
    assert list(dict.fromkeys(beside.table["record"])) == list(first)
    # The other length is noticed of two records, and is that of one motion.
    same = [name for name in found.table if name not in ("record", "warnings")]
    assert found.table.columns == beside.table.columns and "x.peak_sliding_displacement_m" in same
    for name in same:
        assert str(list(found.table[name])) == str(list(beside.table[name])), name
    path = ss.Plan(model(), pairs(), vary, **asked).write(tmp_path / "plan")
    command("study", path, "--out", tmp_path / "out", "-q")
    by_it, *_ = ss._core.read_runs(tmp_path / "out", None)
    assert by_it[PEAK].tolist() == found.table[PEAK].tolist()
    again = ss.Plan.read(path)
    assert ss.study(again).table[PEAK].tolist() == found.table[PEAK].tolist()
    name, pair = next(iter(pairs().items()))
    separate = ss.study(ss.Plan(model(), {name: pair}, vary, pairs="separate", **asked))
    one, other = ({stem: motion} for stem, motion in (*list(first.items())[:1], *list(second.items())[:1]))
    both = ss.study(ss.Plan(model(), one, vary, second=other, pairs="separate", **asked))
    assert separate.runs == both.runs == found.runs
    assert separate.table[PEAK].tolist() == both.table[PEAK].tolist()
    assert list(dict.fromkeys(separate.table["record"])) == [f"{name} x", f"{name} y"]


def test_demands_of_motions_in_two_directions_are_those_of_run() -> None:
    radii = [1.0, 2.0, 4.0]
    table = ss.demands(model(), pairs(), {"slider.radius": radii}, check=1.0)
    assert table["record"] == [name for name in pairs() for _ in radii]
    alone = [
        ss.run(model().with_({"slider.radius": f"{radius} m"}), motion).summary
        for motion in pairs().values()
        for radius in radii
    ]
    assert table[PEAK].tolist() == [summary[PEAK] for summary in alone]


def test_a_pair_of_arrays_with_a_vertical_component_is_one_too() -> None:
    rng = np.random.default_rng(1)
    times = np.cumsum(rng.uniform(0.01, 0.05, 200))
    x, y, up = rng.normal(size=(3, 200))
    motion = ss.Motion(x, y=y, vertical=up, times_s=times - times[0], units="m/s2")
    vary = {"slider.radius": ["1 m", "2 m"]}
    study = ss.study(ss.Plan(model(), {"noise": motion}, vary, method="grid", bounds="nominal"))
    table = ss.demands(model(), {"noise": motion}, {"slider.radius": [1.0, 2.0]}, check=1.0)
    assert study.table[PEAK].tolist() == table[PEAK].tolist()
    assert study.table["record"] == ["noise"] * 2
    one = ss.run(model().with_({"slider.radius": "1 m"}), motion).summary[PEAK]
    found = ss.spectrum(model(), {"noise": motion}, {"slider.radius": "1, 2 m"}, bounds="nominal")
    assert found.tables["runs"][PEAK].tolist()[0] == one == table[PEAK][0]


def test_pairs_that_cannot_be_are_told() -> None:
    pair, (alone, _) = pairs(), apart()
    name = next(iter(pair))
    mixed = {**pair, "alone": next(iter(alone.values()))}
    told = '^(records|motion): expected motions all in one direction or all in two, found "alone" in one$'
    calls: list[Callable[[Mapping[str, ss.Motion]], object]] = [
        lambda records: ss.suite(model(), records),
        lambda records: ss.sensitivity(model(), records, "slider.radius"),
        lambda records: ss.demands(model(), records, {"slider.radius": [1.0]}),
        lambda records: ss.Plan(model(), records),
    ]
    for call in calls:
        with pytest.raises(ss.InputError, match=told.replace("motion)", "motions?)")):
            call(mixed)
    beside = re.escape(f'second: expected records in one direction beside it, found "{name}" in two')
    with pytest.raises(ss.InputError, match=beside):
        ss.ida(model(), pair, second=alone, limit="40 mm")
    with pytest.raises(ss.InputError, match=beside):
        ss.Plan(model(), pair, second=alone)
    with pytest.raises(ss.InputError, match="^pairs: expected pairs that are run together"):
        ss.spectrum(model(), pair, pairs="separate")


@pytest.mark.parametrize("separate", [False, True])
def test_a_study_says_of_a_motion_what_the_motion_does(separate: bool) -> None:
    # Components of unequal lengths: on the times of both the shorter ends with a jump, which is none of their faults.
    name, pair = list(pairs().items())[1]
    assert "lengths_differ" in dict(pair.warnings)
    plan = ss.Plan(model(), {name: pair}, scale=[1.0], bounds="nominal", pairs="separate" if separate else None)
    for said in ss.study(plan).table["warnings"]:
        assert "lengths_differ" in said and "times_rounded" not in said and "duplicate_rows" not in said


def test_a_suite_of_pairs_is_read_at_once() -> None:
    found = ss.read_suite(X, y=Y, **READ)
    assert found == pairs() and [m.warnings for m in found.values()] == [m.warnings for m in pairs().values()]
    with pytest.raises(ss.InputError, match="y: expected one component along y for each of 2 records, found 1"):
        ss.read_suite(X, y=Y[:1], **READ)
    with pytest.raises(Exception, match="expected the other component of .*, found the same motion"):
        ss.read_suite(X, y=X, **READ)


def test_figures_in_two_directions_say_which_axis() -> None:
    pytest.importorskip("matplotlib").use("Agg")
    response = ss.run(model(), next(iter(pairs().values())))
    sliding, acceleration, loop = response.plot()
    assert [line.get_label() for line in sliding.lines][::2] == ["along x", "along y"]
    assert acceleration.get_ylabel() == "Acceleration along x (g)"
    assert [line.get_label() for line in acceleration.lines] == ["ground", "block", "storey 1"]
    assert [line.get_label() for line in loop.lines] == ["along x", "along y"]
    knots = response.knots
    top = response.plot.acceleration(along="y").lines[2].get_ydata()
    assert list(top) == list(knots["storey1_acceleration_y_m_per_s2"] / 9.80665)
    both = response.plot.history(along="resultant").lines[0].get_ydata()
    assert np.allclose(both, 1e3 * np.hypot(knots["sliding_displacement_m"], knots["sliding_displacement_y_m"]))
    assert response.plot.drift(along="y").get_ylabel() == "Drift along y (mm)"
    with pytest.raises(ValueError, match="^along: expected one of x, y, both"):
        response.plot.loop(along="resultant")


def test_a_structure_by_its_modes_is_drawn_by_the_names_of_its_points() -> None:
    pytest.importorskip("matplotlib").use("Agg")
    response = ss.run(ss.Model.read(EXAMPLES / "structures" / "building.toml"))
    assert [line.get_label() for line in response.plot.drift().lines] == ["First", "Second", "Roof"]
    assert [line.get_label() for line in response.plot.acceleration().lines] == ["ground", "block", "Roof"]


def test_floor_spectra_of_a_pair() -> None:
    pytest.importorskip("matplotlib").use("Agg")
    motion = next(iter(pairs().values()))
    response = ss.run(model(), motion, floor_spectrum=True)
    spectra = response.summary["floor_spectrum"]
    for key in ["table_acceleration_m_per_s2", "block_acceleration_m_per_s2"]:
        x, y = (np.asarray(spectra[axis][key]) for axis in "xy")
        largest = np.asarray(spectra[key])
        assert (largest >= np.maximum(x, y)).all() and (largest <= np.hypot(x, y)).all()
    drawn = response.plot.floor_spectra()
    assert drawn.get_ylabel() == "Spectral acceleration (g), RotD100"
    assert list(drawn.lines[1].get_ydata()) == [a / 9.80665 for a in spectra["block_acceleration_m_per_s2"]]
    drawn = response.plot.floor_spectra(along="y")
    assert drawn.get_ylabel() == "Spectral acceleration (g), along y"
    assert list(drawn.lines[1].get_ydata()) == [a / 9.80665 for a in spectra["y"]["block_acceleration_m_per_s2"]]
    with pytest.raises(ValueError, match="along: expected one of x, y, found 'both'"):
        response.plot.floor_spectra(along="both")
