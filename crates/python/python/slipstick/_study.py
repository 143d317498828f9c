"""Many analyses of one plan."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _core
from ._arguments import check_arguments, checked
from ._assessment import read_suite
from ._errors import InputError, RecordError
from ._names import renamed, tell
from ._progress import following
from ._records import Suite, components
from ._request import several, text_of, wrong
from ._result import svg_of, warn_of
from ._table import Table, columns_of, is_frame, units_of, with_numbers

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._progress import Progress
    from ._records import Records


class _Results(NamedTuple):
    """What a study gives, in its order."""

    #: One row a run
    table: Table
    #: Fractiles and counts, one row a level and demand
    summary: Table
    runs: int
    #: Runs that have no answer; their status says why
    failures: int
    #: What a person should know
    notices: list[str]


class Study(_Results):
    """What came of a study: its ``table`` of runs, its ``summary``, ``runs``, ``failures`` and ``notices``."""

    _made_of: Mapping[str, str] = MappingProxyType({})

    @property
    def made_of(self) -> dict[str, str]:
        """Which model and motions it is of: their digests; of files the SHA-256 of each."""
        return dict(self._made_of)

    @classmethod
    def _with(cls, results: _Results, made_of: Mapping[str, str]) -> Study:
        study = cls(*results)
        study._made_of = dict(made_of)
        return study

    @classmethod
    @checked
    def read(cls, folder: str | PathLike[str]) -> Study:
        """Read what a study has written into its folder, without its plan.

        Parameters
        ----------
        folder
            That of ``study(plan, out)``, of ``slipstick study --out`` or of a cluster, concluded. Records go by the
            names that its files have.

        Raises
        ------
        OSError, RecordError
            For a folder without the runs and the summary of a study.
        """
        read = _core.read_study(folder)
        assert read.table is not None and read.summary is not None
        summary = with_numbers(Table._of(read.summary))
        results = _Results(Table._of(read.table), summary, read.runs, read.failures, read.notices)
        return cls._with(results, _hashes_of_files(Path(folder)))

    @checked
    def plot(
        self,
        x: str | None = None,
        y: str = "peak_sliding_displacement_m",
        *,
        by: str | None = None,
        ax: Axes | None = None,
        **kwargs: Any,
    ) -> Axes:
        """Draw a demand over what was varied, or one column of the runs over another, in Matplotlib.

        Parameters
        ----------
        x, y
            Columns of ``table``; what is varied first, or the level, if left out.
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
        if x is None and by is None and y in self.table:
            from ._plot import draw_runs, varied

            return draw_runs(self.table, varied(self.table), y, ax, **kwargs)
        return self.table.plot(x, y, by=by, ax=ax, **kwargs)

    def _repr_html_(self) -> str:
        from html import escape

        failed = f", {self.failures} without an answer" if self.failures else ""
        said = "".join(f"<p>{escape(notice)}</p>" for notice in self.notices)
        return f"<p>{self.runs} runs{failed}</p>{said}{svg_of(self.plot)}{self.summary._repr_html_()}"


