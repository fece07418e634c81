"""Drivers perceive as people do: late, with errors, not always, and they sway; and what that does to them."""

from dataclasses import replace

import numpy as np
import pytest

from studio import job
from studio.model import driver
from studio.road.drawn.motorway import motorway
from studio.road.network.signals import AMBER, GREEN, RED
from studio.scenario.setup import complete
from studio.vehicle.parameter import FRONT
from studio.vehicle.state import A_X, V_X, VEHICLE, X, Y
from studio.world.build import build
from studio.world.passes.junction import sets_off_before
from studio.world.passes.traffic import next_red
from studio.world.setting import setting
from studio.world.snapshot import restore, snapshot
from studio.world.table.mind import (
    AWAY,
    DRIVER,
    EXPECTED,
    FOLLOW_GAP,
    FRONT_OFFSET,
    GAP,
    GAP_SHARE,
    HEADWAY,
    INTENT,
    MIND,
    MISJUDGED,
    PENDING,
    SEEN_GAP,
    STARTLED,
    STATION,
    STOOD,
    SURPRISED,
    SWAYED,
    WISH,
)  # fmt: skip
from studio.world.tick import tick
from tests.conftest import ROOT

TICK = 0.02
EXACT = {"expected_reaction": 0.0, "surprised_reaction": 0.0, "reaction_spread": 0.0, "gap_error": 0.0, "closing_error": 0.0, "sway": 0.0}
WANDERING = {  # a driver who does everything that people do
    "expected_reaction": 0.7, "surprised_reaction": 1.3, "reaction_spread": 0.3, "gap_error": 0.1, "closing_error": 0.01,
    "distraction_rate": 10.0, "distraction_length": 1.0, "sway": 0.2, "sway_time": 3.0, "aggressiveness": 0.5,
}  # fmt: skip


def column(folder, speeds, places, profile=None, *, limit=30.0, length=3000.0, seed=1, **style):
    """Cars on one lane, the first of which drives a profile [[s, m/s]] if there is one."""
    (folder / "motorway.xodr").write_text(motorway(length=length, lanes=1), encoding="utf-8")
    usual = {"route": "way", "driver": EXACT | style}
    document = {
        "title": "column", "map": {"file": "motorway.xodr"}, "seed": seed,
        "vehicles": {
            f"car_{i:03d}": usual | {"position": {"along": float(at)}, "speed": float(v)}
            for i, (v, at) in enumerate(zip(speeds, places, strict=True))
        },
        "routes": {"way": {"roads": ["motorway"], "speeds": [{"at": 0, "speed": limit}]}},
    }  # fmt: skip
    if profile:
        first = {"kind": "speed_profile", "vehicle": "car_000", "points": profile}
        document["script"] = {"lead": {"when": {"kind": "time", "at": 0}, "do": first}}
    return build([setting(complete(document, "column"), folder, "column")])


def rows(world, seconds, *which):
    """Rows of the minds, tick by tick, [tick, row, vehicle]."""
    found = []
    for _ in range(round(seconds / TICK)):
        tick(world)
        found.append(world.vehicles.mind[list(which)].copy())
    return np.array(found)


# -- reaction ------------------------------------------------------------------------------------------


def test_reactions_are_lognormal_among_drivers(tmp_path):
    """Of 300 drivers: median, spread of the logarithm, the same person slow at both; and chance does not hang on what else there is."""
    style = {"expected_reaction": 0.7, "surprised_reaction": 1.4, "reaction_spread": 0.3}
    drawn = column(tmp_path, np.zeros(300), 20.0 + 9.0 * np.arange(300), **style).vehicles.drivers
    assert drawn[SURPRISED] == pytest.approx(2.0 * drawn[EXPECTED])
    logarithm = np.log(drawn[EXPECTED] / 0.7)
    assert abs(np.median(logarithm)) < 0.06 and logarithm.std() == pytest.approx(0.3 * 0.95, abs=0.04)
    assert np.abs(logarithm).max() == pytest.approx(0.6)  # nobody is slower or quicker than by two standard deviations
    few = column(tmp_path, np.zeros(10), 20.0 + 9.0 * np.arange(10), **style).vehicles.drivers
    assert np.array_equal(few[EXPECTED], drawn[EXPECTED, :10])


