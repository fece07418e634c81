"""The registry: one door for all kinds."""

import subprocess
import sys

import pytest

from studio.errors import KindError
from studio.kind import registry


def test_a_name_is_given_once():
    kind = registry.find("application", "acc")
    with pytest.raises(KindError, match=r"taken(.|\n)*built in"):
        registry.register("acc", kind.module)


def test_many_may_ask_at_once_for_the_first_time():
    """In a process of its own: whoever comes first registers the built-ins, the others wait."""
    code = """
import threading
from studio.kind import registry
start, found = threading.Barrier(8), []
def ask():
    start.wait()
    found.append(sorted(registry.known("application")))
threads = [threading.Thread(target=ask) for _ in range(8)]
[each.start() for each in threads]; [each.join() for each in threads]
assert len(found) == 8 and all(each == found[0] and "acc" in each for each in found), found
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_files_of_a_folder_import_each_other_and_helpers_are_no_kinds(tmp_path, own_kinds):
    """With a dot and without; what they import is part of what they are, what they do not is none."""
    text = (
        '"""Does something."""\n{line}\nKIND, TITLE, UNIT, BETTER = "metric", "Mine", "m", None\ndef measure(record):\n    return VALUE\n'
    )
    (tmp_path / "one.py").write_text(text.format(line="from .helper import VALUE"))
    (tmp_path / "two.py").write_text(text.format(line="from helper import VALUE"))
    (tmp_path / "helper.py").write_text("from deeper import VALUE\n")
    (tmp_path / "deeper.py").write_text("VALUE = 3.0\n")
    (tmp_path / "other.py").write_text("VALUE = 4.0\n")
    one, two = own_kinds(tmp_path)
    assert one.module.measure(None) == two.module.measure(None) == 3.0
    assert list(one.texts) == ["one.py", "deeper.py", "helper.py"] and one.texts["deeper.py"] == "VALUE = 3.0\n"
    assert one.digest != two.digest and registry.broken() == []
