"""What can go wrong, with all that is known of it as attributes."""

from __future__ import annotations


class SlipstickWarning(UserWarning):
    """What makes figures void, incomplete or of another quantity until it is cleared up.

    All that is noticed, this and less, is in ``warnings`` of motions and results.
    """


class _Told(Exception):
    """An error that pickles with its attributes."""

    def __reduce__(self) -> tuple[object, ...]:
        return _rebuild, (type(self), str(self), dict(self.__dict__))


class InputError(_Told, ValueError):
    """A model, a plan or an argument that cannot be.

    Attributes
    ----------
    source : str
        The file, or what the text is called; empty for a value that stood in none.
    line, column : int or None
        Where in the text, from 1.
    path : str
        The key, such as ``slider.radius``, or the argument.
    expected, found : str
        What was expected there, and what was found.
    nearest : str or None
        What was probably meant.
    """

    def __init__(
        self,
        message: str,
        *,
        source: str = "",
        line: int | None = None,
        column: int | None = None,
        path: str = "",
        expected: str = "",
        found: str = "",
        nearest: str | None = None,
    ) -> None:
        super().__init__(message)
        self.source = source
        self.line = line
        self.column = column
        self.path = path
        self.expected = expected
        self.found = found
        self.nearest = nearest


class RecordError(_Told, ValueError):
    """A file or an array that is no ground motion.

    Attributes
    ----------
    source : str
        The file; empty where there is none.
    line, column : int or None
        Where in a text, from 1.
    offset : int or None
        Where in a binary file, in bytes from 0.
    expected, found : str
        What was expected there, and what was found.
    """

    def __init__(
        self,
        message: str,
        *,
        source: str = "",
        line: int | None = None,
        column: int | None = None,
        offset: int | None = None,
        expected: str = "",
        found: str = "",
    ) -> None:
        super().__init__(message)
        self.source = source
        self.line = line
        self.column = column
        self.offset = offset
        self.expected = expected
        self.found = found


class SolveError(_Told, RuntimeError):
    """An analysis that has no answer.

    Attributes
    ----------
    time_s : float or None
        The time at which it ends, in s, where there is one.
    """

    def __init__(self, message: str, *, time_s: float | None = None) -> None:
        super().__init__(message)
        self.time_s = time_s


class StudyError(RuntimeError):
    """A study that cannot be run (parts of another one in its folder, a run that fails its check), or
    data from which a statistic cannot be told."""


def _rebuild(cls: type[Exception], message: str, fields: dict[str, object]) -> Exception:
    return cls(message, **fields)
