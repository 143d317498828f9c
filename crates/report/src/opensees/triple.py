

def slider(k_init):
    """Two or three pendulums in series; the first to slide yields at k_init."""
    for i, coefficient in enumerate(FRICTION):
        ops.frictionModel("Coulomb", 1 + i, coefficient)
    ops.uniaxialMaterial("Elastic", 2, WEIGHT / 1e-3)
    ops.uniaxialMaterial("Elastic", 3, 1.0)
    element = "TripleFrictionPendulum", 1, 1, 2, 1, 2, 3, 2, 3, 3, 3
    yield_m = FRICTION[0] * WEIGHT / k_init
    ops.element(*element, *LENGTHS, *TRAVELS, WEIGHT, yield_m, WEIGHT / 1e-3, 1e-6 * WEIGHT, 1e-9)
