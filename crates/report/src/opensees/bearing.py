

def slider(k_init):
    """A bearing whose friction, and pendulum if it is one, follow the force of the vertical spring 2."""
    ops.frictionModel(*FRICTION)
    ops.uniaxialMaterial("Elastic", 2, WEIGHT / 1e-3)
    ops.uniaxialMaterial("Elastic", 3, 1.0)
    if NDM == 3:
        turns = "-P", 2, "-T", 3, "-My", 3, "-Mz", 3, "-orient", 0, 0, 1, 1, 0, 0
    else:
        turns = "-P", 2, "-Mz", 3, "-orient", 0, 1, 0, -1, 0, 0
    # The element's own passes end at this force in N, which is above the rounding of the weight.
    ops.element(*BEARING, k_init, *turns, "-iter", 100, 1e-13 * WEIGHT)
