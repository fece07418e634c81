"""Near misses, hard brakes, and what is told about them: constructed records, and one run from its start to the database and back."""

import json
from dataclasses import replace

import numpy as np
import pytest
import yaml

from studio import job
from studio.assess.cause import explain
from studio.assess.danger import QUIET, Lookout, hard_brakes, near_misses, stretches, with_dangers
from studio.assess.known import belongs_to, known, overseers, place_of
from studio.errors import UnknownError
from studio.execution.brought import Brought
from studio.execution.happening import happening
from studio.execution.message import none
from studio.execution.record import Mount, Traced
from studio.execution.simulation import simulation
from studio.road.drawn.motorway import motorway
from studio.store.explanation import decelerations, explanation
from studio.store.runs import open_runs
from studio.world.table.cause import FADING, RECEIVED
from studio.world.table.event import HIT
from tests.assess.drive import behind, braking, record

TIME = np.arange(0.0, 10.0 + 1e-9, 0.02)


@pytest.fixture
def drive():
    """Both 20 m/s, 14 m apart; a brakes with 4 m/s² from 2 s, b with 6 m/s² from 3.5 s, both until 8 m/s."""
    return behind(TIME, 14.0, braking(TIME, 20.0, 2.0, 4.0, 8.0), braking(TIME, 20.0, 3.5, 6.0, 8.0))


def test_a_near_miss_is_told_when_it_is_nearest(drive):
    (found,) = near_misses(drive)
    assert (found.kind, found.units, found.time) == ("near_miss", ("b", "a"), 5.0)
    assert found.numbers["ttc"].value == pytest.approx(0.9167, abs=2e-3) and found.text == "comes near a: 0.92 s to a collision"


def test_a_hard_brake_is_told_when_it_begins(drive):
    """4 m/s² are none, 6 m/s² are one."""
    (found,) = hard_brakes(drive)
    assert (found.kind, found.units, found.time) == ("hard_brake", ("b", "a"), pytest.approx(3.5, abs=0.021))
    assert found.numbers["deceleration"].value == pytest.approx(6.0)


def test_a_collision_is_no_near_miss_besides(drive):
    hit = happening(HIT, 5.3, ("a", "b"), impact_speed=3.0)
    made = with_dangers(replace(drive, happenings=(hit,)))
    assert [event.kind for event in made.happenings] == ["hard_brake", "collision"]


def test_stretches_that_are_near_each_other_are_one():
    holds = np.isin(np.arange(TIME.size), [10, 11, 12, 50, 51, 300])
    assert [(part.start, part.stop) for part in stretches(holds, TIME)] == [(10, 52), (300, 301)]


def seen(made, values, measured=TIME):
    """The record with a target of a sensor: range [m] over time, straight ahead, measured at these times [s]."""
    fields = {"measured": (measured, "s"), "range": (values, "m"), "azimuth": (np.zeros(TIME.size), "rad")}
    return replace(made, probes={f"b.front.{name}": Traced(each, unit, name) for name, (each, unit) in fields.items()})


def test_a_target_is_the_vehicle_at_its_place(drive):
    """The range of the true gap is that of the car ahead; 30 m too far nobody is there."""
    gap = drive.channel("gap")[1]
    (found,) = known(seen(drive, gap), "b", "a", 250, 5.0)
    assert (found.source, found.age, found.what["range"].value) == ("front", 0.0, gap[250])
    assert (
        list(known(seen(drive, gap + 30.0), "b", "a", 250, 5.0)) == []
        and list(known(seen(drive, np.full(TIME.size, np.nan)), "b", "a", 250, 5.0)) == []
    )


def test_a_sensor_looks_from_where_it_is(drive):
    """1 m behind the front, 0.5 m to the right and turned: what it has 1 m farther and turned back is at the same place."""
    mount, gap = Mount(-1.0, -0.5, 0.1), drive.channel("gap")[1]
    place = place_of(replace(drive, mounts={"b.front": mount}), "b", "b.front", {"range": gap[250] + 1.0, "azimuth": -0.1}, 250)
    assert place - place_of(drive, "b", "b.front", {"range": gap[250], "azimuth": 0.0}, 250) == pytest.approx([0.0, -0.5])


