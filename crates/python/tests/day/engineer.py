"""The day of an earthquake engineer: a building on sliders, one record, both directions, figures, a suite.

It is run with the folder of the examples.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import polars as pl

import slipstick as ss

examples = Path(sys.argv[1])

# A model of typed parts: a value is text with its unit, or a number, a scalar, a quantity in SI.
tank = ss.Model(
    name="Tank",
    block=ss.Block(mass=np.float64(325e3)),
    slider=ss.Slider(static_friction="6 %", kinetic_friction=0.05, radius="2 m", gap="250 mm"),
    storey=[ss.Storey(mass="201 t", stiffness="90 kN/mm", damping_ratio=0.02)],
)
x, y = (examples / "records" / f"taft-{angle}.txt" for angle in ("021", "111"))
taft = ss.read_record(x, units="g", dt=0.01)["2 s":"12 s"].scaled(pga="0.3 g")

# A whole number is a sample, a text or `at` a time, an array the samples.
at: float = taft.at("3.2 s") - taft[320]
samples = np.asarray(taft)
assert at == 0.0 and len(samples) == len(taft.time_s) and taft["3.2 s"] == taft[320]

# One analysis: what it says, its figures, its folder.
response = ss.run(tank, taft, floor_spectrum=True)
assert response.holds and response.summary["record"]["motion_hash"] == taft.digest
history = response.plot.history(color="C3", linewidth=2, marker="x", label="Taft")
_, (left, right) = plt.subplots(1, 2)
assert response.plot.loop(ax=left) is left and response.plot.drift(ax=right) is right
pages = [response.plot(), response.plot.energy(), response.plot.demand(), response.plot.acceleration()]
spectra = response.plot.floor_spectra()
folder = response.save("response")
assert ss.Response.read(folder) == response
report: Path = response.report("report.html", units="kN-mm")
table = pl.DataFrame(response.history)
assert table.height == response.summary["samples"]

# Two directions: x, y, their resultant and the way of the block in its gap.
pair = ss.read_record(x, y=y, units="g", dt=0.01)["2 s":"12 s"].rotated(angle_deg=30)
both = ss.run(tank, pair)
orbit = both.plot.orbit()
lines = [line.get_label() for line in both.plot.history().lines]
assert "along x" in lines and "along y" in lines
resultant, along_y = both.plot.history(along="resultant"), both.plot.loop(along="y")

# A structure by its modes, of an eigenvalue analysis or of parts: its points go by their names.
by_modes = ss.Model.from_modes(
    np.eye(2), [12.0, 30.0], 0.03, [100e3, 80e3], block=ss.Block(mass="300 t"),
    slider=ss.Slider(static_friction=0.06, kinetic_friction=0.05, radius=2.0), points={"Deck": 0, "Roof": 1},
)
tower = ss.Model(
    block=ss.Block(mass="300 t"),
    slider=ss.Slider(static_friction=0.06, kinetic_friction=0.05, radius=2.0),
    structure=ss.Structure(mass="200 t", mode=[ss.Mode(period=0.5, effective_mass_ratio=0.9, damping_ratio=0.02)]),
)
points = ss.run(by_modes, taft).plot.displacement()
assert [line.get_label() for line in points.lines] == ["Deck", "Roof"] and ss.run(tower, taft).holds

# A suite, scaled once: the same records in every call.
records = ss.Suite({"021": taft, "111": ss.read_record(y, units="g", dt=0.01)["2 s":"12 s"]}, scale_to="0.3 g")
light = ss.suite(tank, records, check=False, progress=False)
done: list[int] = []
found = ss.suite(tank, records, progress=lambda runs, planned: done.append(runs))
peaks = pl.DataFrame(found.table)["peak_sliding_displacement_m"]
assert peaks.to_list() == light.table["peak_sliding_displacement_m"].tolist() and done
