"""Many records to a decision: spectra, incremental dynamic analysis, fragility, design."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING

from . import _core
from ._result import Result, write

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    Values = str | Sequence[str] | Sequence[float]
    Varied = Mapping[str, Values]
    Progress = Callable[[int, int], object]


class Assessment(Result):
    """What came of an analysis over many records: tables, figures, summary, report.

    Two compare by what they tell, and pickle as that.
    """

    _KEYS = (*Result._KEYS, ("text",), ("_report_html",))

    def report(self, path: str | PathLike[str]) -> Path:
        """Write the result as one HTML page.

        Parameters
        ----------
        path
            The file.
        """
        return write(path, self._tell("_report_html"))

    def __str__(self) -> str:
        return str(self._tell("text"))

    def __repr__(self) -> str:
        return f"<slipstick.Assessment {', '.join(self.tables)}>"


def read_suite(
    patterns: str | PathLike[str] | Iterable[str | PathLike[str]],
    *,
    channel: str | None = None,
    units: str | None = None,
    dt_s: float | None = None,
    vertical: str | PathLike[str] | Iterable[str | PathLike[str]] = (),
) -> dict[str, _core.Motion]:
    """Read many records.

    Parameters
    ----------
    patterns
        Files, folders or patterns such as ``"suite/*.AT2"``.
    channel, units, dt_s
        As in ``read_record``, for all files.
    vertical
        The same for the vertical components, as many and in the same order.

    Returns
    -------
    dict
        The motions by the stems of their files, or by their paths where stems repeat.

    Raises
    ------
    RecordError
        For a file that is no record, with line and column.
    OSError
        For a file that cannot be read, and a pattern that matches none.
    """
    return dict(
        _core.read_suite(
            _texts(patterns), channel=channel, units=units, dt_s=dt_s, vertical=_texts(vertical)
        )
    )


def spectrum(
    model: _core.Model,
    records: Mapping[str, _core.Motion],
    over: Varied,
    *,
    vary: Varied | None = None,
    friction: Values | None = None,
    measure: str = "PGA",
    level: str | None = None,
    demands: Sequence[str] = (),
    bounds: str = "all",
    jobs: int | None = None,
    progress: Progress | None = None,
) -> Assessment:
    """Demands over one parameter of the model, with fractiles over the records.

    Parameters
    ----------
    model, records
        The model and the motions by name, such as from ``read_suite``.
    over
        The parameter along the axis and its values: ``{"slider.radius": "1..5 m:50"}``.
    vary
        Parameters that make groups of curves.
    friction
        Kinetic coefficients that make groups; the ratio of static to kinetic friction is kept.
    measure, level
        All records are scaled so that the measure takes this value; as recorded if left out.
    demands
        Keys of demands besides those that are always told.
    bounds
        Which of the model's ``slider.bounds`` are run: ``"all"``, ``"lower"``, ``"nominal"``, ``"upper"``.
    jobs, progress
        As in ``study``.

    Returns
    -------
    Assessment
        Tables ``spectrum``, the fractiles, and ``runs``.

    Raises
    ------
    InputError
        For a path, a list of values, a measure or a level that cannot be.
    KeyboardInterrupt
        At Ctrl-C.

    Examples
    --------
    >>> import slipstick as ss
    >>> model = ss.Model({"block.mass": "325 kg", "slider.static_friction": 0.06,
    ...                   "slider.kinetic_friction": 0.05, "slider.radius": "2 m"})
    >>> records = {name: ss.Motion([0.0, 0.3, -0.3, 0.0], dt=dt, units="g")
    ...            for name, dt in [("short", 0.2), ("middle", 0.25), ("long", 0.3)]}
    >>> found = ss.spectrum(model, records, {"slider.radius": "1..3 m:3"})
    >>> len(found.tables["runs"])
    9
    """
    return Assessment(
        _core.spectrum(
            model,
            list(records.items()),
            _varied(over)[0],
            vary=_varied(vary or {}),
            friction=None if friction is None else _values(friction),
            measure=measure,
            level=level,
            demands=list(demands),
            bounds=bounds,
            jobs=jobs,
            progress=progress,
        )
    )


def ida(
    model: _core.Model,
    records: Mapping[str, _core.Motion],
    *,
    levels: str | None = None,
    between: str | None = None,
    measure: str = "PGA",
    demand: str = "peak_sliding_displacement_m",
    limit: str | None = None,
    vary: Varied | None = None,
    keep: Sequence[str] = (),
    by: str | None = None,
    bounds: str = "all",
    jobs: int | None = None,
    progress: Progress | None = None,
) -> Assessment:
    """Incremental dynamic analysis.

    Parameters
    ----------
    model, records
        The model and the motions by name.
    levels
        Levels of the measure for all records: ``"0.1..1 g:10"``.
    between
        In place of them: each record's own capacity is hunted between two levels, ``"0.05..2 g"``.
    measure
        The intensity measure.
    demand, limit
        The demand and the limit on it with its unit; of sliding, the model's gap if left out.
    vary, keep, by
        Designs that are run, rows that are kept, and the path whose values have curves of their own.
    bounds
        Which of the model's ``slider.bounds`` are run: ``"all"``, ``"lower"``, ``"nominal"``, ``"upper"``.
    jobs, progress
        As in ``study``.

    Returns
    -------
    Assessment
        Tables ``ida``, one row a run, and where there is a limit ``capacities``.

    Raises
    ------
    InputError
        For neither or both of ``levels`` and ``between``, and for a choice that cannot be.
    KeyboardInterrupt
        At Ctrl-C.

    Examples
    --------
    >>> import slipstick as ss
    >>> model = ss.Model({"block.mass": "325 kg", "slider.static_friction": 0.06,
    ...                   "slider.kinetic_friction": 0.05, "slider.radius": "2 m"})
    >>> records = {name: ss.Motion([0.0, 0.3, -0.3, 0.0], dt=dt, units="g")
    ...            for name, dt in [("short", 0.2), ("middle", 0.25), ("long", 0.3)]}
    >>> found = ss.ida(model, records, levels="0.1..0.4 g:4", limit="50 mm")
    >>> len(found.table), len(found.tables["capacities"])
    (12, 3)
    """
    return Assessment(
        _core.ida(
            model,
            list(records.items()),
            levels=levels,
            between=between,
            measure=measure,
            demand=demand,
            limit=limit,
            vary=_varied(vary or {}),
            keep=list(keep),
            by=by,
            bounds=bounds,
            jobs=jobs,
            progress=progress,
        )
    )


def fragility(
    source: _core.Table | Assessment | str | PathLike[str],
    *,
    demand: str = "peak_sliding_displacement_m",
    limit: str | None = None,
    measure: str | None = None,
    units: str | None = None,
    fit_to: str | None = None,
    keep: Sequence[str] = (),
    confidence: float = 0.9,
    bootstrap: tuple[int, int] | None = None,
    jobs: int | None = None,
    progress: Progress | None = None,
) -> Assessment:
    """Fit a lognormal fragility, with intervals clustered by record.

    Parameters
    ----------
    source
        Runs of ``ida`` or ``study``, capacities or counts: a table, or a file in CSV or Parquet.
    demand, limit
        The demand and the limit on it with its unit.
    measure, units
        The measure, and its units where the table does not state them.
    fit_to
        ``"counts"``, ``"capacities"`` or ``"cloud"``; by the kind of data if left out.
    keep
        Rows that are kept: ``"slider.radius=2 m"``.
    confidence
        Of intervals and band.
    bootstrap
        Intervals from so many draws of the records, with this seed.

    Returns
    -------
    Assessment
        The table ``fragility`` is the curve with its band; ``summary`` has median and dispersion.

    Raises
    ------
    InputError
        For a limit, a measure or a kind of fit that cannot be.
    StudyError
        For data that tell no curve.

    Examples
    --------
    >>> import slipstick as ss
    >>> model = ss.Model({"block.mass": "325 kg", "slider.static_friction": 0.06,
    ...                   "slider.kinetic_friction": 0.05, "slider.radius": "2 m"})
    >>> records = {name: ss.Motion([0.0, 0.3, -0.3, 0.0], dt=dt, units="g")
    ...            for name, dt in [("short", 0.2), ("middle", 0.25), ("long", 0.3)]}
    >>> ida = ss.ida(model, records, levels="0.1..0.6 g:11", limit="50 mm")
    >>> curve = ss.fragility(ida)
    >>> curve.table.columns
    ['level', 'probability', 'band_low', 'band_high']
    """
    if isinstance(source, Assessment):
        table = source.tables.get("capacities", source.table) if limit is None else source.table
    elif isinstance(source, _core.Table):
        table = source
    else:
        table = _core.read_table([Path(source)])
    return Assessment(
        _core.fragility(
            table,
            demand=demand,
            limit=limit,
            measure=measure,
            units=units,
            fit_to=fit_to,
            keep=list(keep),
            confidence=confidence,
            bootstrap=bootstrap,
            jobs=jobs,
            progress=progress,
        )
    )


def design(
    model: _core.Model,
    records: Mapping[str, _core.Motion],
    vary: Varied | None = None,
    *,
    friction: Values | None = None,
    gap: str | None = None,
    probability: float = 0.9,
    demand: str | None = None,
    share: float = 0.5,
    measure: str = "PGA",
    level: str | None = None,
    bounds: tuple[float, float] | None = None,
    sensitivity: int = 256,
    seed: int = 1,
    confidence: float = 0.9,
    jobs: int | None = None,
    progress: Progress | None = None,
) -> Assessment:
    """Search the designs that keep a gap with the least acceleration.

    Parameters
    ----------
    model, records
        The model and the motions by name.
    vary
        Parameters and their values: ``{"slider.radius": "1..5 m:200"}``.
    friction
        Kinetic coefficients; the ratio of static to kinetic friction is kept.
    gap, probability
        The sliding displacement that this share of the records must not exceed; the model's gap if left
        out.
    demand, share
        Key of the acceleration that is made least, and the share of the records that must not exceed it;
        the roof's if left out.
    measure, level
        As in ``spectrum``.
    bounds
        Factors on friction for the check of robustness; those of the model if left out.
    sensitivity, seed
        Sample points of Sobol' indices, 0 for none, and their seed.
    confidence
        Of intervals.
    jobs, progress
        As in ``study``.

    Returns
    -------
    Assessment
        Tables ``front``, one row a design, and ``runs``.

    Raises
    ------
    InputError
        For nothing to vary, no gap, and a choice that cannot be.
    KeyboardInterrupt
        At Ctrl-C.

    Examples
    --------
    >>> import slipstick as ss
    >>> model = ss.Model({"block.mass": "325 kg", "slider.static_friction": 0.06,
    ...                   "slider.kinetic_friction": 0.05, "slider.radius": "2 m"})
    >>> records = {name: ss.Motion([0.0, 0.3, -0.3, 0.0], dt=dt, units="g")
    ...            for name, dt in [("short", 0.2), ("middle", 0.25), ("long", 0.3)]}
    >>> found = ss.design(model, records, {"slider.radius": "1..3 m:3"}, friction="0.04..0.1:4",
    ...                   gap="60 mm", sensitivity=0)
    >>> list(found.tables)
    ['front', 'runs']
    """
    return Assessment(
        _core.design(
            model,
            list(records.items()),
            _varied(vary or {}),
            friction=None if friction is None else _values(friction),
            gap=gap,
            probability=probability,
            demand=demand,
            share=share,
            measure=measure,
            level=level,
            bounds=bounds,
            sensitivity=sensitivity,
            seed=seed,
            confidence=confidence,
            jobs=jobs,
            progress=progress,
        )
    )


def _texts(paths: str | PathLike[str] | Iterable[str | PathLike[str]]) -> list[str]:
    if isinstance(paths, (str, PathLike)):
        return [fspath(paths)]
    return [fspath(path) for path in paths]


def _values(values: Values) -> str:
    return values if isinstance(values, str) else ", ".join(str(value) for value in values)


def _varied(varied: Varied) -> list[str]:
    return [f"{path}={_values(values)}" for path, values in varied.items()]
