"""Many analyses of one plan."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _core
from ._assessment import components, read_suite
from ._errors import InputError, RecordError
from ._request import several, text_of, wrong
from ._result import svg_of, warn_of
from ._table import Table

if TYPE_CHECKING:
    from collections.abc import Callable
    from os import PathLike

    from matplotlib.axes import Axes


class Study(NamedTuple):
    """What came of a study."""

    #: One row a run
    table: Table
    #: Fractiles and counts, one row a level and demand
    summary: Table
    runs: int
    #: Runs that have no answer; their status says why
    failures: int
    #: What a person should know
    notices: list[str]

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
        Motions by name, which rows keep, all in one direction or all in two; the model's own motion if left out,
        which must then be a made one.
    second
        Other components of records in one direction, as many and in the same order, with one factor for the pair.
    pairs
        How pairs are run: ``"together"``, the table moving in two horizontal directions, or ``"separate"``, each
        component by itself; together if left out.
    vary
        What is varied, as in a plan: ``{"slider.kinetic_friction": {"uniform": [0.02, 0.06]}}``; a list
        is one of its values.
    samples, seed, method
        Number of samples, their seed, and ``"sobol"``, ``"latin-hypercube"`` or ``"grid"``.
    correlation
        Correlations of pairs of paths: ``[["slider.radius", "storey.1.mass", 0.3]]``.
    measure, levels, scale
        Each record is scaled so that the measure takes each of the levels, ``["0.1 g", "0.2 g"]`` or
        ``"0.1..0.4 g:4"``; or by each of the factors of ``scale``.
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
    records: Mapping[str, _core.Motion] | None = None
    vary: Mapping[str, Any] = field(default_factory=dict)
    samples: int | None = None
    seed: int | None = None
    method: str = "sobol"
    measure: str | None = None
    levels: str | Sequence[str] | None = None
    scale: Sequence[float] | None = None
    bounds: str | None = None
    name: str | None = None
    second: Mapping[str, _core.Motion] | None = None
    correlation: Sequence[Sequence[Any]] | None = None
    pairs: str | None = None

    def __post_init__(self) -> None:
        if self.records is not None:
            components("records", self.records, self.second)
        for of, beside, there in [
            (("measure", "levels", "scale", "second"), "records", bool(self.records)),
            (("pairs",), "second, or records in two directions,", self._of_pairs),
            (("samples", "seed", "correlation"), "vary", bool(self.vary)),
        ]:
            for name in () if there else of:
                if (value := getattr(self, name)) is not None:
                    raise wrong(name, f"{beside} beside it", repr(list(value) if isinstance(value, Mapping) else value))

    @classmethod
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
            levels=records.get("levels"),
            scale=records.get("scale"),
            bounds=said.get("bounds"),
            name=said.get("name"),
            second=suite("second"),
            correlation=sampling.get("correlation"),
            pairs=records.get("pairs"),
        )

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
        return any(motion.acceleration_y_m_per_s2 is not None for motion in (self.records or {}).values())

    @property
    def _of_pairs(self) -> bool:
        return self.second is not None or self._in_two

    @property
    def _motions(self) -> tuple[Mapping[str, _core.Motion], Mapping[str, _core.Motion]]:
        """The records and their other components, which those in two directions have in themselves."""
        records = self.records or {}
        return records, records if self._in_two else self.second or {}

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
    def digest(self) -> str:
        """A hash of all that goes in: equal plans have the same."""
        import hashlib
        import json

        noticed = [motion.warnings for _, _, motion in self._named]
        return hashlib.sha256(json.dumps([_core.__version__, self.files, noticed]).encode()).hexdigest()

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
            records = [_file("records", name) for name in self.records]
            second = [_file("second", name) for name in self._motions[1]] or None
            levels = self.levels
            if isinstance(levels, str):
                levels = _core.levels(levels, self.measure or "PGA")
            measured = {"measure": self.measure, "levels": levels, "scale": self.scale}
            pairs = {"second": second, "pairs": self.pairs}
            # A channel that is named is taken whatever its file is called: "up" is a name here.
            text += ["[records]", *rows({"files": records, "channel": _CHANNEL, **pairs, **measured})]
        if self.vary:
            varied = {k: v if isinstance(v, Mapping) else {"values": v} for k, v in self.vary.items()}
            counted = {"method": self.method, "count": self.samples, "seed": self.seed}
            sampling = {**counted, "correlation": self.correlation}
            text += ["[vary]", *rows(varied), "[sampling]", *rows(sampling)]
        return "\n".join(text) + "\n"


def study(
    plan: Plan | str | PathLike[str],
    out: str | PathLike[str] | None = None,
    *,
    jobs: int | None = None,
    progress: Callable[[int, int], object] | None = None,
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
    from tempfile import TemporaryDirectory

    with ExitStack() as folders:

        def new_folder() -> Path:
            return Path(folders.enter_context(TemporaryDirectory(prefix="slipstick-")))

        path = plan.write(new_folder()) if isinstance(plan, Plan) else Path(plan)
        folder = new_folder() if out is None else Path(out)
        named = plan._named if isinstance(plan, Plan) else []
        with _said_of(plan, path.parent):
            done = _core.study(path, folder, motions=named, jobs=jobs, progress=progress, force=force)
    table, summary = done.table, done.summary
    assert table is not None and summary is not None
    if done.failures:
        warn_of([("failed_runs", f"{done.failures} of {done.runs} runs have no answer: their status says why", True)])
    names = plan._names if isinstance(plan, Plan) else []
    notices = [_by_name(notice, path.parent, names) for notice in done.notices]
    return Study(Table._of(table), Table._of(summary), done.runs, done.failures, notices)


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
        path = plan.write(folder) if isinstance(plan, Plan) else Path(plan)
        named = plan._named if isinstance(plan, Plan) else []
        with _said_of(plan, path.parent):
            return _core.study(path, Path(out), motions=named, shard=shard, jobs=jobs).runs


#: The column of a record of a plan of values
_CHANNEL = "acceleration_m_per_s2"

#: Arguments of a plan by its keys, where they have another name.
_ARGUMENTS = {"records.files": "records", "sampling.count": "samples"}


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


def _toml(value: Any) -> str:
    import json

    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_toml(inner)}" for key, inner in value.items()) + " }"
    if several(value):
        return "[" + ", ".join(map(_toml, value)) + "]"
    text = text_of("vary", value)
    is_text = isinstance(_core.plain("vary", value), str)
    return json.dumps(text, ensure_ascii=False) if is_text else text
