"""The strongest rival we know how to write in Python: an event-exact loop compiled by numba.

Whole samples by propagators; where the end values and slopes of a sample do not exclude an event,
the sample is redone by its Taylor series and the event is a root of that polynomial.
"""

import numpy as np
from numba import njit
from scipy.linalg import expm

ORDER = 12


def prepare(case):
    """Arguments of `loop`: the samples, the step, rates over the block's mass, propagators."""
    m1 = case.block_kg
    k1, k2, c2 = case.spring / m1, case.storey_spring / m1, case.storey_damper / m1
    kr = cr = on = 0.0
    if not case.rigid:
        kr, cr, on = case.storey_spring / case.floor_kg, case.storey_damper / case.floor_kg, 1.0
    rates = (k1, k2, c2, kr, cr, on, case.static_limit / m1, case.kinetic_force / m1)
    # State: s, w = s', y, v = y'; inputs: ground at both ends of the sample, friction.
    free_floor = [0, 0, -on * kr, -on * cr]
    sliding_floor = [on * k1, 0, -on * (kr + k2), -on * (cr + c2)]
    slip = np.array([[0, 1, 0, 0], [-k1, 0, k2, c2], [0, 0, 0, on], sliding_floor])
    stick = np.array([[0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, on], free_floor])
    slip_table = propagator(slip, [0, -1, 0, 0], [0, -1, 0, on], case.dt)
    stick_table = propagator(stick, [0, 0, 0, -on], [0, 0, 0, 0], case.dt)
    return case.ground, case.dt, rates, slip_table, stick_table


def propagator(matrix, by_ground, by_friction, h):
    """Columns for s, w, y, v, ground at the start, ground at the end, friction."""
    whole = np.zeros((7, 7))
    whole[:4, :4], whole[:4, 4], whole[:4, 6] = matrix, by_ground, by_friction
    whole[4, 5] = 1.0
    e = expm(whole * h)[:4]
    e[:, 4], e[:, 5] = e[:, 4] - e[:, 5] / h, e[:, 5] / h
    return e


@njit
def value(c, t):
    total = c[ORDER]
    for k in range(ORDER - 1, -1, -1):
        total = total * t + c[k]
    return total


@njit
def slope(c, t):
    total = ORDER * c[ORDER]
    for k in range(ORDER - 1, 0, -1):
        total = total * t + k * c[k]
    return total


@njit
def curvature(c, t):
    total = ORDER * (ORDER - 1) * c[ORDER]
    for k in range(ORDER - 1, 1, -1):
        total = total * t + k * (k - 1) * c[k]
    return total


@njit
def root_between(c, low, at_low, high, at_high):
    """Newton's steps from the chord's root, kept inside a bracket with c(low) >= 0 > c(high)."""
    t = low + (high - low) * at_low / (at_low - at_high)
    for _ in range(80):
        g, d = c[ORDER], 0.0
        for k in range(ORDER - 1, -1, -1):
            d = d * t + g
            g = g * t + c[k]
        if g >= 0.0:
            low = t
        else:
            high = t
        nearer = t - g / d if d != 0.0 else low
        if abs(nearer - t) <= 1e-16:
            return nearer
        t = nearer if low < nearer < high else 0.5 * (low + high)
    return t


@njit
def lowest_between(c, low, high):
    """Where a polynomial that falls at `low` and rises at `high` is lowest."""
    t = 0.5 * (low + high)
    for _ in range(80):
        d = slope(c, t)
        if d < 0.0:
            low = t
        else:
            high = t
        bend = curvature(c, t)
        nearer = t - d / bend if bend != 0.0 else low
        if not (low < nearer < high):
            nearer = 0.5 * (low + high)
        if abs(nearer - t) <= 1e-15:
            return nearer
        t = nearer
    return t


@njit
def first_below_zero(c, h):
    """First time in (0, h] at which a polynomial, not negative at 0, falls below zero; else -1."""
    low, at_low, falls = 0.0, c[0], c[1] < 0.0
    for half in range(1, 3):
        high = 0.5 * h * half
        at_high = value(c, high)
        if at_high < 0.0:
            return root_between(c, low, at_low, high, at_high)
        rises = slope(c, high) > 0.0
        if falls and rises:
            dip = lowest_between(c, low, high)
            at_dip = value(c, dip)
            if at_dip < 0.0:
                return root_between(c, low, at_low, dip, at_dip)
        low, at_low, falls = high, at_high, not rises
    return -1.0


@njit
def expand(x, sign, a, da, rates):
    """Taylor coefficients of s, w, y, v about a state in x[:, 0]; sign 0 means stick."""
    k1, k2, c2, kr, cr, on, _, fk = rates
    for k in range(ORDER):
        ground = a if k == 0 else (da if k == 1 else 0.0)
        push = 0.0
        if sign != 0.0:
            push = -ground - k1 * x[0, k] + k2 * x[2, k] + c2 * x[3, k]
            if k == 0:
                push -= sign * fk
        over = 1.0 / (k + 1)
        x[0, k + 1] = x[1, k] * over
        x[1, k + 1] = push * over
        x[2, k + 1] = x[3, k] * over
        x[3, k + 1] = on * (-kr * x[2, k] - cr * x[3, k] - ground - push) * over


@njit
def divided_by_t(g):
    for k in range(ORDER):
        g[k] = g[k + 1]
    g[ORDER] = 0.0


