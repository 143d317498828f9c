"""The analyses that every program is given: a sliding block, with or without a storey on it.

Quantities are SI. `sliding` is the displacement of the block minus that of the table.
"""

import math
import os
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

GRAVITY = 9.81
RECORD_G = 9.80665
ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Case:
    """One analysis. `ground` holds the table's acceleration at 0, dt, 2 dt, ... in m/s2."""

    name: str
    title: str
    block_kg: float
    floor_kg: float
    spring: float
    storey_spring: float
    storey_damper: float
    mu_static: float
    mu_kinetic: float
    dt: float
    ground: np.ndarray

    @property
    def rigid(self):
        return self.floor_kg == 0.0

    @property
    def normal_force(self):
        return (self.block_kg + self.floor_kg) * GRAVITY

    @property
    def static_limit(self):
        return self.mu_static * self.normal_force

    @property
    def kinetic_force(self):
        return self.mu_kinetic * self.normal_force

    def finer(self, parts):
        """Step and samples of the same polyline, each interval cut into equal parts."""
        whole = np.arange(len(self.ground))
        cut = np.arange((len(self.ground) - 1) * parts + 1) / parts
        return self.dt / parts, np.interp(cut, whole, self.ground)

    def with_static_as_kinetic(self):
        """What a program without a static coefficient solves."""
        values = {**self.__dict__, "mu_static": self.mu_kinetic}
        return Case(**values)

    def to_file(self, path):
        """The form that the example `peer_bench` reads: little-endian doubles."""
        head = [
            self.block_kg, self.floor_kg, self.spring, self.storey_spring, self.storey_damper,
            self.mu_static, self.mu_kinetic, GRAVITY, self.dt,
        ]
        np.concatenate([head, self.ground]).astype("<f8").tofile(path)


def storey(mass_kg, frequency_hz, damping_ratio):
    """Spring and damper of a storey from its frequency on a fixed base."""
    rate = 2.0 * math.pi * frequency_hz
    return mass_kg * rate * rate, 2.0 * damping_ratio * mass_kg * rate


def sine(amplitude, frequency_hz, duration_s, dt):
    count = round(duration_s / dt) + 1
    return amplitude * np.sin(2.0 * math.pi * frequency_hz * np.arange(count) * dt)


def scaled(ground, peak_g):
    return ground * (peak_g * RECORD_G / np.abs(ground).max())


def read_record(path):
    """Time step in s and values of a PEER AT2 file, or of one column at 0.01 s."""
    text = path.read_text(errors="replace")
    header = re.search(r"NPTS\s*=\s*(\d+)\s*,\s*DT\s*=\s*([0-9.Ee+-]+)", text)
    if header:
        dt, body = float(header.group(2)), text[header.end():].split("\n", 1)[1]
        return dt, np.array(body.split()[: int(header.group(1))], float)
    lines = (line.strip() for line in text.split("\n"))
    return 0.01, np.array([line for line in lines if line and line[0] not in "#%"], float)


def records_folder():
    for place in (os.environ.get("SLIPSTICK_RECORDS"), ROOT.parent / "shared" / "records"):
        if place and Path(place, "motions").is_dir():
            return Path(place, "motions")
    return None


def taft():
    """Kern County 1952, Taft, in g at 0.01 s: beside the examples, else in the folder."""
    places = [ROOT / "examples" / "records" / "taft-111.txt"]
    if records_folder():
        places.append(records_folder() / "kern_1952_taft" / "TAF-111.txt")
    for place in places:
        if place.is_file():
            return read_record(place)
    raise SystemExit(f"bench-peers: expected the Taft record at {places[0]}")


def pendulum(name, title, dt, ground, radius_m, mu_static, mu_kinetic):
    k, c = storey(201.0, 2.15, 0.01)
    spring = (325.0 + 201.0) * GRAVITY / radius_m
    return Case(name, title, 325.0, 201.0, spring, k, c, mu_static, mu_kinetic, dt, ground)


def named_cases():
    """The paper's mock-ups on sines, and on an earthquake record with and without a spring."""
    dt, values = taft()
    ground = scaled(values, 0.3)
    k_a, c_a = storey(45.0, 1.625, 0.01)
    k_b, c_b = storey(201.0, 2.687, 0.01)
    k_c, c_c = storey(201.0, 2.15, 0.01)
    return [
        Case("A", "sine 0.5 m/s², 1 Hz, 45 kg on 325 kg", 325.0, 45.0, 0.0, k_a, c_a,
             0.020, 0.012, 0.005, sine(0.5, 1.0, 40.0, 0.005)),
        Case("B", "sine 1.5 m/s², 2.984 Hz, 201 kg on 325 kg", 325.0, 201.0, 0.0, k_b, c_b,
             0.020, 0.012, 0.005, sine(1.5, 2.984, 40.0, 0.005)),
        Case("C1", "Taft at 0.3 g, spring 143 kN/m", 325.0, 201.0, 143e3, k_c, c_c,
             0.16, 0.14, dt, ground),
        Case("C0", "Taft at 0.3 g, no spring", 325.0, 201.0, 0.0, k_c, c_c, 0.16, 0.14, dt, ground),
        Case("D", "Taft at 0.3 g, rigid block", 325.0, 0.0, 0.0, 0.0, 0.0, 0.15, 0.15, dt, ground),
        pendulum("E", "Taft at 0.3 g, pendulum 2 m, μ .06/.05", dt, ground, 2.0, 0.06, 0.05),
        pendulum("F", "Taft at 0.3 g, pendulum 2 m, μ .025/.02", dt, ground, 2.0, 0.025, 0.02),
    ]


def far_field_cases():
    """Case E under every far-field record at 0.3 g, where the folder of records is at hand."""
    folder = records_folder()
    if folder is None:
        return []
    cases = []
    for path in sorted((folder / "fema_p695_far_field").glob("*.AT2")):
        dt, values = read_record(path)
        cases.append(pendulum(path.stem, path.stem, dt, scaled(values, 0.3), 2.0, 0.06, 0.05))
    return cases
