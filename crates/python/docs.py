"""Prints the book's page on the package, from its docstrings: `cargo xtask python-docs`."""

import inspect
import re
import sys
from collections.abc import Iterator
from functools import cached_property
from types import ModuleType
from typing import Any

import slipstick as ss
import slipstick.dask
from slipstick import _parts
from slipstick._plot import Plotter

PARTS: list[tuple[str, list[tuple[str, Any]]]] = [
    (
        "Models and motions",
        [
            (f"slipstick.{name}", getattr(ss, name))
            for name in ["Model", "Motion", "read_record", "read_channels", "read_suite", "schema", "units"]
        ],
    ),
    (
        "Tables of a model",
        [(f"slipstick.{name}", cls) for name, cls in vars(_parts).items() if name in ss.__all__],
    ),
    (
        "One analysis",
        [
            ("slipstick.run", ss.run),
            ("slipstick.Response", ss.Response),
            ("Response.plot", Plotter),
            ("slipstick.Event", ss.Event),
            ("slipstick.Events", ss.Events),
        ],
    ),
    (
        "Studies",
        [
            ("slipstick.demands", ss.demands),
            ("slipstick.study", ss.study),
            ("slipstick.Plan", ss.Plan),
            ("slipstick.Study", ss.Study),
            ("slipstick.dask.run_study", slipstick.dask.run_study),
            ("slipstick.dask.submit_study", slipstick.dask.submit_study),
        ],
    ),
    (
        "Suites of records",
        [
            (f"slipstick.{name}", getattr(ss, name))
            for name in ["Suite", "suite", "spectrum", "sensitivity", "ida", "fragility", "design", "Assessment", "Sensitivity"]
        ],
    ),
    (
        "Tests of a laboratory",
        [
            ("slipstick.compare", ss.compare),
            ("slipstick.Comparison", ss.Comparison),
            ("slipstick.identify.cyclic", ss.identify.cyclic),
            ("slipstick.identify.free_vibration", ss.identify.free_vibration),
            ("slipstick.identify.shaking_table", ss.identify.shaking_table),
            ("slipstick.Identified", ss.Identified),
            ("slipstick.Estimate", ss.Estimate),
        ],
    ),
    (
        "Other programs",
        [
            ("slipstick.audit.regularisation", ss.audit.regularisation),
            ("slipstick.audit.Regularisation", ss.audit.Regularisation),
            ("slipstick.audit.Attempt", ss.audit.Attempt),
        ],
    ),
    ("The page in a notebook", [("slipstick.widget", ss.widget)]),
    ("Tables", [("slipstick.Table", ss.Table)]),
    (
        "Errors",
        [
            (f"slipstick.{name}", getattr(ss, name))
            for name in ["InputError", "RecordError", "SlipstickWarning", "SolveError", "StudyError"]
        ],
    ),
]

HEAD = """\
<!-- Written by `cargo xtask python-docs --write` from the docstrings. -->

# Python: reference

Everything that `import slipstick as ss` gives; [Python](python.md) shows it at work. Values are in SI; a number with a
dimension is text with its unit unless the argument's name ends in one.
"""


def signature(value: Any) -> str:
    """Names and defaults, without types."""
    try:
        given = inspect.signature(value)
    except (TypeError, ValueError):
        return ""
    bare = [p.replace(annotation=inspect.Parameter.empty) for p in given.parameters.values()]
    bare = [p for p in bare if p.name not in ("self", "cls")]
    text = str(inspect.Signature(bare))
    return re.sub(r"<factory>|\{\}", "{}", text)


