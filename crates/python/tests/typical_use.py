"""What a user writes, for the checkers of types: test_types.py. It is not run."""

from pathlib import Path

import numpy as np

import slipstick as ss

model = ss.Model(
    name="Tank",
    block=ss.Block(mass="325 kg", width="2 m"),
    slider=ss.Slider(static_friction=0.06, kinetic_friction=np.float64(0.05), radius="2 m", gap="150 mm"),
    storey=[ss.Storey(mass="201 kg", frequency="2.15 Hz", damping_ratio=0.01)],
    motion=ss.Sine(frequency="1 Hz", amplitude="0.2 g", duration="5 s", dt="0.005 s"),
    analysis=ss.Analysis(tail="2 s"),
)
beside = ss.Model({"block.mass": "1 t", "slider": {"static_friction": 0.1, "kinetic_friction": 0.1}})
other = model.with_({"slider.radius": "3 m"}) if model != beside else ss.Model.example("mock-up")
radius: float | None = other.value("slider.radius")

taft = ss.read_record("taft.txt", units="g", dt=0.01).scaled(pga="0.3 g")
part: ss.Motion = taft["2 s":"30 s"].filter(high_pass=0.1)
at: float = taft.at("3.2 s") + taft[320]
samples = np.asarray(taft)
measures: dict[str, object] = taft.measures("Sa(1 s)")
sa = taft.spectrum([0.5, 1.0], damping=0.02)["sa_m_per_s2"]
path: Path = taft.write("taft.AT2")
channels: dict[str, ss.Motion] = ss.read_channels("three.v2")

response = ss.run(model, taft)
peak: float = response.summary["peak_sliding_displacement_m"]
holds: bool | None = response.holds
for event in response.events:
    print(event.time_s, event.kind, event.interface)
loop = response.plot.loop(color="k")
light: ss.Response = ss.run(model, taft, history=False, check=False)
frame = response.history.to_pandas()

response.save("folder")
again: ss.Response = ss.Response.read("folder")
in_si = ss.Model(block=ss.Block(mass=325), slider=ss.Slider(static_friction=0.06, kinetic_friction=0.05, radius=2.0))
by_modes = ss.Model.from_modes(np.eye(2), [10.0, 20.0], 0.03, [1e3, 1e3], block=ss.Block(mass=1e3), points={"Roof": 1})
structure = ss.Structure(mass=1e3, mode=[ss.Mode(period=0.5, effective_mass_ratio=0.9, damping_ratio=0.02)])

records = ss.read_suite(["*.AT2"])
scaled = ss.Suite(records, measure="PGV", scale_to="0.4 m/s")
listed: ss.Assessment = ss.suite(model, [taft, part])
several: ss.Assessment = ss.run(model, records)
table = ss.demands(model, records, {"slider.radius": np.linspace(1.0, 3.0, 5)})
numbers: list[str] = list(table)
each = ss.demands(model, taft, {"slider.radius": [1.0, 2.0]}, measure="PGA", scale_to=["0.1 g", 2.0])
spectrum = ss.spectrum(model, scaled, {"slider.radius": np.linspace(1.0, 3.0, 5)})
found: ss.Sensitivity = ss.sensitivity(model, taft, ["slider.radius"])
axes = found.plot(most=5)
counted = ss.fragility(levels=["0.1 g", "0.2 g"], exceeded=[1, 4], runs=20, measure="PGA")
reached = ss.fragility(capacities=np.array([1.0, 2.0, 4.0]), measure="Sa(1 s)")
curve = ss.fragility(ss.ida(model, records, scale_to="0.1..1 g:10", limit="150 mm"))
study = ss.study(ss.Plan(model, records, {"slider.radius": [1.0, 2.0]}, method="grid"), jobs=-1)
runs: int = study.runs + ss.Study.read("out").runs
keys: dict[str, object] = ss.schema()
known = ss.units()["unit"]
try:
    ss.Model({})
except ss.InputError as error:
    print(error.path, error.expected, error.nearest)
