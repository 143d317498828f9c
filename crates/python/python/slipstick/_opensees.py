"""The modes of a model that stands in OpenSees, as the table ``[structure]`` of a model file."""

from __future__ import annotations

import json
import math
from typing import Any

__all__ = ["structure"]

#: Direction: its place in the eigenvector of a node, and its key in the modal properties
DIRECTIONS = {"x": (0, "MX"), "y": (1, "MY")}


def structure(
    ops: Any,
    unit_kg: float,
    nodes: dict[str, int],
    damping_ratio: float,
    modes: int | None,
    direction: str,
) -> str:
    """TOML of participations and shapes, of unit modal mass.

    With ``G = f' M 1/f' M f`` and ``m = (f' M 1)^2/f' M f`` of OpenSees: ``L = sgn G sqrt m``, and the shape is
    ``f/sqrt(f' M f)`` with ``sqrt(f' M f) = sqrt m/|G|``.
    """
    place, axis = DIRECTIONS[direction]
    if modes is not None:
        ops.eigen(modes)
    properties = ops.modalProperties("-return")
    directions = [key.removeprefix("partiFactor") for key in properties if key.startswith("partiFactor")]
    root_unit = math.sqrt(unit_kg)
    periods = properties["eigenPeriod"]
    roots = [_root_of_modal_mass(properties, directions, mode) for mode in range(len(periods))]
    lines = ["[structure]", f'mass = "{properties["totalFreeMass"][place] * unit_kg!r} kg"']
    for mode, period in enumerate(periods):
        mass = properties[f"partiMass{axis}"][mode]
        participation = math.copysign(math.sqrt(mass), properties[f"partiFactor{axis}"][mode])
        lines += [
            "[[structure.mode]]",
            f'period = "{period!r} s"',
            f"damping_ratio = {damping_ratio!r}",
            f"participation = {participation * root_unit!r}",
        ]
    for name, node in nodes.items():
        shape = [
            ops.nodeEigenvector(node, mode + 1)[place] / (root * root_unit)
            for mode, root in enumerate(roots)
        ]
        lines += ["[[structure.point]]", f"name = {json.dumps(name)}", f"shape = {shape!r}"]
    return "\n".join(lines) + "\n"


def _root_of_modal_mass(properties: dict[str, Any], directions: list[str], mode: int) -> float:
    """``sqrt(f' M f)`` from the direction of the largest mass; 1 of a mode that takes part in none."""
    pairs = [
        (properties[f"partiMass{axis}"][mode], abs(properties[f"partiFactor{axis}"][mode]))
        for axis in directions
    ]
    mass, factor = max(pairs)
    return math.sqrt(mass) / factor if mass > 0.0 and factor > 0.0 else 1.0