def markdown(text: str) -> str:
    """A docstring in NumPy's style as Markdown."""
    lines, out = text.split("\n"), []
    at = 0
    listing = False
    while at < len(lines):
        line = lines[at]
        if at + 1 < len(lines) and line and re.fullmatch(r"-{3,}", lines[at + 1].strip()):
            out += [f"**{line.strip()}**", ""]
            listing = line.strip() != "Examples"
            at += 2
            continue
        if line.startswith(">>>"):
            block = []
            while at < len(lines) and lines[at].strip():
                block.append(lines[at])
                at += 1
            out += ["```python", *block, "```"]
            continue
        if listing and line.strip() and not line.startswith(" "):
            names = ", ".join(f"`{name}`" for name in line.partition(" : ")[0].split(", "))
            told = []
            at += 1
            while at < len(lines) and (lines[at].startswith(" ") or not lines[at].strip()):
                told.append(lines[at].strip())
                at += 1
            out.append(f"- {names}: {' '.join(word for word in told if word)}".rstrip(": "))
            if told and not told[-1]:
                out.append("")
            continue
        out.append(line)
        at += 1
    return re.sub("(?<!`)``(?!`)", "`", "\n".join(out)).strip()


def first(text: str | None) -> str:
    """The first paragraph in one line."""
    return " ".join((text or "").split("\n\n")[0].split()).replace("``", "`")


def fields(cls: type) -> Iterator[tuple[str, str]]:
    """Fields of a record with the comments that stand above them."""
    told: list[str] = []
    for line in inspect.getsource(cls).splitlines():
        stripped = line.strip()
        if stripped.startswith("#:"):
            told.append(stripped[2:].strip())
        elif match := re.match(r"    (\w+): ", line):
            if told:
                yield match[1], " ".join(told).replace("``", "`")
            told = []


def members(cls: type) -> Iterator[str]:
    """Attributes in a list, then methods."""
    names = [name for name in dict.fromkeys(n for c in reversed(cls.__mro__) for n in vars(c))]
    public = [name for name in names if not name.startswith("_") or (name == "__call__" and cls is Plotter)]
    values, methods = [], []
    inherited = set(dir(tuple)) | set(dir(Exception)) | set(dir(dict))
    for name in public:
        value = inspect.getattr_static(cls, name)
        if name in inherited or name in getattr(cls, "_fields", ()):
            continue
        is_value = isinstance(value, (property, cached_property))
        if not is_value and inspect.isroutine(getattr(cls, name)):
            methods.append(name)
        elif doc := first(getattr(value, "__doc__", "")):
            values.append(f"- `{name}`: {doc}")
    # The extension lists its attributes in any order.
    if any(inspect.isgetsetdescriptor(inspect.getattr_static(cls, name)) for name in public):
        values.sort()
    if hasattr(cls, "_fields") or hasattr(cls, "__dataclass_fields__"):
        values = [f"- `{name}`: {told}" for name, told in fields(cls)] + values
    if values:
        yield "**Attributes**\n\n" + "\n".join(values)
    for name in methods:
        method = getattr(cls, name)
        doc = inspect.getdoc(method)
        if doc:
            shown = "plot" if name == "__call__" else f"{cls.__name__}.{name}"
            shown = shown.replace("Plotter.", "plot.")
            yield f"#### `{shown}{signature(method)}`\n\n{markdown(doc)}"


def entry(name: str, value: Any) -> Iterator[str]:
    is_error = inspect.isclass(value) and issubclass(value, Exception)
    given = "" if is_error or value is Plotter or hasattr(value, "_fields") else signature(value)
    made = {"Response", "Assessment", "Sensitivity", "Comparison", "Identified", "Events", "Regularisation", "Attempt"}
    if inspect.isclass(value) and value.__name__ in made:
        given = ""
    yield f"### `{name}{given}`\n\n{markdown(inspect.getdoc(value) or '')}"
    if inspect.isclass(value) and not is_error:
        yield from members(value)


def undocumented(module: ModuleType) -> list[str]:
    shown = {name.rpartition(".")[2] for _, entries in PARTS for name, _ in entries}
    return [name for name in module.__all__ if name not in shown | {"__version__", "audit", "identify"}]


def page() -> str:
    blocks = [HEAD]
    for title, entries in PARTS:
        blocks.append(f"## {title}")
        for name, value in entries:
            blocks += entry(name, value)
    return "\n\n".join(block.strip() for block in blocks) + "\n"


if __name__ == "__main__":
    if missing := undocumented(ss):
        sys.exit(f"not in the book: {', '.join(missing)}")
    sys.stdout.reconfigure(encoding="utf-8")  # type: ignore[union-attr]
    print(page(), end="")
