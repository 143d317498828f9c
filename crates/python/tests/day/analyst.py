"""The day of a risk analyst: records, designs and intensities by the thousand, and fragilities of them.

It is run with the folder of the examples.
"""

import sys
from pathlib import Path

import numpy as np
import polars as pl

import slipstick as ss

examples = Path(sys.argv[1])
model = ss.Model(
    block=ss.Block(mass="325 t"),
    slider=ss.Slider(static_friction=0.06, kinetic_friction=0.05, radius="2 m"),
)
taft, other = (
    ss.read_record(examples / "records" / f"taft-{angle}.txt", units="g", dt=0.01)["3 s":"9 s"] for angle in ("021", "111")
)
records = {"021": taft, "111": other}

# Values in every form, and motions in every form, in every call.
radii = pl.DataFrame({"slider.radius": [1.0, 2.0, 3.0], "block.mass": [3e5, 3.2e5, 3.4e5]})
for varied in ({"slider.radius": np.linspace(1.0, 3.0, 3)}, {"slider.radius": radii["slider.radius"]},
               {"slider.radius": ["1 m", 2.0, "3000 mm"]}, radii):
    designs: ss.Table = ss.demands(model, taft, varied)
    assert len(designs) == 3
# Each design has an intensity of its own.
designs = ss.demands(model, [taft, other], radii, measure="PGA", scale_to=["0.1 g", 2.0, 3.0])
doubled = ss.demands(model, records, radii, scale=[1.0, 1.5, 2.0])
assert len(designs) == len(doubled) == 6

# The same words everywhere: records, vary, scale_to.
suite = ss.Suite(records, scale_to="0.3 g")
spectrum = ss.spectrum(model, suite, {"slider.radius": radii["slider.radius"]}, vary={"slider.kinetic_friction": [0.04, 0.05]})
front = ss.design(model, suite, vary={"slider.radius": [1.0, 2.0, 3.0]}, gap=0.3, sensitivity=0, friction_factors=(0.9, 1.1))
plan = ss.Plan(model, records, vary={"slider.radius": [1.0, 2.0]}, scale_to=["0.2 g", "0.3 g"])
study = ss.study(plan, "study")
again = ss.Study.read("study")
assert study.runs == again.runs == 8 and study.failures == 0 and set(study.made_of) >= {"model", "record 021"}

# Figures: one colour a record, of twelve too.
twelve = {f"{taft.pga_m_per_s2 * factor:.2f}": taft.scaled(factor) for factor in np.linspace(0.5, 1.6, 12)}
many = ss.study(ss.Plan(model, twelve, {"slider.radius": [1.0, 2.0]}))
lines = many.plot("slider.radius", by="record", marker="o").lines
assert len({line.get_color() for line in lines}) == 12
drawn = [spectrum.plot(), front.plot(), study.plot(), many.table.plot("slider.radius", "peak_sliding_displacement_m")]

# Incremental dynamic analysis, and fragilities of it and of one's own counts and capacities.
ida = ss.ida(model, records, scale_to=np.linspace(4.0, 7.0, 7), limit="140 mm")
curve = ss.fragility(ida)
counted = ss.fragility(levels=["0.1 g", "0.2 g", "0.3 g", "0.4 g"], exceeded=[1, 4, 9, 14], runs=20, measure="PGA")
reached = ss.fragility(capacities=np.array([1.0, 2.0, 2.5, 4.0]), reached=[True, True, True, False], measure="PGA")
medians = [result.summary["median"] for result in (curve, counted, reached)]
assert all(median > 0.0 for median in medians) and counted.plot().get_xlabel() == "PGA (g)"

# Results are tables of every library, and do not change.
frame = pl.DataFrame(study.table)
units = dict(study.table.units)
assert units["block.peak_acceleration_m_per_s2"] == "m/s²" and frame.height == 8
try:
    ida.table["level"][0] = 0.0
except ValueError:
    pass
else:
    raise AssertionError("a result was written to")

# What cannot be is told in one's own words, with the nearest that there is.
told: list[str] = []
for wrong in (
    lambda: ss.demands(model, taft, {"slider.raduis": [1.0]}),
    lambda: ss.suite(model, "records/taft.txt"),  # type: ignore[arg-type]
    lambda: ss.fragility({"level": [0.1], "exceded": [1], "runs": [4]}, measure="PGA", units="g"),
    lambda: ss.demands(model, taft, {"block.mass": [1.0, float("nan")]}),
    lambda: ss.Plan(model, records, {"slider.radius": {"uniform": [1.0, 2.0]}}),
):
    try:
        wrong()
    except ss.InputError as error:
        told.append(str(error))
assert len(told) == 5 and 'nearest is "slider.radius"' in told[0] and 'nearest is "exceeded"' in told[2]