def test_a_reading_ages(drive):
    """A radar that gives every tenth of a second what it saw then: at 5.06 s it is 0.06 s old, and of where a was then."""
    gap = drive.channel("gap")[1]
    looks = np.arange(TIME.size) // 5 * 5
    (found,) = known(seen(drive, gap[looks], TIME[looks]), "b", "a", 253, 5.06)
    assert (found.age, found.time) == pytest.approx((0.06, 5.0)) and found.what["range"].value == gap[250]


def test_of_two_the_nearer_outline_counts():
    made = record(np.array([0.0, 1.0]), x=np.array([[0.0], [20.0]]), y=np.array([[0.0], [3.5]]))
    assert [belongs_to(made, np.array(place), 0) for place in ((2.0, 0.8), (16.0, 3.0), (10.0, 1.75))] == ["a", "b", ""]


def crash(acceleration=-3.48):
    """b drives with 20 m/s into a, which stands 20 m ahead: they touch at 1.01 s, and b drives on through a. An application brakes b."""
    going = braking(TIME, 20.0, 20.0, 4.0, 0.0)
    made = behind(TIME, 20.2, (0.0 * TIME, 0.0 * TIME, 0.0 * TIME), going)
    values = with_channel(replace(made, values=with_channel(made, "commands_brake", 4.0)), "requested_acceleration", acceleration)
    hit = happening(HIT, 1.02, ("a", "b"), impact_speed=20.0)
    commanders = ("driver", "script", "driver's intervention", "gearbox", "acc")
    return replace(made, values=values, commanders=commanders, happenings=(hit,))


def with_radar(made, sees):
    """The record with the radar of b, exact while it sees something: when is told by `sees`, bool[n]. It says 0 while bodies overlap."""
    gap = np.clip(20.2 - 20.0 * TIME, 0.0, None)
    rate = np.where(gap > 0.0, -20.0, 0.0)
    fields = {"measured": (TIME, "s"), "range": (gap, "m"), "rate": (rate, "m/s"), "azimuth": (np.zeros(TIME.size), "rad")}
    traced = {f"b.front.{name}": Traced(np.where(sees, each, np.nan), unit, name) for name, (each, unit) in fields.items()}
    return replace(made, probes=traced)


def test_of_a_collision_is_told_what_was_known_before_it():
    """Not what the radar says when the bodies overlap: range 0 and rate 0, which moreover is as near to b itself as to a."""
    (told,) = explain(with_radar(crash(), TIME >= 0.0))
    (seen,) = [each for each in told.known if each.unit == "b"]
    assert (seen.about, seen.age, seen.time, seen.what["rate"].value) == ("a", pytest.approx(0.02), pytest.approx(1.0), -20.0)
    assert seen.what["range"].value == pytest.approx(0.2)
    assert "b knew a by front, 0.02 s old (of 1.00 s), range 0.2 m, rate -20 m/s, azimuth 0 rad" in told.lines


@pytest.mark.parametrize(("hit", "until", "is_told"), [(1.02, 0.5, True), (2.6, 0.5, False), (2.6, 0.7, True)])
def test_the_last_that_a_sensor_has_said_counts_for_two_seconds(hit, until, is_told):
    """A radar that loses a at some time: what it said last is known, as old as it is, and nothing is when that is more than 2 s ago."""
    made = crash()
    made = replace(made, happenings=(replace(made.happenings[0], time=hit),))
    (told,) = explain(with_radar(made, until + 1e-6 >= TIME))
    ages = [(each.time, each.age) for each in told.known if each.unit == "b"]
    assert ages == ([(pytest.approx(until), pytest.approx(hit - until))] if is_told else [])
    assert ("b knew nothing of a in the 2 s before" in told.lines) is not is_told


def test_no_sensor_sees_its_own_vehicle():
    """A target right before b's front, 0.05 m inside of it by noise and 0.1 m from a: it is a, for b does not see itself."""
    made = record(np.array([0.0, 1.0]), x=np.array([[4.65], [0.0]]))
    place = np.array([2.2, 0.0])
    assert (belongs_to(made, place, 0), belongs_to(made, place, 0, "b")) == ("b", "a")


