"""Deeds: weather, lights, vehicles that come and go, radio, sensors and applications, while their entry acts and not after."""

import numpy as np
import pytest
import yaml

from studio import job
from studio.errors import ScenarioError
from studio.kind import registry
from studio.road.drawn.motorway import motorway
from studio.road.network.signals import GREEN, RED
from studio.vehicle.parameter import WIDTH
from studio.world.build import build
from studio.world.snapshot import restore, snapshot
from studio.world.table.mind import SIGHT, SIGHT_SPEED
from studio.world.tick import tick

TICK = 0.02


@pytest.fixture(scope="module")
def road(tmp_path_factory):
    """A straight road with a car at 20 m/s that follows another with an ACC, and a station."""
    folder = tmp_path_factory.mktemp("deeds")
    (folder / "motorway.xodr").write_text(motorway(length=1500.0, lanes=2), encoding="utf-8")
    car = {"route": "way", "speed": 20.0}
    document = {
        "version": 3, "title": "deeds", "map": {"file": "motorway.xodr"}, "clock": {"duration": 8},
        "routes": {"way": {"roads": ["motorway"], "speeds": [{"at": 0, "speed": 20}]}},
        "vehicles": {
            "own": car | {"position": {"road": "motorway", "lane": 0, "offset": 100}, "sensors": {"front": {"kind": "front_radar"}}},
            "front": car | {"position": {"road": "motorway", "lane": 0, "offset": 140}, "sensors": {}},
        },
        "applications": {"keep": {"application": "acc", "units": ["own"]}},
    }  # fmt: skip
    (folder / "deeds.yaml").write_text(yaml.safe_dump(document))
    return folder / "deeds.yaml"


def at(time):
    return {"kind": "time", "at": time}


def entry(begin, end, kind, **settings):
    return {"when": at(begin), "do": {"kind": kind} | settings} | ({"until": at(end)} if end else {})


def run(road, script, seconds=6.0, **parts):
    return job.run(job.load(road, {"script": script, "clock.duration": seconds} | parts))


def ticks(setting, count):
    world = build([setting])
    for _ in range(count):
        tick(world)
    return world


def prepared(road, script, **parts):
    return job.prepare(job.load(road, {"script": script} | parts))


