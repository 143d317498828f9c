"""The workflows of a public forge, which nobody has run: they fit the schema of such files."""

import subprocess
import sys

import pytest

from support import ROOT

WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))


def test_workflows_fit_their_schema() -> None:
    pytest.importorskip("check_jsonschema")
    assert [path.stem for path in WORKFLOWS] == ["ci", "release"]
    words = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", "vendor.github-workflows"]
    ended = subprocess.run([*words, *map(str, WORKFLOWS)], capture_output=True, text=True)
    assert ended.returncode == 0, ended.stdout + ended.stderr