@pytest.mark.parametrize("late", [0.1, 0.5, 1.3])
def test_the_foot_does_what_was_decided_one_reaction_ago(tmp_path, late):
    """Bit for bit, and `pending` is what is decided and not done."""
    world = column(tmp_path, [15.0, 15.0], [100.0, 70.0], [[0, 15], [5, 15], [8, 9], [20, 9]], expected_reaction=late)
    intent, wish, pending = rows(world, 15.0, INTENT, WISH, PENDING).transpose(1, 0, 2)
    n = round(late / TICK)
    assert np.array_equal(wish[n:], intent[:-n]) and not wish[:n].any()
    assert pending[-1] == pytest.approx(TICK * intent[-n:].sum(axis=0), abs=1e-9)
    assert wish[:, 1].min() < -0.5


@pytest.mark.parametrize("late", [0.7, 1.2])
def test_a_late_driver_comes_to_rest_behind_an_object_as_a_prompt_one_does(tmp_path, late):
    """Foresight makes up for it: he stands a little nearer, without swinging, and brakes no harder than a quarter more."""
    world = column(tmp_path, [0.0, 14.0], [354.5, 50.0], [[0, 0.0], [200, 0.0]], limit=14.0, expected_reaction=late)
    found = []
    for _ in range(round(70.0 / TICK)):
        tick(world)
        found.append([world.vehicles.state[A_X, 1], world.vehicles.state[V_X, 1]])
    braking, speed = np.array(found).T
    assert -np.convolve(braking, np.full(10, 0.1), "valid").min() < 1.25 * 1.789
    assert abs(speed[-1]) < 0.05 and world.vehicles.mind[GAP, 1] == pytest.approx(1.5, abs=0.5)
    assert np.diff(speed[round(5 / TICK) :]).max() < 0.02  # never faster again


def test_who_is_surprised_takes_longer(tmp_path):
    """A car stands 25 m ahead of one with 15 m/s from one tick to the next: braking begins 0.7 s, or 1.3 s, later."""
    begun = {}
    for surprised in (0.0, 1.3):
        world = column(tmp_path, [15.0, 15.0], [400.0, 200.0], [[0, 0.0], [9, 0.0]], expected_reaction=0.7, surprised_reaction=surprised)
        rows(world, 1.0, WISH)
        state = world.vehicles.state
        state[X, 0], state[Y, 0] = state[X, 1] + 30.0, state[Y, 1]
        world.vehicles.mind[STATION, 0] = world.vehicles.mind[STATION, 1] + 30.0
        wish, startled = rows(world, 2.0, WISH, STARTLED).transpose(1, 0, 2)
        begun[surprised] = TICK * np.flatnonzero(wish[:, 1] < -4.0)[0]
        assert (startled[:, 1] > 0).any() == (surprised > 0.0)
    assert begun == {0.0: pytest.approx(0.7, abs=TICK), 1.3: pytest.approx(1.3, abs=2 * TICK)}


def test_who_answers_late_decides_earlier_whether_to_stop():
    """With 14 m/s 31 m before a line he stops; but not if that is where his foot will be 0.7 s later. Nor does he pass at red for it."""
    v, late = 14.0, 0.7 * 14.0
    assert driver.must_stop(v, 31.0) and not driver.must_stop(v, driver.foreseen_gap(31.0, v, 0.0, 0.0, 0.7))
    assert driver.must_stop(v, driver.foreseen_gap(31.0 + late, v, 0.0, 0.0, 0.7))
    assert driver.is_red_then(v, 42.5) and not driver.is_red_then(v, 41.5)


