"""What is asked of an analysis, by keywords: the fields of its request, of which the core knows the defaults."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any

from . import _core
from ._errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable

    Values = str | Sequence[str] | Sequence[float]
    Varied = str | Mapping[str, Values]
    Columns = str | PathLike[str] | Mapping[str, str]


def given(kind: str, asked: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return the fields among what is asked as texts; what is left out has its default in the core."""
    texts: list[tuple[str, str]] = []
    for name, many, *_ in _core.fields(kind):
        value = asked.get(name)
        if value is None:
            continue
        if isinstance(value, Mapping):
            of_field = [
                path if ends is None else f"{path}={joined(name, ends)}" for path, ends in value.items()
            ]
        elif many and several(value):
            of_field = [text_of(name, item) for item in list(value)]
        else:
            of_field = [joined(name, value)]
        texts += [(name, text) for text in of_field]
    return texts


def paths(given: str | PathLike[str] | Iterable[str | PathLike[str]]) -> list[str]:
    """One path or several as texts."""
    if isinstance(given, (str, PathLike)):
        return [fspath(given)]
    return [fspath(path) for path in given]


def several(value: Any) -> bool:
    """Whether a value is a list of them: a sequence, an array, a series."""
    if isinstance(value, (str, bytes, Mapping)):
        return False
    return isinstance(value, Sequence) or getattr(value, "ndim", 0) > 0


def joined(name: str, values: Any) -> str:
    """One text of a value or several."""
    if several(values):
        return ", ".join(text_of(name, value) for value in values)
    return text_of(name, values)


def text_of(name: str, value: Any) -> str:
    """The text of one value."""
    if isinstance(value, PathLike):
        return str(fspath(value))
    plain = _core.plain(name, value)
    if plain is None:
        raise wrong(name, "a number or text", type(value).__name__)
    return str(plain).lower() if isinstance(plain, bool) else str(plain)


def wrong(name: str, expected: str, found: str) -> InputError:
    """An argument that cannot be."""
    return InputError(f"{name}: expected {expected}, found {found}", path=name, expected=expected, found=found)
