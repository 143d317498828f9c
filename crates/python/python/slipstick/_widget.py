"""The page of Slipstick in a notebook."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ._core import Model, Motion

if TYPE_CHECKING:
    from os import PathLike

_BUNDLE = Path(__file__).with_name("page.js")
_OWN = "motion.csv"


def widget(model: Model | str | PathLike[str], motion: Motion | None = None) -> Any:
    """Show a model with sliders to drag, in Jupyter and wherever else anywidget works.

    All is computed in the browser. The widget's ``model`` is the model's text as it stands, its
    ``summary`` a dict of the main results; both follow what is done in it.

    Parameters
    ----------
    model
        A model, or the path of a model file.
    motion
        The ground motion; without it the model's own, whose record is read beside the model file.

    Raises
    ------
    ImportError
        Without the package ``anywidget``, and where the page was not built into this package.
    InputError
        Where the model cannot be understood.
    ValueError
        Where the model's motion is a record whose file is not known.
    """
    import base64

    try:
        import anywidget
        import traitlets
    except ImportError as error:
        message = "slipstick.widget needs the package anywidget: pip install anywidget"
        raise ImportError(message) from error
    if not _BUNDLE.is_file():
        message = f"{_BUNDLE.name}: expected the page, found none: build it with cargo xtask web"
        raise ImportError(message)
    folder = None
    if isinstance(model, Model):
        text = model.toml
    else:
        path = Path(model)
        # Refused here with its place, rather than in the window.
        Model.read(path)
        text, folder = path.read_text(encoding="utf-8"), path.parent
    files = {_OWN: _csv(motion).encode()} if motion is not None else _own_records(text, folder)
    records = {name: base64.b64encode(data).decode() for name, data in files.items()}

    class Widget(anywidget.AnyWidget):  # type: ignore[misc]
        _esm = _BUNDLE
        model = traitlets.Unicode().tag(sync=True)
        motion = traitlets.Unicode().tag(sync=True)
        records = traitlets.Dict().tag(sync=True)
        summary = traitlets.Dict().tag(sync=True)

    return Widget(model=text, motion="" if motion is None else _OWN, records=records, summary={})


def _csv(motion: Motion) -> str:
    """The motion as the CSV that needs no keys."""
    names = ["time_s", "acceleration_m_per_s2"]
    columns = [motion.time_s, motion.acceleration_m_per_s2]
    if (vertical := motion.vertical_m_per_s2) is not None:
        names.append("vertical_acceleration_m_per_s2")
        columns.append(vertical)
    rows = (",".join(map(repr, map(float, row))) for row in zip(*columns, strict=True))
    return "\n".join([",".join(names), *rows]) + "\n"


def _own_records(text: str, folder: Path | None) -> dict[str, bytes]:
    """The files of the model's own motion, by the names that it gives them."""
    import tomllib

    own = tomllib.loads(text).get("motion", {})
    names = [own[key] for key in ("record", "vertical") if key in own]
    if names and folder is None:
        message = f"motion: expected a Motion beside a model whose record is {names[0]!r}, found none"
        raise ValueError(message)
    return {name: (folder / name).read_bytes() for name in names if folder}
