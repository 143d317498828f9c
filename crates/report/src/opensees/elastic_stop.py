

def stops(tag, k_init):
    """Springs behind gaps, towards +x or -x."""
    for i, (side, gap) in enumerate(STOPS):
        between(tag + i, 1, 2, "ElasticPPGap", STOP, side * 1e9 * STOP, side * gap)
