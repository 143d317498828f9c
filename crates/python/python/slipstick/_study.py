"""Many analyses of one plan."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, NamedTuple

from . import _core

if TYPE_CHECKING:
    from collections.abc import Callable
    from os import PathLike


class Study(NamedTuple):
    """What came of a study."""

    #: One row a run
    table: _core.Table
    #: Fractiles and counts, one row a level and demand
    summary: _core.Table
    runs: int
    #: Runs that have no answer; their status says why
    failures: int
    #: What a person should know
    notices: list[str]


def study(
    plan: str | PathLike[str],
    out: str | PathLike[str] | None = None,
    *,
    jobs: int | None = None,
    progress: Callable[[int, int], object] | None = None,
    force: bool = False,
) -> Study:
    """Run a study plan.

    Parameters
    ----------
    plan
        The plan, a TOML file.
    out
        A folder for parts, manifest and summary, as ``slipstick study --out`` writes it. What it holds
        of this study is not run again. A folder of its own, removed at the end, if left out.
    jobs
        Number of threads; as many as the machine has if left out.
    progress
        Called with the runs done and planned, some twenty times a second.
    force
        Whether parts in the folder are removed first.

    Returns
    -------
    Study
        The runs and their summary as tables.

    Raises
    ------
    InputError
        For a plan or a model that cannot be, with line and column.
    StudyError
        For a folder with parts of another study, and a run that fails its check.
    KeyboardInterrupt
        At Ctrl-C, which leaves whole parts.
    """

    def into(folder: Path) -> Study:
        done = _core.study(Path(plan), folder, jobs=jobs, progress=progress, force=force)
        return Study(done.table, done.summary, done.runs, done.failures, done.notices)

    if out is not None:
        return into(Path(out))
    with TemporaryDirectory(prefix="slipstick-") as folder:
        return into(Path(folder))
