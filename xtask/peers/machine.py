"""Where a benchmark ran, in words, and notes to the person who waits for it."""

import os
import platform
import sys
from importlib.metadata import version
from pathlib import Path


def machine(*programs):
    """System, processor, cores, and versions of Python and some programs."""
    model = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.is_file():
        names = [line.split(":")[1].strip() for line in info.read_text().split("\n")
                 if line.startswith("model name")]
        model = names[0] if names else model
    versions = ", ".join(f"{name} {version(name)}" for name in programs)
    return (f"{platform.system()}, {model}, {os.cpu_count()} cores, "
            f"Python {platform.python_version()}, {versions}")


def note(text):
    print(text, file=sys.stderr, flush=True)
