"""pySLAMMER on a rigid block. It slides one way, down a slope, with one coefficient: a run for each way.

Their difference is two-way sliding as long as the block stops before it turns.
"""

import numpy as np
import pyslammer

import cases


def fits(case):
    """Whether pySLAMMER has the model: a rigid block, one coefficient, no spring."""
    return case.rigid and case.spring == 0.0 and case.mu_static == case.mu_kinetic


def run(case):
    """Sliding displacement at the record's samples in m."""
    g = pyslammer.constants.G_EARTH
    motion = pyslammer.GroundMotion(case.ground / g, case.dt, case.name)
    yield_g = case.mu_kinetic * cases.GRAVITY / g
    ways = [pyslammer.RigidAnalysis(yield_g, motion, inverse=inverse) for inverse in (True, False)]
    positive, negative = (np.asarray(way.sliding_disp) for way in ways)
    return positive - negative
