"""The loop of `numba_loop` for a shear frame of any number of storeys.

Fixed-base modes; whole samples by dense propagators; where the end values and slopes of a sample do
not exclude an event, the sample is redone by its Taylor series. Peaks of the sliding displacement
alone: the rival does less than it is compared with.
"""

import numpy as np
from numba import njit
from scipy.linalg import eigh, expm

from numba_loop import ORDER, divided_by_t, first_below_zero, value


def prepare(ground, dt, block_kg, floors_kg, stiffnesses, ratio, spring, mu_s, mu_k, gravity):
    """Arguments of `loop`: samples, step, modal properties, propagators, friction forces."""
    n = len(floors_kg)
    masses, k = np.array(floors_kg), np.array(stiffnesses)
    matrix = np.diag(k) + np.diag(np.append(k[1:], 0.0))
    matrix -= np.diag(k[1:], 1) + np.diag(k[1:], -1)
    omega2, shapes = eigh(matrix, np.diag(masses))
    l, d = shapes.T @ masses, 2.0 * ratio * np.sqrt(omega2)
    # State: s, w, eta, eta'; f = D eta' + Omega eta; inputs: ground and friction force.
    size = 2 * n + 2
    stick, slip = np.zeros((size, size)), np.zeros((size, size))
    stick[2:2 + n, 2 + n:] = np.eye(n)
    stick[2 + n:, 2:2 + n], stick[2 + n:, 2 + n:] = -np.diag(omega2), -np.diag(d)
    slip[:] = stick
    slip[0, 1] = 1.0
    slip[1, 0], slip[1, 2:2 + n], slip[1, 2 + n:] = -spring, l * omega2, l * d
    slip[1] /= block_kg
    slip[2 + n:] -= np.outer(l, slip[1])
    by_ground = [np.zeros(size), np.zeros(size)]
    by_ground[0][2 + n:] = -l
    by_ground[1][1] = -1.0
    by_force = np.zeros(size)
    by_force[1] = 1.0 / block_kg
    by_force[2 + n:] = -l / block_kg
    tables = [propagator(matrix, ground_in, force_in, dt)
              for matrix, ground_in, force_in in ((stick, by_ground[0], 0.0 * by_force),
                                                  (slip, by_ground[1], by_force))]
    weight = (block_kg + masses.sum()) * gravity
    force = np.array([mu_s * weight, mu_k * weight])
    return (ground, dt, block_kg, spring, l, omega2, d, tables[0], tables[1], force)


def propagator(matrix, by_ground, by_force, h):
    """Columns for the state, ground at the start, ground at the end, force on the block."""
    size = len(matrix)
    whole = np.zeros((size + 3, size + 3))
    whole[:size, :size], whole[:size, size], whole[:size, size + 2] = matrix, by_ground, by_force
    whole[size, size + 1] = 1.0
    e = expm(whole * h)[:size]
    e[:, size], e[:, size + 1] = e[:, size] - e[:, size + 1] / h, e[:, size + 1] / h
    return np.ascontiguousarray(e)


@njit
def expand(x, sign, a, da, m1, k1, l, omega2, d, fk):
    """Taylor coefficients about a state in x[:, 0]; sign 0 means stick."""
    n = len(l)
    for k in range(ORDER):
        ground = a if k == 0 else (da if k == 1 else 0.0)
        shear = 0.0
        for j in range(n):
            shear += l[j] * (omega2[j] * x[2 + j, k] + d[j] * x[2 + n + j, k])
        u = ground
        if sign != 0.0:
            u = (shear - k1 * x[0, k] - (sign * fk if k == 0 else 0.0)) / m1
        over = 1.0 / (k + 1)
        x[0, k + 1] = x[1, k] * over
        x[1, k + 1] = (u - ground) * over
        for j in range(n):
            x[2 + j, k + 1] = x[2 + n + j, k] * over
            f = omega2[j] * x[2 + j, k] + d[j] * x[2 + n + j, k]
            x[2 + n + j, k + 1] = -(f + l[j] * u) * over


@njit
def shear_and_rate(x, u, l, omega2, d):
    n = len(l)
    shear = rate = 0.0
    for j in range(n):
        f = omega2[j] * x[2 + j] + d[j] * x[2 + n + j]
        shear += l[j] * f
        rate += l[j] * (omega2[j] * x[2 + n + j] - d[j] * (f + l[j] * u))
    return shear, rate


