"""Who follows long work: a callable, a bar of tqdm, or a line in the terminal."""

from __future__ import annotations

import sys
import time
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    class Bar(Protocol):
        """A bar such as tqdm's."""

        total: Any

        def update(self, n: int = 1) -> object: ...

    #: Called with the runs done and planned; a bar or its class; False for nobody
    Progress = Callable[[int, int], object] | Bar | bool

#: Seconds before a line is shown
PATIENCE_S = 1.0


@contextmanager
def following(progress: Progress | None) -> Iterator[Callable[[int, int], object] | None]:
    """What is called with the runs done and planned; without a word of it a line where somebody sees it."""
    if progress is None or progress is True:
        if progress is None and not _is_watched():
            yield None
            return
        line = _Line()
        try:
            yield line
        finally:
            line.end()
    elif progress is False:
        yield None
    elif hasattr(progress, "update") or _makes_bars(progress):
        bar = _OfBar(progress)
        try:
            yield bar
        finally:
            bar.end()
    else:
        yield progress


def _is_watched() -> bool:
    """Whether a line that is written over is seen: in a terminal, and below a cell of a notebook."""
    if sys.stderr is None:
        return False
    return sys.stderr.isatty() or type(sys.stderr).__module__.startswith("ipykernel")


def _makes_bars(given: object) -> bool:
    """Whether a value makes bars: the class of them, perhaps with some of its arguments, ``partial(tqdm, desc="IDA")``."""
    of = given.func if isinstance(given, partial) else given
    return isinstance(of, type) and hasattr(of, "update")


class _OfBar:
    """Moves a bar, made with its total where its class is given."""

    def __init__(self, given: Any) -> None:
        self._bar: Any = None if _makes_bars(given) else given
        self._make = given
        self._at = 0

    def __call__(self, done: int, planned: int) -> None:
        if self._bar is None:
            self._bar = self._make(total=planned)
        self._bar.total = planned
        self._bar.update(done - self._at)
        self._at = done

    def end(self) -> None:
        if self._bar is not None and _makes_bars(self._make):
            self._bar.update(max(0, (self._bar.total or 0) - self._at) if sys.exc_info()[0] is None else 0)
            self._bar.close()


class _Line:
    """A line of the terminal that says how far the work is; of short work nothing."""

    def __init__(self) -> None:
        self._start = time.monotonic()
        self._width = 0

    def __call__(self, done: int, planned: int) -> None:
        taken = time.monotonic() - self._start
        if taken < PATIENCE_S or not planned:
            return
        left = f", {taken / done * (planned - done):.0f} s left" if done else ""
        self._show(f"{done} of {planned} runs, {100 * done // planned} %{left}")

    def _show(self, text: str) -> None:
        sys.stderr.write("\r" + text.ljust(self._width))
        sys.stderr.flush()
        self._width = max(self._width, len(text))

    def end(self) -> None:
        if self._width:
            self._show("")
            sys.stderr.write("\r")
            sys.stderr.flush()
