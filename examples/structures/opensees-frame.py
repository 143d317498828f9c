"""A frame of four floors with a setback and eccentric masses: its modes as OpenSees reports them.

Writes opensees-modal.txt, the report of modalProperties, and opensees-eigenvectors.csv. Units: kN, m, t, s.
"""

import openseespy.opensees as ops

FLOORS = [(12.0, 8.0), (12.0, 8.0), (6.0, 8.0), (6.0, 8.0)]  # plan of each floor in m
HEIGHT = 3.2
CORNERS = [(0.0, 0.0), (6.0, 0.0), (12.0, 0.0), (0.0, 8.0), (6.0, 8.0), (12.0, 8.0)]
YOUNG, SHEAR = 30e6, 12.5e6


def frame(corner_mass=0.6, slab=None):
    """Nodes 10, 20, 30, 40 are the centres of mass of the floors; the feet are fixed, or go with the node `slab`."""
    ops.geomTransf("Linear", 1, 1.0, 0.0, 0.0)
    ops.geomTransf("Linear", 2, 0.0, 0.0, 1.0)
    element = 0
    for level in range(len(FLOORS) + 1):
        width = FLOORS[max(level - 1, 0)][0]
        present = [i for i, (x, _) in enumerate(CORNERS) if x <= width]
        for i in present:
            node = 10 * level + i + 1
            ops.node(node, *CORNERS[i], HEIGHT * level)
            if level == 0 and slab is None:
                ops.fix(node, 1, 1, 1, 1, 1, 1)
            elif level == 0:
                ops.fix(node, 0, 0, 1, 1, 1, 1)
                ops.equalDOF(slab, node, 1, 2)
            else:
                if corner_mass > 0.0:
                    ops.mass(node, *[corner_mass] * 3, 0.0, 0.0, 0.0)
                element += 1
                size = 0.45 if i else 0.6
                ops.element("elasticBeamColumn", element, node - 10, node, size**2, YOUNG, SHEAR,
                            0.14 * size**4, size**4 / 12, size**4 / 12, 1)
        if level == 0:
            continue
        for a, b in [(0, 1), (1, 2), (3, 4), (4, 5), (0, 3), (1, 4), (2, 5)]:
            if a in present and b in present:
                element += 1
                ops.element("elasticBeamColumn", element, 10 * level + a + 1, 10 * level + b + 1, 0.18,
                            YOUNG, SHEAR, 4e-3, 1.35e-3, 5.4e-3, 2)
        centre = 10 * level
        ops.node(centre, 0.55 * width, 3.4, HEIGHT * level)  # 5 % and 7 % off the middle
        ops.fix(centre, 0, 0, 1, 1, 1, 0)
        mass = 0.8 * width * 8.0
        ops.mass(centre, mass, mass, 0.0, 0.0, 0.0, mass * (width**2 + 8.0**2) / 12)
        ops.rigidDiaphragm(3, centre, *[10 * level + i + 1 for i in present])


def write_modes(count, nodes, *solver):
    """The report and the eigenvectors at nodes, of the model that stands in memory on a fixed base."""
    ops.constraints("Transformation")
    ops.eigen(*solver, count)
    ops.modalProperties("-file", "opensees-modal.txt")
    with open("opensees-eigenvectors.csv", "w") as out:
        out.write("mode,node,ux,uy\n")
        for node in nodes:
            for mode in range(1, count + 1):
                ux, uy = ops.nodeEigenvector(node, mode)[:2]
                out.write(f"{mode},{node},{ux!r},{uy!r}\n")


if __name__ == "__main__":
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    frame()
    write_modes(8, [10, 20, 30, 40, 41])