@dataclass(frozen=True)
class Plan:
    """A study of values instead of files.

    Parameters
    ----------
    model
        The model.
    records
        Motions by name, which rows keep, all in one direction or all in two, a list of them, one, or a stream of
        ObsPy; the model's own motion if left out, which must then be a made one.
    second
        Other components of records in one direction, as many and in the same order, with one factor for the pair.
    pairs
        How pairs are run: ``"together"``, the table moving in two horizontal directions, or ``"separate"``, each
        component by itself; together if left out.
    vary
        What is varied, as in a plan: ``{"slider.kinetic_friction": {"uniform": [0.02, 0.06]}}``; a list, an array or
        a column of a frame is one of its values. Numbers are in SI, texts have their unit. A frame of any library
        is a list of designs, a row each, its columns named by their paths.
    samples, seed, method
        Number of samples, their seed, and ``"sobol"``, ``"latin-hypercube"`` or ``"grid"``: every combination of lists,
        which it is where there are nothing but lists and no number of samples.
    correlation
        Correlations of pairs of paths: ``[["slider.radius", "storey.1.mass", 0.3]]``.
    measure, scale_to, scale
        Each record is scaled so that the measure, PGA if left out, takes each of these values, ``["0.1 g", "0.2 g"]``,
        ``"0.1..0.4 g:4"`` or numbers in SI; or by each of the factors of ``scale``.
    bounds
        Which of the model's ``slider.bounds`` are run: ``"all"``, ``"lower"``, ``"nominal"``, ``"upper"``.
    name
        Name of the study.

    Examples
    --------
    >>> import slipstick as ss
    >>> model = ss.Model({"block.mass": "1 t", "slider.static_friction": 0.06,
    ...                   "slider.kinetic_friction": 0.05})
    >>> records = {"pulse": ss.Motion([0.0, 0.3, -0.3, 0.0], dt=0.1, units="g")}
    >>> plan = ss.Plan(model, records, {"slider.kinetic_friction": {"uniform": [0.03, 0.06]}},
    ...                samples=64, seed=1, scale=[1.0, 2.0])
    >>> study = ss.study(plan)
    >>> study.runs, study.failures
    (128, 0)
    >>> study.table.columns[:5]
    ['run', 'record', 'channel', 'level', 'scale']
    """

    model: _core.Model
    records: Records | Suite | None = None
    vary: Any = field(default_factory=dict)
    samples: int | None = None
    seed: int | None = None
    method: str | None = None
    measure: str | None = None
    scale_to: str | Sequence[str] | Sequence[float] | None = None
    scale: Sequence[float] | None = None
    bounds: str | None = None
    name: str | None = None
    second: Records | None = None
    correlation: Sequence[Sequence[Any]] | None = None
    pairs: str | None = None

    def __post_init__(self) -> None:
        check_arguments(type(self).__annotations__, vars(self))
        if isinstance(self.records, Suite):
            own = {name: getattr(self, name) for name in ("second", "measure", "scale_to", "scale", "pairs")}
            filled = self.records.fill(own)
            filled["scale"] = [filled["scale"]] if isinstance(filled["scale"], (int, float)) else filled["scale"]
            for name, value in [("records", self.records.records), *filled.items()]:
                object.__setattr__(self, name, value)
        if self.records is not None:
            of_all = components("records", self.records, self.second)  # type: ignore[arg-type]
            for name, of in zip(("records", "second"), of_all, strict=True):
                if getattr(self, name) is not None:
                    object.__setattr__(self, name, dict(of))
        object.__setattr__(self, "vary", _by_path(self.vary))
        if self.method is None and self.vary:
            listed = all(several(value) or (isinstance(value, Mapping) and "values" in value) for value in self.vary.values())
            if self.samples is None and not listed:
                raise wrong("samples", "a number of samples beside distributions", "none")
            object.__setattr__(self, "method", "grid" if self.samples is None else "sobol")
        for arguments, beside, there in [
            (("measure", "scale_to", "scale", "second"), "records", bool(self.records)),
            (("pairs",), "second, or records in two directions,", self._of_pairs),
            (("samples", "seed", "correlation"), "vary", bool(self.vary)),
        ]:
            for name in () if there else arguments:
                if (value := getattr(self, name)) is not None:
                    raise wrong(name, f"{beside} beside it", repr(list(value) if isinstance(value, Mapping) else value))

    @classmethod
    @checked
    def read(cls, path: str | PathLike[str]) -> Plan:
        """Read a plan file with its model and its records.

        Parameters
        ----------
        path
            The file, TOML.

        Raises
        ------
        InputError
            For a plan or a model that cannot be, with line and column, and for pairs that are brought to a
            spectrum, which a file alone says: ``study`` takes its path.
        RecordError, OSError
            For records that cannot be read.
        """
        import tomllib

        path = Path(path)
        _core.study_id(path)  # All that is wrong is said of its place.
        said = tomllib.loads(path.read_text(encoding="utf-8-sig"))
        records, sampling = said.get("records", {}), said.get("sampling", {})
        for key in ("target", "code_spectrum", "periods", "vertical_scale"):
            if key in records:
                raise wrong(f"records.{key}", "the path of the plan where it is run", "a plan of values")

        def suite(key: str) -> dict[str, _core.Motion] | None:
            if key not in records:
                return None
            found = [path.parent / pattern for pattern in records[key]]
            up = [path.parent / pattern for pattern in records.get("vertical", ())]
            told = {name: records.get(name) for name in ("channel", "units", "dt")}
            return read_suite(found, vertical=up, **told)

        return cls(
            _core.Model.read(path.parent / said["model"]),
            suite("files"),
            said.get("vary", {}),
            samples=sampling.get("count"),
            seed=sampling.get("seed"),
            method=sampling.get("method", "sobol"),
            measure=records.get("measure"),
            scale_to=records.get("levels"),
            scale=records.get("scale"),
            bounds=said.get("bounds"),
            name=said.get("name"),
            second=suite("second"),
            correlation=sampling.get("correlation"),
            pairs=records.get("pairs"),
        )

    @property
    def levels(self) -> str | Sequence[str] | Sequence[float] | None:
        """The old name of ``scale_to``."""
        tell("Plan.levels", "scale_to")
        return self.scale_to

    @property
    def files(self) -> dict[str, str]:
        """The plan, the model and the records as the files of a study, text by name."""
        files = {"plan.toml": self._toml(), "model.toml": self.model.toml}
        first, second = self._motions
        files.update({_file("records", name): _csv(motion) for name, motion in first.items()})
        files.update({_file("second", name): _csv(motion, along_y=self.second is None) for name, motion in second.items()})
        return files

    @property
    def _in_two(self) -> bool:
        """Whether records are in two directions."""
        records: Mapping[str, _core.Motion] = self.records or {}  # type: ignore[assignment]
        return any(motion.acceleration_y_m_per_s2 is not None for motion in records.values())

    @property
    def _of_pairs(self) -> bool:
        return self.second is not None or self._in_two

    @property
    def _motions(self) -> tuple[Mapping[str, _core.Motion], Mapping[str, _core.Motion]]:
        """The records and their other components, which those in two directions have in themselves."""
        records: Mapping[str, _core.Motion] = self.records or {}  # type: ignore[assignment]
        second: Mapping[str, _core.Motion] = self.second or {}  # type: ignore[assignment]
        return records, records if self._in_two else second

    @property
    def _named(self) -> list[tuple[str, str, _core.Motion]]:
        """Files, names and motions of the records; names of components that are run separately have their axes."""
        axes = (" x", " y") if self._in_two and self.pairs == "separate" else ("", "")
        of = zip(("records", "second"), self._motions, axes, strict=True)
        return [
            (_file(folder, name), name + axis, motion)
            for folder, motions, axis in of
            for name, motion in motions.items()
        ]

    @property
    def _names(self) -> list[tuple[str, str]]:
        return [(file, name) for file, name, _ in self._named]

    @property
    def _made_of(self) -> dict[str, str]:
        records: Mapping[str, _core.Motion] = self.records or {}  # type: ignore[assignment]
        second: Mapping[str, _core.Motion] = self.second or {}  # type: ignore[assignment]
        of = [("model", self.model.digest)]
        of += [(f"record {name}", motion.digest) for name, motion in records.items()]
        return dict(of + [(f"second {name}", motion.digest) for name, motion in second.items()])

    @property
    def digest(self) -> str:
        """A hash of all that goes in: equal plans have the same."""
        import hashlib
        import json

        noticed = [motion.warnings for _, _, motion in self._named]
        return hashlib.sha256(json.dumps([_core.__version__, self.files, noticed]).encode()).hexdigest()

    @checked
    def write(self, folder: str | PathLike[str]) -> Path:
        """Write the files of the study and return the path of the plan, for ``slipstick study``."""
        for name, text in self.files.items():
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8", newline="\n")
        return Path(folder) / "plan.toml"

    def _toml(self) -> str:
        def rows(values: Mapping[str, Any]) -> list[str]:
            given = ((key, value) for key, value in values.items() if value is not None)
            return [f"{_toml(str(key))} = {_toml(value)}" for key, value in given]

        text = rows({"name": self.name, "model": "model.toml", "bounds": self.bounds})
        if self.records is not None:
            records = [_file("records", name) for name in self._motions[0]]
            second = [_file("second", name) for name in self._motions[1]] or None
            levels: Any = self.scale_to
            measure = self.measure if levels is None else self.measure or "PGA"
            if isinstance(levels, str):
                levels = _core.levels(levels, measure or "")
            elif levels is not None:
                unit = _core.unit_of_measure(measure or "")
                levels = [text_of("scale_to", level, unit, row) for row, level in enumerate(levels)]
            measured = {"measure": measure, "levels": levels, "scale": self.scale}
            pairs = {"second": second, "pairs": self.pairs}
            # A channel that is named is taken whatever its file is called: "up" is a name here.
            text += ["[records]", *rows({"files": records, "channel": _CHANNEL, **pairs, **measured})]
        if self.vary:
            counted = {"method": self.method, "count": self.samples, "seed": self.seed}
            sampling = {**counted, "correlation": self.correlation}
            varied = [f"{_toml(str(path))} = {_distribution(path, value)}" for path, value in self.vary.items()]
            text += ["[vary]", *varied, "[sampling]", *rows(sampling)]
        return "\n".join(text) + "\n"


