"""The campaign in its short form: some of everything, of a seed; and that what judges would see what is wrong."""

import random

import pytest

from tests.campaign import container, faults, files, mutation, place, rest, soak
from tests.campaign.formats import FORMATS
from tests.campaign.request import KINDS, Request
from tests.campaign.station import Station, quick_run
from tests.campaign.table import Row, markdown

SEED = 20261128
MUTANTS, REQUESTS, LINES, CASES, RUNS = 6, 20, 5, 1, 4


def nothing_is_wrong(*rows):
    assert not [each for row in rows for each in row.wrong], markdown(rows, "")


@pytest.fixture(scope="module")
def station(tmp_path_factory):
    with Station(tmp_path_factory.mktemp("campaign")) as running:
        quick_run(running)
        yield running


@pytest.fixture(scope="module")
def siege(station):
    return rest.Siege(station)


@pytest.fixture(scope="module")
def reader():
    with files.Reader() as running:
        yield running


@pytest.mark.parametrize("kind", KINDS)
def test_requests(siege, kind):
    nothing_is_wrong(siege.requests(kind, seed=SEED, count=REQUESTS))


@pytest.mark.parametrize("kind", rest.LINES)
def test_lines(siege, kind):
    nothing_is_wrong(siege.lines(kind, seed=SEED, count=LINES))


@pytest.mark.parametrize("kind", rest.MODES)
def test_the_description(siege, kind):
    nothing_is_wrong(siege.described(rest.MODES[kind], number=SEED, count=CASES))


def test_the_server_afterwards(siege):
    nothing_is_wrong(siege.afterwards(SEED))


@pytest.mark.parametrize("name", FORMATS)
def test_files(reader, name):
    nothing_is_wrong(files.campaign(reader, name, seed=SEED, count=MUTANTS))


@pytest.mark.parametrize("fault", [each for each in faults.FAULTS if each.is_short], ids=lambda each: each.name)
def test_faults(station, tmp_path, fault):
    is_special = fault.place or fault.settings
    nothing_is_wrong(faults.campaign(fault, tmp_path, seed=SEED, count=1) if is_special else faults.on(station, fault, seed=SEED, count=1))


def test_soak_and_the_end(station):
    *_, (runs, *_) = soak.campaign(station, seed=SEED, count=RUNS)
    nothing_is_wrong(runs)
    station.terminate()
    station.leaves_nobody()
    station.start()


# -- the judges ----------------------------------------------------------------------------------------


def test_a_slope_is_seen_with_its_uncertainty():
    chance = random.Random(1)
    level = [100 + chance.gauss(0, 5) for _ in range(300)]
    growing = [each + 0.2 * i for i, each in enumerate(level)]
    assert abs(soak.slope(level).value) < soak.SURE * soak.slope(level).deviation
    assert abs(soak.slope(growing).value - 0.2) < soak.SURE * soak.slope(growing).deviation
    assert soak.growth("memory", growing, 1).wrongs == 1 and not soak.growth("memory", level, 1).wrongs


@pytest.mark.parametrize(
    ("status", "body", "wrong"),
    [
        (500, b"{}", "a mistake"),
        (200, b"Traceback (most recent call last)", "a mistake"),
        (200, b"root:x:0:0", "outside"),
        (418, b"{}", "not described"),
        (404, b'{"detail": "Not Found"}', "without its form"),
        (404, b'{"message": "no", "problems": []}', "says nothing"),
        (0, b"", "no answer"),
    ],
)
def test_what_is_wrong_with_an_answer_is_seen(status, body, wrong):
    judge = rest.Judge({"/api/runs/{run}": {"get": {"responses": {"200": {}, "404": {}}}}})
    assert wrong in judge.wrong(Request("GET", None, "/api/runs/1"), status, body)


def test_what_raises_is_seen():
    assert files.outcome(lambda: {}["x"])[0] == "raised" and "KeyError" in files.outcome(lambda: {}["x"])[1]
    assert files.outcome(lambda: 1) == ("taken", "")


def test_the_same_seed_is_the_same_mutant():
    made = [mutation.mutant(f"1/x/{i}", [place.xml()], mutation.XML) for i in range(20)]
    assert made == [mutation.mutant(f"1/x/{i}", [place.xml()], mutation.XML) for i in range(20)]
    assert len(set(made)) > 15


def test_what_is_packed_again_is_what_it_was(tmp_path):
    pbf = place.pbf(tmp_path)
    again = container.as_pbf(container.from_pbf(pbf))
    assert container.from_pbf(again) == container.from_pbf(pbf) != pbf


def test_the_table_counts():
    row = Row("files", "scenario", 7)
    row.add("refused", 0.5)
    with row.trying("as before"):
        raise ValueError("no")
    assert (row.tried, row.wrongs, row.worst) == (2, 1, 0.5)
    assert "| files | scenario | 2 | 7 | 1 refused, 1 wrong | 0.50 | 1 | 0 |" in markdown([row], "Seed 7.")
