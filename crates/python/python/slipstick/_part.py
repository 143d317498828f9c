"""What the tables of the model file have in common: a checked dict."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from . import _core


class Quantity(Protocol):
    """A quantity of pint."""

    @property
    def magnitude(self) -> Any: ...
    @property
    def units(self) -> Any: ...


class Part(dict[str, Any]):
    """A table of a model: a dict whose keys and values are checked as they are given."""

    #: Where it stands in the model file
    _PATH = ""

    def __init__(self, given: Mapping[str, Any]) -> None:
        values = {key: value for key, value in given.items() if key not in ("self", "__class__") and value is not None}
        values = {"from" if key == "from_" else key: value for key, value in values.items()}
        for key, value in values.items():
            _core.check(f"{self._PATH}.{key}", value)
        # A made motion stands in a table of its own.
        of_motion = self._PATH.partition(".")[2] if self._PATH.startswith("motion.") else ""
        super().__init__({of_motion: values} if of_motion else values)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({super().__repr__()})"