@pytest.mark.parametrize(("asked", "text"), [
    (-3.48, "b: acc asked for -3.48 m/s², at its limit of -3.5 m/s²"), (-2.0, "b: acc asked for -2.00 m/s², of at most -3.5 m/s²"),
    (1.0, "b: acc asked for 1.00 m/s²"),
])  # fmt: skip
def test_what_was_asked_for_and_whether_more_could_be(asked, text):
    (told,) = explain(crash(asked), greatest={"acc": 3.5})
    assert text in told.lines and {"unit": "b", "by": "acc", "acceleration": asked, "greatest": 3.5} in told.as_json()["asked"]
    (told,) = explain(crash(asked))
    assert f"b: acc asked for {asked:.2f} m/s²" in told.lines


def test_of_a_near_miss_is_told_what_was_known_when_it_began(drive):
    """It is told when it is nearest, at 5.0 s; what is heard after it began, of 4.9 s, does not count."""
    gap, closing = drive.channel("gap")[1], drive.channel("speed")[1] - drive.channel("speed")[0]
    with np.errstate(divide="ignore"):
        began = TIME[np.flatnonzero((closing > 0.0) & (gap / closing < 1.5))[0]]
    made = with_dangers(told(seen(drive, gap), (began - 0.1, RECEIVED, 0.01), (4.9, RECEIVED, 0.01)))
    (miss,) = explain(made, ("near_miss",))
    assert began < 4.9 < miss.event.time == 5.0 and miss.began == pytest.approx(began) and miss.lines[0] == f"it began at {began:.2f} s"
    found = {each.source: (each.time, each.age) for each in miss.known}
    assert found == {"front": (pytest.approx(began), 0.0), "awareness": (pytest.approx(began - 0.1), pytest.approx(0.1))}


def test_who_is_tuned_by_the_script_has_no_known_limit():
    tune = {"do": {"kind": "tune_application", "application": "acc", "parameters": {"deceleration_max": 5.0}}}
    groups = {"acc": {"parameters": {"deceleration_max": 3.5}}, "jam": {"parameters": {}}}
    assert decelerations({"applications": groups, "script": {}}) == {"acc": 3.5}
    assert decelerations({"applications": groups, "script": {"later": tune}}) == {}


def told(made, *rows):
    """The record with messages of a to b: when each was sent, what became of it, its delay."""
    times, causes, delays = (np.array(each) for each in zip(*rows, strict=True))
    ones = np.ones(times.size, dtype=np.int32)
    messages = replace(
        none(("awareness",), ("a", "b")), time=times, sender=0 * ones, kind=0 * ones, number=np.arange(times.size), size=200.0 * ones,
        said_0=0.0 * ones, said_1=0.0 * ones, count=ones, receiver=ones, cause=causes, delay=delays, distance=20.0 * ones,
    )  # fmt: skip
    return replace(made, messages=messages)


def test_what_was_heard_and_what_was_lost(drive):
    """Of four messages the first came, two were lost, the last is still under way: known is the first, 0.28 s old."""
    made = told(drive, (4.8, RECEIVED, 0.01), (4.9, FADING, np.nan), (5.0, FADING, np.nan), (5.07, RECEIVED, 0.05), (6.0, RECEIVED, 0.01))
    (found,) = known(made, "b", "a", 254, 5.08)
    assert (found.source, found.age, found.time) == ("awareness", pytest.approx(0.28), 4.8)
    assert [(each.time, each.why) for each in found.lost] == [(4.9, "fading"), (5.0, "fading")]
    assert found.text == "b knew a by awareness, 0.28 s old (of 4.80 s); lost since: 2 messages, the last of 5.00 s (fading)"
    assert list(known(made, "a", "b", 254, 5.08)) == []


