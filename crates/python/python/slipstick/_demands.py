"""Demands of many designs at once: arrays in, a table out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from . import _core
from ._arguments import checked
from ._names import renamed
from ._progress import following
from ._records import components
from ._request import one_of, several, text_of, texts, wrong
from ._table import Table, columns_of, is_frame, units_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ._progress import Progress
    from ._records import Records
    from ._request import Values


@renamed(motion="records", designs="vary", levels="scale_to")
@checked
def demands(
    model: _core.Model,
    records: Records | None,
    vary: Any,
    *,
    scale: Values | None = None,
    measure: str | None = None,
    scale_to: Values | None = None,
    columns: Sequence[str] | None = None,
    check: float = 0.001,
    jobs: int | None = None,
    progress: Progress | None = None,
) -> Table:
    """Analyse a model with many values, on all threads, without histories.

    Parameters
    ----------
    model
        The model, with the friction that it has; its ``slider.bounds`` play no part.
    records
        A motion, several by name or in a list, or a stream of ObsPy, in one direction or in two; None for the model's
        own, which must then be a made one.
    vary
        Arrays by path, all of one length: in SI, or of quantities of pint and texts with their units. One
        number serves for all designs. A frame of any library goes as well, a row a design, its columns named by paths.
    scale
        A factor on every motion for each design, or one for all.
    measure, scale_to
        In place of that every motion is scaled for each design so that the measure, PGA if left out, takes the
        design's value: texts with their unit, or numbers in SI.
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
    if columns is not None:
        columns = texts("columns", columns)
    lists = _lists(vary)
    if not lists:
        raise wrong("vary", "at least one path with its values", "none")
    scaling: dict[str, Any] = {name: values for name, values in (("scale", scale), ("scale_to", scale_to)) if values is not None}
    lists.update({name: list(values) if several(values) else [values] for name, values in scaling.items()})
    count = max(len(values) for values in lists.values())
    all_of = {name: list(values) * count if len(values) == 1 else values for name, values in lists.items()}
    of_designs = {name: all_of.pop(name) for name in scaling}
    if not 0.0 <= check <= 1.0:
        raise wrong("check", "a share from 0 to 1", repr(check))
    of = [] if records is None else components("records", records)[0]
    every = round(1.0 / check) if check > 0.0 else None
    with following(progress) as on:
        core = _core.demands(
            model, of, list(all_of.items()), **of_designs, measure=measure, one_of=every, jobs=jobs, progress=on
        )
    table = Table._of(core)
    if columns is None:
        return table
    for name in columns:
        one_of("columns", "columns among", name, table)
    return Table({name: table[name] for name in columns}, {k: v for k, v in table.units.items() if k in columns})


def _lists(designs: Any) -> dict[str, Any]:
    """Values by path, of a frame its columns, each with the unit that the frame says."""
    if isinstance(designs, Mapping):
        for path in designs:
            if not isinstance(path, str):
                raise wrong("vary", "paths of the model, {path: array}", _core.described(path))
        return {path: values if several(values) else [values] for path, values in designs.items()}
    if not is_frame(designs):
        raise wrong("vary", "arrays by path, {path: array}, or a frame of designs", _core.described(designs))
    units = units_of(designs)
    return {
        path: [text_of(path, value, units[path]) for value in values] if path in units else values
        for path, values in columns_of(designs)
    }
