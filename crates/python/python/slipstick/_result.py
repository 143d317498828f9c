"""What results have in common: they tell themselves once, compare by what they tell, and pickle as that."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NoReturn, Self

from ._errors import SlipstickWarning
from ._table import Table

if TYPE_CHECKING:
    from collections.abc import Callable
    from os import PathLike

    from matplotlib.axes import Axes

    import pandas as pd
    import xarray as xr

    Key = tuple[str, ...]
    #: Kind, message, whether it is severe
    Noticed = tuple[str, str, bool]

#: Systems of units that results are shown in
UNITS = ("si", "si-g", "kN-mm", "us")


def noticed(warnings: list[dict[str, Any]]) -> list[Noticed]:
    """What the warnings of a summary say."""
    return [(w["kind"], w["message"], w.get("severity") == "severe") for w in warnings]


def warn_of(of: list[Noticed]) -> None:
    """Warn whoever called the package of what is severe."""
    import sys
    import warnings

    frame, depth = sys._getframe(1), 2
    while frame.f_back is not None and frame.f_globals.get("__name__", "").startswith("slipstick."):
        frame, depth = frame.f_back, depth + 1
    for _, message, severe in of:
        if severe:
            warnings.warn(message, SlipstickWarning, stacklevel=depth)


def in_a_line(holds: bool | None, of: list[Noticed]) -> str:
    """Whether a result holds, and its warnings, the gravest first."""
    words = [] if holds is None else ["holds" if holds else "DOES NOT HOLD"]
    words += [("severe: " if severe else "warning: ") + kind.replace("_", " ") for kind, _, severe in of]
    return "".join(f"{word}; " for word in words)


def in_html(holds: bool | None, of: list[Noticed], meaning: str) -> str:
    """The same for a notebook, in whole sentences."""
    from html import escape

    lines = [] if holds is None else [f"<b>{meaning} {'holds' if holds else 'DOES NOT HOLD'}</b>"]
    lines += [f"<b>{'Severe' if severe else 'Warning'}:</b> {escape(message)}" for _, message, severe in of]
    return "".join(f"<p>{line}</p>" for line in lines)


def svg_of(draw: Callable[..., Axes]) -> str:
    """What a plot draws, as SVG; nothing without Matplotlib, or where there is nothing to draw."""
    try:
        from matplotlib.backends.backend_svg import FigureCanvasSVG
        from matplotlib.figure import Figure
    except ImportError:
        return ""
    import io

    figure = Figure(figsize=(6, 3.5), layout="constrained")
    FigureCanvasSVG(figure)
    try:
        draw(ax=figure.add_subplot())
    except ValueError:
        return ""
    text = io.StringIO()
    figure.savefig(text, format="svg")
    return text.getvalue()[text.getvalue().index("<svg") :]


def _fixed(self: object, *given: object, **named: object) -> NoReturn:
    raise TypeError("expected one's own copy, copy.deepcopy(summary): a result does not change")


class _FixedDict(dict[str, Any]):
    """A dict that does not change; its copies do."""

    __setitem__ = __delitem__ = update = pop = popitem = clear = setdefault = __ior__ = _fixed

    def __reduce_ex__(self, protocol: Any) -> Any:
        return dict, (list(self.items()),)


class _FixedList(list[Any]):
    """A list that does not change; its copies do."""

    __setitem__ = __delitem__ = append = extend = insert = pop = remove = clear = sort = reverse = _fixed
    __iadd__ = __imul__ = _fixed

    def __reduce_ex__(self, protocol: Any) -> Any:
        return list, (tuple(self),)


def figures_of(text: str) -> dict[str, Any]:
    """The figures of a text in JSON, which do not change."""
    import json

    def fixed(value: Any) -> Any:
        if isinstance(value, dict):
            return _FixedDict({key: fixed(inner) for key, inner in value.items()})
        return _FixedList([fixed(inner) for inner in value]) if isinstance(value, list) else value

    figures: dict[str, Any] = fixed(json.loads(text))
    return figures


class Result:
    """Tables, figures, summary and report of some work."""

    #: What the result tells, each a name of the extension's object with its arguments
    _KEYS: tuple[Key, ...] = (("tables",), ("_figures",), ("_summary_json",))

    def __init__(self, core: Any) -> None:
        self._core = core
        self._told: dict[Key, Any] = {}

    def _tell(self, *key: str) -> Any:
        if key not in self._told:
            name, *arguments = key
            value = getattr(self._core, name)
            self._told[key] = value(*arguments) if callable(value) else value
        return self._told[key]

    @property
    def tables(self) -> Mapping[str, Table]:
        """The tables by name."""
        return self._tabled("tables")

    def _tabled(self, key: str) -> Mapping[str, Table]:
        return MappingProxyType({name: Table._of(core) for name, core in self._tell(key).items()})

    @property
    def table(self) -> Table:
        """The first of the tables."""
        return next(iter(self.tables.values()))

    @property
    def summary(self) -> dict[str, Any]:
        """All figures, as the command prints them with ``--json``."""
        return figures_of(self._tell("_summary_json"))

    @property
    def holds(self) -> bool | None:
        """Whether the answer keeps its bounds; None where it has none."""
        return None

    @property
    def warnings(self) -> list[dict[str, Any]]:
        """What may change a decision, the gravest first."""
        warnings: list[dict[str, Any]] = self.summary.get("warnings", [])
        return warnings

    @property
    def figures(self) -> Mapping[str, str]:
        """The figures as SVG by name; a notebook shows the first."""
        return MappingProxyType(dict(self._tell("_figures")))

    def to_pandas(self) -> pd.DataFrame:
        """The first of the tables as a data frame."""
        return self.table.to_pandas()

    def to_xarray(self) -> xr.Dataset:
        """The first of the tables as a dataset."""
        return self.table.to_xarray()

    def __getitem__(self, name: str) -> Table:
        return self.tables[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.tables)

    def __contains__(self, name: object) -> bool:
        return name in self.tables

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Any:
        return self.table.__array__(dtype, copy)

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        return self.table.__arrow_c_stream__(requested_schema)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self.tables)

    def _keys(self) -> Iterator[Key]:
        yield from self._KEYS

    def __reduce__(self) -> tuple[Any, ...]:
        told = {key: self._tell(*key) for key in self._keys()}
        return _restored, (type(self), told)

    @classmethod
    def _of(cls, told: dict[Key, Any]) -> Self:
        result = cls(None)
        result._told.update(told)
        return result

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        assert isinstance(other, Result)
        mine, theirs = self._tell("_summary_json"), other._tell("_summary_json")
        return bool(mine == theirs and self._tell("tables") == other._tell("tables"))

    def __hash__(self) -> int:
        return hash(self._tell("_summary_json"))

    def _repr_html_(self) -> str:
        said = in_html(self.holds, noticed(self.warnings), "The answer")
        return said + next(iter(self.figures.values()), "")

    def __repr__(self) -> str:
        said = in_a_line(self.holds, noticed(self.warnings))
        return f"<slipstick.{type(self).__name__} {said}{self._names()}>"

    def _names(self) -> str:
        return ", ".join(self.tables)


def _restored(cls: type[Result], told: dict[Key, Any]) -> Result:
    return cls._of(told)


def write(path: str | PathLike[str], text: str) -> Path:
    """Write a page."""
    target = Path(path)
    target.write_text(text, encoding="utf-8")
    return target