def test_who_sees_red_and_cannot_stop_firmly_stops_hard(sample):
    """Lights that turn red at once 17 m before cars with 10 m/s: firm braking needs 17.5 m, and the hard one that does is asked for."""
    loaded = job.load(sample, {"traffic.count": 0})
    world = build([job.prepare(replace(loaded, scenario=loaded.scenario.model_copy(update={"applications": {}, "script": {}})))])
    world.roads.forced[:] = GREEN
    tick(world)
    v, r = world.vehicles, world.roads
    car = int(np.flatnonzero(r.stop_count)[0])
    line = r.stop_station[r.stop_first[car]]
    v.mind[STATION, car] = line - 17.0 - v.parameter[FRONT, car]
    assert not driver.must_stop(10.0, 17.0) and driver.can_stop(10.0, 17.0 - 10.0 * driver.BRAKE_TIME)
    for light, stops in ((GREEN, False), (AMBER, False), (RED, True)):
        shown = np.full(r.shown.size, light)
        v.state[V_X, car] = 10.0
        found = next_red.py_func(car, v.state, v.parameter, v.drivers, v.mind, r.stop_first[car], 1, r.stop_station, r.stop_link, shown)
        assert np.isfinite(found) == stops


# -- errors, attention, sway -----------------------------------------------------------------------------


def test_gaps_are_misjudged_as_an_ornstein_uhlenbeck_process_has_it(tmp_path):
    """40 drivers for 200 s: the logarithm of estimated over true gap has a standard deviation of 0.1 and forgets in 20 s."""
    world = column(tmp_path, np.zeros(40), 1000.0 - 20.0 * np.arange(40), [[0, 0.0], [300, 0.0]], limit=0.5, gap_error=0.1)
    found = rows(world, 200.0, MISJUDGED, SEEN_GAP, FOLLOW_GAP)[::50]
    wrong = np.log(found[:, 0])
    assert wrong.std() == pytest.approx(0.1, rel=0.12)
    assert np.mean(wrong[20:] * wrong[:-20]) / wrong.var() == pytest.approx(np.exp(-1.0), abs=0.15)
    seen = found[:, 1, 1:], found[:, 0, 1:] * found[:, 2, 1:]
    assert seen[0] == pytest.approx(seen[1])


def test_who_looks_away_knows_what_he_knew(tmp_path):
    """Ten times a minute for a second: so much of the time, as the means of both have it; meanwhile what he sees stands still."""
    world = column(tmp_path, np.zeros(40), 1000.0 - 20.0 * np.arange(40), distraction_rate=10.0, distraction_length=1.0)
    away, seen = rows(world, 120.0, AWAY, SEEN_GAP).transpose(1, 0, 2)
    mean = np.exp(0.5 * driver.GLANCE**2)
    assert away.mean() == pytest.approx(mean / (mean + 6.0), rel=0.12)
    both = (away[1:, 1:] > 0) & (away[:-1, 1:] > 0)
    before, after = seen[:-1, 1:][both], seen[1:, 1:][both]
    assert before.size > 1000 and np.array_equal(before, after)


def test_who_looks_away_too_long_hits(tmp_path):
    """A standing car 140 m ahead: who looks is fine; who looks away nearly always is not."""
    for style, hits in (({}, 0), ({"distraction_rate": 60.0, "distraction_length": 20.0}, 1)):
        world = column(tmp_path, [0.0, 20.0], [300.0, 150.0], [[0, 0.0], [200, 0.0]], limit=20.0, **style)
        rows(world, 40.0, WISH)
        assert world.events.hits_found == hits


def test_sway(tmp_path):
    """The place that is wanted has a standard deviation of 0.2 m and forgets in 3 s; the front axle follows it."""
    world = column(tmp_path, np.full(20, 20.0), 2000.0 - 100.0 * np.arange(20), length=8000.0, limit=20.0, sway=0.2, sway_time=3.0)
    found = rows(world, 200.0, SWAYED, FRONT_OFFSET)[500::10]
    wanted, driven = found.transpose(1, 0, 2)
    assert wanted.std() == pytest.approx(0.2, rel=0.12)
    assert np.mean(wanted[15:] * wanted[:-15]) / wanted.var() == pytest.approx(np.exp(-1.0), abs=0.1)
    assert 0.1 < driven.std() < 0.25 and np.corrcoef(wanted[:-3].ravel(), driven[3:].ravel())[0, 1] > 0.8


# -- temper ----------------------------------------------------------------------------------------------


