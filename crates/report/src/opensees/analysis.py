

def node(tag, mass, *free):
    """A node that moves in the given directions, counted from 1."""
    ops.node(tag, *[0.0] * NDM)
    ops.fix(tag, *[0 if i in free else 1 for i in range(1, NDF + 1)])
    if mass:
        ops.mass(tag, mass, *[0.0] * (NDF - 1))


def between(tag, below, above, *material):
    """A uniaxial material along x between two nodes; both have the tag."""
    ops.uniaxialMaterial(material[0], tag, *material[1:])
    ops.element("zeroLength", tag, below, above, "-mat", tag, "-dir", 1)


def build(k_init=K_INIT):
    """The model: node 1 the ground, node 2 the block, then the floors, then the contents."""
    ops.wipe()
    ops.model("basic", "-ndm", NDM, "-ndf", NDF)
    node(1, 0.0)
    for i, mass in enumerate(MASSES):
        node(i + 2, mass, *([1, NDM] if i == 0 else [1]))
    slider(k_init)
    tag = 10
    between(tag, 1, 2, "Elastic", SPRING, DAMPER)
    for i, stiffness in enumerate(STOREYS):
        between(tag := tag + 1, 2 + i, 3 + i, "Elastic", stiffness)
    for i, j, damper in DASHPOTS:
        between(tag := tag + 1, 2 + i, 2 + j, "Elastic", 0.0, damper)
    for part, first in zip(PARTS, (1000, 2000)):
        part(first, k_init)
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.algorithm("Newton")
    weigh()
    ops.test("NormDispIncr", TOLERANCE, 50)
    ops.timeSeries("Path", 1, "-time", *TIMES, "-values", *ACCELERATION, "-useLast")
    ops.pattern("UniformExcitation", 1, 1, "-accel", 1)
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
    """Times in s and sliding displacements in m, with so many steps a sample."""
    build(k_init)
    sliding = [0.0]
    for start, end in zip(TIMES, TIMES[1:]):
        for _ in range(parts):
            if not step((end - start) / parts):
                ops.wipe()
                raise ArithmeticError(f"no convergence at {end:.3f} s")
        sliding.append(ops.nodeDisp(2, 1))
    ops.wipe()
    return TIMES, sliding


if __name__ == "__main__":
    _, s = analyse()
    print(f"peak sliding displacement {max(map(abs, s)):.6g} m, residual {s[-1]:.6g} m")