def spans(run, true):
    """When something began and ceased to be true."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], np.asarray(true, int), [0]])))
    return [float(run.time[min(each, run.time.size - 1)]) for each in edges]


# -- weather and lights --------------------------------------------------------------------------------


def test_weather_comes_and_goes(road):
    """Friction of the ground and sight of the drivers, of two entries that overlap: the later counts, then the earlier again."""
    script = {"ice": entry(1, 4, "weather", friction=0.2, visibility=50), "fog": entry(2, 3, "weather", visibility=30)}
    world = build([prepared(road, script)])
    usual = world.vehicles.drivers[[SIGHT, SIGHT_SPEED], 0].tolist()
    seen = []
    for _ in range(250):
        tick(world)
        seen.append((float(world.roads.weather[0]), float(world.vehicles.drivers[SIGHT, 0])))
    assert [seen[k] for k in (49, 50, 99, 100, 149, 150, 199, 200)] == [
        (1.0, usual[0]), (0.2, 50.0), (0.2, 50.0), (0.2, 30.0), (0.2, 30.0), (0.2, 50.0), (0.2, 50.0), (1.0, usual[0]),
    ]  # fmt: skip
    assert world.vehicles.drivers[[SIGHT, SIGHT_SPEED], 0].tolist() == usual


def test_drivers_slow_down_in_fog(road):
    """From 20 m/s to what one can stop from within 40 m, at 2 m/s²: 2 (v + v²/4) < 80, about 11 m/s."""
    made = run(road, {"fog": entry(1, None, "weather", visibility=40)}, 12, applications={})
    assert made.trace("own.speed")[-1] < 13 < 19 < made.trace("own.speed")[45]


def test_lights_are_forced(sample):
    """Red from 1 to 3 s, then green by hand, then what the programme says."""
    setting = job.prepare(job.load(sample, {"traffic.count": 0, "goals": {}}))
    signals, lanes = setting.network.signals, setting.network.lanes
    road = lanes[signals.link_lane[0]].road
    links = [i for i in range(len(signals)) if lanes[signals.link_lane[i]].road == road]
    script = {"stop": entry(1, 3, "light", road=road, shows="red"), "go": entry(3, 4, "light", road=road, shows="green")}
    world = build([job.prepare(job.load(sample, {"traffic.count": 0, "goals": {}, "script": script}))])
    shown = []
    for _ in range(250):
        tick(world)
        shown.append(world.roads.shown[links].tolist())
    assert all(each == [RED] * len(links) for each in shown[50:150]) and all(each == [GREEN] * len(links) for each in shown[150:200])
    programme = [[signals.state(i, k * TICK + setting.scenario.map.signal_start) for i in links] for k in (*range(50), *range(200, 250))]
    assert shown[:50] + shown[200:250] == programme


# -- vehicles ------------------------------------------------------------------------------------------


def test_a_vehicle_is_taken_away_and_put_back(road):
    """Without values meanwhile, no arrival told; then where it was put, rolling, and whoever follows sees it."""
    script = {"away": entry(1, None, "remove", vehicle="front"), "back": entry(3, None, "place", vehicle="front", along=260, speed=15)}
    made = run(road, script)
    speed = made.trace("front.speed")
    assert spans(made, np.isnan(speed))[0] == pytest.approx(1.0, abs=1.01 * TICK) and np.isfinite(speed[made.time > 3.01]).all()
    assert made.trace("front.station")[np.searchsorted(made.time, 3.0)] == pytest.approx(260, abs=0.5)
    assert speed[np.searchsorted(made.time, 3.0)] == pytest.approx(15, abs=0.1) and abs(speed[np.searchsorted(made.time, 3.2)] - 15) < 1
    assert not [each for each in made.record.happenings if each.kind in ("arrived", "collision")]
    gap = made.trace("own.gap")
    assert np.isnan(gap[(made.time > 1.05) & (made.time < 2.95)]).all() and np.isfinite(gap[made.time > 3.05]).all()


TAKEOVERS = {
    "brake": {}, "set_speed": {"speed": 5}, "hold": {"speed": 5}, "speed_profile": {}, "steer": {},
    "change_lane": {"offset": 1.0}, "follow_path": {"line": [[0, 0], [50, 0]]},
}  # fmt: skip


@pytest.mark.parametrize("kind", TAKEOVERS)
def test_who_commands_a_vehicle_that_is_not_there_is_told(road, kind):
    """Nobody is commanded then. Once it has been put back it is, and that ends as always; so does what had it when it left."""
    script = {
        "before": entry(0.5, None, "brake", vehicle="front", deceleration=1, duration=5), "away": entry(1, None, "remove", vehicle="front"),
        "late": entry(2, None, kind, vehicle="front", **TAKEOVERS[kind]),
        "back": entry(3, None, "place", vehicle="front", along=260, speed=15),
        "then": entry(3.5, 4, "brake", vehicle="front", deceleration=1, duration=5),
    }  # fmt: skip
    told = [(each.time, each.kind, each.text) for each in run(road, script).record.happenings if each.kind.startswith("script_")]
    (vain,) = [each for each in told if each[1] == "script_in_vain"]
    assert vain == (2.0, "script_in_vain", "late does nothing: front is not on the road")
    assert {each[2] for each in told if each[1] == "script_ended"} == {"before ends", "away ends", "back ends", "then ends"}


# -- radio ---------------------------------------------------------------------------------------------

PLATOON = {"keep": {"application": "cacc", "units": ["own"], "listens_to": ["front"], "parameters": {"headway": 1.0}}}


def age(road, script, seconds=6.0, **parts):
    """The age of the newest message on the link, at every tick, and causes of losses."""
    setting = prepared(road, script, applications=PLATOON, **({"radio": {"kind": "ad_hoc", "loss": 0.0}} | parts))
    world, found = build([setting]), []
    for _ in range(round(seconds / TICK)):
        tick(world)
        (post,) = [each for each in world.units.posts if each.link_receiver.size and each.kind.name == "awareness"]
        link = next(i for i in range(post.link_receiver.size) if world.units.name_of(int(post.link_receiver[i])) == "own")
        found.append(world.clock.time - TICK - float(post.inbox[1, link]))
    return np.array(found)


def test_the_radio_is_jammed_in_an_area(road):
    """While the entry acts and the unit is in the area its messages grow old; before and after they are young."""
    x, y = (float(each) for each in build([prepared(road, {})]).vehicles.state[:2, 1])
    near, far = {"x": x, "y": y, "radius": 500.0}, {"x": x + (400.0 if x < 0.0 else -400.0), "y": y, "radius": 50.0}
    usual = age(road, {})
    jammed = age(road, {"jam": entry(2, 4, "jam", area=near)})
    beside = age(road, {"jam": entry(2, 4, "jam", area=far)})
    young = usual[50:].max()
    assert (beside == usual).all() and jammed[50:100].max() <= young
    assert jammed[195] > 1.7 and jammed[210:].max() <= young + TICK


def test_messages_are_dropped_and_delayed(road):
    """The next twenty of the sender; a delay of 0.2 s for everybody."""
    usual, dropped = age(road, {}), age(road, {"drop": entry(2, None, "drop_messages", unit="front", count=20)})
    late = age(road, {"late": entry(2, 4, "delay_messages", added_delay=0.2)})
    period = 0.1
    assert dropped.max() == pytest.approx(usual[50:].max() + 20 * period, abs=2.01 * TICK)
    assert late[120:195].min() == pytest.approx(usual[120:195].min() + 0.2, abs=1.01 * TICK) and late[225:].max() <= usual[50:].max() + TICK


def marked(road, conditions, seconds=3.0, **parts):
    """The times at which marks were made, again and again, of some conditions about messages."""
    script = {name: {"when": {"kind": "message"} | each, "again": True, "do": {"kind": "mark"}} for name, each in conditions.items()}
    loss = {"radio": {"kind": "ad_hoc", "loss": 0.0}}
    made = run(road, script | parts.pop("script", {}), seconds, applications=PLATOON, **(loss | parts))
    begun = [(each.text.split()[0], each.time) for each in made.record.happenings if each.kind == "script_begun"]
    return {name: [time for which, time in begun if which == name] for name in conditions}, made


def test_messages_are_sent_received_and_lost(road):
    """Beacons every 0.1 s: each is seen at the tick after, received when its delay is over, lost when it was dropped, from and to whom."""
    times, _ = marked(road, {
        "sent": {"was": "sent", "sender": "front"},
        "came": {"was": "received", "message": "awareness", "sender": "front", "receiver": "own"},
        "wrong_way": {"was": "received", "sender": "own", "receiver": "front"},
        "lost": {"was": "lost", "sender": "front", "receiver": "own"},
    }, script={"drop": entry(1.5, None, "drop_messages", unit="front", count=3)})  # fmt: skip
    assert np.diff(times["sent"]) == pytest.approx(0.1) and 28 <= len(times["sent"]) <= 30
    assert len(times["lost"]) == 3 and set(times["lost"]) < set(times["sent"]) and 1.5 < times["lost"][0] < 1.64
    assert len(times["came"]) == pytest.approx(len(times["sent"]) - 3, abs=1)
    assert max(np.diff(times["came"])) == pytest.approx(0.4, abs=0.06) and not times["wrong_way"]


def test_nobody_sends_it(road):
    """A kind that only applications send, and none does: it can never come, and that is told."""
    kind = next(name for name, kind in registry.known("message").items() if not hasattr(kind.module, "beacon"))
    _, made = marked(road, {"x": {"message": kind}}, 0.1)
    assert [each.text for each in made.record.happenings if each.kind == "never_begins"] == [
        f"x can never begin: nobody sends messages of the kind {kind!r}"
    ]


# -- on board ------------------------------------------------------------------------------------------


def test_a_sensor_fails_and_is_noisy(road):
    """Nothing while it fails; with four times the noise four times the standard deviation, within 15 % for 1200 samples."""
    made = run(road, {"gone": entry(1, 2, "sensor_fault", unit="own", sensor="front")}, 4)
    there = np.isfinite(made.trace("own.front.range"))
    assert not there[(made.time > 1.1) & (made.time < 1.95)].any() and there[(made.time > 0.3) & (made.time < 0.95)].all()
    noisy = run(
        road, {"noisy": entry(10, None, "sensor_fault", unit="own", sensor="front", fails=False, noise=4.0)}, 22, applications={},
        **{"vehicles.own.speed": 20.0},
    )  # fmt: skip
    seen, true = noisy.trace("own.front.rate"), noisy.trace("front.speed") - noisy.trace("own.speed")
    error = (seen - true)[np.isfinite(seen)]
    times = noisy.time[np.isfinite(seen)]
    before, after = error[(times > 1) & (times < 10)].std(), error[times > 10.2].std()
    assert after / before == pytest.approx(4.0, rel=0.2)


def test_an_application_stops_and_starts(road):
    """Its commands are its driver's meanwhile, and that is told."""
    made = run(road, {"off": entry(2, 4, "stop_application", application="keep")})
    who = made.trace("own.commands_drive")
    assert set(who[(made.time >= 2.0) & (made.time < 3.99)]) == {0.0}
    assert set(who[(made.time > 0.1) & (made.time < 1.99)]) == {4.0} == set(who[(made.time >= 4.0) & (made.time < 5.99)])
    told = [(each.time, each.text) for each in made.record.happenings if each.kind in ("takes_over", "gives_back")]
    assert told == [(2.0, "keep gives brake and drive back to driver"), (4.0, "keep takes over brake and drive from driver")]


