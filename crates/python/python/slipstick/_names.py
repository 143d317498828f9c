"""Words of arguments that have changed, taken for one version more."""

from __future__ import annotations

import functools
import warnings
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

P = ParamSpec("P")
R = TypeVar("R")


def tell(old: str, new: str, stacklevel: int = 3) -> None:
    """Warn whoever uses an old word, and name the new one."""
    warnings.warn(f"{old} is called {new} now", DeprecationWarning, stacklevel=stacklevel)


def renamed(**words: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Let a function take old words of its arguments, with a warning that names the new: ``renamed(old="new")``."""

    def of(function: Callable[P, R]) -> Callable[P, R]:
        called = function.__qualname__.removesuffix(".__init__")

        @functools.wraps(function)
        def call(*args: P.args, **kwargs: P.kwargs) -> R:
            given: dict[str, Any] = kwargs
            for old, new in words.items():
                if old in given:
                    if new in given:
                        raise TypeError(f"{called}: expected {new}, found {new} and {old}, which is its old name")
                    tell(f"{called}: {old}", new, stacklevel=3)
                    given[new] = given.pop(old)
            return function(*args, **kwargs)

        return call

    return of
