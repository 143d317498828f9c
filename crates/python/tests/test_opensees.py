"""Structures taken from OpenSees."""

from importlib.util import find_spec

import pytest
from support import pulse

import slipstick as ss

needs_opensees = pytest.mark.skipif(
    find_spec("openseespy") is None, reason="openseespy is not installed"
)

BASE = {
    "block.mass": "300 t",
    "slider.static_friction": 0.06,
    "slider.kinetic_friction": 0.05,
    "slider.radius": "2.5 m",
}
MASSES_T = (420.0, 400.0, 380.0)
STIFFNESSES_KN_PER_M = (9e5, 8e5, 7e5)


def shear_frame(axis: int):
    """Springs from floor to floor along x (1) or y (2), in kN, m and t."""
    import openseespy.opensees as ops

    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 3)
    ops.node(1, 0.0, 0.0, 0.0)
    ops.fix(1, 1, 1, 1)
    free = [0 if direction == axis else 1 for direction in (1, 2, 3)]
    floors = zip(MASSES_T, STIFFNESSES_KN_PER_M, strict=True)
    for floor, (mass, stiffness) in enumerate(floors, start=1):
        ops.node(floor + 1, 0.0, 0.0, 0.0)
        ops.fix(floor + 1, *free)
        ops.mass(floor + 1, mass, mass, mass)
        ops.uniaxialMaterial("Elastic", floor, stiffness)
        ops.element("zeroLength", floor, floor, floor + 1, "-mat", floor, "-dir", axis)
    ops.eigen("-fullGenLapack", 3)
    return ops


@needs_opensees
@pytest.mark.parametrize(("direction", "axis"), [("x", 1), ("y", 2)])
def test_opensees_shear_frame_is_ours(direction, axis):
    ops = shear_frame(axis)
    model = ss.Model.from_opensees(
        ops,
        BASE,
        mass_unit="1 t",
        nodes={"First": 2, "Roof": 4},
        damping_ratio=0.03,
        direction=direction,
    )
    storeys = {}
    floors = zip(MASSES_T, STIFFNESSES_KN_PER_M, strict=True)
    for i, (mass, stiffness) in enumerate(floors, start=1):
        storeys |= {
            f"storey.{i}.mass": f"{mass} t",
            f"storey.{i}.stiffness": f"{stiffness} kN/m",
            f"storey.{i}.damping_ratio": 0.03,
        }
    ours = ss.run(ss.Model(BASE | storeys), pulse()).summary
    theirs = ss.run(model, pulse()).summary
    # The eigenvalues of LAPACK are good to some 1e-13.
    for key in ("peak_sliding_displacement_m", "residual_sliding_displacement_m"):
        assert theirs[key] == pytest.approx(ours[key], rel=1e-10)
    roof, top = theirs["points"][1], ours["storeys"][2]
    assert roof["name"] == "Roof"
    for key in ("peak_acceleration_m_per_s2", "peak_displacement_m"):
        assert roof[key] == pytest.approx(top[key], rel=1e-9)


class Fixed:
    """Two modes as OpenSees says them: of modal masses 4 and 1."""

    calls = 0

    def eigen(self, modes):
        self.calls += modes

    def modalProperties(self, *_):
        return {
            "eigenPeriod": [0.5, 0.2],
            "totalFreeMass": [3.0, 3.0, 0.0],
            "partiFactorMX": [0.75, -0.5],
            "partiMassMX": [2.25, 0.25],
            "partiFactorMY": [0.0, 0.0],
            "partiMassMY": [0.0, 0.0],
        }

    def nodeEigenvector(self, _node, mode):
        return [[2.0, 0.0, 0.0], [-0.5, 0.0, 0.0]][mode - 1]


def test_shapes_of_unit_modal_mass():
    ops = Fixed()
    asked = {"mass_unit": "100 kg", "nodes": {"Top": 7}, "damping_ratio": 0.02}
    model = ss.Model.from_opensees(ops, BASE, modes=2, **asked)
    assert ops.calls == 2
    assert model.value("structure.mass") == 300.0
    assert model.value("structure.mode.1.participation") == 15.0
    assert model.value("structure.mode.2.participation") == -5.0
    assert model.value("structure.point.1.shape.1") == pytest.approx(2.0 / 2.0 / 10.0)
    with pytest.raises(ss.InputError, match='expected "x" or "y"'):
        ss.Model.from_opensees(ops, BASE, direction="z", **asked)
    with pytest.raises(ss.InputError, match="mass_unit"):
        ss.Model.from_opensees(ops, BASE, **(asked | {"mass_unit": "t"}))
