

def contents(tag, k_init):
    """Masses on the floors, on flat sliders whose friction follows the vertical motion."""
    for i, (floor, mass, friction) in enumerate(CONTENTS):
        own = 2 + len(MASSES) + i
        node(own, mass, 1, NDM)
        ops.frictionModel("Coulomb", tag + i, friction)
        ops.uniaxialMaterial("Elastic", tag + i, mass * GRAVITY / 1e-3)
        bearing = "flatSliderBearing", tag + i, 2 + floor, own, tag + i, k_init
        ops.element(*bearing, "-P", tag + i, "-Mz", 3, "-orient", 0, 1, 0, -1, 0, 0,
                    "-iter", 100, 1e-13 * mass * GRAVITY)