def test_a_unit_beside_the_road_knew_for_the_cars_that_it_guides(drive):
    """A garage that had heard a 0.15 s before, and that b had heard 0.08 s before; what it heard long ago is nothing that it knows."""
    ones = np.ones(2, dtype=np.int32)

    def guided(heard):
        messages = replace(
            none(("status", "order"), ("a", "b", "garage")), time=np.array([heard, 5.0]), sender=np.array([0, 2]), kind=np.array([0, 1]),
            number=0 * ones, size=200.0 * ones, said_0=0.0 * ones, said_1=0.0 * ones, count=ones, receiver=np.array([2, 1]),
            cause=np.array([RECEIVED, RECEIVED]), delay=0.01 * ones, distance=20.0 * ones,
        )  # fmt: skip
        return replace(drive, messages=messages)

    (found,) = overseers(guided(4.93), "b", "a", 5.08)
    assert found.text == "garage, which b had heard by order, 0.08 s old, knew a by status, 0.15 s old"
    assert list(overseers(guided(4.93), "a", "b", 5.08)) == []
    assert list(overseers(guided(2.9), "b", "a", 5.08)) == []


def test_who_never_heard_says_so(drive):
    (found,) = known(told(drive, (4.8, FADING, np.nan)), "b", "a", 254, 5.08)
    assert (
        found.age is found.time is None and found.text == "b never heard a by awareness; lost since: 1 message, the last of 4.80 s (fading)"
    )


def test_an_explanation_in_order(drive):
    """Sensor, message, who commanded, tyres: of a hard brake in which b's front left tyre used all it had."""
    made = told(seen(drive, drive.channel("gap")[1]), (3.4, RECEIVED, 0.01), (3.45, FADING, np.nan))
    use = np.where(TIME[None] >= 3.5, [[0.3], [0.97]], 0.1)
    made = with_dangers(replace(made, values=with_channel(made, "adhesion_front_left", use)))
    (brake,) = explain(made, ("hard_brake",))
    plain = json.loads(json.dumps(brake.as_json()))
    assert {"event", "time", "units", "known", "commanded_by", "tyre_at_limit"} <= plain.keys()
    assert plain["units"] == ["b", "a"] and [each["source"] for each in plain["known"]] == ["front", "awareness"]
    assert plain["known"][1]["lost"] == [{"time": 3.45, "why": "fading"}] and plain["known"][1]["about"] == "a"
    assert plain["tyre_at_limit"] == [{"unit": "b", "wheel": "front_left", "use": 0.97, "slides": False}]
    assert (
        brake.lines[0].startswith("b knew a by front") and brake.lines[-1] == "b: the front left tyre was at its limit, 97% of its adhesion"
    )
    assert "a knew nothing of b in the 2 s before" in brake.lines


def with_channel(made, name, values):
    """The values of a record with one channel replaced."""
    from tests.assess.drive import NAMES

    found = made.values.copy()
    found[NAMES.index(name)] = values
    return found


HARD = {"clock.duration": 25, "script.hard_brake.do.deceleration": 8, "applications.platoon.application": "acc",
        "applications.platoon.parameters": {"headway": 0.5}}  # fmt: skip


def test_a_run_is_explained_from_the_database(sample, tmp_path):
    """A leader that brakes with 8 m/s²: whoever follows brakes hard. What stands in the database is what the run itself tells."""
    runs = open_runs(tmp_path / "runs.db")
    made = job.run(job.load(sample, HARD), runs=runs)
    found = explanation(runs, 1)
    assert [each.as_json() for each in found] == [each.as_json() for each in explain(made.record, greatest={"platoon": 8.0})]
    brakes = {each.event.vehicle: each for each in found if each.event.kind == "hard_brake"}
    assert {"leader", "follower_1"} <= brakes.keys()
    first = brakes["follower_1"]
    (radar,) = [each for each in first.known if each.source == "front"]
    gap = made.trace("follower_1.gap")[np.searchsorted(made.time, first.event.time)]
    assert radar.about == "leader" and radar.what["range"].value == pytest.approx(gap, abs=0.6)
    assert explanation(runs, 1, "1") == found[:1] and explanation(runs, 1, "collision") == []
    for event, words in (("arrived", "not explained"), ("99", "no event 99")):
        with pytest.raises(UnknownError, match=words):
            explanation(runs, 1, event)


