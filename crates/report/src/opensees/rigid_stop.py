

def stops(tag, k_init):
    """OpenSees has no rigid stop: springs as stiff as that of stick, with the damper of the restitution."""
    damper = 2.0 * STOP_DAMPING * (k_init * MASSES[0]) ** 0.5
    for i, (side, gap) in enumerate(STOPS):
        ends = (2, 1) if side > 0 else (1, 2)
        between(tag + i, *ends, "ViscoelasticGap", k_init, damper, -gap)
