"""The matrices of an eigenvalue analysis as keys of the table ``[structure]`` of a model."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._request import several, wrong

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["structure"]


def structure(phi: Any, omega: Any, damping: Any, mass: Any, points: Any, influence: Any) -> dict[str, str]:
    """Values by the paths of their keys, of arrays of any kind; a list of masses stands on a diagonal."""
    shapes = _numbers("phi", phi, 2, "a matrix, a row a degree of freedom and a column a mode")
    freedoms, modes = shapes.shape
    expected = f"masses in kg: {freedoms} of them, or a symmetric matrix of {freedoms} × {freedoms}"
    masses = _numbers("mass", mass, 2 if np.ndim(mass) == 2 else 1, expected)
    rates = _numbers("omega", omega, 1, "circular frequencies in rad/s, one a mode")
    ratios = _numbers("damping", damping if several(damping) else [damping] * modes, 1, "damping ratios, one a mode")
    if influence is None:
        influence = np.ones(freedoms)
    moved = _numbers("influence", influence, 1, "a number a degree of freedom")
    mass_kg = np.diag(masses) if masses.ndim == 1 else masses
    return dict(
        _core.keys_of_modes(
            shapes.tolist(), rates.tolist(), ratios.tolist(), mass_kg.tolist(), moved.tolist(), _places(points, freedoms)
        )
    )


def _places(points: Any, freedoms: int) -> list[tuple[str, int]]:
    """Degrees of freedom by names; all of them where nothing is said."""
    if points is None:
        return [(f"DOF {i + 1}", i) for i in range(freedoms)]
    if not isinstance(points, Mapping):
        raise wrong("points", 'degrees of freedom by names, {"Roof": 9}', _core.described(points))
    for name, place in points.items():
        if not isinstance(name, str):
            raise wrong("points", "names that are text", _core.described(name))
        if not hasattr(place, "__index__") or place < 0:
            raise wrong("points", f"rows of phi, from 0 to {freedoms - 1}", f"{name!r}: {place}")
    return [(name, int(place)) for name, place in points.items()]


def _numbers(name: str, given: Any, dimensions: int, expected: str) -> NDArray[np.float64]:
    if np.ma.isMaskedArray(given):
        raise wrong(name, expected, "an array with a mask")
    try:
        array = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        raise wrong(name, expected, _core.described(given)) from None
    if array.ndim != dimensions or not array.size:
        raise wrong(name, expected, f"an array of shape {array.shape}")
    if not np.isfinite(array).all():
        raise wrong(name, "finite numbers", "NaN or an infinite one")
    return array
