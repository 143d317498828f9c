"""A structure from the matrices of an eigenvalue analysis, as the table ``[structure]`` of a model."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._request import several, wrong

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

__all__ = ["structure"]

#: What two shapes may have in common over their modal masses, by rounding of the program that they come from
ORTHOGONAL = 1e-6


def structure(
    phi: Any, omega: Any, damping: Any, mass: Any, points: Mapping[str, int] | None, influence: Any
) -> dict[str, Any]:
    """Periods, participations ``L = f' M r`` and shapes at points, of shapes of unit modal mass ``f' M f``.

    ``r``, the influence, is what each degree of freedom does where the base moves by 1.
    """
    shapes = _numbers("phi", phi, 2, "a matrix, a row a degree of freedom and a column a mode")
    freedoms, modes = shapes.shape
    rates = _of_count("omega", omega, modes, "circular frequencies in rad/s, one a mode")
    if not (rates > 0.0).all():
        raise wrong("omega", "circular frequencies > 0", str(rates.min()))
    ratios = _of_count("damping", damping if several(damping) else [damping] * modes, modes, "damping ratios, one a mode")
    masses = _mass_matrix(mass, freedoms)
    r = np.ones(freedoms) if influence is None else _of_count("influence", influence, freedoms, "a number a degree of freedom")
    common = shapes.T @ masses @ shapes
    modal = np.diag(common)
    if not (modal > 0.0).all():
        raise wrong("mass", "a matrix by which every mode has a mass > 0", f"{modal.min()} kg")
    root = np.sqrt(modal)
    apart = np.abs(common / np.outer(root, root) - np.eye(modes)).max()
    if apart > ORTHOGONAL:
        expected = "shapes that are orthogonal with respect to the masses, a column a mode"
        raise wrong("phi", expected, f"two that have {apart:.3g} of their modal masses in common")
    unit = shapes / root
    shares = unit.T @ masses @ r
    order = np.argsort(rates, kind="stable")
    mode = [
        {"period": f"{float(2.0 * np.pi / rates[j])!r} s", "damping_ratio": float(ratios[j]), "participation": float(shares[j])}
        for j in order
    ]
    wanted = {f"DOF {i + 1}": i for i in range(freedoms)} if points is None else points
    for name, place in wanted.items():
        if not 0 <= place < freedoms:
            raise wrong("points", f"rows of phi, from 0 to {freedoms - 1}", f"{name!r}: {place}")
    point = [{"name": name, "shape": [float(unit[place, j]) for j in order]} for name, place in wanted.items()]
    return {"mass": f"{float(r @ masses @ r)!r} kg", "mode": mode, "point": point}


def _numbers(name: str, given: Any, dimensions: int, expected: str) -> NDArray[np.float64]:
    try:
        array = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError):
        raise wrong(name, expected, type(given).__name__) from None
    if array.ndim != dimensions or not array.size:
        raise wrong(name, expected, f"an array of shape {array.shape}")
    if not np.isfinite(array).all():
        raise wrong(name, "finite numbers", "NaN or an infinite one")
    return array


def _of_count(name: str, given: Any, count: int, expected: str) -> NDArray[np.float64]:
    array = _numbers(name, given, 1, expected)
    if len(array) != count:
        raise wrong(name, f"{expected}, {count} in all", str(len(array)))
    return array


def _mass_matrix(given: Any, freedoms: int) -> NDArray[np.float64]:
    """The mass matrix in kg, of a list of masses with these on its diagonal."""
    expected = f"masses in kg: {freedoms} of them, or a symmetric matrix of {freedoms} × {freedoms}"
    array = _numbers("mass", given, np.ndim(given), expected)
    if array.ndim == 1 and len(array) == freedoms:
        return np.diag(array)
    if array.shape != (freedoms, freedoms) or not np.allclose(array, array.T, rtol=1e-9, atol=0.0):
        raise wrong("mass", expected, f"an array of shape {array.shape}" + (", not symmetric" if array.shape == (freedoms, freedoms) else ""))
    return array
