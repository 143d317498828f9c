from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "Assessment",
    "Comparison",
    "Identified",
    "Model",
    "Motion",
    "Response",
    "Study",
    "Table",
    "__version__",
    "compare_with",
    "design",
    "fragility",
    "ida",
    "identify_cyclic",
    "identify_free_vibration",
    "identify_shaking_table",
    "read_suite",
    "read_table",
    "run",
    "spectrum",
    "study",
]

__version__: str

@final
class Model:
    """A checked model: block, slider, storeys, perhaps its own motion and the method."""

    def __new__(cls, values: dict[str, Any]) -> Model: ...
    @staticmethod
    def read(path: str | PathLike[str]) -> Model: ...
    @staticmethod
    def from_toml(text: str, source: str = "model.toml") -> Model: ...
    def with_(self, values: dict[str, Any]) -> Model: ...
    def value(self, path: str) -> float | None: ...
    def to_opensees(self, motion: Motion, k_init: str) -> str: ...
    @property
    def toml(self) -> str: ...
    @property
    def name(self) -> str | None: ...
    @property
    def storeys(self) -> int: ...
    @property
    def values(self) -> dict[str, str]: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class Motion:
    """A ground motion, linear between its samples."""

    def __new__(
        cls,
        acceleration: ArrayLike,
        *,
        dt: float | str | None = None,
        times_s: ArrayLike | None = None,
        units: str,
        vertical: ArrayLike | None = None,
    ) -> Motion: ...
    @staticmethod
    def read(
        path: str | PathLike[str],
        *,
        channel: str | None = None,
        units: str | None = None,
        dt: float | str | None = None,
        vertical: str | PathLike[str] | None = None,
    ) -> Motion: ...
    @staticmethod
    def from_obspy(trace: Any, *, units: str) -> Motion: ...
    @staticmethod
    def from_eqsig(signal: Any, *, units: str = "m/s2") -> Motion: ...
    def scaled(self, factor: float | None = None, *, pga: str | None = None) -> Motion: ...
    @property
    def time_s(self) -> NDArray[np.float64]: ...
    @property
    def acceleration_m_per_s2(self) -> NDArray[np.float64]: ...
    @property
    def vertical_m_per_s2(self) -> NDArray[np.float64] | None: ...
    @property
    def dt_s(self) -> float | None: ...
    @property
    def duration_s(self) -> float: ...
    @property
    def pga_m_per_s2(self) -> float: ...
    @property
    def description(self) -> str: ...
    @property
    def warnings(self) -> list[tuple[str, str]]: ...
    def __len__(self) -> int: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __reduce__(self) -> tuple[Any, ...]: ...
    @staticmethod
    def _from_parts(
        times_s: NDArray[np.float64],
        horizontal: NDArray[np.float64],
        vertical: NDArray[np.float64] | None,
        description: list[str],
        warnings: list[tuple[str, float | None, str]],
    ) -> Motion: ...

@final
class Response:
    """What came of one analysis."""

    @property
    def name(self) -> str: ...
    @property
    def holds(self) -> bool | None: ...
    def _took_s(self) -> float: ...
    def _summary_json(self) -> str: ...
    def _history(self, knots: bool) -> dict[str, NDArray[np.float64]]: ...
    def _modes(self) -> NDArray[np.float64]: ...
    def _friction_limits(self) -> list[list[float]]: ...
    def _slider_force(self) -> NDArray[np.float64]: ...
    @property
    def motion(self) -> Motion: ...
    def _energy(self) -> dict[str, NDArray[np.float64]]: ...
    def _events(self) -> list[tuple[float, str, float, float, str]]: ...
    def _report_html(self, units: str) -> str: ...

@final
class Table:
    """Named columns of equal length; pandas, Polars, DuckDB and PyArrow take it as it is."""

    @property
    def columns(self) -> list[str]: ...
    @property
    def units(self) -> dict[str, str]: ...
    def to_csv(self) -> str: ...
    def __len__(self) -> int: ...
    def __getitem__(self, name: str, /) -> Any: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __reduce__(self) -> tuple[Any, ...]: ...
    @staticmethod
    def _from_columns(columns: list[tuple[str, str, str, Any]]) -> Table: ...
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...

@final
class Study:
    """What came of a study."""

    @property
    def table(self) -> Table | None: ...
    @property
    def summary(self) -> Table | None: ...
    @property
    def runs(self) -> int: ...
    @property
    def failures(self) -> int: ...
    @property
    def notices(self) -> list[str]: ...

def run(
    model: Model, motion: Motion | None = None, *, floor_spectra: bool = False
) -> Response: ...
def study(
    plan: str | PathLike[str] | Path,
    folder: str | PathLike[str] | Path,
    *,
    shard: tuple[int, int] | None = None,
    jobs: int | None = None,
    progress: Callable[[int, int], object] | None = None,
    force: bool = False,
) -> Study: ...

