"""Runs the notebooks of the examples and writes them as pages of the book: `cargo xtask notebooks`.

Texts stand in the pages, drawings beside the other figures of the book, which are drawn anew for every build of it.
"""

import base64
import re
import sys
from pathlib import Path
from typing import Any

import nbclient
import nbformat

ROOT = Path(__file__).resolve().parents[2]
PAGES = ROOT / "book/src/notebooks"
FIGURES = ROOT / "book/src/figures/notebooks"
NOTE = "<!-- Written by `cargo xtask notebooks`. -->\n"

#: Drawn as text that is the same on every run
START = """\
import matplotlib_inline.backend_inline as inline
inline.set_matplotlib_formats("svg")
import matplotlib
matplotlib.rcParams.update({"svg.hashsalt": "slipstick", "svg.fonttype": "none"})
"""


def run(path: Path) -> Any:
    notebook = nbformat.read(path, as_version=4)
    notebook.cells.insert(0, nbformat.v4.new_code_cell(START))
    folder = {"metadata": {"path": str(path.parent)}}
    nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3", resources=folder).execute()
    notebook.cells.pop(0)
    return notebook


def text_of(data: Any) -> str:
    return "".join(data) if isinstance(data, list) else str(data)


def page(path: Path) -> str:
    out = [NOTE]
    drawn = 0
    for cell in run(path).cells:
        if cell.cell_type == "markdown":
            out.append(cell.source)
            continue
        out.append(f"```python\n{cell.source}\n```")
        for output in cell.outputs:
            data = output.get("data", {})
            if output.output_type == "stream":
                if output.name == "stdout":
                    out.append(f"```text\n{text_of(output.text).rstrip()}\n```")
                continue
            svg = data.get("image/svg+xml")
            html = text_of(data.get("text/html", ""))
            if svg is None and html.count("<svg") == 1:
                svg = html[html.index("<svg") : html.index("</svg>") + 6]
            if svg is not None or "image/png" in data:
                drawn += 1
                name = f"{path.stem}-{drawn}.{'svg' if svg is not None else 'png'}"
                content = text_of(svg).encode() if svg is not None else base64.b64decode(text_of(data["image/png"]))
                # The date of the drawing says nothing.
                (FIGURES / name).write_bytes(re.sub(rb"<dc:date>.*?</dc:date>", b"", content))
                out.append(f"![Figure {drawn} of this notebook](../figures/notebooks/{name})")
            elif "text/plain" in data:
                out.append(f"```text\n{text_of(data['text/plain']).rstrip()}\n```")
    name = path.name
    out.append(f"This page is the notebook `examples/notebooks/{name}` as it ran.")
    return "\n\n".join(out) + "\n"


def main() -> None:
    PAGES.mkdir(exist_ok=True)
    FIGURES.mkdir(parents=True, exist_ok=True)
    for path in sorted((ROOT / "examples/notebooks").glob("*.ipynb")):
        if sys.argv[1:] and path.stem not in sys.argv[1:]:
            continue
        (PAGES / f"{path.stem}.md").write_text(page(path), encoding="utf-8", newline="\n")
        print(f"wrote book/src/notebooks/{path.stem}.md", file=sys.stderr)


if __name__ == "__main__":
    main()
