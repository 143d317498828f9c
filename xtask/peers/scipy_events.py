"""SciPy as one would use it: `solve_ivp` with terminal events, one call a phase."""

import math

import numpy as np
from scipy.integrate import solve_ivp


def run(case, rtol=1e-6, atol=1e-9):
    """Sliding displacement at the samples, and the peak over samples and phase ends."""
    m1, m2 = case.block_kg, case.floor_kg
    k1, k2, c2 = case.spring, case.storey_spring, case.storey_damper
    h, samples = case.dt, case.ground
    last = len(samples) - 1
    rises = np.diff(samples) / h
    ground, rises = samples.tolist(), rises.tolist()

    def table(t):
        i = min(int(t / h), last - 1)
        return ground[i] + rises[i] * (t - i * h)

    def demand(t, x):
        return m1 * table(t) + k1 * x[0] - k2 * x[2] - c2 * x[3]

    def stuck(t, x):
        relative = 0.0 if m2 == 0.0 else -(k2 * x[2] + c2 * x[3]) / m2 - table(t)
        return 0.0, 0.0, x[3], relative

    def sliding(sign):
        friction = sign * case.kinetic_force

        def rates(t, x):
            block = -(demand(t, x) + friction) / m1
            relative = 0.0 if m2 == 0.0 else -(k2 * x[2] + c2 * x[3]) / m2 - table(t) - block
            return x[1], block, x[3], relative

        return rates

    def crossing(function):
        function.terminal, function.direction = True, -1
        return function

    grid = np.arange(last + 1) * h
    out = np.zeros(last + 1)
    x, t, sign, peak = np.zeros(4), 0.0, 0, 0.0
    if abs(demand(t, x)) > case.static_limit:
        sign = -int(math.copysign(1, demand(t, x)))
    while t < grid[-1]:
        if sign:
            rates, events = sliding(sign), [crossing(lambda t, x: sign * x[1])]
        else:
            limit = case.static_limit
            rates = stuck
            events = [crossing(lambda t, x: limit - demand(t, x)),
                      crossing(lambda t, x: limit + demand(t, x))]
        # Without the cap on the step it jumps over whole stretches of sliding.
        phase = solve_ivp(rates, (t, grid[-1]), x, rtol=rtol, atol=atol, max_step=h,
                          events=events, dense_output=True)
        inside = slice(np.searchsorted(grid, t), np.searchsorted(grid, phase.t[-1], side="right"))
        if inside.stop > inside.start:
            out[inside] = phase.sol(grid[inside])[0]
        x, t = phase.y[:, -1].copy(), phase.t[-1]
        peak = max(peak, abs(x[0]))
        if phase.status != 1:
            break
        x[1] = 0.0
        r = demand(t, x)
        if sign and abs(r) <= case.static_limit:
            sign = 0
        else:
            sign = -int(math.copysign(1, r))
    return out, max(peak, np.abs(out).max())