def test_what_was_not_kept_is_not_guessed(sample, tmp_path):
    """Messages are there whatever channels are kept; what sensors saw, who commanded and what tyres did are said to be unknown."""
    runs = open_runs(tmp_path / "runs.db")
    job.run(job.load(sample, HARD | {"recording.channels": ["speed", "gap"]}), runs=runs)
    found = explanation(runs, 1, "hard_brake")
    of = next(each for each in found if len(each.event.units) == 2 and not each.unknown)
    one, other = of.event.units
    assert {"x", "commands_brake", "adhesion_rear_left", "sensors"} <= set(of.not_recorded)
    assert f"what {one} knew of {other} by sensors was not recorded" in of.lines and f"{one}: who commanded was not recorded" in of.lines
    assert of.lines[-1] == "how much of its adhesion every tyre used was not recorded"
    assert not any("knew nothing" in line for line in of.lines) and of.as_json()["not_recorded"] == list(of.not_recorded)


def test_an_unknown_kind_names_each_kind_once(tmp_path):
    with pytest.raises(UnknownError) as told:
        explanation(open_runs(tmp_path / "runs.db"), 1, "nonsense")
    assert all(str(told.value).count(kind) == 1 for kind in ("collision", "near_miss", "hard_brake"))


CHILD = {
    "version": 3,
    "title": "a child on the road",
    "map": {"file": "motorway.xodr"},
    "clock": {"duration": 6},
    "routes": {"way": {"roads": ["motorway"], "speeds": [{"at": 0, "speed": 15}]}},
    "vehicles": {"car": {"route": "way", "position": {"along": 100}, "speed": 15, "sensors": {"front": {"kind": "object_sensor"}}}},
    "script": {"child": {"do": {"kind": "mover", "route": "way", "line": [[160, 0]]}}},
}
BLIND = {"blind": {"when": {"kind": "time", "at": 1}, "do": {"kind": "sensor_fault", "unit": "car", "sensor": "front"}}}


@pytest.mark.parametrize("is_blind", [False, True])
def test_of_somebody_on_foot_is_told_who_knew_it(tmp_path, is_blind):
    """A driver brakes hard for a child; his radar has seen it, or the script has made it fail."""
    (tmp_path / "motorway.xodr").write_text(motorway(length=600.0, lanes=2), encoding="utf-8")
    script = CHILD["script"] | (BLIND if is_blind else {})
    driver = {"time_headway": 0.3, "deceleration": 8, "standstill_gap": 0.5}
    cars = {"car": CHILD["vehicles"]["car"] | {"driver": driver}}
    (tmp_path / "child.yaml").write_text(yaml.safe_dump(CHILD | {"script": script, "vehicles": cars}))
    runs = open_runs(tmp_path / "runs.db")
    made = job.run(job.load(tmp_path / "child.yaml"), runs=runs)
    assert made.status == "done", made.error
    event = next(each for each in explanation(runs, 1) if each.event.units == ("car", "child"))
    fault = "front of car gave nothing, by blind since 1.00 s"
    if is_blind:
        assert "car knew nothing of child in the 2 s before" in event.lines and fault in event.lines and event.faults[0].sensor == "front"
    else:
        (seen,) = [each for each in event.known if each.about == "child"]
        assert seen.source == "front" and "car knew child by front" in event.lines[0] and fault not in event.lines


def test_whoever_moves_is_where_his_line_says():
    """3 m/s along 3 m to the east and 4 m to the north; one who does not stay is gone at its end."""
    walker = Brought("walk", ((0.0, 0.0), (3.0, 0.0), (3.0, 4.0)), 0.0, 3.0, False, 0.6, 0.5)
    assert walker.after(0.5) == (1.5, 0.0, 0.0) and walker.after(2.0) == pytest.approx((3.0, 3.0, np.pi / 2.0))
    assert walker.after(2.5) is None and walker._replace(stays=True).after(9.0) == pytest.approx((3.0, 4.0, np.pi / 2.0))
    assert Brought("cone", ((5.0, 6.0),), 0.7, 0.0, True, 0.3, 0.3).after(9.0) == (5.0, 6.0, 0.7)


