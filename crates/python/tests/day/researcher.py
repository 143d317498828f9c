"""The day of a researcher with a shaking table: motions as signals, a prediction beside a test, parameters from tests.

It is run with the folder of the examples.
"""

import sys
from pathlib import Path

import numpy as np
import polars as pl

import slipstick as ss

examples = Path(sys.argv[1])

# Motions as signals.
taft = ss.read_record(examples / "records" / "taft-111.txt", units="g", dt=0.01)["2 s":"10 s"]
shaken: ss.Motion = taft.filter(high_pass=0.2, low_pass="20 Hz").scaled(pga=3.0)
sa = shaken.spectrum(np.geomspace(0.1, 2.0, 8), damping="5 %")["sa_m_per_s2"]
measures: dict[str, object] = shaken.measures("Sa(1 s)")
axes = shaken.plot()
assert sa.shape == (8,) and "pga_m_per_s2" in measures and len(axes) == 3

# A test is made up: what the model says, with noise.
mock_up = ss.Model(
    block=ss.Block(mass="325 kg"),
    slider=ss.Slider(static_friction=0.10, kinetic_friction=0.08, spring="4 kN/m"),
    analysis=ss.Analysis(tail="1 s"),
)
truth = ss.run(mock_up, shaken)
noise = np.random.default_rng(1)
columns = {name: truth.history[name] for name in ("time_s", "table_acceleration_m_per_s2", "sliding_displacement_m")}
columns["sliding_displacement_m"] = columns["sliding_displacement_m"] + noise.normal(0.0, 1e-5, len(columns["time_s"]))
comparison = ss.compare(pl.DataFrame(columns), mock_up, within={"peak_ratio.sliding_displacement": (0.9, 1.1)})
overlay = comparison.plot("sliding_displacement")
assert comparison.holds and overlay.get_ylabel() == "Sliding displacement (mm)"

# Friction from a cyclic test, damping from free vibration: columns by name, in any frame.
t = np.arange(0.0, 6.0, 0.002)
sliding = 0.02 * np.sin(2.0 * np.pi * t)
force = 150.0 * np.sign(np.cos(2.0 * np.pi * t)) + 1e3 * sliding + noise.normal(0.0, 1.0, t.size)
cyclic = ss.identify.cyclic({"time_s": t, "displacement_m": sliding, "force_n": force}, mass=100.0)
friction = cyclic.estimates["slider.kinetic_friction"]
assert friction.value is not None and abs(friction.value - 150.0 / 980.665) < 1e-3
decay = np.exp(-0.1 * t) * np.cos(2.0 * np.pi * 1.6 * t) + noise.normal(0.0, 0.01, t.size)
free = ss.identify.free_vibration(ss.Table({"time_s": t, "storey1_acceleration_m_per_s2": decay}), start="0.1 s")
assert free.holds and set(free.estimates) == {"storey.1.frequency", "storey.1.damping_ratio"}

# Which keys matter.
keys = ["slider.kinetic_friction", "slider.static_friction"]
tornado = ss.sensitivity(mock_up, shaken, vary=keys, demand="peak_sliding_displacement_m")
bars = tornado.plot(most=2)
assert set(tornado.table["path"]) == set(keys)

# What cannot be is told in one's own words.
told: list[str] = []
for number in (float("nan"), "3 parsecs"):
    try:
        mock_up.with_({"slider.spring": number})
    except ss.InputError as error:
        told.append(str(error.path))
assert told == ["slider.spring", "slider.spring"]
