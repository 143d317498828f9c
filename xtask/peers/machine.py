"""Where a benchmark ran, in words, notes to the person who waits for it, and the process it times."""

import os
import platform
import subprocess
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


class Process:
    """One of the examples of the library, told over a pipe what to do."""

    def __init__(self, program):
        self.process = subprocess.Popen(
            program if isinstance(program, list) else [program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def ask(self, *words):
        """The words of its answer."""
        self.process.stdin.write(" ".join(map(str, words)) + "\n")
        self.process.stdin.flush()
        return self.process.stdout.readline().split()
