"""A campaign that is broken off goes on where it ended."""

import json

import pytest

from tests.rush import __main__ as command
from tests.rush.kept import keep, kept, left
from tests.rush.outcome import MEASURES, Outcome

GOOD = dict.fromkeys(MEASURES, 0.0) | {"conflicts": 100.0}


def one(place, seed, **measures):
    """What came of a run."""
    return Outcome(place, seed, 300, 30.0, "abc", 1.5, GOOD | measures, ["violation: a before b at 3.00 s, 3.2"], None)


def test_what_was_kept_is_read_again(tmp_path):
    """To the last digit; it is one line of JSON a run."""
    file = tmp_path / "rush.jsonl"
    for seed in (1, 2):
        keep(file, one("Großer Stern", seed, longest_wait=100.0 / 3.0))
    assert kept(file) == [one("Großer Stern", seed, longest_wait=100.0 / 3.0) for seed in (1, 2)]
    assert [json.loads(line)["seed"] for line in file.read_text(encoding="utf-8").splitlines()] == [1, 2]


def test_a_line_that_was_broken_off_counts_as_not_run(tmp_path):
    """And the next one does not hang on to it."""
    file = tmp_path / "rush.jsonl"
    keep(file, one("grid", 1))
    file.write_bytes(file.read_bytes() + b'{"place": "gri')
    assert left([("grid", 1), ("grid", 2), ("motorway", 1)], kept(file)) == [("grid", 2), ("motorway", 1)]
    keep(file, one("grid", 2))
    assert kept(file) == [one("grid", 1), one("grid", 2)]


def test_only_what_is_left_is_run(tmp_path, monkeypatch):
    """A campaign that has been broken off after one of four runs makes the other three, in order; a third call makes none.

    What is kept decides what comes of all: 1 while one run is wrong, and the table names it and who it was.
    """
    file, made = tmp_path / "rush.jsonl", []

    def run(asked, wanted):
        for place, seed in wanted:
            made.append((place, seed))
            yield one(place, seed, right_of_way_violations=float(seed == 2))

    monkeypatch.setattr(command, "runs", run)
    asked = ["--places", "grid,motorway", "--seeds", "2", "--kept", str(file)]
    keep(file, one("grid", 1))
    assert command.main(asked) == 1
    assert command.main(asked) == 1
    assert made == [("grid", 2), ("motorway", 1), ("motorway", 2)]
    table = file.with_suffix(".md").read_text(encoding="utf-8")
    wrong = [line for line in table.splitlines() if line.endswith("| right_of_way_violations |")]
    assert [line.split(" | ")[:2] for line in wrong] == [["| grid", "2"], ["| motorway", "2"]]
    assert "- grid, seed 2: violation: a before b at 3.00 s, 3.2" in table


@pytest.mark.parametrize(("other", "said"), [(["--cars", "200"], "300 cars for 30 minutes"), (["--places", "gird"], "gird")])
def test_what_does_not_fit_is_refused(tmp_path, capsys, other, said):
    """Runs of another size do not stand in one table; a place that there is not is named, with those that there are."""
    file = tmp_path / "rush.jsonl"
    keep(file, one("grid", 1))
    before = file.read_bytes()
    assert command.main([*other, "--kept", str(file)]) == 2
    assert said in capsys.readouterr().out
    assert file.read_bytes() == before
