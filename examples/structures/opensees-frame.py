"""A frame of four floors with a setback and eccentric masses: its modes as OpenSees reports them.

Writes opensees-modal.txt, the report of modalProperties, and opensees-eigenvectors.csv. Units: kN, m, t, s.
"""

import openseespy.opensees as ops

FLOORS = [(12.0, 8.0), (12.0, 8.0), (6.0, 8.0), (6.0, 8.0)]  # plan of each floor in m
HEIGHT, MODES = 3.2, 8

ops.wipe()
ops.model("basic", "-ndm", 3, "-ndf", 6)
ops.geomTransf("Linear", 1, 1.0, 0.0, 0.0)
ops.geomTransf("Linear", 2, 0.0, 0.0, 1.0)
E, G = 30e6, 12.5e6
corners = [(0.0, 0.0), (6.0, 0.0), (12.0, 0.0), (0.0, 8.0), (6.0, 8.0), (12.0, 8.0)]
element = 0
for level in range(len(FLOORS) + 1):
    width = 12.0 if level == 0 else FLOORS[level - 1][0]
    for i, (x, y) in enumerate(corners):
        if x > width:
            continue
        node = 10 * level + i + 1
        ops.node(node, x, y, HEIGHT * level)
        if level == 0:
            ops.fix(node, 1, 1, 1, 1, 1, 1)
            continue
        ops.mass(node, 0.6, 0.6, 0.6, 0.0, 0.0, 0.0)
        element += 1
        size = 0.45 if i else 0.6
        ops.element("elasticBeamColumn", element, node - 10, node, size**2, E, G, 0.14 * size**4,
                    size**4 / 12, size**4 / 12, 1)
    if level == 0:
        continue
    present = [i for i, (x, _) in enumerate(corners) if x <= width]
    for a, b in [(0, 1), (1, 2), (3, 4), (4, 5), (0, 3), (1, 4), (2, 5)]:
        if a in present and b in present:
            element += 1
            ops.element("elasticBeamColumn", element, 10 * level + a + 1, 10 * level + b + 1, 0.18, E, G,
                        4e-3, 1.35e-3, 5.4e-3, 2)
    centre = 10 * level
    ops.node(centre, 0.55 * width, 3.4, HEIGHT * level)  # 5 % and 7 % off the middle
    ops.fix(centre, 0, 0, 1, 1, 1, 0)
    mass = 0.8 * width * 8.0
    ops.mass(centre, mass, mass, 0.0, 0.0, 0.0, mass * (width**2 + 8.0**2) / 12)
    ops.rigidDiaphragm(3, centre, *[10 * level + i + 1 for i in present])

ops.constraints("Transformation")
ops.eigen(MODES)
ops.modalProperties("-file", "opensees-modal.txt")
with open("opensees-eigenvectors.csv", "w") as out:
    out.write("mode,node,ux,uy\n")
    for node in [10, 20, 30, 40, 41]:
        for mode in range(1, MODES + 1):
            ux, uy = ops.nodeEigenvector(node, mode)[:2]
            out.write(f"{mode},{node},{ux!r},{uy!r}\n")
