"""What the README says is true: its commands run, its Python runs, its links lead somewhere."""

import re
import shlex
import subprocess
import sys

import pytest


@pytest.fixture(scope="module")
def text(root):
    return (root / "README.md").read_text(encoding="utf-8")


def blocks(text, language):
    return re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)


def test_commands(text, root, tmp_path_factory):
    """All commands in their order, in a folder with the samples; serving is tested elsewhere."""
    folder = tmp_path_factory.mktemp("readme")
    for name in ("scenarios", "studio"):
        (folder / name).symlink_to(root / name)
    lines = [line for block in blocks(text, "sh") for line in block.splitlines() if line.startswith("uv run studio ")]
    commands = [shlex.split(line)[3:] for line in lines if "--kinds" not in line]
    assert [each[0] for each in commands] == [
        "check",
        "run",
        "run",
        "runs",
        "compare",
        "verdict",
        "explain",
        "export",
        "queue",
        "vehicles",
        "vehicles",
        "drive",
        "drive",
        "tyre",
        "import",
        "correct",
        "correct",
        *3 * ["generate"],
    ]
    for command in commands:
        done = subprocess.run([sys.executable, "-m", "studio.cli", *command], cwd=folder, capture_output=True, text=True)
        assert done.returncode == 0, (command, done.stderr)
        assert done.stdout.strip()


def test_python(text, root, monkeypatch, capsys):
    monkeypatch.chdir(root)
    (block,) = blocks(text, "python")
    exec(compile(block, "README.md", "exec"), {})
    ttc, fastest, end, electric = map(float, capsys.readouterr().out.split())
    assert ttc > 0 and 10 < fastest < 20 and end == 60 and 30 < electric < 40


def test_links(text, root):
    links = [link for link in re.findall(r"\]\(([^)]+)\)", text) if not link.startswith("http")]
    assert links
    for link in links:
        assert (root / link).exists(), link


def test_the_test_command_is_what_ci_calls(text, root):
    script = (root / ".ci" / "run").read_text()
    assert "python3 -m pip install uv && uv run pytest" in text
    assert "python3 -m pip install --quiet uv && uv run pytest" in script


def test_every_room_is_named(text, root):
    """The architecture's table names every room of the package."""
    rooms = {path.stem for path in (root / "studio").iterdir() if path.name[0] not in "_." and path.name != "__pycache__"}
    named = set(re.findall(r"`(\w+)`", "".join(line for line in text.splitlines() if line.startswith("| `"))))
    assert rooms <= named, rooms - named
