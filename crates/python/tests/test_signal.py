"""Motions as signals: the figures of `slipstick record`, bit for bit."""

import csv
import io
import json
from pathlib import Path

import numpy as np
import pytest

import slipstick as ss
from support import EXAMPLES, command, pulse

TAFT = EXAMPLES / "records" / "taft-111.txt"
TOLD = ["--units", "g", "--dt", "0.01 s"]


def taft() -> ss.Motion:
    return ss.read_record(TAFT, units="g", dt=0.01)


def pair() -> ss.Motion:
    """Both components as far as both are recorded, so that the samples stay even."""
    x, y = taft(), ss.read_record(EXAMPLES / "records" / "taft-021.txt", units="g", dt=0.01)
    return ss.Motion(x.acceleration_m_per_s2, y=y.acceleration_m_per_s2[: len(x)], dt=0.01, units="m/s2")


def columns(text: str) -> dict[str, list[str]]:
    head, *rows = csv.reader(io.StringIO(text))
    return dict(zip(head, map(list, zip(*rows, strict=True)), strict=True))


def test_measures_are_those_of_the_command() -> None:
    [info] = json.loads(command("record", "info", TAFT, *TOLD, "--json"))
    found = taft().measures()
    assert len(found) == 15 and found == {key: info[key] for key in found}
    named = taft().measures("Sa(1.2 s)", "Sa_avg(0.5 s, 3 s)")
    assert named["Sa(1.2 s)"] == taft().spectrum("1.2 s")["sa_m_per_s2"][0]
    of_pair = pair().measures("RotD50(1 s)", "PGA")
    assert of_pair["x"] == found and of_pair["RotD50(1 s)"] > 0.0
    assert of_pair["PGA"] == np.sqrt(of_pair["x"]["pga_m_per_s2"] * of_pair["y"]["pga_m_per_s2"])
    with pytest.raises(ss.InputError, match="^names: .*Sa"):
        taft().measures("Sb(1 s)")
    with pytest.raises(ss.InputError, match="^names: expected a motion in two horizontal directions"):
        taft().measures("RotD50(1 s)")


def test_spectra_are_those_of_the_command() -> None:
    told = columns(command("record", "spectrum", TAFT, *TOLD, "--damping", "5 %", "--damping", "0.02"))
    found = taft().spectrum(damping=["5 %", 0.02])
    assert list(found) == [name for name in told if name not in ("file", "channel")]
    for name in found:
        assert found[name].tolist() == [float(cell) for cell in told[name]]
    assert found.units["sa_m_per_s2"] == "m/s²" and len(found.to_pandas()) == 400
    told = columns(command("record", "spectrum", TAFT, *TOLD, "--fourier"))
    found = taft().fourier()
    for name in found:
        assert found[name].tolist() == [float(cell) for cell in told[name]]
    with pytest.raises(ss.InputError, match="^spectrum: expected a motion in one direction"):
        pair().spectrum()
    with pytest.raises(ss.InputError, match="^damping: "):
        taft().spectrum(damping=1.5)
    with pytest.raises(ss.InputError, match="^periods: "):
        taft().spectrum(-1.0)


def test_processing_is_that_of_the_command() -> None:
    steps = ["remove linear", "band-pass 0.1 Hz 25 Hz order 3", "taper 5 %", "trim 2 s 30 s", "resample 0.02 s"]
    asked = [word for step in steps for word in ("--step", step)]
    told = command("record", "process", TAFT, *TOLD, *asked, "-q")
    told = columns(told.partition("\n")[2])
    found = taft().processed(*steps)
    assert found.acceleration_m_per_s2.tolist() == [float(cell) for cell in told["acceleration_m_per_s2"]]
    assert found.time_s.tolist() == [float(cell) for cell in told["time_s"]]
    one_by_one = taft().baseline().filter(high_pass=0.1, low_pass="25 Hz", order=3).processed("taper 5 %")
    assert one_by_one["2 s":30.0].resample("0.02 s") == found  # type: ignore[misc]
    assert "band-pass 0.1 Hz 25 Hz order 3" in found.description
    both = pair().filter(low_pass=10)
    assert both.components["x"].acceleration_m_per_s2.tolist() == taft().filter(low_pass=10).acceleration_m_per_s2.tolist()
    assert both.acceleration_y_m_per_s2 is not None


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda m: m.processed("smooth"), "^steps: expected one of"),
        (lambda m: m.processed("to velocity"), "^steps: expected steps that end in acceleration"),
        (lambda m: m.filter(), "^high_pass: expected a corner, or low_pass, found neither"),
        (lambda m: m.filter(low_pass="60 Hz"), "^low_pass: "),
        (lambda m: m["30 s":"2 s"], "^time: "),
        (lambda m: m[-1.0], "^time: expected a time from 0 to"),
        (lambda m: m["0.1 g"], "^time: "),
        (lambda m: m.scaled(spectrum="sds = 1 g, sd1 = 0.6 g, tl = 8 s"), "^periods: expected the range"),
        (lambda m: m.scaled(periods="1 s..2 s"), "^periods: expected a spectrum"),
        (lambda m: m.write("a.xyz"), r"^path: expected a name that ends in .csv"),
    ],
)
def test_what_cannot_be_done_is_told(call: object, told: str) -> None:
    with pytest.raises(ss.InputError, match=told):
        call(taft())  # type: ignore[operator]


