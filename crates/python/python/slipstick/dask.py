"""Studies on a cluster of Dask, and by dask-jobqueue on Slurm.

Plan, model and records travel with the tasks as values, or as the path of a plan that all workers see; the parts go to a folder that all workers see.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _core
from ._study import Plan, Study, run_shard, study

if TYPE_CHECKING:
    from os import PathLike


def submit_study(
    plan: Plan | str | PathLike[str],
    client: Any,
    out: str | PathLike[str],
    *,
    shards: int | None = None,
    retries: int = 2,
    jobs: int = 1,
) -> list[Any]:
    """Submit a study, one task a shard.

    Parameters
    ----------
    plan
        A ``Plan``, whose values travel with the tasks, or the path of a plan file that all workers see.
    client
        A ``distributed.Client``.
    out
        The folder for parts, which all workers see.
    shards
        Number of shards; four a thread of the cluster if left out.
    retries
        How often a task is tried again; what a lost worker has finished is kept.
    jobs
        Threads of a task.

    Returns
    -------
    list
        The futures, each of the number of runs of its shard. Their keys follow from the study, so
        that the same one is not run twice.
    """
    count = shards if shards is not None else 4 * max(1, sum(client.nthreads().values()))
    folder = str(Path(out).absolute())
    if not isinstance(plan, Plan):
        plan = str(Path(plan).absolute())
    key = (plan.digest if isinstance(plan, Plan) else _core.study_id(plan))[:16]
    return [
        client.submit(
            run_shard,
            plan,
            folder,
            (index, count),
            jobs=jobs,
            key=f"slipstick-{key}-{index}-of-{count}",
            retries=retries,
        )
        for index in range(1, count + 1)
    ]


def run_study(
    plan: Plan | str | PathLike[str],
    client: Any,
    out: str | PathLike[str],
    *,
    shards: int | None = None,
    retries: int = 2,
    jobs: int = 1,
) -> Study:
    """Run a study on a cluster, then read what its folder holds.

    The parts are those of ``slipstick study``, to the same bytes. Parameters are those of
    ``submit_study``.
    """
    futures = submit_study(plan, client, out, shards=shards, retries=retries, jobs=jobs)
    client.gather(futures)
    return study(plan, out)
