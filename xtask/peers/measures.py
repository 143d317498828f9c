"""Reference values for spectra, intensity measures and processing, by NumPy, SciPy, eqsig and pyrotd.

Run as: python measures.py REPOSITORY > data/reference/measures/expected.json

Nothing of Slipstick is used. Spectra come from matrix exponentials at every sixteenth of a sample, and the
highest turning points from the same exponentials at the root of the velocity.
"""

import json
import sys
from pathlib import Path

import eqsig
import numpy as np
import pyrotd
import scipy
from scipy import linalg, optimize, signal

G = 9.80665
PARTS = 16
PERIODS = [0.02, 0.05, 0.1, 0.2, 0.37, 0.5, 1.0, 2.0, 4.0, 10.0]
DAMPINGS = [0.0, 0.01, 0.05, 0.2, 0.7]


def read(path):
    lines = Path(path).read_text().splitlines()
    return np.array([float(line) for line in lines if line.strip() and not line.startswith("#")]) * G


def matrix(omega, xi):
    """d/dt of (u, v, a, slope of a)."""
    m = np.zeros((4, 4))
    m[0, 1] = 1.0
    m[1] = [-omega**2, -2 * xi * omega, -1.0, 0.0]
    m[2, 3] = 1.0
    return m


def oscillators(a, dt, pairs):
    """Largest |u|, |v| and |u'' + a| of each (omega, xi), between samples too."""
    count = len(pairs)
    omega = np.array([p[0] for p in pairs])
    xi = np.array([p[1] for p in pairs])
    whole = np.array([linalg.expm(matrix(*p) * dt) for p in pairs])
    part = [np.array([linalg.expm(matrix(*p) * (dt * k / PARTS)) for p in pairs]) for k in range(PARTS)]
    u, v = np.zeros(count), np.zeros(count)
    # Candidates of each oscillator and quantity: (value at the point, sample).
    best = [[[] for _ in range(count)] for _ in range(3)]
    peak = np.zeros((3, count))
    starts = np.zeros((len(a) - 1, 2, count))
    high = np.zeros((len(a) - 1, 3, count))
    for i in range(len(a) - 1):
        starts[i] = u, v
        x = np.stack([u, v, np.full(count, a[i]), np.full(count, (a[i + 1] - a[i]) / dt)])
        for k in range(PARTS):
            y = np.einsum("nij,jn->in", part[k], x)
            total = omega**2 * y[0] + 2 * xi * omega * y[1]
            high[i] = np.maximum(high[i], np.abs([y[0], y[1], total]))
        y = np.einsum("nij,jn->in", whole, x)
        u, v = y[0], y[1]
        total = omega**2 * u + 2 * xi * omega * v
        high[i] = np.maximum(high[i], np.abs([u, v, total]))
    out = []
    for n, (w, z) in enumerate(pairs):
        m = matrix(w, z)
        found = []
        for q in range(3):
            order = np.argsort(-high[:, q, n])[:6]
            value = high[:, q, n].max()
            for i in order:
                x = np.array([*starts[i, :, n], a[i], (a[i + 1] - a[i]) / dt])

                def quantity(t):
                    y = linalg.expm(m * t) @ x
                    return [y[0], y[1], w**2 * y[0] + 2 * z * w * y[1]][q]

                def slope(t):
                    y = linalg.expm(m * t) @ x
                    d = m @ y
                    return [d[0], d[1], w**2 * d[0] + 2 * z * w * d[1]][q]

                grid = np.linspace(0, dt, PARTS + 1)
                slopes = [slope(t) for t in grid]
                for s, e, fs, fe in zip(grid, grid[1:], slopes, slopes[1:]):
                    if fs * fe < 0:
                        t = optimize.brentq(slope, s, e, xtol=1e-16, rtol=1e-15)
                        value = max(value, abs(quantity(t)))
            found.append(value)
        out.append(found)
    return np.array(out)