def test_temper(tmp_path):
    """At 1 and -1 as the aggressive and the timid driver of Kesting, Treiber and Helbing; between them geometrically."""
    rude, usual, meek = (column(tmp_path, [10.0], [50.0], aggressiveness=g).vehicles.drivers[:, 0] for g in (1.0, 0.0, -1.0))
    assert rude[HEADWAY] == pytest.approx(1.2 * 1.0 / 1.5) and usual[HEADWAY] == 1.2 and meek[HEADWAY] == pytest.approx(1.2 * 1.8 / 1.5)
    assert rude[GAP_SHARE] == pytest.approx(4.9 / 6.05) and usual[GAP_SHARE] == 1.0 and meek[GAP_SHARE] == pytest.approx(7.2 / 6.05)
    half = column(tmp_path, [10.0], [50.0], aggressiveness=0.5)
    assert half.vehicles.drivers[HEADWAY, 0] == pytest.approx(1.2 * (1.0 / 1.5) ** 0.5)
    assert half.seats[0].settings[:, 0].tolist().count(half.vehicles.drivers[HEADWAY, 0]) == 1  # his own law has it as well


# -- bits ------------------------------------------------------------------------------------------------


def test_the_same_bits_alone_batched_and_from_a_snapshot(sample):
    """With everything that people do: worlds of two seeds, together and alone, and cut in the middle."""
    changes = {"traffic.count": 10, **{f"traffic.driver.{name}": value for name, value in WANDERING.items()}}
    settings = [job.prepare(job.load(sample, changes | {"seed": seed})) for seed in (1, 2)]
    together, alone = build(settings), build([settings[0]])
    for world in (together, alone):
        for _ in range(300):
            tick(world)
    assert together.digest(0) == alone.digest(0) != together.digest(1)
    kept = snapshot(alone)
    for _ in range(200):
        tick(alone)
    other = build([settings[0]])
    restore(other, kept)
    for _ in range(200):
        tick(other)
    assert other.digest() == alone.digest()


# -- what comes of it ------------------------------------------------------------------------------------


def collisions(seconds, count, **style):
    """Collisions per vehicle hour of so many cars in a town."""
    changes = {"traffic.count": count, "traffic.spacing": 12, "seed": 3} | {
        f"traffic.driver.{name}": value for name, value in style.items()
    }
    loaded = job.load(ROOT / "scenarios" / "urban_grid.yaml", changes)
    bare = loaded.scenario.model_copy(update={"applications": {}, "script": {}})
    world = build([job.prepare(replace(loaded, scenario=bare))])
    for _ in range(round(seconds / TICK)):
        tick(world)
    return world.events.hits_found / (world.size * seconds / 3600.0)


def test_the_traffic_is_not_safe_by_construction():
    """Nobody hits anybody among usual drivers, nor among late ones; among some who look away for four seconds several do each hour."""
    assert collisions(90.0, 100) == collisions(90.0, 100, expected_reaction=0.7) == 0.0
    assert collisions(90.0, 100, distraction_rate=10.0, distraction_length=4.0) > 2.0


@pytest.mark.parametrize(
    ("way", "speed", "stood", "late", "waits"),
    [
        (20.0, 13.0, 5.0, 0.0, True),  # 13 m/s need 27 m
        (28.0, 13.0, 5.0, 0.0, False),
        (28.0, 13.0, 5.0, 0.7, True),  # and 9.1 m more where one answers late
        (38.0, 13.0, 5.0, 0.7, False),
        (20.0, 2.0, 5.0, 0.7, False),  # who crawls lets others in
        (20.0, 13.0, 31.0, 0.7, False),
    ],
)
def test_nobody_sets_off_into_the_way_of_one_who_would_have_to_brake_hard(way, speed, stood, late, waits):
    state, drivers, mind = np.zeros((len(VEHICLE), 2)), np.zeros((len(DRIVER), 2)), np.zeros((len(MIND), 2))
    state[V_X, 1], drivers[EXPECTED], mind[STOOD, 0] = speed, late, stood
    assert sets_off_before.py_func(0, 1, way, state, drivers, mind) == waits
    state[V_X, 0] = 3.0
    assert not sets_off_before.py_func(0, 1, way, state, drivers, mind)