def test_an_application_is_tuned(road):
    """A wider time gap for two seconds: as if it had it from the file, until it has its own again."""
    script = {"wide": entry(2, 4, "tune_application", application="keep", unit="own", parameters={"headway": 3.0})}
    world = build([prepared(road, script)])
    (hosted,) = world.hosted
    seen = []
    for _ in range(250):
        tick(world)
        seen.append(float(hosted.parameters[0, 0]))
    usual = seen[0]
    assert len(set(seen)) in (1, 2) and seen[99] == usual == seen[200]
    tuned, plain = run(road, script), run(road, {})
    speed = [each.trace("own.speed") for each in (tuned, plain)]
    assert (speed[0] == speed[1])[tuned.time <= 2.0].all() and (speed[1] - speed[0])[(tuned.time > 3) & (tuned.time < 4)].min() > 0.5


# -- sensors and movers --------------------------------------------------------------------------------


def test_a_radar_sees_somebody_who_walks(road):
    """Ahead in the own lane, walking away with 1.5 m/s: range and rate are those of his near edge."""
    walk = {"do": {"kind": "mover", "route": "way", "line": [[160.0, 0.0], [260.0, 0.0]], "speed": 1.5}}
    quiet = {"front": {"kind": "front_radar", "range_noise": 0.0, "rate_noise": 0.0}}
    alone = {"route": "way", "position": {"road": "motorway", "lane": 0, "offset": 100}, "speed": 20.0, "sensors": quiet}
    made = run(road, {"child": walk}, 1.0, applications={}, vehicles={"own": alone})
    at_ = (made.time > 0.4) & (made.time < 0.9)
    assert made.trace("own.front.rate")[at_] == pytest.approx(1.5 - made.trace("own.speed")[at_], abs=0.3)
    assert made.trace("own.front.range")[at_] == pytest.approx(made.trace("own.gap")[at_], abs=2.0)


