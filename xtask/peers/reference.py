"""The exact answer, by a method that none of the timed programs uses: integers.

Every number is an integer times 2^-160. Between events the motion is its Taylor series, carried on
until the terms vanish; events are isolated by a bound on the second derivative (between two points
a function lies above the lower of its end values less width^2/8 times that bound) and bisected.
"""

import hashlib
from fractions import Fraction

import numpy as np

BITS = 160
ONE = 1 << BITS
# Neighbouring roots closer than this (in steps of the record) count as one.
NARROWEST = ONE >> 100


def fixed(x):
    x = Fraction(x)
    return x.numerator * ONE // x.denominator


def evaluate(c, t):
    total = c[-1]
    for q in c[-2::-1]:
        total = (total * t >> BITS) + q
    return total


def derivative(c):
    return [k * q for k, q in enumerate(c)][1:] or [0]


def first_below_zero(c, end):
    """First t in (0, end] where the polynomial falls below zero, or None; c[0] >= 0."""
    bend, power = 0, ONE
    for k in range(2, len(c)):
        bend += k * (k - 1) * abs(c[k]) * power >> BITS
        power = power * end >> BITS
    rise = derivative(c)

    def search(low, g_low, high, g_high):
        width = high - low
        sag = (bend * width >> BITS) * width >> BITS + 3
        if min(g_low, g_high) > sag:
            return None
        if g_low >= 0 > g_high and evaluate(rise, low) + (bend * width >> BITS) < 0:
            while high - low > 1:
                middle = (low + high) >> 1
                low, high = (low, middle) if evaluate(c, middle) < 0 else (middle, high)
            return high
        if width < NARROWEST:
            return high if g_high < 0 else None
        middle = (low + high) >> 1
        g_middle = evaluate(c, middle)
        found = search(low, g_low, middle, g_middle)
        if found is not None or g_middle < 0:
            return middle if found is None else found
        return search(middle, g_middle, high, g_high)

    return search(0, c[0], end, evaluate(c, end))


class Exact:
    """Equations of one case, over the block's mass and in steps of the record."""

    def __init__(self, case):
        m1, m2, h = Fraction(case.block_kg), Fraction(case.floor_kg), Fraction(case.dt)
        k1, k2 = Fraction(case.spring), Fraction(case.storey_spring)
        c2 = Fraction(case.storey_damper)
        self.h = fixed(h)
        self.k1, self.k2, self.c2 = (fixed(h * q / m1) for q in (k1, k2, c2))
        self.rigid = case.rigid
        self.kr, self.cr = (0, 0) if self.rigid else (fixed(h * q / m2) for q in (k2, c2))
        weight = (m1 + m2) * Fraction(9.81)
        self.fs = fixed(h * Fraction(case.mu_static) * weight / m1)
        self.fk = fixed(h * Fraction(case.mu_kinetic) * weight / m1)
        self.ground = [fixed(h * Fraction(float(a))) for a in case.ground]

    def demand(self, x, a):
        s, _, y, v = x
        return a + ((self.k1 * s - self.k2 * y - self.c2 * v) >> BITS)

    def series(self, x, sign, a, da):
        """Coefficients of s, w, y, v in time counted in steps; all forces are times h already."""
        c = [[q] for q in x]
        for k in range(200):
            s, w, y, v = (q[k] for q in c)
            ground = a if k == 0 else da if k == 1 else 0
            push = 0
            if sign:
                push = -self.demand((s, w, y, v), ground) - (sign * self.fk if k == 0 else 0)
            swing = 0 if self.rigid else -ground - push - ((self.kr * y + self.cr * v) >> BITS)
            rates = (self.h * w >> BITS, push, self.h * v >> BITS, swing)
            for q, rate in zip(c, rates):
                q.append(rate // (k + 1))
            if k > 2 and all(-2 < q[-1] < 2 and -2 < q[-2] < 2 for q in c):
                return c
        raise ArithmeticError("the Taylor series of a step does not end: cut the record finer")

    def limits(self, c, a, da):
        """fs - demand and fs + demand as polynomials."""
        s = c[0][0]
        demand = [-((self.k2 * y + self.c2 * v) >> BITS) for y, v in zip(c[2], c[3])]
        demand[0] += a + (self.k1 * s >> BITS)
        demand[1] += da
        above, below = [-q for q in demand], demand[:]
        above[0] += self.fs
        below[0] += self.fs
        return above, below

    def run(self):
        x, sign, events, peak = [0, 0, 0, 0], 0, 0, 0
        begins = None  # acceleration with which a slip begins
        r = self.ground[0]
        if abs(r) > self.fs:
            sign, begins, events = (-1 if r > 0 else 1), abs(r) - self.fk, 1
        history = [0.0]
        for a0, a1 in zip(self.ground, self.ground[1:]):
            da, t = a1 - a0, 0
            while True:
                rest, a = ONE - t, a0 + (da * t >> BITS)
                c = self.series(x, sign, a, da)
                if sign == 0:
                    above, below = self.limits(c, a, da)
                    # A demand that is at its bound to the last bit starts on the bound.
                    above[0], below[0] = max(above[0], 0), max(below[0], 0)
                    up = first_below_zero(above, rest)
                    down = first_below_zero(below, rest if up is None else up)
                    towards = -1 if down is None else 1
                    stop = up if down is None else down
                else:
                    g = [sign * q for q in c[1]]
                    if begins is not None:
                        g = [begins] + g[2:] if begins > 0 else g[2:]
                        begins = None
                    g[0] = max(g[0], 0)
                    stop = first_below_zero(g, rest)
                x = [evaluate(q, rest if stop is None else stop) for q in c]
                if sign == 0:
                    x[0], x[1] = c[0][0], 0
                if stop is None:
                    break
                t += stop
                x[1], events, peak = 0, events + 1, max(peak, abs(x[0]))
                if sign == 0:
                    sign, begins = towards, self.fs - self.fk
                else:
                    r = self.demand(x, a0 + (da * t >> BITS))
                    sign = 0 if abs(r) <= self.fs else -1 if r > 0 else 1
                    begins = abs(r) - self.fk if sign else None
            history.append(x[0] / ONE)
        return np.array(history), max(peak, abs(x[0])) / ONE, events


def exact(case, cache):
    """Sliding displacement at the samples, its peak, the number of events; kept in a folder."""
    cache.mkdir(parents=True, exist_ok=True)
    probe = cache / "probe.bin"
    case.to_file(probe)
    code = __file__.encode() + open(__file__, "rb").read()
    key = hashlib.sha256(probe.read_bytes() + code).hexdigest()[:16]
    file = cache / f"exact-{key}.npz"
    if not file.is_file():
        history, peak, events = Exact(case).run()
        np.savez(file, history=history, peak=peak, events=events)
    kept = np.load(file)
    return kept["history"], float(kept["peak"]), int(kept["events"])
