"""Motions as streams of ObsPy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._request import wrong

if TYPE_CHECKING:
    from ._core import Motion

__all__ = ["stream"]


def stream(motion: Motion) -> Any:
    """A trace for each component, in m/s²."""
    if motion.dt_s is None:
        raise wrong("to_obspy", "even samples (motion.resample gives them)", "uneven ones")
    try:
        from obspy import Stream, Trace
    except ImportError as error:
        raise ImportError("to_obspy needs the package obspy: pip install obspy") from error
    traces = []
    for name, component in motion.components.items():
        origin = component.origin
        header = {"delta": component.dt_s, "channel": origin["component"] or name}
        if origin["station"]:
            header["station"] = origin["station"]
        traces.append(Trace(component.acceleration_m_per_s2, header=header))
    return Stream(traces)
