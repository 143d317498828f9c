"""What is asked of an analysis, by keywords: the fields of its request, of which the core knows the defaults."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any

from . import _core

if TYPE_CHECKING:
    from collections.abc import Iterable

    Values = str | Sequence[str] | Sequence[float]
    Varied = str | Mapping[str, Values]
    Columns = str | PathLike[str] | Mapping[str, str]


def given(kind: str, asked: Mapping[str, object]) -> list[tuple[str, str]]:
    """Return the fields among what is asked as texts; what is left out has its default in the core."""
    texts: list[tuple[str, str]] = []
    for name, many, *_ in _core.fields(kind):
        value = asked.get(name)
        if value is None:
            continue
        if isinstance(value, bool):
            of_field = [str(value).lower()]
        elif isinstance(value, Mapping):
            of_field = [path if ends is None else f"{path}={joined(ends)}" for path, ends in value.items()]
        elif many and isinstance(value, Sequence) and not isinstance(value, str):
            of_field = [str(item) for item in value]
        else:
            of_field = [joined(value)]
        texts += [(name, text) for text in of_field]
    return texts


def paths(given: str | PathLike[str] | Iterable[str | PathLike[str]]) -> list[str]:
    """One path or several as texts."""
    if isinstance(given, (str, PathLike)):
        return [fspath(given)]
    return [fspath(path) for path in given]


def joined(values: Any) -> str:
    """One text of a value or several."""
    if isinstance(values, Sequence) and not isinstance(values, str):
        return ", ".join(str(value) for value in values)
    return fspath(values) if isinstance(values, PathLike) else str(values)
