"""The types of the package, as checkers of them see it."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import slipstick as ss

HERE = Path(__file__).resolve().parent
#: What users write: typical use of every part, and the scripts of a day
USE = [HERE / "typical_use.py", *sorted((HERE / "day").glob("*.py"))]
FAULTS = """\
import slipstick as ss
ss.typo
ss.Slider(static_fricton=0.1)
ss.Model({}).value(1)
ss.run(ss.Model({}), history=3)
"""


def test_mypy_is_content_with_typical_use(tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    faults = tmp_path / "faults.py"
    faults.write_text(FAULTS)

    words = [sys.executable, "-m", "mypy", "--strict", "--no-error-summary", "--cache-dir", str(tmp_path)]
    files = [*map(str, USE), str(faults)]
    told = subprocess.run([*words, *files], capture_output=True, text=True, cwd=tmp_path).stdout.splitlines()
    errors = [line for line in told if ": error:" in line]
    assert [line for line in errors if not line.startswith("faults.py:")] == []
    assert [line.split(":")[1] for line in errors] == ["2", "3", "4", "5"]


def test_pyright_is_content_with_package_and_typical_use(tmp_path: Path) -> None:
    pytest.importorskip("pyright")
    package = Path(ss.__file__).parent
    settings = tmp_path / "pyrightconfig.json"
    faults = tmp_path / "faults.py"
    faults.write_text(FAULTS)
    # It ignores paths that are not relative.
    files = [os.path.relpath(path, tmp_path) for path in (*USE, package / "_core.pyi", faults)]
    asked = {"include": files, "typeCheckingMode": "strict"}
    settings.write_text(json.dumps({**asked, "reportMissingTypeStubs": False, "reportUnknownMemberType": False}))
    words = [sys.executable, "-m", "pyright", "--outputjson", "--pythonpath", sys.executable, "--project", str(settings)]
    ended = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path)
    if not ended.stdout.lstrip().startswith("{"):
        pytest.skip(f"pyright does not run here: {(ended.stderr or ended.stdout).strip()[-200:]}")
    found = json.loads(ended.stdout)
    assert found["summary"]["filesAnalyzed"] == len(files)
    said = found["generalDiagnostics"]
    told = [(Path(d["file"]).name, d["range"]["start"]["line"] + 1, d["message"]) for d in said if d["severity"] == "error"]
    assert [one for one in told if one[0] != "faults.py"] == []
    assert sorted({line for name, line, _ in told if name == "faults.py"}) == [2, 3, 4, 5]
