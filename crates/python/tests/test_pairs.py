"""Pairs of components: motions in two directions wherever the command takes ``--second``, with the same bits."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import slipstick as ss
from support import EXAMPLES, command

MODEL = EXAMPLES / "taft.toml"
FILES = [EXAMPLES / "records" / name for name in ("taft-021.txt", "taft-111.txt")]
STEMS = [file.stem for file in FILES]
READ: dict[str, Any] = {"units": "g", "dt": 0.01}
PEAK = "peak_sliding_displacement_m"


def model() -> ss.Model:
    return ss.Model.read(MODEL)


def pairs() -> dict[str, ss.Motion]:
    """Both orders of the two components, each as one motion."""
    return {
        " + ".join(stems): ss.read_record(first, y=second, **READ)
        for stems, (first, second) in zip([STEMS, STEMS[::-1]], [FILES, FILES[::-1]], strict=True)
    }


def apart() -> tuple[dict[str, ss.Motion], dict[str, ss.Motion]]:
    """The same as records and their other components."""
    first = ss.read_suite(FILES, **READ)
    return first, dict(reversed(first.items()))


def by_command(kind: str, folder: Path, *asked: str) -> str:
    """What the command answers of the same pairs."""
    files = ["--records", FILES[0], "--records", FILES[1], "--second", FILES[1], "--second", FILES[0]]
    return command(kind, MODEL, *files, "--units", "g", "--dt", "0.01 s", *asked, "--json", "-q", "--out", folder)


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
        ["--paths", "slider.radius", "--measure", "PGV", "--scale-to", "0.3 m/s"],
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
        {"friction": "0.02..0.06:3", "gap": "80 mm", "scale": 2.0, "sensitivity": 0},
        ["--vary", "slider.radius=1..3 m:5", "--friction", "0.02..0.06:3", "--gap", "80 mm", "--scale", "2"]
        + ["--sensitivity", "0"],
        "runs",
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
    assert found._core._summary_json() == by_command(kind, tmp_path, *asked)
    assert found.tables[table].to_csv() == (tmp_path / f"{table}.csv").read_text()
    first, second = apart()
    beside = call(model(), first, *arguments, second=second, **keywords)
    assert beside.tables == found.tables and beside.text == found.text


def test_several_motions_in_two_directions_are_a_suite() -> None:
    found = ss.run(model(), pairs())
    assert found == ss.suite(model(), pairs())
    assert found.table["record"][0] == "taft-021 + taft-111"
    assert "peak_sliding_displacement_100_30_m" in found.table


@pytest.mark.parametrize(
    ("call", "keywords"),
    [(ss.suite, {"scale": 2.0}), (ss.ida, {"scale_to": "0.1..0.8 g:8", "limit": "40 mm", "bounds": "nominal"})],
)
def test_components_of_a_motion_are_run_separately(
    call: Callable[..., ss.Assessment], keywords: Mapping[str, Any]
) -> None:
    found = call(model(), pairs(), pairs="separate", **keywords).table
    first, second = apart()
    beside = call(model(), first, second=second, pairs="separate", **keywords).table
    assert list(dict.fromkeys(found["record"]))[:2] == [f"taft-021 + taft-111 {axis}" for axis in "xy"]
    assert list(dict.fromkeys(found["pair"]))[0] == "taft-021 + taft-111 x"
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
    asked: dict[str, Any] = {"method": "grid", "measure": "RotD50(1.2 s)", "levels": ["0.2 g", "0.4 g"]}
    found = ss.study(ss.Plan(model(), pairs(), vary, **asked))
    first, second = apart()
    beside = ss.study(ss.Plan(model(), first, vary, second=second, **asked))
    # The names of motions, of records those of the first components.
    assert list(dict.fromkeys(found.table["record"])) == list(pairs())
    assert list(dict.fromkeys(beside.table["record"])) == STEMS
    same = [name for name in found.table if name not in ("record", "channel")]
    assert found.table.columns == beside.table.columns and "x.peak_sliding_displacement_m" in same
    for name in same:
        assert list(found.table[name]) == list(beside.table[name]) or np.array_equal(
            found.table[name], beside.table[name], equal_nan=True
        ), name
    path = ss.Plan(model(), pairs(), vary, **asked).write(tmp_path / "plan")
    command("study", path, "--out", tmp_path / "out", "-q")
    by_it = ss.Table.read(sorted((tmp_path / "out" / "parts").glob("*.parquet"))[0])
    assert by_it[PEAK].tolist() == found.table[PEAK].tolist()
    again = ss.Plan.read(path)
    assert ss.study(again).table[PEAK].tolist() == found.table[PEAK].tolist()
    separate = ss.study(ss.Plan(model(), pairs(), vary, pairs="separate", **asked))
    both = ss.study(ss.Plan(model(), first, vary, second=second, pairs="separate", **asked))
    assert separate.runs == both.runs == 2 * found.runs
    assert separate.table[PEAK].tolist() == both.table[PEAK].tolist()
    assert list(dict.fromkeys(separate.table["record"]))[:2] == ["taft-021 + taft-111 x", "taft-021 + taft-111 y"]


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
    pair, alone = pairs(), ss.read_suite(FILES, **READ)
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
    beside = f'^second: expected records in one direction beside it, found "{name}" in two$'.replace("+", r"\+")
    with pytest.raises(ss.InputError, match=beside):
        ss.ida(model(), pair, second=alone, limit="40 mm")
    with pytest.raises(ss.InputError, match=beside):
        ss.Plan(model(), pair, second=alone)
    with pytest.raises(ss.InputError, match="^pairs: expected pairs that are run together"):
        ss.spectrum(model(), pair, pairs="separate")
