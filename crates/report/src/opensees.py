

def build(k_init=K_INIT):
    """The model: node 1 the ground, node 2 the block, then the floors."""
    ops.wipe()
    ops.model("basic", "-ndm", 1, "-ndf", 1)
    ops.node(1, 0.0)
    ops.fix(1, 1)
    for i, mass in enumerate(MASSES):
        ops.node(i + 2, 0.0)
        ops.mass(i + 2, mass)
    ops.uniaxialMaterial("ElasticPP", 1, k_init, FRICTION[0] / k_init, -FRICTION[1] / k_init)
    ops.uniaxialMaterial("Elastic", 2, SPRING, DAMPER)
    ops.element("zeroLength", 1, 1, 2, "-mat", 1, 2, "-dir", 1, 1)
    for i, stiffness in enumerate(STOREYS):
        ops.uniaxialMaterial("Elastic", 3 + i, stiffness)
        ops.element("zeroLength", 2 + i, 2 + i, 3 + i, "-mat", 3 + i, "-dir", 1)
    tag = 3 + len(STOREYS)
    for i, j, damper in DASHPOTS:
        ops.uniaxialMaterial("Elastic", tag, 0.0, damper)
        ops.element("zeroLength", tag, 2 + i, 2 + j, "-mat", tag, "-dir", 1)
        tag += 1
    ops.timeSeries("Path", 1, "-time", *TIMES, "-values", *ACCELERATION, "-useLast")
    ops.pattern("UniformExcitation", 1, 1, "-accel", 1)
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.test("NormDispIncr", 1e-11, 50)
    ops.algorithm("Newton")
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
