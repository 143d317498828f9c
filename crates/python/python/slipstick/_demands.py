"""Demands of many designs at once: arrays in, a table out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from . import _core
from ._assessment import components
from ._request import several, wrong
from ._table import Table

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


def demands(
    model: _core.Model,
    motion: _core.Motion | Mapping[str, _core.Motion] | None,
    designs: Mapping[str, Any],
    *,
    columns: Sequence[str] | None = None,
    check: float = 0.001,
    jobs: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Table:
    """Analyse a model with many values, on all threads, without histories.

    Parameters
    ----------
    model
        The model, with the friction that it has; its ``slider.bounds`` play no part.
    motion
        A motion, or several by name, in one direction or in two; None for the model's own, which must then be a
        made one.
    designs
        Arrays by path, all of one length: in SI, or of quantities of pint and texts with their units. One
        number serves for all designs.
    columns
        The columns that are wanted; all of them if left out.
    check
        The share of the runs that is run again alone and judged, the first of each kind of structure and
        directions besides; 0 for none.
    jobs, progress
        As in ``study``.

    Returns
    -------
    Table
        One row a run: all designs in their order on the first motion, then on the next. Rows are those of
        a study, equal to ``run`` bit for bit; a run without an answer is NaN, and ``status`` says why.

    Raises
    ------
    InputError
        For paths that the model lacks, lists of different lengths, a column that there is not.
    StudyError
        For a run that fails its check.
    KeyboardInterrupt
        At Ctrl-C.

    Examples
    --------
    >>> import numpy as np
    >>> import slipstick as ss
    >>> model = ss.Model({"block.mass": "325 kg", "slider.static_friction": 0.06,
    ...                   "slider.kinetic_friction": 0.05, "slider.radius": "2 m"})
    >>> motion = ss.Motion([0.0, 0.3, -0.3, 0.0], dt=0.1, units="g")
    >>> table = ss.demands(model, motion, {"slider.radius": np.linspace(1.0, 3.0, 5)})
    >>> bool((np.diff(table["peak_sliding_displacement_m"]) > 0.0).all())
    True
    """
    if not isinstance(designs, Mapping):
        raise wrong("designs", "arrays by path, {path: array}", type(designs).__name__)
    lists = {path: values if several(values) else [values] for path, values in designs.items()}
    if not lists:
        raise wrong("designs", "at least one path with its values", "none")
    count = max(len(values) for values in lists.values())
    each = [(path, list(values) * count if len(values) == 1 else values) for path, values in lists.items()]
    if not 0.0 <= check <= 1.0:
        raise wrong("check", "a share from 0 to 1", repr(check))
    motions = {"motion": motion} if isinstance(motion, _core.Motion) else motion
    records = [] if motions is None else components("motion", motions)[0]
    one_of = round(1.0 / check) if check > 0.0 else None
    core = _core.demands(model, records, each, one_of=one_of, jobs=jobs, progress=progress)
    table = Table._of(core)
    if columns is None:
        return table
    for name in columns:
        if name not in table:
            raise wrong("columns", f"columns among {', '.join(table)}", repr(name))
    return Table({name: table[name] for name in columns}, {k: v for k, v in table.units.items() if k in columns})
