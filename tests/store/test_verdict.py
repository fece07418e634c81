"""Verdicts are a history with reasons, remarks are what was set last; both are refused where they would say nothing."""

import json
import sqlite3
from datetime import UTC, datetime, timedelta

import pytest

from studio.cli import main
from studio.errors import StudioError, UnknownError
from studio.store.many import Given, Retag, judge_all, retag
from studio.store.runs import open_runs, read_runs
from studio.store.verdict import LONGEST_LINE, MOST_TAGS, VERDICTS, Remark, judge, remark, remark_of, verdicts
from tests.store.test_backup import begun, database


@pytest.fixture
def db(tmp_path):
    """Two runs that are done, and one that failed."""
    path = database(tmp_path / "runs.db", count=3)
    runs = open_runs(path)
    with runs.writing():
        runs.database.table("runs").update(3, {"status": "failed"})
    runs.close()
    return path


def test_a_run_is_open_until_somebody_decides(db):
    row = read_runs(db).find(1)
    assert (row.verdict, row.reason, row.name, row.tags) == ("open", "", "", []) and verdicts(read_runs(db), 1) == []


def test_the_last_verdict_counts_and_none_is_lost(db):
    runs = open_runs(db)
    given = [judge(runs, 1, *each) for each in (("candidate", "no gap below 5 m", "Ada"), ("discarded", "uncomfortable"), ("open", "anew"))]
    assert verdicts(read_runs(db), 1) == given and [each.verdict for each in given] == ["candidate", "discarded", "open"]
    assert given[0].who == "Ada" and given[1].who and given[0].when <= given[1].when <= given[2].when
    assert abs(datetime.fromisoformat(given[0].when) - datetime.now(UTC)) < timedelta(minutes=5)
    judge(runs, 2, "candidate", "best of all")
    rows = {row.run: (row.verdict, row.reason) for row in read_runs(db).select()}
    assert rows == {1: ("open", "anew"), 2: ("candidate", "best of all"), 3: ("open", "")}


@pytest.mark.parametrize(
    ("run", "verdict", "reason", "words"),
    [
        (1, "good", "yes", "open, candidate, discarded"),
        (1, "candidate", "", "reason"),
        (1, "candidate", " \t ", "reason"),
        (1, "discarded", "two\nlines", "one line"),
        (1, "discarded", "x" * (LONGEST_LINE + 1), "too long"),
        (1, "discarded", "half \ud800", "half a character"),
        (3, "candidate", "it failed", "did not come to its end"),
    ],
)
def test_what_says_nothing_is_refused(db, run, verdict, reason, words):
    with pytest.raises(StudioError) as refused:
        judge(open_runs(db), run, verdict, reason)
    assert words in str(refused.value) and verdicts(read_runs(db), run) == []


def test_a_failed_run_may_be_discarded_and_one_that_goes_on_may_not(db):
    runs = open_runs(db)
    assert judge(runs, 3, "discarded", "a wheel lifts").verdict == "discarded"
    going = begun(runs)
    with pytest.raises(StudioError, match="not over"):
        judge(runs, going, "discarded", "too early")
    for act in (lambda: judge(runs, 99, "open", "why"), lambda: verdicts(runs, 99), lambda: remark_of(runs, 99)):
        with pytest.raises(UnknownError, match="There is no run 99"):
            act()


def test_a_remark_is_what_was_set_last(db):
    runs = open_runs(db)
    assert remark_of(runs, 2) == Remark()
    remark(runs, 2, name="first", tags=["wet"], note="")
    made = remark(runs, 2, name=" short gap ", tags=["night", "wet", "night"], note="See 12.3 s.\nThen the hop gain.")
    assert made == remark_of(read_runs(db), 2) == Remark("short gap", ("night", "wet"), "See 12.3 s.\nThen the hop gain.")
    assert (read_runs(db).find(2).name, read_runs(db).find(2).tags) == ("short gap", ["night", "wet"])


@pytest.mark.parametrize(
    ("said", "words"),
    [
        ({"tags": [str(i) for i in range(MOST_TAGS + 1)]}, "at most 20"),
        ({"tags": ["wet", " "]}, "says nothing"),
        ({"name": "a\nb"}, "one line"),
        ({"note": "x" * 20_001}, "too long"),
    ],
)
def test_a_remark_that_cannot_be_is_refused(db, said, words):
    with pytest.raises(StudioError) as refused:
        remark(open_runs(db), 1, **{"name": "", "tags": [], "note": ""} | said)
    assert words in str(refused.value) and remark_of(read_runs(db), 1) == Remark()