def measures(a, dt):
    n = 1
    while n < 4 * (len(a) - 1) or n * dt < 20.0:
        n *= 2
    f = np.fft.rfftfreq(n, dt)
    c = np.abs(np.fft.rfft(a, n)) * dt
    band = (f >= 0.25) & (f <= 20.0)
    tm = float(np.sum(c[band] ** 2 / f[band]) / np.sum(c[band] ** 2))
    eq = eqsig.AccSignal(a, dt)
    arias = float(eqsig.im.calc_arias_intensity(eq)[-1])
    cav = float(eqsig.im.calc_cav(eq)[-1])
    fine = 50
    t = np.arange((len(a) - 1) * fine + 1) * (dt / fine)
    b = np.interp(t, np.arange(len(a)) * dt, a)
    integral = lambda y: float(np.trapezoid(y, dx=dt / fine))
    energy = np.concatenate([[0.0], np.cumsum(0.5 * (b[1:] ** 2 + b[:-1] ** 2))])
    share = energy / energy[-1]
    at = lambda p: float(np.interp(p, share, t))
    v = np.concatenate([[0.0], np.cumsum(0.5 * (b[1:] + b[:-1]) * dt / fine)])
    d = np.concatenate([[0.0], np.cumsum(0.5 * (v[1:] + v[:-1]) * dt / fine)])
    above = np.abs(b) > 0.05 * G
    windows = np.arange(int(np.ceil(t[-1])) + 1)
    cavstd = 0.0
    for s in windows[:-1]:
        inside = (t >= s - 1e-9) & (t <= s + 1 + 1e-9)
        if inside.sum() > 1 and np.abs(b[inside]).max() > 0.025 * G:
            cavstd += integral(np.abs(b[inside]))
    return {
        "tm_s": tm,
        "eqsig": {"arias_m_per_s": arias, "cav_m_per_s": cav},
        "fine": {
            "pga_m_per_s2": float(np.abs(b).max()),
            "pgv_m_per_s": float(np.abs(v).max()),
            "pgd_m": float(np.abs(d).max()),
            "arias_m_per_s": np.pi / (2 * G) * integral(b**2),
            "cav_m_per_s": integral(np.abs(b)),
            "cavstd_m_per_s": cavstd,
            "d5_75_s": at(0.75) - at(0.05),
            "d5_95_s": at(0.95) - at(0.05),
            "bracketed_0.05g_s": float(t[above][-1] - t[above][0]),
            "uniform_0.05g_s": float(above.sum() * dt / fine),
        },
    }


def fiv3(a, dt, period, alpha=0.7, beta=0.85):
    """Analogue Butterworth filter by lsim (straight lines between samples), one pass."""
    fine = 20
    t = np.arange((len(a) - 1) * fine + 1) * (dt / fine)
    x = np.interp(t, np.arange(len(a)) * dt, a)
    b, c = signal.butter(2, 2 * np.pi * beta / period, analog=True)
    _, y, _ = signal.lsim((b, c), x, t)
    w = np.concatenate([[0.0], np.cumsum(0.5 * (y[1:] + y[:-1]) * dt / fine)])
    end = t[-1] - alpha * period
    s = t[t <= end]
    value = np.interp(s + alpha * period, t, w) - w[: len(s)]
    top = np.sort(value[signal.find_peaks(value)[0]])[-3:].sum()
    low = np.sort(value[signal.find_peaks(-value)[0]])[:3].sum()
    return float(max(top, abs(low)))


def filters(a, dt):
    cases = [("low", 5.0, 1), ("low", 25.0, 4), ("low", 10.0, 3), ("high", 0.1, 4), ("high", 0.5, 3), ("high", 0.1, 2)]
    cases += [("band", (0.1, 25.0), 4), ("band", (0.5, 10.0), 3), ("band", (0.2, 30.0), 1), ("band", (0.1, 20.0), 2)]
    out = []
    pick = list(range(0, len(a), 217)) + [len(a) - 1]
    for kind, corner, order in cases:
        btype = {"low": "lowpass", "high": "highpass", "band": "bandpass"}[kind]
        sos = signal.butter(order, corner, btype, fs=1 / dt, output="sos")
        y = signal.sosfiltfilt(sos, a)
        corners = list(corner) if kind == "band" else [corner]
        out.append({"kind": kind, "corners_hz": corners, "order": order, "index": pick, "value": [float(y[i]) for i in pick], "peak": float(np.abs(y).max())})
    return out


