"""Habits: what the linter, the formatter and the type checker say, each with the rules of pyproject.toml."""

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from tests.conftest import ROOT

BIN = Path(sys.executable).parent
COMMANDS = {
    "lint": ["ruff", "check", "--output-format", "concise", "--no-cache"],
    "format": ["ruff", "format", "--check", "--no-cache"],
    "types": ["pyrefly", "check", "--output-format", "min-text"],
}
REMEDY = {"lint": "ruff check --fix", "format": "ruff format", "types": "pyrefly check"}


def said(name: str, *paths: Path | str) -> subprocess.CompletedProcess[str]:
    """What a tool says of the project, or of some files."""
    program, *arguments = COMMANDS[name]
    return subprocess.run([BIN / program, *arguments, *paths], cwd=ROOT, capture_output=True, text=True)


@pytest.mark.parametrize("name", COMMANDS)
def test_the_project_is_clean(name):
    done = said(name)
    assert done.returncode == 0, f"uv run {REMEDY[name]}\n{done.stdout[-8000:]}{done.stderr[-2000:]}"


def test_the_linter_finds_what_it_is_there_for(tmp_path):
    wrong = tmp_path / "wrong.py"
    wrong.write_text('"""One."""\n\nfrom math import *\n\nimport os\n\n\ndef two():\n    return three\n')
    done = subprocess.run(
        [BIN / "ruff", "check", "--config", ROOT / "pyproject.toml", "--output-format", "concise", "--no-cache", wrong],
        capture_output=True,
        text=True,
    )
    assert done.returncode == 1
    for rule in ("F401", "F403", "F405", "D103"):
        assert rule in done.stdout


def test_the_type_checker_finds_what_it_is_there_for(tmp_path):
    """Also through `compiled`: a compiled function has the arguments of the function that it is made of."""
    wrong = tmp_path / "wrong.py"
    wrong.write_text("from studio.model.brake import axle_torque\n\naxle_torque(1.0, 2.0)\n")
    done = said("types", "-c", "pyproject.toml", wrong)
    assert done.returncode == 1 and "missing-argument" in done.stdout, done.stdout + done.stderr


def test_what_is_left_out_has_a_reason():
    """Every rule that is ignored, and every part that the type checker leaves out, says why behind it."""
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    lint = tomllib.loads(text)["tool"]["ruff"]["lint"]
    for rule in lint["ignore"]:
        (line,) = [each for each in text.splitlines() if each.strip().startswith(f'"{rule}",')]
        assert "#" in line, rule