def test_what_is_damaged_holds_up_nobody(db):
    runs = open_runs(db)
    judge(runs, 1, "candidate", "good")
    remark(runs, 2, name="x", tags=["y"], note="")
    runs.close()
    connection = sqlite3.connect(db)
    connection.execute("update verdicts set verdict = 'splendid'")
    connection.execute("update remarks set tags = '{'")
    connection.commit()
    rows = {row.run: row for row in read_runs(db).select()}
    assert (rows[1].verdict, rows[2].tags) == ("open", [])
    assert "Damaged in the database: verdict" in rows[1].error and "Damaged in the database: tags" in rows[2].error


def test_a_database_of_an_older_studio_takes_verdicts(db):
    connection = sqlite3.connect(db)
    for statement in ("drop table verdicts", "drop table remarks", "pragma user_version = 5"):
        connection.execute(statement)
    connection.close()
    assert read_runs(db).find(1).verdict == "open"
    assert judge(open_runs(db), 1, "candidate", "as before").verdict == read_runs(db).find(1).verdict == "candidate"


def said(capsys, *words):
    """What a command prints."""
    with pytest.raises(SystemExit) as ended:
        main(list(map(str, words)))
    assert not ended.value.code
    return capsys.readouterr().out


def test_the_command_line_decides(db, capsys):
    place = ("--db", db)
    assert "Run 1 is open" in said(capsys, "verdict", 1, *place)
    decided = said(capsys, "verdict", 1, "candidate", "--reason", "no gap below 5 m", "--who", "Ada", *place)
    assert "no gap below 5 m" in decided and "Ada" in decided
    (given,) = json.loads(said(capsys, "verdict", 1, "--json", *place))
    assert {key: given[key] for key in ("verdict", "reason", "who")} == {"verdict": VERDICTS[1], "reason": "no gap below 5 m", "who": "Ada"}
    assert "wet, night" in said(capsys, "remark", 1, "--name", "short gap", "--tag", "wet", "--tag", "night", *place)
    told = json.loads(said(capsys, "remark", 1, "--note", "look at 12 s", "--json", *place))
    assert told == {"name": "short gap", "tags": ["wet", "night"], "note": "look at 12 s"}
    rows = {each["run"]: each for each in json.loads(said(capsys, "runs", "--json", *place))}
    assert (rows[1]["verdict"], rows[1]["name"], rows[1]["tags"]) == ("candidate", "short gap", ["wet", "night"])
    assert "candidate" in said(capsys, "runs", *place)


def test_many_runs_are_decided_about_together_or_not_at_all(db):
    runs = open_runs(db)
    made = judge_all(runs, [Given(1, "candidate", "near"), Given(2, "discarded", "far")], "Ada")
    assert [verdicts(read_runs(db), run) for run in (1, 2)] == [[each] for each in made]
    with pytest.raises(StudioError, match="run 3 did not come to its end"):
        judge_all(runs, [Given(1, "open", "anew"), Given(3, "candidate", "it failed")])
    assert read_runs(db).find(1).verdict == "candidate"


def test_tags_are_put_on_and_taken_off_many_runs_and_the_opposite_takes_it_back(db):
    runs = open_runs(db)
    remark(runs, 1, name="first", tags=["wet", "night"], note="See 12 s.")
    made = retag(runs, [Retag(run, add=("dry", "night"), remove=("wet",)) for run in (1, 2)])
    assert made == [Retag(1, add=("dry",), remove=("wet",)), Retag(2, add=("dry", "night"))]
    assert remark_of(read_runs(db), 1) == Remark("first", ("night", "dry"), "See 12 s.")
    retag(runs, [Retag(each.run, add=each.remove, remove=each.add) for each in made])
    assert [set(remark_of(read_runs(db), run).tags) for run in (1, 2)] == [{"wet", "night"}, set()]
    assert retag(runs, [Retag(1, add=("wet",), remove=("dry",))]) == []  # nothing was changed


def test_one_run_with_too_many_tags_keeps_all_from_being_tagged(db):
    runs = open_runs(db)
    remark(runs, 2, name="", tags=[str(i) for i in range(MOST_TAGS)], note="")
    with pytest.raises(StudioError, match="at most 20"):
        retag(runs, [Retag(1, add=("wet",)), Retag(2, add=("wet",))])
    with pytest.raises(UnknownError, match="There is no run 99"):
        retag(runs, [Retag(1, add=("wet",)), Retag(99, add=("wet",))])
    assert remark_of(read_runs(db), 1) == Remark()
