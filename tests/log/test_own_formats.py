"""Formats of logs that users bring: asked before those of the studio, and whatever they do is told with their name."""

import pytest

from studio.errors import ScenarioError
from studio.kind import registry
from studio.log import reading

FORMAT = '''"""A laboratory's own tables."""
from studio.kind.log import Log, signal
KIND = "logformat"
TITLE = "Own"
SUFFIXES = (".csv", ".own")

{fits}

def read(path, dbc):
    """A Log."""
    {read}
'''
FITS = '''def fits(path):
    """Whether its first line says so."""
    return path.read_text().startswith("OWN")'''
READ = 'return Log(path.name, {"speed": signal("speed", "m/s", [0.0, 1.0], [3.0, 4.0])})'


@pytest.fixture
def own(own_kinds, tmp_path):
    """Puts a format into a folder and loads it."""

    def load(read=READ, fits=FITS):
        (tmp_path / "kinds").mkdir()
        (tmp_path / "kinds" / "own.py").write_text(FORMAT.format(read=read, fits=fits))
        return own_kinds(tmp_path / "kinds")

    return load


def test_its_own_tables_are_read_by_it_and_others_as_before(own, tmp_path):
    (found,) = own()
    ours, others = tmp_path / "a.csv", tmp_path / "b.csv"
    ours.write_text("OWN\n")
    others.write_text("t,speed\n0,1\n1,2\n")
    assert reading.format_of(ours) is found and reading.read(ours)["speed"].values.tolist() == [3.0, 4.0]
    assert reading.format_of(others).name == "csv_table" and reading.read(others)["speed"].values.tolist() == [1.0, 2.0]


def test_without_a_word_about_it_it_takes_all_of_its_ending(own, tmp_path):
    own(fits="")
    (tmp_path / "b.csv").write_text("t,speed\n0,1\n1,2\n")
    assert reading.format_of(tmp_path / "b.csv").name == "own"


@pytest.mark.parametrize(
    ("read", "told"),
    [("return 1 / 0", "the format own failed: ZeroDivisionError"), ("return {}", "the format own gave dict, no Log")],
)
def test_what_it_does_wrong_is_told_with_its_name(own, tmp_path, read, told):
    own(read=read)
    (tmp_path / "a.own").write_text("OWN\n")
    with pytest.raises(ScenarioError) as caught:
        reading.read(tmp_path / "a.own")
    assert told in str(caught.value) and "own.py" in str(caught.value)


def test_a_file_that_is_nothing_for_anybody_is_told(own, tmp_path):
    own(fits='def fits(path):\n    """Fails."""\n    raise OSError')
    (tmp_path / "a.own").write_text("x")
    with pytest.raises(ScenarioError, match="is nothing for own"):
        reading.read(tmp_path / "a.own")


@pytest.mark.parametrize("suffixes", ['".csv"', '("csv",)', '(".CSV",)', "()"])
def test_endings_that_are_none_break_the_contract(own_kinds, tmp_path, suffixes):
    (tmp_path / "own.py").write_text(FORMAT.format(read=READ, fits="").replace('(".csv", ".own")', suffixes))
    assert own_kinds(tmp_path) == []
    assert "SUFFIXES" in str(registry.broken()[-1].error)