def test_a_motion_is_indexed_by_sample_and_by_time() -> None:
    motion = ss.Motion([0.0, 1.0, 3.0, 0.0], dt=0.5, units="m/s2")
    assert (motion[0.5], motion["0.75 s"], motion[1.5]) == (1.0, 2.0, 0.0)
    assert (motion[1], motion[-2], motion[np.int64(2)]) == (1.0, 3.0, 3.0)
    assert (motion.at(1), motion.at("0.75 s"), motion.at(np.float64(0.5))) == (3.0, 2.0, 1.0)
    for key in (4, -5, 10**30):
        with pytest.raises(IndexError, match=f"^sample: expected a sample from 0 to 3 .*found {key}|found 9"):
            motion[key]
    part = motion[0.5:]
    assert part.acceleration_m_per_s2.tolist() == [1.0, 3.0, 0.0] and part.time_s[0] == 0.0
    assert motion[1:] == part and motion[1:4] == part and motion[:-1].acceleration_m_per_s2.tolist() == [0.0, 1.0, 3.0]
    jump = ss.Motion([0.0, 1.0, 3.0, 0.0], times_s=[0.0, 1.0, 1.0, 2.0], units="m/s2")
    assert jump[1.0] == 3.0 and [jump[i] for i in range(4)] == [0.0, 1.0, 3.0, 0.0]
    assert jump[:2].acceleration_m_per_s2.tolist() == [0.0, 1.0] and jump[2:].acceleration_m_per_s2.tolist() == [3.0, 0.0]
    for wrong, told in [
        (lambda: motion[1:"1 s"], "^slice: expected two samples, or two times"),  # type: ignore[misc]
        (lambda: motion[3:1], "^slice: expected two samples or more"),
        (lambda: motion[::2], "^step: "),
        (lambda: motion[True], "^time: "),
        (lambda: motion.at("9 s"), "^time: expected a time from 0 to 1.5 s"),
    ]:
        with pytest.raises(ss.InputError, match=told):
            wrong()
    assert motion.velocity_m_per_s.tolist() == [0.0, 0.25, 1.25, 2.0]
    assert motion.displacement_m[0] == 0.0


def test_a_motion_is_an_array_of_its_samples() -> None:
    motion = ss.Motion([0.0, 1.0, 3.0, 0.0], dt=0.5, units="m/s2")
    array = np.asarray(motion)
    assert array.dtype == np.float64 and array.tolist() == list(motion) == motion.acceleration_m_per_s2.tolist()
    assert np.asarray(motion, dtype="f4").dtype == np.float32 and np.abs(motion).max() == 3.0
    assert ss.Motion(motion, dt=0.5, units="m/s2") == motion
    with pytest.raises(ss.InputError, match="^array: expected a motion in one direction"):
        np.asarray(pair())
    upwards = ss.Motion([0.0, 1.0], vertical=[0.0, 1.0], dt=0.5, units="m/s2")
    with pytest.raises(ss.InputError, match="^array: expected a motion without a vertical component"):
        list(upwards)