@njit
def step(table, x, a0, a1, force, out):
    size = len(x)
    for i in range(size):
        total = table[i, size] * a0 + table[i, size + 1] * a1 + table[i, size + 2] * force
        for j in range(size):
            total += table[i, j] * x[j]
        out[i] = total


@njit(fastmath=False)
def loop(ground, h, m1, k1, l, omega2, d, stick, slip, force):
    """Peak of |s| and number of events."""
    fs, fk = force
    n, modes = len(ground), len(l)
    size = 2 * modes + 2
    x, ahead = np.zeros(size), np.zeros(size)
    c = np.zeros((size, ORDER + 1))
    g, g2 = np.zeros(ORDER + 1), np.zeros(ORDER + 1)
    sign, peak, events = 0.0, 0.0, 0
    begins, start = False, 0.0
    if abs(m1 * ground[0]) > fs:
        sign = -np.sign(ground[0])
        begins, start = True, (abs(m1 * ground[0]) - fk) / m1
        events += 1
    for i in range(n - 1):
        a0, a1 = ground[i], ground[i + 1]
        da = (a1 - a0) / h
        if sign == 0.0:
            step(stick, x, a0, a1, 0.0, ahead)
            shear0, rate0 = shear_and_rate(x, a0, l, omega2, d)
            shear1, rate1 = shear_and_rate(ahead, a1, l, omega2, d)
            r0, r1 = m1 * a0 + k1 * x[0] - shear0, m1 * a1 + k1 * x[0] - shear1
            d0, d1 = m1 * da - rate0, m1 * da - rate1
            if abs(r0) <= fs and abs(r1) <= fs:
                quiet = d0 * d1 >= 0.0
                if not quiet:
                    t = (r1 - r0 - d1 * h) / (d0 - d1)
                    quiet = abs(r0 + d0 * t) < fs
                if quiet:
                    ahead[0], ahead[1] = x[0], 0.0
                    x, ahead = ahead, x
                    continue
        elif not begins:
            step(slip, x, a0, a1, -sign * fk, ahead)
            if sign * ahead[1] > 0.0:
                shear0, _ = shear_and_rate(x, 0.0, l, omega2, d)
                shear1, _ = shear_and_rate(ahead, 0.0, l, omega2, d)
                d0 = sign * ((shear0 - k1 * x[0]) / m1 - a0) - fk / m1
                d1 = sign * ((shear1 - k1 * ahead[0]) / m1 - a1) - fk / m1
                quiet = d0 >= 0.0 or d1 <= 0.0
                if not quiet:
                    t = (sign * (ahead[1] - x[1]) - d1 * h) / (d0 - d1)
                    quiet = sign * x[1] + d0 * t > 0.0
                if quiet:
                    x, ahead = ahead, x
                    continue
        t0 = 0.0
        for _ in range(1000):
            rest, a = h - t0, a0 + da * t0
            c[:, 0] = x
            expand(c, sign, a, da, m1, k1, l, omega2, d, fk)
            if sign == 0.0:
                for k in range(ORDER + 1):
                    r = 0.0
                    for j in range(modes):
                        r -= l[j] * (omega2[j] * c[2 + j, k] + d[j] * c[2 + modes + j, k])
                    g[k], g2[k] = -r, r
                r = m1 * a + k1 * x[0]
                g[0] += fs - r
                g2[0] += fs + r
                g[1] -= m1 * da
                g2[1] += m1 * da
                t, other, towards = first_below_zero(g, rest), first_below_zero(g2, rest), -1.0
                if t < 0.0 or 0.0 <= other < t:
                    t, towards = other, 1.0
            else:
                for k in range(ORDER + 1):
                    g[k] = sign * c[1, k]
                if begins:
                    g[1] = start
                    divided_by_t(g)
                    if start == 0.0:
                        divided_by_t(g)
                    begins = False
                t = first_below_zero(g, rest)
            end = rest if t < 0.0 else t
            s = x[0]
            for j in range(size):
                x[j] = value(c[j], end)
            if sign == 0.0:
                x[0], x[1] = s, 0.0
            if t < 0.0:
                break
            t0 += t
            x[1] = 0.0
            events += 1
            peak = max(peak, abs(x[0]))
            if sign == 0.0:
                sign, begins, start = towards, True, (fs - fk) / m1
            else:
                shear, _ = shear_and_rate(x, 0.0, l, omega2, d)
                r = m1 * (a0 + da * t0) + k1 * x[0] - shear
                if abs(r) <= fs:
                    sign = 0.0
                else:
                    sign, begins, start = -np.sign(r), True, (abs(r) - fk) / m1
    return max(peak, abs(x[0])), events
