"""Prints slipstick/_parts.py from the schema of the model file: `python crates/python/parts.py`."""

import json
import sys
import textwrap
from typing import Any

import slipstick as ss

#: Name, path of the table, what it is, keys without which there is none
PARTS = [
    ("Block", "block", "The rigid block that slides on the table."),
    ("Slider", "slider", "The bearing between table and block."),
    ("Stop", "slider.stop", "What the block strikes at the end of its travel: ``Slider(stop=...)``."),
    ("Surface", "slider.surface", "A sliding surface of several in series: ``Slider(surface=[...])``."),
    ("Storey", "storey", "A storey of the structure on the block."),
    ("Contents", "contents", "What stands unfastened on the block or on a floor and may slide there."),
    ("Frame", "frame", "What the storeys have in common."),
    ("Structure", "structure", "A structure by its modes, instead of storeys: ``Model(structure=...)``; ``Model.from_modes`` makes one of matrices."),
    ("Mode", "structure.mode", "A mode of a structure: ``Structure(mode=[...])``."),
    ("Point", "structure.point", "A point of a structure whose motion is wanted: ``Structure(point=[...])``."),
    ("Sine", "motion.sine", "A sine as the motion of a model: ``Model(motion=Sine(...))``."),
    ("Sweep", "motion.sweep", "A sine of changing frequency as the motion of a model."),
    ("Pulse", "motion.pulse", "A single pulse as the motion of a model."),
    ("Initial", "initial", "State at the start; each key replaces its own default."),
    ("Analysis", "analysis", "How the response is computed."),
]

HEAD = '''\
"""Tables of the model file as calls with keywords. Written by parts.py from the schema of the model file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, SupportsFloat

from ._part import Part, Quantity
'''


def table(schema: dict[str, Any], path: str) -> dict[str, Any]:
    for key in path.split("."):
        schema = schema["properties"][key]
        schema = schema.get("items", schema)
    return schema


def type_of(of: dict[str, Any]) -> str:
    kinds = [option for option in of.get("anyOf", [of])]
    types: list[str] = []
    for kind in kinds:
        if "enum" in kind:
            types.append(f"Literal[{', '.join(json.dumps(word) for word in kind['enum'])}]")
        elif kind.get("type") in ("number", "integer"):
            types.append({"number": "SupportsFloat", "integer": "int"}[kind["type"]])
        elif kind.get("type") == "object":
            types.append("Mapping[str, Any]")
        elif kind.get("type") == "array":
            types.append("Sequence[Any]")
        elif "pattern" in kind or kind.get("type") == "string":
            types.append("str")
    if "str" in types and "SupportsFloat" not in types and any("pattern" in kind for kind in kinds):
        types += ["Quantity", "SupportsFloat"]
    return " | ".join(dict.fromkeys(types)) or "Any"


def main() -> None:
    schema = ss.schema()
    out = [HEAD]
    for name, path, what in PARTS:
        of = table(schema, path)
        keys = of["properties"]
        argument = {key: "from_" if key == "from" else key for key in keys}
        lines = [f"class {name}(Part):", f'    """{what}', "", "    Parameters", "    ----------"]
        for key, told in keys.items():
            lines.append(f"    {argument[key]}")
            words = told.get("description", "").replace("[", "``").replace("]", "``")
            example = next((o["examples"][0] for o in told.get("anyOf", [told]) if "examples" in o), None)
            like = f"Such as ``{json.dumps(example, ensure_ascii=False)}``." if example else ""
            lines += textwrap.wrap(words, 108, initial_indent=" " * 8, subsequent_indent=" " * 8)
            if like:
                lines.append(f"        {like}")
        lines += ["", "    Raises", "    ------", "    InputError", "        For a value of another kind or unit.", '    """']
        lines += ["", f'    _PATH = "{path}"', "", "    def __init__(", "        self,", "        *,"]
        for key, told in keys.items():
            lines.append(f"        {argument[key]}: {type_of(told)} | None = None,")
        lines += ["    ) -> None:", "        super().__init__(locals())"]
        out.append("\n".join(lines) + "\n")
    sys.stdout.reconfigure(encoding="utf-8")  # type: ignore[union-attr]
    print("\n\n".join(text.rstrip() + "\n" for text in out), end="")


if __name__ == "__main__":
    main()