@njit
def loop(ground, h, rates, slip, stick):
    """Histories of s and of the floor's acceleration, peak of |s|, number of events."""
    k1, k2, c2, kr, cr, on, fs, fk = rates
    n = len(ground)
    s_out, a2_out = np.zeros(n), np.zeros(n)
    x, g, g2 = np.zeros((4, ORDER + 1)), np.zeros(ORDER + 1), np.zeros(ORDER + 1)
    s = w = y = v = 0.0
    sign, peak, events = 0.0, 0.0, 0
    # A slip that has just begun: its velocity is zero, and its acceleration is this.
    begins, start = False, 0.0
    if abs(ground[0]) > fs:
        sign = -np.sign(ground[0])
        begins, start = True, abs(ground[0]) - fk
        events += 1
    for i in range(n - 1):
        a0, a1 = ground[i], ground[i + 1]
        if sign == 0.0:
            y1 = stick[2, 2] * y + stick[2, 3] * v + stick[2, 4] * a0 + stick[2, 5] * a1
            v1 = stick[3, 2] * y + stick[3, 3] * v + stick[3, 4] * a0 + stick[3, 5] * a1
            r0 = a0 + k1 * s - k2 * y - c2 * v
            r1 = a1 + k1 * s - k2 * y1 - c2 * v1
            da = (a1 - a0) / h
            d0 = da - k2 * v + c2 * on * (kr * y + cr * v + a0)
            d1 = da - k2 * v1 + c2 * on * (kr * y1 + cr * v1 + a1)
            if abs(r0) <= fs and abs(r1) <= fs:
                quiet = d0 * d1 >= 0.0
                if not quiet:
                    # The turning point lies within the triangle of the two tangents.
                    t = (r1 - r0 - d1 * h) / (d0 - d1)
                    quiet = abs(r0 + d0 * t) < fs
                if quiet:
                    y, v = y1, v1
                    s_out[i + 1], a2_out[i + 1] = s, -(kr * y + cr * v)
                    continue
        elif not begins:
            w1 = slip[1, 0] * s + slip[1, 1] * w + slip[1, 2] * y + slip[1, 3] * v
            w1 += slip[1, 4] * a0 + slip[1, 5] * a1 + slip[1, 6] * sign * fk
            if sign * w1 > 0.0:
                s1 = slip[0, 0] * s + slip[0, 1] * w + slip[0, 2] * y + slip[0, 3] * v
                s1 += slip[0, 4] * a0 + slip[0, 5] * a1 + slip[0, 6] * sign * fk
                y1 = slip[2, 0] * s + slip[2, 1] * w + slip[2, 2] * y + slip[2, 3] * v
                y1 += slip[2, 4] * a0 + slip[2, 5] * a1 + slip[2, 6] * sign * fk
                v1 = slip[3, 0] * s + slip[3, 1] * w + slip[3, 2] * y + slip[3, 3] * v
                v1 += slip[3, 4] * a0 + slip[3, 5] * a1 + slip[3, 6] * sign * fk
                d0 = sign * (-a0 - k1 * s + k2 * y + c2 * v) - fk
                d1 = sign * (-a1 - k1 * s1 + k2 * y1 + c2 * v1) - fk
                quiet = d0 >= 0.0 or d1 <= 0.0
                if not quiet:
                    t = (sign * (w1 - w) - d1 * h) / (d0 - d1)
                    quiet = sign * w + d0 * t > 0.0
                if quiet:
                    s, w, y, v = s1, w1, y1, v1
                    s_out[i + 1], a2_out[i + 1] = s, -(kr * y + cr * v)
                    continue
        # Something may happen in this sample: series from event to event.
        da, t0 = (a1 - a0) / h, 0.0
        for _ in range(1000):
            rest, a = h - t0, a0 + da * t0
            x[0, 0], x[1, 0], x[2, 0], x[3, 0] = s, w, y, v
            expand(x, sign, a, da, rates)
            if sign == 0.0:
                for k in range(ORDER + 1):
                    r = -k2 * x[2, k] - c2 * x[3, k]
                    g[k], g2[k] = -r, r
                r = a + k1 * s
                g[0] += fs - r
                g2[0] += fs + r
                g[1] -= da
                g2[1] += da
                t, other, towards = first_below_zero(g, rest), first_below_zero(g2, rest), -1.0
                if t < 0.0 or 0.0 <= other < t:
                    t, towards = other, 1.0
            else:
                for k in range(ORDER + 1):
                    g[k] = sign * x[1, k]
                if begins:
                    g[1] = start
                    divided_by_t(g)
                    if start == 0.0:
                        divided_by_t(g)
                    begins = False
                t = first_below_zero(g, rest)
            end = rest if t < 0.0 else t
            s, w, y, v = value(x[0], end), value(x[1], end), value(x[2], end), value(x[3], end)
            if sign == 0.0:
                s, w = x[0, 0], 0.0
            if t < 0.0:
                break
            t0 += t
            w = 0.0
            events += 1
            peak = max(peak, abs(s))
            if sign == 0.0:
                sign, begins, start = towards, True, fs - fk
            else:
                r = a0 + da * t0 + k1 * s - k2 * y - c2 * v
                if abs(r) <= fs:
                    sign = 0.0
                else:
                    sign, begins, start = -np.sign(r), True, abs(r) - fk
        s_out[i + 1], a2_out[i + 1] = s, -(kr * y + cr * v)
    return s_out, a2_out, max(peak, abs(s)), events