def baselines(a, dt):
    pick = list(range(0, len(a), 217)) + [len(a) - 1]
    t = np.arange(len(a)) * dt
    x = 2 * t / t[-1] - 1
    out = []
    for degree in range(6):
        y = a - np.polynomial.legendre.legval(x, np.polynomial.legendre.legfit(x, a, degree))
        if degree == 1:
            assert np.allclose(y, signal.detrend(a), rtol=0, atol=1e-12)
        out.append({"degree": degree, "index": pick, "value": [float(y[i]) for i in pick]})
    return out


def main():
    root = Path(sys.argv[1])
    a = read(root / "examples/records/taft-111.txt")
    b = read(root / "examples/records/taft-021.txt")
    dt = 0.01
    pairs = [(2 * np.pi / t, xi) for xi in DAMPINGS for t in PERIODS]
    exact = oscillators(a, dt, pairs)
    grid = [k / 100 for k in range(10, 251)]
    five = oscillators(a, dt, [(2 * np.pi / t, 0.05) for t in grid])
    omega = 2 * np.pi / np.array(grid)
    eq = eqsig.AccSignal(a, dt, response_times=np.array(PERIODS))
    eq.generate_response_spectrum(xi=0.05)
    freqs = 1.0 / np.array(PERIODS)
    # pyrotd transforms what it is given as if it were periodic: zeros keep the end from the start.
    zeros = np.zeros(2 * len(a))
    psa = pyrotd.calc_spec_accels(dt, np.concatenate([a, zeros]), freqs, 0.05).spec_accel
    n = min(len(a), len(b))
    padded = [np.concatenate([x[:n], zeros]) for x in (a, b)]
    rotated = pyrotd.calc_rotated_spec_accels(dt, *padded, freqs, 0.05, percentiles=[50, 100])
    rotd = {str(int(p)): [float(row.spec_accel) for row in rotated if row.percentile == p] for p in (50, 100)}
    average = np.exp(np.linspace(np.log(0.5), np.log(3.0), 50))
    sa50 = oscillators(a, dt, [(2 * np.pi / t, 0.05) for t in average])[:, 0] * (2 * np.pi / average) ** 2
    tukey = signal.windows.tukey(len(a), 0.1)
    pick = list(range(0, 300, 13))
    print(
        json.dumps(
            {
                "versions": {"numpy": np.__version__, "scipy": scipy.__version__, "eqsig": "1.2.17", "pyrotd": "0.6.1"},
                "record": "examples/records/taft-111.txt",
                "periods_s": PERIODS,
                "damping_ratios": DAMPINGS,
                "sd_m": exact[:, 0].tolist(),
                "sv_m_per_s": exact[:, 1].tolist(),
                "sa_m_per_s2": exact[:, 2].tolist(),
                "eqsig_psa_5_percent": [float(x) for x in eq.s_a],
                "pyrotd_psa_5_percent": [float(x) for x in psa],
                "pyrotd_rotd": rotd,
                "measures": measures(a, dt),
                "housner_m": float(np.trapezoid(five[:, 0] * omega, dx=0.01)),
                "vsi_m": float(np.trapezoid(five[:, 1], dx=0.01)),
                "asi_m_per_s": float(np.trapezoid(five[:41, 2], dx=0.01)),
                "sa_avg_0.5s_3s": float(np.exp(np.mean(np.log(sa50)))),
                "fiv3": {str(t): fiv3(a, dt, t) for t in (0.3, 1.0, 2.5)},
                "filters": filters(a, dt),
                "baselines": baselines(a, dt),
                "taper_5_percent": {"index": pick, "value": [float(tukey[i]) for i in pick]},
            },
            indent=1,
        )
    )


main()