Plan.__init__ = renamed(levels="scale_to")(Plan.__init__)  # type: ignore[method-assign]


@checked
def study(
    plan: Plan | str | PathLike[str],
    out: str | PathLike[str] | None = None,
    *,
    jobs: int | None = None,
    progress: Progress | None = None,
    force: bool = False,
) -> Study:
    """Run a study.

    Parameters
    ----------
    plan
        A ``Plan``, or the path of a plan file.
    out
        A folder for parts, manifest and summary, as ``slipstick study --out`` writes it. What it holds
        of this study is not run again. A folder of its own, removed at the end, if left out.
    jobs
        Number of threads; as many as the machine has if left out or -1.
    progress
        Called with the runs done and planned, some twenty times a second; or a bar of tqdm, or its class. If left out, a
        line says how far the work is in a terminal and below a cell of a notebook, once it takes a second; False is nobody.
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
    from tempfile import TemporaryDirectory

    with ExitStack() as folders:

        def new_folder() -> Path:
            return Path(folders.enter_context(TemporaryDirectory(prefix="slipstick-")))

        path = plan.write(new_folder()) if isinstance(plan, Plan) else _path_of(plan)
        folder = new_folder() if out is None else Path(out)
        named = plan._named if isinstance(plan, Plan) else []
        with _said_of(plan, path.parent), following(progress) as on:
            done = _core.study(path, folder, motions=named, jobs=jobs, progress=on, force=force)
        table, summary = done.table, done.summary
        assert table is not None and summary is not None
        if done.failures:
            warn_of([("failed_runs", f"{done.failures} of {done.runs} runs have no answer: their status says why", True)])
        names = plan._names if isinstance(plan, Plan) else []
        notices = [_by_name(notice, path.parent, names) for notice in done.notices]
        results = _Results(Table._of(table), Table._of(summary), done.runs, done.failures, notices)
        return Study._with(results, plan._made_of if isinstance(plan, Plan) else _hashes_of_files(folder))


def _hashes_of_files(folder: Path) -> dict[str, str]:
    """The files that a study in a folder was made of, and the hash of each."""
    import json

    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    return {entry["path"]: entry["sha256"] for entry in manifest["inputs"]}


@checked
def run_shard(
    plan: Plan | str | PathLike[str], out: str | PathLike[str], shard: tuple[int, int], *, jobs: int | None = 1
) -> int:
    """Run one of so many shards of a study into a folder, what it lacks of it; the runs of the shard.

    Parameters
    ----------
    plan, out
        The study and its folder, which other processes may write to as well.
    shard
        The shard and the number of shards, from 1: ``(3, 8)``.
    jobs
        Number of threads.
    """
    from tempfile import TemporaryDirectory

    with TemporaryDirectory(prefix="slipstick-") as folder:
        path = plan.write(folder) if isinstance(plan, Plan) else _path_of(plan)
        named = plan._named if isinstance(plan, Plan) else []
        with _said_of(plan, path.parent):
            return _core.study(path, Path(out), motions=named, shard=shard, jobs=jobs).runs


def _path_of(plan: object) -> Path:
    if not isinstance(plan, (str, PathLike)):
        raise wrong("plan", "a Plan, or the path of one", _core.described(plan))
    return Path(plan)


#: The column of a record of a plan of values
_CHANNEL = "acceleration_m_per_s2"

#: Arguments of a plan by its keys, where they have another name.
_ARGUMENTS = {"records.files": "records", "records.levels": "scale_to", "sampling.count": "samples"}


def _by_name(text: str, folder: Path, names: list[tuple[str, str]]) -> str:
    """A text that calls records by their names instead of files that nobody wrote."""
    for file, name in names:
        text = text.replace(str(folder / file), name).replace(file, name)
    return text


@contextmanager
def _said_of(plan: Plan | str | PathLike[str], folder: Path) -> Iterator[None]:
    """What is wrong with a plan of values is said of its argument, not of a file in the folder that nobody wrote."""
    try:
        yield
    except InputError as error:
        if not isinstance(plan, Plan) or not error.source:
            raise
        key = error.path
        name = _ARGUMENTS.get(key, key.removeprefix("records.").removeprefix("sampling."))
        found = _by_name(error.found, folder, plan._names)
        hint = f'; nearest is "{error.nearest}"' if error.nearest else ""
        message = f"{name}: expected {error.expected}, found {found}{hint}"
        raise InputError(message, path=name, expected=error.expected, found=found, nearest=error.nearest) from None
    except RecordError as error:
        if not isinstance(plan, Plan):
            raise
        name = next((name for file, name in plan._names if file in str(error)), "records")
        raise RecordError(_by_name(str(error), folder, plan._names), source=name) from None


def _file(folder: str, name: str) -> str:
    """The file of a record: its name, with what a name of a file or a pattern may not have escaped."""
    from urllib.parse import quote

    if not name:
        raise wrong("records", "names that are not empty", repr(name))
    plain = quote(name, safe=" +,;=@()&'!")
    return f"{folder}/{plain.replace('.', '%2E', 1) if plain.startswith('.') else plain}.csv"


def _csv(motion: _core.Motion, *, along_y: bool = False) -> str:
    """A record of one horizontal direction, whose numbers read back as the same."""
    across = motion.acceleration_y_m_per_s2 if along_y else None
    horizontal = motion.acceleration_m_per_s2 if across is None else across
    columns = {"time_s": motion.time_s, _CHANNEL: horizontal}
    if motion.vertical_m_per_s2 is not None:
        columns["vertical_acceleration_m_per_s2"] = motion.vertical_m_per_s2
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    return "\n".join([",".join(columns), *(",".join(map(repr, row)) for row in rows)]) + "\n"


#: Keys of a distribution, and how many of their numbers are values of its path; all where there is no end
_OF_PATH = {"values": None, "linspace": 2, "logspace": 2, "uniform": 2, "normal": 2, "lognormal": 1, "truncated": 2}


def _distribution(path: str, given: Any) -> str:
    """How a path is varied, as a plan has it; bare numbers of what has a dimension are in SI."""
    of = dict(given) if isinstance(given, Mapping) else {"values": given}
    unit = "" if "factor_of" in of else _core.unit_at(path)
    for key, count in _OF_PATH.items():
        if unit and several(of.get(key)):
            values = list(of[key])
            of_path = [text_of(f"vary.{path}", value, unit, row) for row, value in enumerate(values[:count])]
            of[key] = of_path + (values[count:] if count is not None else [])
    return _toml(of)


def _by_path(vary: Any) -> dict[str, Any]:
    """What is varied, by paths: rows of a frame belong together."""
    if isinstance(vary, Mapping):
        return dict(vary)
    if not is_frame(vary):
        raise wrong("vary", "values by path, {path: values}, or a frame of designs", _core.described(vary))
    units, columns = units_of(vary), columns_of(vary)
    found: dict[str, Any] = {}
    for path, values in columns:
        unit = units.get(path, "")
        of: dict[str, Any] = {"values": [text_of(path, value, unit) if unit else value for value in values]}
        found[path] = {**of, "paired_with": next(iter(found))} if found else of
    return found


def _toml(value: Any) -> str:
    import json

    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_toml(inner)}" for key, inner in value.items()) + " }"
    if several(value):
        return "[" + ", ".join(map(_toml, value)) + "]"
    text = text_of("vary", value)
    is_text = isinstance(_core.plain("vary", value), str)
    return json.dumps(text, ensure_ascii=False) if is_text else text
