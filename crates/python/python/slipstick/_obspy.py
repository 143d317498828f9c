"""Motions and streams of ObsPy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from . import _core
from ._request import wrong

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ._core import Motion

__all__ = ["Stream", "Trace", "is_stream", "motion", "motions", "stream"]


class Trace(Protocol):
    """A trace of ObsPy."""

    @property
    def data(self) -> Any: ...
    @property
    def stats(self) -> Any: ...


class Stream(Protocol):
    """A stream of ObsPy."""

    @property
    def traces(self) -> Sequence[Any]: ...


def is_stream(value: object) -> bool:
    """Whether a value is a trace or a stream of traces."""
    return hasattr(value, "traces") or (hasattr(value, "data") and hasattr(value, "stats"))


def stream(motion: Motion) -> Any:
    """A trace for each component, in m/s², with station, channel and start where the motion knows them."""
    if motion.dt_s is None:
        raise wrong("to_obspy", "even samples (motion.resample gives them)", "uneven ones")
    try:
        from obspy import Stream, Trace, UTCDateTime
    except ImportError as error:
        raise ImportError("to_obspy needs the package obspy: pip install obspy") from error
    of_all = motion.origin
    network, _, station = (of_all["station"] or "").rpartition(".")
    traces = []
    for name, component in motion.components.items():
        known = of_all.get("component_y") if name == "y" else component.origin["component"]
        header = {"delta": component.dt_s, "channel": known or name, "units": "m/s2"}
        header.update({key: text for key, text in (("network", network), ("station", station)) if text})
        if "start" in of_all:
            header["starttime"] = UTCDateTime(ns=int(of_all["start"].astype("int64")))
        traces.append(Trace(component.acceleration_m_per_s2, header=header))
    return Stream(traces)


def motion(given: Trace | Stream, units: str | None = None) -> Motion:
    """The motion of a trace, or of the components of one station."""
    if not is_stream(given):
        raise wrong("stream", "a trace or a stream of ObsPy", _core.described(given))
    traces = list(getattr(given, "traces", [given]))
    found = _by_station(traces)
    if len(found) != 1:
        raise wrong("stream", "the components of one station", f"{len(found)}: {', '.join(found) or 'none'}")
    return _joined(*found.popitem(), units)


def motions(given: Trace | Stream, units: str | None = None) -> dict[str, Motion]:
    """The motions of a stream by the stations of its traces."""
    found = _by_station(list(getattr(given, "traces", [given])))
    return {name: _joined(name, traces, units) for name, traces in found.items()}


def _said(trace: Trace, key: str) -> str:
    return str(getattr(trace.stats, key, "") or "")


def _by_station(traces: list[Trace]) -> dict[str, list[Trace]]:
    """Traces by network, station, place and instrument: components differ in the last letter of their channel."""
    found: dict[str, list[Trace]] = {}
    for number, trace in enumerate(traces, 1):
        place = ".".join(_said(trace, key) for key in ("network", "station", "location"))
        name = f"{place}.{_said(trace, 'channel')[:-1]}".strip(".")
        found.setdefault(name or (f"trace {number}" if len(traces) > 1 else "trace"), []).append(trace)
    return found


def _joined(name: str, traces: list[Trace], units: str | None) -> Motion:
    vertical = [len(traces) > 1 and _said(trace, "channel").upper().endswith("Z") for trace in traces]
    up = [trace for trace, is_up in zip(traces, vertical, strict=True) if is_up]
    level = [trace for trace, is_up in zip(traces, vertical, strict=True) if not is_up]
    if not level or len(level) > 2 or len(up) > 1:
        channels = ", ".join(_said(trace, "channel") or "unnamed" for trace in traces)
        raise wrong("stream", "at most two horizontal components and a vertical one a station", f"{channels} of {name}")
    first = level[0]
    for trace in [*level[1:], *up]:
        for key in ("delta", "starttime"):
            one, other = getattr(first.stats, key, None), getattr(trace.stats, key, None)
            if one != other:
                raise wrong("stream", f"components of {name} of one {key} (stream.trim cuts them)", f"{one} and {other}")
        if len(first.data) != len(trace.data):
            found = f"{len(first.data)} and {len(trace.data)} samples"
            raise wrong("stream", f"components of {name} of one length (stream.trim cuts them)", found)
    of_values = units if units is not None else getattr(first.stats, "units", None)
    if of_values is None:
        expected = 'units of the values, "m/s2", as an argument of Motion.from_obspy or in trace.stats.units'
        raise wrong("units", expected, "none")
    made = _core.Motion(
        first.data,
        y=level[1].data if len(level) > 1 else None,
        vertical=up[0].data if up else None,
        dt=first.stats.delta,
        units=of_values,
    )
    station = ".".join(text for key in ("network", "station") if (text := _said(first, key)))
    start = getattr(getattr(first.stats, "starttime", None), "ns", None)
    across = _said(level[1], "channel") or None if len(level) > 1 else None
    return made._recorded(station or None, _said(first, "channel") or None, start, across)
