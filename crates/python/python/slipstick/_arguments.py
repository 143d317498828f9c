"""Arguments of calls, checked by the annotations of their functions before anything is done with them."""

from __future__ import annotations

import functools
import inspect
import operator
from numbers import Real
from os import PathLike
from typing import TYPE_CHECKING, Any, NamedTuple, ParamSpec, TypeVar

import numpy as np

from . import _core
from ._request import a_model, wrong

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

P = ParamSpec("P")
R = TypeVar("R")


class Kind(NamedTuple):
    """What an argument of some annotation is."""

    expected: str
    fits: Callable[[object], bool]


def _is_flag(value: object) -> bool:
    return isinstance(value, bool) or type(value).__name__ in ("bool", "bool_")


def _is_whole(value: object) -> bool:
    if _is_flag(value) or np.ndim(value):  # type: ignore[arg-type]
        return False
    try:
        operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        return False
    return True


def _is_number(value: object) -> bool:
    is_scalar = isinstance(value, Real) or (hasattr(value, "__float__") and np.ndim(value) == 0)  # type: ignore[arg-type]
    return is_scalar and not _is_flag(value) and not hasattr(value, "mask")


def _is_path(value: object) -> bool:
    return isinstance(value, (str, PathLike))


def _is_progress(value: object) -> bool:
    return _is_flag(value) or callable(value) or (hasattr(value, "update") and hasattr(value, "total"))


#: Kinds of arguments by their annotations; what has another is checked by what takes it
_KINDS = {
    "bool": Kind("True or False", _is_flag),
    "int": Kind("a whole number", _is_whole),
    "float": Kind("a number", _is_number),
    "str": Kind("text", lambda value: isinstance(value, str)),
    "str | PathLike[str]": Kind("a path", _is_path),
    "Progress": Kind("a callable of runs done and planned, a bar such as tqdm, or False", _is_progress),
}

#: Annotations of models
_MODELS = ("_core.Model", "Model")


def check_arguments(annotations: Mapping[str, str], given: Mapping[str, object]) -> None:
    """Refuses arguments that are not what their annotations say."""
    for name, value in given.items():
        annotation = annotations.get(name)
        if annotation is None:
            continue
        of = annotation.removesuffix(" | None")
        if value is None and of is not annotation:
            continue
        if of in _MODELS:
            a_model(value, name)
        elif (kind := _KINDS.get(of)) is not None and not kind.fits(value):
            raise wrong(name, kind.expected, _core.described(value))


def checked(function: Callable[P, R]) -> Callable[P, R]:
    """Let a function refuse what is not what its annotations say, in the caller's words."""
    known = {*_KINDS, *_MODELS}
    said: dict[str, str] = function.__annotations__
    annotations = {name: of for name, of in said.items() if name != "return" and of.removesuffix(" | None") in known}
    names = list(inspect.signature(function).parameters)

    @functools.wraps(function)
    def call(*args: P.args, **kwargs: P.kwargs) -> R:
        check_arguments(annotations, dict(zip(names, args)))
        check_arguments(annotations, kwargs)
        return function(*args, **kwargs)

    return call
