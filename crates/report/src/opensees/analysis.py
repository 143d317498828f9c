

def node(tag, mass, *free):
    """A node that moves in the given directions, counted from 1."""
    ops.node(tag, *[0.0] * NDM)
    ops.fix(tag, *[0 if i in free else 1 for i in range(1, NDF + 1)])
    if mass:
        ops.mass(tag, *[mass if i in HORIZONTAL else 0.0 for i in range(1, NDF + 1)])


def between(tag, below, above, *material, along=1):
    """A uniaxial material along x, or another direction, between two nodes; both have the tag."""
    ops.uniaxialMaterial(material[0], tag, *material[1:])
    ops.element("zeroLength", tag, below, above, "-mat", tag, "-dir", along)


def build(k_init=K_INIT):
    """The model: node 1 the ground, node 2 the block, then the floors, then the contents."""
    ops.wipe()
    ops.model("basic", "-ndm", NDM, "-ndf", NDF)
    node(1, 0.0)
    for i, mass in enumerate(MASSES):
        node(i + 2, mass, *([*HORIZONTAL, NDM] if i == 0 else HORIZONTAL))
    slider(k_init)
    tag = 10
    for along, storeys, dashpots in zip(HORIZONTAL, STOREYS, DASHPOTS):
        between(tag := tag + 1, 1, 2, "Elastic", SPRING, DAMPER, along=along)
        for i, stiffness in enumerate(storeys):
            between(tag := tag + 1, 2 + i, 3 + i, "Elastic", stiffness, along=along)
        for i, j, damper in dashpots:
            between(tag := tag + 1, 2 + i, 2 + j, "Elastic", 0.0, damper, along=along)
    for part, first in zip(PARTS, (1000, 2000)):
        part(first, k_init)
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.algorithm("Newton")
    weigh()
    ops.test("NormDispIncr", TOLERANCE, 50)
    for along, acceleration in zip(HORIZONTAL, ACCELERATION):
        ops.timeSeries("Path", 10 + along, "-time", *TIMES, "-values", *acceleration, "-useLast")
        ops.pattern("UniformExcitation", 10 + along, along, "-accel", 10 + along)
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")


def step(dt):
    """One step; where it does not converge another algorithm, then smaller steps."""
    if ops.analyze(1, dt) == 0:
        return True
    ops.algorithm("KrylovNewton")
    done = ops.analyze(1, dt) == 0 or all(ops.analyze(1, dt / 20) == 0 for _ in range(20))
    ops.algorithm("Newton")
    return done


def analyse(k_init=K_INIT, parts=1):
    """Times in s and sliding displacements in m (in two directions pairs), with so many steps a sample."""
    build(k_init)
    place = lambda: [ops.nodeDisp(2, along) for along in HORIZONTAL]
    sliding = [place()]
    for start, end in zip(TIMES, TIMES[1:]):
        for _ in range(parts):
            if not step((end - start) / parts):
                ops.wipe()
                raise ArithmeticError(f"no convergence at {end:.3f} s")
        sliding.append(place())
    ops.wipe()
    return TIMES, sliding if len(HORIZONTAL) > 1 else [s for [s] in sliding]


if __name__ == "__main__":
    _, s = analyse()
    size = [abs(complex(*s)) for s in s] if len(HORIZONTAL) > 1 else [abs(s) for s in s]
    print(f"peak sliding displacement {max(size):.6g} m, residual {size[-1]:.6g} m")