@final
class Assessment:
    """A result as people and programs read it."""

    @property
    def tables(self) -> dict[str, Table]: ...
    def _figures(self) -> list[tuple[str, str]]: ...
    @property
    def text(self) -> str: ...
    def _summary_json(self) -> str: ...
    def _report_html(self) -> str: ...

def read_suite(
    patterns: list[str],
    *,
    channel: str | None = None,
    units: str | None = None,
    dt_s: float | None = None,
    vertical: list[str] = ...,
) -> list[tuple[str, Motion]]: ...
def read_table(files: list[Path]) -> Table: ...
def spectrum(
    model: Model,
    records: list[tuple[str, Motion]],
    over: str,
    *,
    vary: list[str] = ...,
    friction: str | None = None,
    measure: str = "PGA",
    level: str | None = None,
    demands: list[str] = ...,
    bounds: str = "all",
    jobs: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Assessment: ...
def ida(
    model: Model,
    records: list[tuple[str, Motion]],
    *,
    levels: str | None = None,
    between: str | None = None,
    measure: str = "PGA",
    demand: str = "peak_sliding_displacement_m",
    limit: str | None = None,
    vary: list[str] = ...,
    keep: list[str] = ...,
    by: str | None = None,
    bounds: str = "all",
    jobs: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Assessment: ...
def fragility(
    table: Table,
    *,
    demand: str = "peak_sliding_displacement_m",
    limit: str | None = None,
    measure: str | None = None,
    units: str | None = None,
    fit_to: str | None = None,
    keep: list[str] = ...,
    confidence: float = 0.9,
    bootstrap: tuple[int, int] | None = None,
    jobs: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Assessment: ...
def design(
    model: Model,
    records: list[tuple[str, Motion]],
    vary: list[str],
    *,
    friction: str | None = None,
    gap: str | None = None,
    probability: float = 0.9,
    demand: str | None = None,
    share: float = 0.5,
    measure: str = "PGA",
    level: str | None = None,
    bounds: tuple[float, float] | None = None,
    sensitivity: int = 256,
    seed: int = 1,
    confidence: float = 0.9,
    jobs: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Assessment: ...

_Given = str | PathLike[str] | list[tuple[str, NDArray[np.float64]]]

@final
class Comparison:
    """A prediction beside what was measured."""

    @property
    def motion(self) -> Motion: ...
    @property
    def holds(self) -> bool: ...
    @property
    def verdict(self) -> list[str]: ...
    @property
    def tables(self) -> dict[str, Table]: ...
    @property
    def curves(self) -> dict[str, Table]: ...
    def _figures(self) -> list[tuple[str, str]]: ...
    def _text(self, units: str) -> str: ...
    def _summary_json(self) -> str: ...
    def _report_html(self, units: str) -> str: ...

@final
class Identified:
    """Parameters from tests."""

    @property
    def model(self) -> Model | None: ...
    @property
    def holds(self) -> bool: ...
    @property
    def verdict(self) -> list[str]: ...
    @property
    def tables(self) -> dict[str, Table]: ...
    @property
    def curves(self) -> dict[str, Table]: ...
    def _estimates(
        self,
    ) -> list[tuple[str, str, float | None, float | None, float | None, str | None]]: ...
    def _figures(self) -> list[tuple[str, str]]: ...
    def _text(self, units: str) -> str: ...
    def _summary_json(self) -> str: ...
    def _report_html(self, units: str) -> str: ...

def compare_with(
    measured: _Given,
    model: Model,
    *,
    mapping_file: Path | None = None,
    mapping: list[str] = ...,
    within: list[str] = ...,
) -> Comparison: ...
def identify_cyclic(
    tests: list[_Given],
    *,
    mass: str | None = None,
    normal_force: str | None = None,
    model: Model | None = None,
    spring: bool = True,
    damper: bool = True,
    slack: str | None = None,
    law: str = "coulomb",
    mapping_file: Path | None = None,
    mapping: list[str] = ...,
) -> Identified: ...
def identify_free_vibration(
    measured: _Given,
    *,
    channel: str | None = None,
    start: str | None = None,
    end: str | None = None,
    model: Model | None = None,
    mapping_file: Path | None = None,
    mapping: list[str] = ...,
) -> Identified: ...
def identify_shaking_table(
    measured: _Given,
    model: Model,
    fit: list[str],
    *,
    using: list[str] = ...,
    seed: int = 1,
    mapping_file: Path | None = None,
    mapping: list[str] = ...,
    progress: Callable[[int, int], object] | None = None,
) -> Identified: ...
