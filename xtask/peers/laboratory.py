"""Reference values for the laboratory by NumPy and SciPy, which share nothing with our code.

Run from the repository's root: python xtask/peers/laboratory.py
Writes data/reference/laboratory/{metrics,free_vibration,student}.json. Needs numpy and scipy.
"""

import json
from pathlib import Path

import numpy as np
import scipy
from scipy import integrate, optimize, signal, stats

OUT = Path("data/reference/laboratory")
ORIGIN = f"xtask/peers/laboratory.py, NumPy {np.__version__}, SciPy {scipy.__version__}"


def rounded(values):
    """Seven significant digits: what the file holds is what is computed with."""
    return [float(f"{v:.6e}") for v in values]


def write(name, content):
    text = json.dumps({"origin": ORIGIN, **content}, indent=1)
    (OUT / name).write_text(text + "\n")


def score(a, b):
    return 10.0 if a == b else 10.0 * np.exp(-(((a - b) / min(a, b)) ** 2))


def anderson(t, m, p):
    """The ten scores as the module's documentation defines them."""

    def integrals(a):
        v = signal.detrend(integrate.cumulative_trapezoid(a, t, initial=0), type="linear")
        d = integrate.cumulative_trapezoid(v, t, initial=0)
        arias = integrate.cumulative_trapezoid(a * a, t, initial=0)
        energy = integrate.cumulative_trapezoid(v * v, t, initial=0)
        return v, d, arias, energy

    (vm, dm, im, em), (vp, dp, ip, ep) = integrals(m), integrals(p)
    dt, duration = (t[-1] - t[0]) / (len(t) - 1), t[-1] - t[0]
    short = max(4 * dt, 0.05)
    periods = np.geomspace(short, max(min(0.2 * duration, 10), 1.01 * short), 40)

    def spectrum(a):
        """Peaks at 20 points a step of the oscillator, its input linear between samples."""
        fine = np.linspace(t[0], t[-1], 20 * (len(t) - 1) + 1)
        af = np.interp(fine, t, a)
        peaks = []
        for w in 2 * np.pi / periods:
            x = 0.05
            system = signal.StateSpace(
                [[0, 1], [-w * w, -2 * x * w]], [[0], [-1]], [[-w * w, -2 * x * w]], [[0]]
            )
            _, y, _ = signal.lsim(system, af, fine)
            peaks.append(np.abs(y).max())
        return np.array(peaks)

    def fourier(a):
        w = 2 * np.pi / periods
        return np.array(
            [abs(integrate.trapezoid(a * np.exp(-1j * wi * (t - t[0])), t)) for wi in w]
        )

    each = lambda a, b: float(np.mean([score(x, y) for x, y in zip(a, b)]))
    widest = lambda a, b: 10 * (1 - np.abs(a / a[-1] - b / b[-1]).max())
    cross = integrate.trapezoid(m * p, t) / np.sqrt(im[-1] * ip[-1])
    return {
        "arias_duration": widest(im, ip),
        "energy_duration": widest(em, ep),
        "arias_intensity": score(im[-1], ip[-1]),
        "energy_integral": score(em[-1], ep[-1]),
        "peak_acceleration": score(abs(m).max(), abs(p).max()),
        "peak_velocity": score(abs(vm).max(), abs(vp).max()),
        "peak_displacement": score(abs(dm).max(), abs(dp).max()),
        "response_spectrum": each(spectrum(m), spectrum(p)),
        "fourier_spectrum": each(fourier(m), fourier(p)),
        "cross_correlation": 10 * max(0, cross),
    }


def metrics():
    rng = np.random.default_rng(20)
    t = np.arange(600) * 0.02
    envelope = np.exp(-((t - 4) ** 2) / 6)
    m = envelope * (np.sin(2 * np.pi * 1.3 * t) + 0.5 * np.sin(2 * np.pi * 3.1 * t + 1))
    p = 1.15 * envelope * (np.sin(2 * np.pi * 1.3 * (t + 0.03)) + 0.4 * np.sin(2 * np.pi * 3.1 * t + 1.2))
    m, p = m + 0.03 * rng.standard_normal(600), p + 0.01 * rng.standard_normal(600)
    m, p = np.array(rounded(m)), np.array(rounded(p))
    mm, pp, mp = m @ m, p @ p, m @ p
    e = (pp - mm) / np.sqrt(mm * pp)
    magnitude = np.sign(e) * np.log10(1 + abs(e))
    phase = np.arccos(mp / np.sqrt(mm * pp)) / np.pi
    lags = np.arange(-60, 61)
    cross = []
    for lag in lags:
        a, b = (m[lag:], p[: len(p) - lag]) if lag >= 0 else (m[:lag], p[-lag:])
        cross.append(a @ b / np.sqrt((a @ a) * (b @ b)))
    k = int(np.argmax(cross))
    curve = np.polyfit(lags[k - 1 : k + 2], cross[k - 1 : k + 2], 2)
    write(
        "metrics.json",
        {
            "dt_s": 0.02,
            "measured": m.tolist(),
            "predicted": p.tolist(),
            "peak_ratio": abs(p).max() / abs(m).max(),
            "rms_error": float(np.sqrt(np.mean((p - m) ** 2))),
            "normalised_rms_error": float(np.sqrt(np.mean((p - m) ** 2) / np.mean(m**2))),
            "correlation": float(stats.pearsonr(m, p).statistic),
            "russell_magnitude": float(magnitude),
            "russell_phase": float(phase),
            "russell_comprehensive": float(np.sqrt(np.pi / 4 * (magnitude**2 + phase**2))),
            "lag_samples": float(-curve[1] / (2 * curve[0])),
            "anderson": anderson(t, m, p),
        },
    )


def free_vibration():
    """A decay with noise, fitted by curve_fit; its intervals are those of the linearised model."""
    rng = np.random.default_rng(7)
    t = np.arange(900) * 0.01
    model = lambda t, f, xi, a, b, c: np.exp(-xi * 2 * np.pi * f * t) * (
        a * np.cos(2 * np.pi * f * np.sqrt(1 - xi**2) * t)
        + b * np.sin(2 * np.pi * f * np.sqrt(1 - xi**2) * t)
    ) + c
    y = np.array(rounded(model(t, 1.125, 0.013, 0.8, -0.4, 0.02) + 0.04 * rng.standard_normal(900)))
    best, covariance = optimize.curve_fit(model, t, y, p0=[1.12, 0.01, 0.8, -0.4, 0], xtol=1e-14, ftol=1e-14)
    half = stats.t.ppf(0.975, len(t) - 5) * np.sqrt(np.diag(covariance))
    write(
        "free_vibration.json",
        {
            "dt_s": 0.01,
            "values": y.tolist(),
            "frequency_hz": best[0],
            "frequency_half_width_hz": half[0],
            "damping_ratio": best[1],
            "damping_ratio_half_width": half[1],
        },
    )


def student():
    cases = [(p, n) for p in (0.9, 0.95, 0.99) for n in (1, 2, 5, 9, 30, 1e3, 1e6)]
    write(
        "student.json",
        {"cases": [[p, n, float(stats.t.ppf(0.5 * (1 + p), n))] for p, n in cases]},
    )


if __name__ == "__main__":
    OUT.mkdir(parents=True, exist_ok=True)
    metrics()
    free_vibration()
    student()
