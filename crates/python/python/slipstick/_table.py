"""Named columns: what every result gives, and every frame that goes in."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn, Self

import numpy as np

from . import _core
from ._arguments import checked
from ._request import one_of, wrong

if TYPE_CHECKING:
    from os import PathLike

    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes

    #: A dict of columns, or a frame of any library
    Frame = Any

#: Units by the ends of names, the longest first
_UNITS = {"_m_per_s2": "m/s²", "_m_per_s": "m/s", "_m": "m", "_n": "N", "_j": "J", "_s": "s"}

#: Kinds of columns by those of NumPy's types
_KINDS = {"f": "numbers", "i": "counts", "u": "counts", "b": "flags"}


class Table:
    """Named columns of equal length; Polars, PyArrow and ``pandas.DataFrame.from_arrow`` take it as it is.

    ``table["name"]`` is a read-only array where a column holds numbers, NaN where there is none, else a
    list. Iterating gives the names, ``len(table)`` is the number of rows. It is a stream of Arrow's C
    interface, with units in the metadata of its fields. Tables compare and pickle.

    Parameters
    ----------
    frame
        A dict of columns, or a frame of pandas (a named index is a column), Polars, PyArrow or xarray.
    units
        Units of columns by name, where the frame does not have them.

    Examples
    --------
    >>> import slipstick as ss
    >>> model = ss.Model({"block.mass": "1 t", "slider.static_friction": 0.1, "slider.kinetic_friction": 0.1})
    >>> motion = ss.Motion([0.0, 0.3, 0.0], dt=0.1, units="g")
    >>> table = ss.study(ss.Plan(model, {"pulse": motion}, scale=[1.0, 2.0])).table
    >>> len(table), table.units["peak_sliding_displacement_m"], table["record"]
    (2, 'm', ['pulse', 'pulse'])
    >>> "record" in table, list(table)[:2]
    (True, ['run', 'record'])
    """

    def __init__(self, frame: Any, units: Mapping[str, str] | None = None) -> None:
        self._core = self._of_frame("frame", frame, units)
        self._along, self._read = "row", dict[str, Any]()

    @staticmethod
    def _of_frame(argument: str, frame: Any, units: Mapping[str, str] | None) -> _core.Table:
        if units is not None and not isinstance(units, Mapping):
            raise wrong("units", "units by the names of columns", _core.described(units))
        known = {**units_of(frame), **(units or {})}
        columns = columns_of(frame, argument)
        for name, values in columns:
            if not hasattr(values, "__len__") or isinstance(values, (str, bytes, Mapping)) or np.ndim(values) == 0:
                raise wrong(argument, f"values in column {name!r}", _core.described(values))
            if len(values) != len(columns[0][1]):
                expected = f"columns of one length, {len(columns[0][1])} as {columns[0][0]!r}"
                raise wrong(argument, expected, f"{len(values)} in {name!r}")
        return _core.Table._from_columns([_column(name, values, known.get(name, "")) for name, values in columns])

    @classmethod
    def _named(cls, argument: str, frame: Any) -> Self:
        """A table of a frame that is an argument."""
        return cls._of(cls._of_frame(argument, frame, None))

    @classmethod
    def _of(cls, core: _core.Table, along: str = "row") -> Self:
        """What the extension gives, along ``time_s``, knots or rows."""
        table = cls.__new__(cls)
        table._core, table._along, table._read = core, along, {}
        return table

    @property
    def columns(self) -> list[str]:
        """Names of the columns."""
        return self._core.columns

    @property
    def units(self) -> Mapping[str, str]:
        """Units of the columns that have one."""
        return MappingProxyType(self._core.units)

    def keys(self) -> list[str]:
        """Names of the columns."""
        return self.columns

    def values(self) -> list[Any]:
        """The columns."""
        return [self[name] for name in self]

    def items(self) -> list[tuple[str, Any]]:
        """Names and columns."""
        return [(name, self[name]) for name in self]

    def get(self, name: str, default: Any = None) -> Any:
        """A column, or what stands for it where there is none."""
        return self[name] if name in self else default

    def to_csv(self) -> str:
        """Write the table as the text of a CSV file."""
        return self._core.to_csv()

    @checked
    def write(self, path: str | PathLike[str]) -> Path:
        """Write the table as a file, CSV or Parquet by the end of its name; Parquet keeps units and every bit.

        Parameters
        ----------
        path
            The file, ``"runs.parquet"``, which is replaced.
        """
        self._core.write(path)
        return Path(path)

    @classmethod
    @checked
    def read(cls, path: str | PathLike[str]) -> Table:
        """Read a table in CSV or Parquet, such as the commands write.

        Parameters
        ----------
        path
            The file.

        Raises
        ------
        RecordError, OSError
            For a file that is no table, and one that cannot be read.
        """
        return with_numbers(Table._of(_core.Table.read(path)))

    def to_pandas(self) -> pd.DataFrame:
        """The table as a data frame, units in its ``attrs``.

        A history has the time as its index, each once: of a jump the value after it.
        """
        import pandas as pd

        frame = pd.DataFrame(self._once())
        frame.attrs["units"] = dict(self.units)
        return frame.set_index("time_s") if self._along == "time_s" else frame

    def to_xarray(self) -> xr.Dataset:
        """The table as a dataset, units as attributes; a history over ``time_s``, each time once."""
        import xarray as xr

        along, units = self._along, self.units
        of = {
            name: (along, np.asarray(values), {"units": units[name]} if name in units else {})
            for name, values in self._once().items()
        }
        index = {"time_s": of.pop("time_s")} if "time_s" in of else {}
        return xr.Dataset(of, coords=index)

    @checked
    def plot(
        self, x: str | None = None, y: str | None = None, *, by: str | None = None, ax: Axes | None = None, **kwargs: Any
    ) -> Axes:
        """Draw one column over another in Matplotlib; demands and keys of the model go by their names and units in reports.

        Parameters
        ----------
        x, y
            Columns of numbers; the first, and the one that answers first, if left out.
        by
            A column whose values have lines of their own.
        ax
            Where it is drawn; a new figure if left out.
        kwargs
            What lines take: ``color``, ``lw``, ``marker``.
        """
        from ._plot import draw_table

        def many(values: Any) -> bool:
            return len(set(values[~np.isnan(values)])) > 1

        numbers = [name for name in self if isinstance(self[name], np.ndarray) and many(self[name])]
        if x is None:
            x = next(iter(numbers), None)
        if y is None:
            usual = [name for name in numbers if name.startswith("peak_sliding_displacement_m")]
            y = next(iter(usual + [name for name in reversed(numbers) if name != x]), None)
        for argument, name in [("x", x), ("y", y), ("by", by)]:
            if argument != "by" or name is not None:
                one_of(argument, "a column among", name, self)
        assert x is not None and y is not None
        return draw_table(self, x, y, by, ax, **kwargs)

    def _once(self) -> dict[str, Any]:
        """The columns, of a history with the last row of each time."""
        columns = dict(self.items())
        if self._along != "time_s" or not len(self):
            return columns
        last = np.append(np.diff(columns["time_s"]) > 0.0, True)
        return {name: values[last] for name, values in columns.items()}

    def __getitem__(self, name: str) -> Any:
        if not isinstance(name, str) or name not in self._read:
            values = self._core[name]
            if isinstance(values, np.ndarray):
                values.flags.writeable = False
            self._read[name] = values
        return self._read[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __contains__(self, name: object) -> bool:
        return name in self.columns

    def __len__(self) -> int:
        return len(self._core)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Any:
        # Of names alone pandas would make a frame.
        raise TypeError("expected a column of the table, or table.to_pandas(); found the table itself")

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        return self._core.__arrow_c_stream__(requested_schema)

    def _ipython_key_completions_(self) -> list[str]:
        return self.columns

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self)._of, (self._core, self._along)

    def __eq__(self, other: object) -> bool:
        return self._core == other._core if isinstance(other, Table) else NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<slipstick.Table {len(self)} rows, {len(self.columns)} columns>"

    def _repr_html_(self) -> str:
        from html import escape

        shown = [[_cell(column[row]) for column in self.values()] for row in range(min(len(self), 10))]
        rows = [[escape(f"{name} [{self.units[name]}]" if name in self.units else name) for name in self], *shown]
        body = "".join(f"<tr>{''.join(f'<td>{cell}</td>' for cell in row)}</tr>" for row in rows)
        return f"<table>{body}</table><p>{len(self)} rows, {len(self.columns)} columns</p>"


class Columns(Table, dict[str, Any]):  # type: ignore[misc]
    """A table of arrays that is a dict as well, which every library takes, and which does not change."""

    def __init__(self, columns: Mapping[str, Any], along: str) -> None:
        Table.__init__(self, columns, {name: _unit(name) for name in columns})
        self._along = along
        dict.__init__(self, self.items())

    @classmethod
    def _of(cls, core: _core.Table, along: str = "row") -> Self:
        return cls({name: core[name] for name in core.columns}, along)

    def _fixed(self, *given: object, **named: object) -> NoReturn:
        raise TypeError("expected a dict of one's own, dict(columns): a result does not change")

    __setitem__ = __delitem__ = update = pop = popitem = clear = setdefault = __ior__ = _fixed


class Event(NamedTuple):
    """A change between stick and slip, of the direction of sliding, or of what the slider is in contact with."""

    time_s: float
    #: ``slip``, ``stick``, ``reversal``, ``contact``, ``impact``, ``surface`` and so on
    kind: str
    #: Of the sliding after it: 1 towards +x, -1 towards -x, 0 stuck
    direction: int
    #: Of the interface
    sliding_displacement_m: float
    #: ``slider``, or ``contents.1`` and so on
    interface: str


class Events(list[Event]):
    """The events in order: a list that is a table as well, ``events[0]`` an event, ``events["time_s"]`` a column."""

    @property
    def table(self) -> Table:
        """The events as a table, one row each."""
        columns = zip(*self, strict=True) if self else ((),) * len(Event._fields)
        named = dict(zip(Event._fields, map(list, columns), strict=True))
        return Table(named, {name: _unit(name) for name in named})

    def to_pandas(self) -> pd.DataFrame:
        """The events as a data frame, one row each."""
        return self.table.to_pandas()

    def to_xarray(self) -> xr.Dataset:
        """The events as a dataset."""
        return self.table.to_xarray()

    def __getitem__(self, key: Any) -> Any:
        return self.table[key] if isinstance(key, str) else super().__getitem__(key)

    def __contains__(self, key: object) -> bool:
        return key in Event._fields if isinstance(key, str) else super().__contains__(key)

    def _ipython_key_completions_(self) -> list[str]:
        return list(Event._fields)

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        return self.table.__arrow_c_stream__(requested_schema)


def table_of(argument: str, frame: Any) -> Table:
    """A frame of any library as a table."""
    return frame if isinstance(frame, Table) else Table._named(argument, frame)


def columns_of(frame: Any, argument: str = "frame") -> list[tuple[str, Any]]:
    """Names and values of the columns of any frame, of a history each time once."""
    if not isinstance(frame, Mapping) and not is_frame(frame):
        raise wrong(argument, "columns by name: a dict of arrays, or a frame of any library", _core.described(frame))
    if isinstance(frame, Table):
        return list(frame._once().items())
    if hasattr(frame, "to_dataframe"):  # xarray
        frame = frame.to_dataframe()
    if hasattr(frame, "reset_index") and any(name is not None for name in frame.index.names):
        frame = frame.reset_index()
    if hasattr(frame, "column_names"):  # PyArrow
        names = frame.column_names
    else:
        names = frame.keys() if isinstance(frame, Mapping) else frame.columns
    return [(str(name), frame[name]) for name in names]


def is_frame(value: Any) -> bool:
    """Whether a value has columns by name and is no plain dict: its rows belong together."""
    if isinstance(value, Table):
        return True
    named = any(hasattr(value, name) for name in ("columns", "column_names", "to_dataframe"))
    return named and not isinstance(value, Mapping)


def units_of(frame: Any) -> dict[str, str]:
    """Units that a frame says of its columns."""
    if isinstance(frame, Table):
        return dict(frame.units)
    variables = getattr(frame, "variables", None)
    if variables is not None:  # xarray
        return {str(k): v.attrs["units"] for k, v in variables.items() if "units" in v.attrs}
    units = getattr(frame, "attrs", {}).get("units", {})
    return dict(units) if isinstance(units, Mapping) else {}


def _column(name: str, values: Any, unit: str) -> tuple[str, str, str, Any]:
    """A column as the extension takes it."""
    if np.ma.isMaskedArray(values):
        values = values.filled(np.nan)
    if getattr(values, "null_count", 0) and hasattr(values, "to_pylist"):  # Counts stay counts.
        values = np.array(values.to_pylist(), dtype=object)
    array = np.asarray(values)
    kind = _KINDS.get(array.dtype.kind, "texts")
    if kind == "numbers":
        return name, unit, kind, np.ascontiguousarray(array, dtype="f8")
    cells = [None if cell is None or cell != cell else cell for cell in array.tolist()]
    known = {type(cell) for cell in cells if cell is not None}
    if known == {float}:
        return name, unit, "numbers", array.astype("f8")
    if known in ({bool}, {int}):
        kind = "flags" if bool in known else "counts"
    if kind == "texts":
        cells = ["" if cell is None else str(cell) for cell in cells]
    return name, unit, kind, cells


#: Columns of names, which may look like numbers
_NAMES = ("record", "pair", "channel")


def with_numbers(table: Table) -> Table:
    """A table of a text file, whose columns are numbers where all of their cells are."""

    def read(name: str) -> Any:
        values = table[name]
        if isinstance(values, np.ndarray) or name in _NAMES or not any(isinstance(cell, str) and cell for cell in values):
            return values
        try:
            return np.array([float(cell) if cell else np.nan for cell in values])
        except ValueError:
            return values

    columns = {name: read(name) for name in table}
    if all(columns[name] is table[name] for name in columns):
        return table
    return Table(columns, {name: table.units.get(name, _unit(name)) for name in columns})


def _unit(name: str) -> str:
    """The unit that a column's name ends in."""
    return next((unit for ending, unit in _UNITS.items() if name.endswith(ending)), "")


def _cell(value: Any) -> str:
    from html import escape

    return f"{value:.6g}" if isinstance(value, float) else escape(str(value))