@pytest.mark.parametrize("ending", ["csv", "AT2", "smc", "parquet"])
def test_files_are_those_of_the_command(tmp_path: Path, ending: str) -> None:
    told, written = tmp_path / f"told.{ending}", tmp_path / f"written.{ending}"
    command("record", "convert", TAFT, *TOLD, told)
    assert taft().write(written) == written
    assert written.read_bytes() == told.read_bytes()
    # A table of Parquet is no record's format.
    if ending != "parquet":
        again = ss.read_record(written)
        assert ending != "csv" or again == taft()
    with pytest.raises(ss.InputError, match="^write: expected a motion in one direction"):
        pair().write(tmp_path / f"pair.{ending}")
    pair().components["y"].write(written)


def test_uneven_samples_are_no_at2(tmp_path: Path) -> None:
    uneven = ss.Motion([0.0, 1.0, 0.0], times_s=[0.0, 0.1, 0.5], units="m/s2")
    with pytest.raises(ss.RecordError):
        uneven.write(tmp_path / "a.AT2")
    assert not list(tmp_path.iterdir())


def test_all_channels_of_a_file(tmp_path: Path) -> None:
    path = tmp_path / "three.csv"
    path.write_text("time [s], a [g], b [g]\n0, 0, 1\n0.1, 1, 0\n0.2, 0, 0\n")
    found = ss.read_channels(path)
    assert [motion.pga_m_per_s2 for motion in found.values()] == [9.80665, 9.80665]
    for number, (name, motion) in enumerate(found.items(), 1):
        assert motion == ss.read_record(path, channel=name) == ss.read_record(path, channel=number)
    for wrong in (0, -1, True, 1.0):
        with pytest.raises(ss.InputError, match="^channel: expected the name of a channel, or its number from 1"):
            ss.read_record(path, channel=wrong)  # type: ignore[arg-type]


def test_a_motion_is_brought_to_a_spectrum() -> None:
    code = "sds = 1.2 g, sd1 = 0.8 g, tl = 8 s"
    scaled = taft().scaled(spectrum=code, periods="0.6 s..3.8 s")
    periods = np.geomspace(0.6, 3.8, 50)
    target = np.where(periods <= 0.8 / 1.2, 1.2 * 9.80665, 0.8 * 9.80665 / periods)
    ratio = np.log(scaled.spectrum(periods)["psa_m_per_s2"] / target)
    assert abs(ratio.mean()) < 1e-12
    points = {"period_s": periods, "sa_m_per_s2": target}
    again = taft().scaled(spectrum=points, periods="0.6 s..3.8 s")
    assert again.factor == pytest.approx(scaled.factor, rel=1e-3)
    assert pair().scaled(spectrum=code, periods="0.6 s..3.8 s").factor < scaled.factor


def test_a_motion_is_drawn() -> None:
    pytest.importorskip("matplotlib").use("Agg")
    assert len(taft().plot()) == 3
    axes = pair().plot(color="k")[0]
    assert len(axes.lines) == 2 and axes.lines[0].get_color() == "k"
    assert pulse().plot(ax=axes) is axes


def test_a_motion_becomes_a_stream_of_obspy() -> None:
    pytest.importorskip("obspy")
    stream = pair().to_obspy()
    assert len(stream) == 2 and stream[0].stats.delta == 0.01
    assert ss.Motion.from_obspy(stream[0], units="m/s2") == taft()
    with pytest.raises(ss.InputError, match="^to_obspy: expected even samples"):
        ss.Motion([0.0, 1.0, 0.0], times_s=[0.0, 0.1, 0.5], units="m/s2").to_obspy()


def test_a_motion_comes_back_from_parquet(tmp_path: Path) -> None:
    motion = ss.read_record(EXAMPLES / "records" / "taft-111.txt", units="g", dt=0.01)
    read = ss.read_record(motion.write(tmp_path / "a.parquet"))
    assert read == motion and read.description.startswith("Parquet with 2 columns")
    uneven = ss.Motion([0.0, 0.2, 0.1, 0.0], times_s=[0.0, 0.1, 0.1, 0.4], units="g")
    assert ss.read_record(uneven.write(tmp_path / "b.parquet")) == uneven
    assert list(ss.read_channels(tmp_path / "b.parquet").values()) == [uneven]
    assert list(ss.read_suite(tmp_path / "*.parquet").values()) == [motion, uneven]