def test_adhesion_is_that_of_the_tyres(sample):
    """Rolling along, a wheel uses little; braking with 8 m/s² on a dry road, 0.75 to 1 of what it has."""
    use = job.run(job.load(sample, HARD)).record
    most = use.channel("adhesion_rear_left")[0]
    before, braking_hard = use.time < 19.5, (use.time > 20.6) & (use.channel("acceleration")[0] < -7.5)
    assert most[before].max() < 0.35 and braking_hard.any() and 0.75 < most[braking_hard].min() <= most[braking_hard].max() < 1.02


def test_a_tyre_at_its_limit_while_a_hard_brake_lasts_is_told(drive):
    """The event is told when the brake begins, its strongest moment comes later; what comes after it does not count."""
    hard = -drive.channel("acceleration")[1] > 5.0
    first, last = (int(each) for each in np.flatnonzero(hard)[[0, -1]])
    assert last - first > 50
    for at, is_told in ((first + 40, True), (last, True), (last + 60, False)):
        use = np.where(np.arange(TIME.size) == at, 0.99, 0.1)
        made = with_dangers(replace(drive, values=with_channel(drive, "adhesion_rear_left", np.stack([0.1 * use, use]))))
        (brake,) = explain(made, ("hard_brake",))
        assert [each.wheel for each in brake.tyre_at_limit] == (["rear_left"] if is_told else [])


@pytest.fixture(scope="module")
def nearing(tmp_path_factory):
    """A car that comes near another and brakes hard; it does so again as the run ends."""
    folder = tmp_path_factory.mktemp("nearing")
    (folder / "motorway.xodr").write_text(motorway(length=1500.0, lanes=2), encoding="utf-8")

    def at(time, kind, vehicle, **settings):
        return {"when": {"kind": "time", "at": time}, "do": {"kind": kind, "vehicle": vehicle} | settings}

    car = {"route": "way", "speed": 15.0, "sensors": {}}
    document = {
        "version": 3, "title": "nearing", "map": {"file": "motorway.xodr"}, "clock": {"duration": 13.0},
        "routes": {"way": {"roads": ["motorway"]}},
        "vehicles": {
            "b": car | {"speed": 25.0, "position": {"road": "motorway", "lane": 0, "offset": 100}},
            "a": car | {"position": {"road": "motorway", "lane": 0, "offset": 130}},
        },
        "script": {
            "even": at(0, "hold", "a", speed=15, duration=13), "fast": at(0, "hold", "b", speed=25, duration=1.4),
            "hard": at(1.4, "brake", "b", deceleration=8, duration=6, to_speed=12),
            "again": at(8, "set_speed", "b", speed=30, acceleration=6), "more": at(11.5, "brake", "b", deceleration=9, duration=3),
        },
    }  # fmt: skip
    (folder / "nearing.yaml").write_text(yaml.safe_dump(document))
    return job.prepare(job.load(folder / "nearing.yaml"))


@pytest.mark.parametrize("ticks", [1, 7, 60, 1000])
def test_dangers_are_told_while_a_run_goes_on(nearing, ticks):
    """Each once, when nothing belongs to it any more, and the same as in the record of the whole run, however often one looks."""
    going, told = simulation(nearing), []
    lookout = Lookout(going)
    while not going.is_over:
        going.advance(ticks)
        told += [(going.time, event) for event in lookout.look()]
    record = going.record()
    wanted = [*near_misses(record), *hard_brakes(record)]
    assert {"near_miss", "hard_brake"} <= {event.kind for event in wanted} and len(wanted) >= 3
    assert sorted((event for _, event in told), key=key) == sorted(wanted, key=key) and lookout.look() == []
    early = [time - event.time for time, event in told if time < going.time]
    assert min(early, default=QUIET) >= QUIET and (bool(early) == (ticks < 1000))


def key(event):
    return event.time, event.kind, event.units
