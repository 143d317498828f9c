"""Many records to a decision: spectra, incremental dynamic analysis, fragility, design."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _core
from ._arguments import checked
from ._names import renamed
from ._progress import following
from ._records import Suite, of_suite
from ._request import a_model, given, one_of, paths as texts_of, several, wrong
from ._result import Result, noticed, warn_of, write
from ._table import Table, table_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from matplotlib.axes import Axes

    from ._progress import Progress
    from ._records import Named, Records
    from ._request import Values, Varied
    from ._study import Study
    from ._table import Frame

    #: A text with its unit, or a number in SI
    Value = str | float


class Assessment(Result):
    """What came of an analysis over many records: tables, figures, summary, report.

    Two compare by what they tell, and pickle as that.
    """

    _KEYS = (*Result._KEYS, ("text",), ("_report_html",))

    @checked
    def plot(
        self,
        x: str | None = None,
        y: str | None = None,
        *,
        table: str | None = None,
        by: str | None = None,
        ax: Axes | None = None,
        **kwargs: Any,
    ) -> Axes:
        """Draw the result in Matplotlib, or one column of a table over another; the drawings of the report are ``figures``.

        Without columns each kind of result has a figure of its own: a fragility curve with its band, the front of a
        design, fractiles of a spectrum, the curves of an incremental dynamic analysis, the demand of every run of a
        suite.

        Parameters
        ----------
        x, y
            Columns of numbers; of a spectrum ``y`` alone may be a demand, whose fractiles are drawn.
        table
            Which of ``tables``; the first if left out.
        by
            A column whose values have lines of their own.
        ax
            Where it is drawn; a new figure if left out.
        kwargs
            What lines take: ``color``, ``lw``, ``marker``.

        Returns
        -------
        Axes
        """
        if table is None and x is None and by is None:
            drawn = self._drawn(y, ax, **kwargs)
            if drawn is not None:
                return drawn
        chosen = self.table if table is None else self.tables[one_of("table", "a table among", table, self.tables)]
        return chosen.plot(x, y, by=by, ax=ax, **kwargs)

    def _drawn(self, y: str | None, ax: Axes | None, **kwargs: Any) -> Axes | None:
        """The figure of the kind of result; None where a column is asked for that is not of it."""
        from . import _plot

        kind = next(iter(self.tables))
        if kind == "spectrum" and (y is None or f"{y.removesuffix('_p50')}_p50" in self.table):
            return _plot.draw_fractiles(self.table, y, ax, **kwargs)
        if kind == "runs" and len(self.table):
            demand = "peak_sliding_displacement_m" if y is None else y
            return _plot.draw_runs(self.table, "record", demand, ax, **kwargs) if demand in self.table else None
        if y is not None:
            return None
        if kind == "fragility":
            return _plot.draw_fragility(self.table, self.summary, ax, **kwargs)
        if kind == "front":
            return _plot.draw_front(self.table, self.summary, ax, **kwargs)
        if kind == "ida":
            return _plot.draw_ida(self.table, self.summary, ax, **kwargs)
        return None

    @checked
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


@checked
def read_suite(
    patterns: str | PathLike[str] | Iterable[str | PathLike[str]],
    *,
    y: str | PathLike[str] | Iterable[str | PathLike[str]] = (),
    channel: str | int | None = None,
    units: str | None = None,
    dt: float | str | None = None,
    vertical: str | PathLike[str] | Iterable[str | PathLike[str]] = (),
) -> dict[str, _core.Motion]:
    """Read many records.

    Parameters
    ----------
    patterns
        Files, folders or patterns such as ``"suite/*.AT2"``.
    y
        The same for the components along y of motions in two horizontal directions, as many and in the same order.
    channel, units, dt
        As in ``read_record``, for all files.
    vertical
        The same for the vertical components, as many and in the same order.

    Returns
    -------
    dict
        The motions by the stems of their files, or by their paths where stems repeat; of two by both,
        ``"x + y"``.

    Raises
    ------
    RecordError
        For a file that is no record, with line and column.
    InputError
        For components that are not as many as the records.
    OSError
        For a file that cannot be read, a pattern that matches none, and components that are of no one record.
    """
    along_y, up = texts_of("y", y), texts_of("vertical", vertical)
    return dict(
        _core.read_suite(texts_of("patterns", patterns), y=along_y, channel=channel, units=units, dt=dt, vertical=up)
    )


@checked
def suite(
    models: _core.Model | Mapping[str, _core.Model],
    records: Records | Suite,
    *,
    second: Records | None = None,
    measure: str | None = None,
    scale_to: Value | None = None,
    scale: float | None = None,
    target: str | PathLike[str] | None = None,
    code_spectrum: str | None = None,
    periods: str | tuple[float, float] | None = None,
    property_factors: str | None = None,
    hazard: str | Sequence[str] | None = None,
    eccentricity: str | None = None,
    code: str | None = None,
    code_values: str | Sequence[str] | None = None,
    floor_spectrum: bool = False,
    project: str | None = None,
    author: str | None = None,
    date: str | None = None,
    pairs: str | None = None,
    check: bool = True,
    jobs: int | None = None,
    progress: Progress | None = None,
) -> Assessment:
    """Run models on the records of a suite, side by side: what governs, with lower- and upper-bound friction.

    Parameters
    ----------
    models
        A model, or several by name.
    records
        The motions by name, such as from ``read_suite``; those in two directions, ``Motion(x, y=y)``, are pairs. A
        motion alone, a list, whose names are numbers from 1, and a stream of ObsPy, whose stations are, go as well; a
        ``Suite`` says how they are scaled, too.
    second
        Other components of records in one direction, as many and in the same order: both components of a pair
        act at once, under one factor.
    measure, scale_to
        All records, or pairs, are scaled so that the measure takes this value; as recorded if left out.
    scale
        A factor on all records instead.
    target, code_spectrum, periods
        A spectrum to which pairs are brought instead, between two periods, ``"0.6 s..3.8 s"``: a CSV with the
        columns ``period_s`` and ``sa_g``, or the shape of ASCE/SEI 7, ``"sds = 1.2 g, sd1 = 0.8 g, tl = 8 s"``.
    property_factors
        Bounds of friction from property modification factors, ``"test = 0.9..1.2, aging = 1..1.3"``.
    hazard
        What the answer calls this intensity, ``"MCE_R"``; further intensities beside it have a factor on the first:
        ``["MCE_R", "DE=0.6667"]``.
    eccentricity
        Plan of the building, for the total displacement of the hand calculation.
    code, code_values
        A code whose requirements are judged row by row, ``"asce7-22"``, ``"en1998-1"`` or ``"aashto"``, and what it
        asks for and no model says, ``"R = 4, I_e = 1.5, S_1 = 0.9"``.
    project, author, date
        What the title block of the report says.
    floor_spectrum
        Whether floor spectra are wanted: means and fractiles of the records by place, of pairs RotD100, x and y.
    pairs
        How pairs are run: ``"together"``, the table moving in two horizontal directions, or ``"separate"``, each
        component by itself.
    check
        Whether every run is judged. Without it the column ``holds`` is empty, and the answer says that no run was
        certified.
    jobs, progress
        As in ``study``.

    Returns
    -------
    Assessment
        Tables ``runs``, one row a run, and ``governing``; of two storeys and more ``profiles``, demands over the
        height; ``floor-spectra`` where they are wanted.

    Raises
    ------
    InputError
        For records that cannot be scaled so, and a choice that cannot be.
    KeyboardInterrupt
        At Ctrl-C.

    Examples
    --------
    >>> import slipstick as ss
    >>> model = ss.Model({"block.mass": "325 kg", "slider.static_friction": 0.06,
    ...                   "slider.kinetic_friction": 0.05, "slider.radius": "2 m"})
    >>> records = {name: ss.Motion([0.0, 0.3, -0.3, 0.0], dt=dt, units="g")
    ...            for name, dt in [("short", 0.08), ("middle", 0.09), ("long", 0.1)]}
    >>> found = ss.suite(model, records, scale_to="0.2 g")
    >>> len(found.table), found.tables["governing"].columns[:3]
    (3, ['model', 'friction', 'statistic'])
    """
    of, others, asked = of_suite("records", records, {**locals()})
    if not isinstance(models, Mapping):
        a_model(models, "models")
    by_name = models if isinstance(models, Mapping) else {models.name or "model": models}
    for name, model in by_name.items():
        a_model(model, f"models {name!r}")
    with following(progress) as on:
        answer = _core.suite(
            list(by_name.items()),
            of,
            others,
            given("suite", asked),
            target=None if target is None else Path(target),
            check=check,
            jobs=jobs,
            progress=on,
        )
    return _told(answer)


@checked
def spectrum(
    model: _core.Model,
    records: Records | Suite,
    over: Varied | None = None,
    *,
    friction: Values | None = None,
    vary: Varied | None = None,
    measure: str | None = None,
    scale_to: Value | None = None,
    scale: float | None = None,
    demand: Sequence[str] = (),
    bounds: str | None = None,
    pairs: str | None = None,
    second: Records | None = None,
    jobs: int | None = None,
    progress: Progress | None = None,
) -> Assessment:
    """Demands over one parameter of the model, with fractiles over the records.

    Parameters
    ----------
    model, records
        The model and the motions by name, such as from ``read_suite``, in one direction or in two.
    over
        The parameter along the axis and its values: ``{"slider.radius": "1..5 m:50"}``; the isolator period
        if left out.
    friction
        Kinetic coefficients that make groups; the ratio of static to kinetic friction is kept.
    vary
        Parameters that make groups of curves.
    measure, scale_to
        All records are scaled so that the measure takes this value; as recorded if left out.
    scale
        A factor on all records instead.
    demand
        Keys of demands besides those that are always told.
    bounds
        Which of the model's ``slider.bounds`` are run: ``"all"``, ``"lower"``, ``"nominal"``, ``"upper"``.
    second
        As in ``suite``.
    pairs
        How pairs are run: ``"together"``, the table moving in two horizontal directions, or ``"separate"``, each
        component by itself.
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
    ...            for name, dt in [("short", 0.08), ("middle", 0.09), ("long", 0.1)]}
    >>> found = ss.spectrum(model, records, {"slider.radius": "1..3 m:3"})
    >>> len(found.tables["runs"])
    9
    """
    return _assess("spectrum", model, records, locals(), jobs, progress)


class Sensitivity(Assessment):
    """Derivatives of demands, with a tornado plot."""

    @checked
    def plot(  # type: ignore[override]
        self, demand: str | None = None, *, ax: Axes | None = None, most: int = 20, **kwargs: Any
    ) -> Axes:
        """Draw what 1 % more of each key changes as a tornado, medians over the records.

        Parameters
        ----------
        demand
            Key of a demand; the first of the table if left out.
        ax
            Where it is drawn; a new figure if left out.
        most
            Number of keys, the strongest.
        kwargs
            What bars take: ``color``, ``height``.

        Returns
        -------
        Axes
        """
        from ._plot import draw_tornado

        known = list(dict.fromkeys(self.table["demand"]))
        chosen = known[0] if demand is None else demand
        one_of("demand", "one of", chosen, known)
        return draw_tornado(self.table, chosen, ax, most, **kwargs)


@renamed(motions="records", paths="vary")
@checked
def sensitivity(
    model: _core.Model,
    records: Records | Suite | None,
    vary: str | Sequence[str] = (),
    *,
    measure: str | None = None,
    scale_to: Value | None = None,
    scale: float | None = None,
    demand: str | Sequence[str] = (),
    second: Records | None = None,
    pairs: str | None = None,
    jobs: int | None = None,
    progress: Progress | None = None,
) -> Sensitivity:
    """Compute the derivatives of demands with respect to keys of the model, each with its error.

    They are differences of exact runs at the key's value and a step to both sides, chosen from the rounding
    that is seen; of 20 keys at most 45 runs on a motion.

    Parameters
    ----------
    model
        The model.
    records
        A motion or several, as in ``suite``, in one direction or in two; None for the model's own.
    vary
        Keys that stand in the model as one number, ``["slider.kinetic_friction", "storey.1.mass"]``; all of slider,
        block and structure if left out.
    measure, scale_to, scale
        As in ``spectrum``.
    demand
        Keys of the demands; all that are numbers if left out.
    second, pairs
        As in ``suite``.
    jobs, progress
        As in ``study``.

    Returns
    -------
    Sensitivity
        The table ``sensitivity``, one row a motion, key and demand, in SI: ``derivative`` with its ``error`` (half
        the difference of the slopes to both sides, and rounding), ``relative`` in % for 1 %, the ``step``, and
        ``events_change`` where order or number of events changes within the step. ``plot`` draws a tornado.

    Raises
    ------
    InputError
        For a key that the model does not have as a number, and a demand that is none.
    KeyboardInterrupt
        At Ctrl-C.

    Examples
    --------
    >>> import slipstick as ss
    >>> model = ss.Model({"block.mass": "325 kg", "slider.static_friction": 0.06,
    ...                   "slider.kinetic_friction": 0.05, "slider.radius": "2 m"})
    >>> motion = ss.Motion([0.0, 0.3, -0.3, 0.0], dt=0.1, units="g")
    >>> found = ss.sensitivity(model, motion, ["slider.kinetic_friction", "slider.radius"],
    ...                        demand="peak_sliding_displacement_m")
    >>> [bool(d < 0) for d in found.table["derivative"]]
    [True, False]
    """
    asked: Mapping[str, Any] = {**locals()}
    a_model(model)
    of: Named = []
    others: Named = []
    if records is not None:
        of, others, asked = of_suite("records", records, asked)
    with following(progress) as on:
        answer = _core.assess("sensitivity", model, of, others, given("sensitivity", asked), jobs=jobs, progress=on)
    told = Sensitivity(answer)
    warn_of(noticed(told.warnings))
    return told


@checked
def ida(
    model: _core.Model,
    records: Records | Suite,
    *,
    measure: str | None = None,
    scale_to: Values | None = None,
    between: str | tuple[float, float] | None = None,
    demand: str | None = None,
    limit: Value | None = None,
    friction: Values | None = None,
    vary: Varied | None = None,
    where: Sequence[str] | Mapping[str, Values] = (),
    by: str | None = None,
    bounds: str | None = None,
    second: Records | None = None,
    pairs: str | None = None,
    jobs: int | None = None,
    progress: Progress | None = None,
) -> Assessment:
    """Incremental dynamic analysis.

    Parameters
    ----------
    model, records
        The model and the motions by name, in one direction or in two.
    measure
        The intensity measure.
    scale_to
        Levels of the measure for all records: ``"0.1..1 g:10"``, or a list; each record's own capacity is hunted
        if left out.
    between
        First and highest level of the hunt, ``"0.05..2 g"``.
    demand, limit
        The demand and the limit on it with its unit; of sliding, the model's gap if left out.
    friction, vary
        Designs that are run: kinetic coefficients, with the ratio of static to kinetic kept, and parameters.
    where, by
        Designs that are kept, and the path whose values have curves of their own.
    bounds
        Which of the model's ``slider.bounds`` are run: ``"all"``, ``"lower"``, ``"nominal"``, ``"upper"``.
    second
        As in ``suite``.
    pairs
        How pairs are run: ``"together"``, the table moving in two horizontal directions, or ``"separate"``, each
        component by itself.
    jobs, progress
        As in ``study``.

    Returns
    -------
    Assessment
        Tables ``ida``, one row a run, and where there is a limit ``capacities``.

    Raises
    ------
    InputError
        For a hunt without a limit, and for a choice that cannot be.
    KeyboardInterrupt
        At Ctrl-C.

    Examples
    --------
    >>> import slipstick as ss
    >>> model = ss.Model({"block.mass": "325 kg", "slider.static_friction": 0.06,
    ...                   "slider.kinetic_friction": 0.05, "slider.radius": "2 m"})
    >>> records = {name: ss.Motion([0.0, 0.3, -0.3, 0.0], dt=dt, units="g")
    ...            for name, dt in [("short", 0.08), ("middle", 0.09), ("long", 0.1)]}
    >>> found = ss.ida(model, records, scale_to="0.1..0.4 g:4", limit="50 mm")
    >>> len(found.table), len(found.tables["capacities"])
    (12, 3)
    """
    return _assess("ida", model, records, locals(), jobs, progress)


@checked
def fragility(
    source: Frame | Assessment | Study | str | PathLike[str] | None = None,
    *,
    levels: Values | None = None,
    exceeded: int | Iterable[int] | None = None,
    runs: int | Iterable[int] | None = None,
    capacities: Values | None = None,
    reached: Iterable[bool] | None = None,
    demand: str | None = None,
    limit: Value | None = None,
    measure: str | None = None,
    units: str | None = None,
    fit_to: str | None = None,
    where: Sequence[str] | Mapping[str, Values] = (),
    by: str | None = None,
    bootstrap: int | None = None,
    seed: int | None = None,
    floor: Value | None = None,
    cap: Value | None = None,
    confidence: float | None = None,
    jobs: int | None = None,
    progress: Progress | None = None,
) -> Assessment:
    """Fit a lognormal fragility, with intervals clustered by record.

    Parameters
    ----------
    source
        Runs of ``ida`` or ``study``, capacities or counts: what they gave, a frame of any library, a file in CSV
        or Parquet, or the folder of a command.
    levels, exceeded, runs
        In place of that one's own counts: levels of the measure, with their unit, in SI, or in ``units``; how many of
        the runs at each exceed the limit; how many there are, one number where it is the same at all.
    capacities, reached
        In place of that the level at which each record reaches the limit, as ``levels``; where ``reached`` is False
        the highest level that it was run at without reaching it. All are reached if left out.
    demand, limit
        The demand and the limit on it with its unit or in SI; that of the analysis if left out.
    measure, units
        The measure, and its units where the table does not state them or ``levels`` are not in SI.
    fit_to
        ``"counts"``, ``"capacities"`` or ``"cloud"``; by the kind of data if left out.
    where, by
        Rows that are kept, ``"slider.radius=2 m"``, and the column whose values have curves of their own.
    bootstrap, seed
        Intervals from so many draws of the records, with this seed.
    floor, cap
        Demands below and above these count as below and above them only, in a cloud.
    confidence
        Of intervals and band.

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
    ...            for name, dt in [("short", 0.05), ("middle", 0.07), ("long", 0.1)]}
    >>> ida = ss.ida(model, records, scale_to="0.1..0.6 g:11", limit="10 mm")
    >>> curve = ss.fragility(ida)
    >>> curve.table.columns
    ['level', 'probability', 'band_low', 'band_high']
    >>> own = ss.fragility(levels=["0.1 g", "0.2 g", "0.3 g", "0.4 g"], exceeded=[1, 4, 9, 14], runs=20, measure="PGA")
    >>> round(own.summary["median"] / 9.80665, 2)
    0.31
    """
    asked = given("fragility", locals())
    known = certified = made_of = None
    own = {"levels": levels, "exceeded": exceeded, "runs": runs, "capacities": capacities, "reached": reached}
    own = {name: value for name, value in own.items() if value is not None}
    if (source is None) == (not own):
        found = "neither" if source is None else f"both source and {', '.join(own)}"
        raise wrong("source", "a source of runs, or levels with exceeded and runs, or capacities", found)
    if source is None:
        table = _own_data(own, measure, units)._core
    elif isinstance(source, Assessment):
        known, table, made_of = source.summary.get("limit"), source.table._core, _made_of(source.summary)
    elif isinstance(source, (str, PathLike)):
        table, known, certified = _core.read_runs(Path(source), demand)
    else:
        table = table_of("source", getattr(source, "table", source))._core
    with following(progress) as on:
        answer = _core.fit(
            table, asked, limit=known, certified=certified, made_of=made_of, jobs=jobs, progress=on
        )
    return _told(answer)


def _made_of(summary: Mapping[str, Any]) -> tuple[str, list[tuple[str, str, float]]] | None:
    """The hash of the model, and name, hash and peak of each motion, that a summary has."""
    if summary.get("model_hash") is None:
        return None
    motions = [(on["record"], on["motion_hash"], on["pga_m_per_s2"]) for on in summary.get("suite", ())]
    return summary["model_hash"], motions


def _own_data(own: Mapping[str, Any], measure: str | None, units: str | None) -> Table:
    """Counts at levels, or capacities, as the table that a fragility is of."""
    of_levels = "capacities" not in own
    first, others = ("levels", ["exceeded", "runs"]) if of_levels else ("capacities", ["reached"])
    for name in [first, *others] if of_levels else [first]:
        if name not in own:
            raise wrong(name, f"{name} beside {', '.join(own)}", "none")
    for name in own:
        if name not in (first, *others):
            raise wrong(name, "counts at levels, or capacities", "both")
    if measure is None:
        raise wrong("measure", "the measure of the levels, such as PGA or Sa(1.2 s)", "none")
    listed = own[first] if several(own[first]) else [own[first]]
    unit = "" if units is not None else _core.unit_of_measure(measure)
    columns: dict[str, Any] = {"level" if of_levels else "capacity": _core.numbers_in(first, listed, unit)}
    count = len(listed)
    for name in others:
        value = own.get(name, True)
        values = list(value) if several(value) else [value] * count
        if len(values) != count:
            raise wrong(name, f"{count} values, as many as {first}", str(len(values)))
        columns[name] = values
    return Table(columns, {next(iter(columns)): unit} if unit else None)


@renamed(bounds="friction_factors")
@checked
def design(
    model: _core.Model,
    records: Records | Suite,
    vary: Varied | None = None,
    *,
    friction: Values | None = None,
    measure: str | None = None,
    scale_to: Value | None = None,
    scale: float | None = None,
    gap: Value | None = None,
    probability: float | None = None,
    demand: str | None = None,
    share: float | None = None,
    friction_factors: tuple[float, float] | None = None,
    sensitivity: int | None = None,
    seed: int | None = None,
    confidence: float | None = None,
    pairs: str | None = None,
    second: Records | None = None,
    jobs: int | None = None,
    progress: Progress | None = None,
) -> Assessment:
    """Search the designs that keep a gap with the least acceleration.

    Parameters
    ----------
    model, records
        The model and the motions by name, in one direction or in two.
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
    measure, scale_to, scale
        As in ``spectrum``.
    friction_factors
        Factors on friction for the check of robustness; those of the model if left out.
    sensitivity, seed
        Sample points of Sobol' indices, 0 for none, and their seed.
    confidence
        Of intervals.
    second
        As in ``suite``.
    pairs
        How pairs are run: ``"together"``, the table moving in two horizontal directions, or ``"separate"``, each
        component by itself.
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
    ...            for name, dt in [("short", 0.08), ("middle", 0.09), ("long", 0.1)]}
    >>> found = ss.design(model, records, {"slider.radius": "1..3 m:3"}, friction="0.04..0.1:4",
    ...                   gap="60 mm", sensitivity=0)
    >>> list(found.tables)
    ['front', 'runs']
    """
    return _assess("design", model, records, locals(), jobs, progress)


def _assess(
    kind: str,
    model: _core.Model,
    records: Records | Suite,
    asked: Mapping[str, object],
    jobs: int | None,
    progress: Progress | None,
) -> Assessment:
    a_model(model)
    of, others, asked = of_suite("records", records, asked)
    with following(progress) as on:
        answer = _core.assess(kind, model, of, others, given(kind, asked), jobs=jobs, progress=on)
    return _told(answer)


def _told(answer: _core.Assessment) -> Assessment:
    """The answer, with a warning to whom asked for it where it is severe."""
    told = Assessment(answer)
    warn_of(noticed(told.warnings))
    return told
