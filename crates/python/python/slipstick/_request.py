"""What is asked of an analysis, by keywords: the fields of its request, of which the core knows the defaults."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import isfinite, isnan
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any

from . import _core
from ._errors import InputError

if TYPE_CHECKING:
    #: Texts with their units, or numbers in SI: alone, in a list, an array, a column of a frame
    Values = str | float | Sequence[Any] | Iterable[Any]
    Varied = str | Mapping[str, Values]
    Columns = str | PathLike[str] | Mapping[str, str]


def given(kind: str, asked: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return the fields among what is asked as texts; what is left out has its default in the core.

    Bare numbers of what has a dimension are in SI.
    """
    texts: list[tuple[str, str]] = []
    about = {name: asked.get(name) for name in ("demand", "measure")}
    of = {name: value if isinstance(value, str) else None for name, value in about.items()}
    for name, many, is_range, *_ in _core.fields(kind):
        value = asked.get(name)
        if value is None:
            continue

        def unit(key: str = "", name: str = name) -> str:
            return _core.unit_in(kind, name, key, of["demand"], of["measure"])

        if isinstance(value, Mapping):
            of_field = [
                str(path) if ends is None else f"{path}={joined(f'{name} {path}', ends, unit(str(path)), is_range)}"
                for path, ends in value.items()
            ]
        elif hasattr(value, "columns"):
            expected = "values by path, {path: values}, of which every combination is run"
            raise wrong(name, expected, "a frame, whose rows belong together: demands and Plan take it")
        elif many and several(value):
            of_field = [text_of(name, item, unit()) for item in list(value)]
        else:
            of_field = [joined(name, value, unit(), is_range)]
        texts += [(name, text) for text in of_field]
    return texts


def paths(argument: str, given: str | PathLike[str] | Iterable[str | PathLike[str]]) -> list[str]:
    """One path or several as texts."""
    listed = [given] if isinstance(given, (str, PathLike)) else given
    if isinstance(listed, bytes) or not hasattr(listed, "__iter__") or getattr(listed, "ndim", 1) == 0:
        raise wrong(argument, "a path, or several", _core.described(listed))
    for path in (listed := list(listed)):
        if not isinstance(path, (str, PathLike)):
            raise wrong(argument, "paths", _core.described(path))
    return [fspath(path) for path in listed]


def texts(argument: str, given: object) -> list[str]:
    """One text or several."""
    listed: list[Any] = list(given) if isinstance(given, Iterable) and several(given) else [given]
    for text in listed:
        if not isinstance(text, str):
            raise wrong(argument, "text, or several", _core.described(text))
    return listed


def several(value: Any) -> bool:
    """Whether a value is a list of them: a sequence, an array, a series or a column of any library."""
    if isinstance(value, (str, bytes, Mapping, _core.Motion)):
        return False
    if hasattr(value, "ndim"):
        return bool(value.ndim > 0)
    is_column = hasattr(value, "__len__") and (hasattr(value, "dtype") or hasattr(value, "to_pylist"))
    return isinstance(value, Sequence) or is_column


def joined(name: str, values: Any, unit: str = "", is_range: bool = False) -> str:
    """One text of a value or several; of two ends of a range with dots between."""
    if not several(values):
        return text_of(name, values, unit)
    texts = [text_of(name, value, unit, row) for row, value in enumerate(values)]
    return ("..".join if is_range and len(texts) == 2 else ", ".join)(texts)


def text_of(name: str, value: Any, unit: str = "", row: int | None = None) -> str:
    """The text of one value, perhaps in a row of a list; a bare number is in a unit, where there is one."""
    if isinstance(value, PathLike):
        return str(fspath(value))
    plain = _core.plain(name, value)
    if plain is None:
        raise wrong(name, "a number or text", _core.described(value))
    if isinstance(plain, bool):
        return str(plain).lower()
    if isinstance(plain, float) and not isfinite(plain):
        found = "NaN" if isnan(plain) else str(plain)
        raise wrong(name, "finite numbers", found if row is None else f"{found} in row {row}")
    return str(plain) if isinstance(plain, str) or not unit else f"{plain!r} {unit}"


def a_model(given: object, argument: str = "model") -> None:
    """Refuses what is no model."""
    if isinstance(given, _core.Model):
        return
    is_path = isinstance(given, (str, PathLike))
    found = f"the path {str(given)!r} (Model.read reads it)" if is_path else _core.described(given)
    raise wrong(argument, "a Model", found)


def wrong(name: str, expected: str, found: str, nearest: str | None = None) -> InputError:
    """An argument that cannot be, and what was probably meant."""
    hint = "" if nearest is None else f'; nearest is "{nearest}"'
    message = f"{name}: expected {expected}, found {found}{hint}"
    return InputError(message, path=name, expected=expected, found=found, nearest=nearest)


def one_of(argument: str, what: str, given: object, known: Iterable[str]) -> str:
    """A name that is one of those there are; of any other it is told which is nearest."""
    names = list(known)
    expected = f"{what} {', '.join(names)}"
    if isinstance(given, str):
        if given in names:
            return given
        raise wrong(argument, expected, repr(given), _core.nearest(given, names))
    raise wrong(argument, expected, _core.described(given))