# -- bad input, batches --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("do", "field", "word"),
    [
        ({"kind": "weather"}, "", "give `friction`, `visibility` or both"),
        ({"kind": "light", "road": "motorway"}, ".road", "names no road of this map with lights"),
        ({"kind": "place", "vehicle": "own", "along": 99999}, ".along", "≤ "),
        ({"kind": "remove", "vehicle": "owm"}, ".vehicle", "did you mean 'own'?"),
        ({"kind": "jam", "area": {"x": 1, "y": 2}}, ".area", "give either"),
        ({"kind": "delay_messages", "added_delay": -0.1}, ".added_delay", "≥ 0"),
        ({"kind": "drop_messages", "unit": "own", "count": 0}, ".count", "≥ 1"),
        ({"kind": "sensor_fault", "unit": "own", "sensor": "frnt"}, ".sensor", "did you mean 'front'?"),
        ({"kind": "stop_application", "application": "kep"}, ".application", "did you mean 'keep'?"),
        ({"kind": "stop_application", "application": "keep", "unit": "front"}, ".unit", "names no unit of 'keep'"),
        ({"kind": "tune_application", "application": "keep", "parameters": {"headwy": 1}}, ".parameters.headwy", "did you mean 'headway'?"),
        ({"kind": "tune_application", "application": "keep", "parameters": {"headway": -1}}, ".parameters.headway", ""),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told(road, do, field, word):
    with pytest.raises(ScenarioError) as caught:
        prepared(road, {"x": {"do": do}})
    assert f"script.x.do{field}:" in str(caught.value) and word in str(caught.value)


def test_worlds_and_snapshots(road):
    """Worlds with deeds have the bits that they have alone, and go on from a snapshot taken while these act."""
    script = {
        "ice": entry(0.5, 2, "weather", friction=0.3, visibility=60), "off": entry(1, 2, "stop_application", application="keep"),
        "away": entry(1.5, None, "remove", vehicle="front"), "back": entry(2, None, "place", vehicle="front", along=300, speed=10),
        "gone": entry(0.6, 1.2, "sensor_fault", unit="own"),
    }  # fmt: skip
    variants = [prepared(road, each) for each in (script, {}, {"ice": script["ice"]})]

    def made(settings, count):
        world = build(settings)
        for _ in range(count):
            tick(world)
        return world

    alone = [made([each], 150).digest(0) for each in variants]
    assert [made(variants, 150).digest(w) for w in range(3)] == alone and len(set(alone)) == 3
    for before in (30, 55, 80, 110):
        anew = build(variants[:1])
        restore(anew, snapshot(made(variants[:1], before)))
        for _ in range(150 - before):
            tick(anew)
        assert anew.digest(0) == alone[0], before
    assert build(variants[:1]).vehicles.parameter[WIDTH, 0] > 1
