

def load(series, share):
    """Loads that press block and contents on what they stand on, times a series."""
    ops.pattern("Plain", series, series)
    for tag, pressed in PRESSED:
        force = [0.0] * NDF
        force[NDM - 1] = -share * pressed
        ops.load(tag, *force)


def weigh():
    """The weight, then what the vertical motion adds to it; masses have no vertical inertia of their own."""
    ops.timeSeries("Linear", 2)
    load(2, GRAVITY)
    ops.test("NormDispIncr", 1e-12, 50)
    ops.integrator("LoadControl", 1.0)
    ops.analysis("Static")
    if ops.analyze(1) != 0:
        raise ArithmeticError("no convergence under the weight")
    ops.loadConst("-time", 0.0)
    ops.wipeAnalysis()
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.algorithm("Newton")
    if VERTICAL:
        ops.timeSeries("Path", 3, "-time", *TIMES, "-values", *VERTICAL, "-useLast")
        load(3, 1.0)
