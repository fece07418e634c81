"""Cooperative emergency lane change on whole vehicles: least distances against the formula, and everything that can go wrong."""

from itertools import pairwise, product

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from docs.figures.convoy import run
from docs.figures.feasibility import tried
from docs.figures.situation import APPEARS, FRONT, WIDTH, car, formula, least, situation, survived, way_aside
from studio import job
from studio.application.contract import Heard, Inbox
from studio.conventions import GRAVITY
from studio.kinds.application import celc
from studio.kinds.message.maneuver import ACCEPT, REJECT, Payload
from studio.model.evasion import BRAKE_LAG, left_over

IDLE, ASKING, COMMITTED, EVADING, ASIDE, BRAKING, WEIGHING, YIELDING, REFUSING, FOLLOWING, RESUMING = range(11)
SPEEDS, LATENCIES = (40.0, 75.0, 110.0), (0.01, 0.1, 0.2)
PATIENT = {"always": True, "patience": 0.6}
FAST = 100.0 / 3.6


def stages(record, name):
    """The stages that the application of a car went through, in order."""
    values = record.probes[f"{name}.evasion.stage"].values
    values = values[np.isfinite(values)].astype(int)
    return [int(values[0]), *(int(b) for a, b in pairwise(values) if a != b)]


def cases():
    return [{"speed": v / 3.6, "latency": latency, "parameters": PATIENT} for v, latency in product(SPEEDS, LATENCIES)]


def test_the_way_is_that_of_the_formula():
    """1.00 to 1.30 times it from 40 to 110 km/h and 10 to 200 ms, and at 1.3 times nobody touches anybody."""
    records = run([situation(**each, distance=1.3 * formula(each["speed"], each["latency"])) for each in cases()])
    ratios = [way_aside(record) / formula(each["speed"], each["latency"]) for record, each in zip(records, cases(), strict=True)]
    assert all(1.0 <= ratio <= 1.3 for ratio in ratios), ratios
    assert all(survived(record) for record in records)
    assert all(stages(record, "A") == [IDLE, ASKING, COMMITTED, EVADING, ASIDE] for record in records)


def test_no_evasion_undercuts_the_friction_circle():
    """The least distances without contact, found by bisection: above that of a point, 2 m aside at mu 0.85, braking as it may."""
    found = least(cases(), low=0.5, high=1.3, steps=5)
    for each, distance in zip(cases(), found, strict=True):
        v = each["speed"]

        def needed(a_y, v=v):
            t = np.sqrt(4.0 / a_y)
            return v * t - 0.5 * left_over(0.85 * GRAVITY, a_y) * t * t

        bound = minimize_scalar(needed, bounds=(3.0, 0.85 * GRAVITY), method="bounded").fun
        assert bound < distance <= 1.3 * formula(v, each["latency"])


def together(**changes):
    """100 km/h, 1.25 times the formula's distance, too near to stop."""
    return situation(**{"speed": FAST, "latency": 0.02, "distance": 1.25 * formula(FAST, 0.02), "parameters": {}} | changes)


def test_coordination_is_what_saves():
    """Together nobody is touched. Without an answer A brakes and hits the obstacle; without a look aside it hits B; and so do people."""
    blind = together()
    blind["vehicles"]["A"]["sensors"] = blind["vehicles"]["A"]["sensors"] | {"around": {"kind": "blind_spot", "range": 0.0}}
    answered, alone, careless, people = run([together(), together(loss=1.0), blind, together(application=False)])
    assert survived(answered) and stages(answered, "B")[:4] == [IDLE, WEIGHING, YIELDING, RESUMING]
    assert stages(alone, "A")[:3] == [IDLE, ASKING, BRAKING] and hits(alone) == {("A", "obstacle")}
    assert stages(careless, "A")[:2] == [IDLE, EVADING] and ("A", "B") in hits(careless)
    assert ("A", "obstacle") in hits(people)


def hits(record):
    """Who touched whom."""
    return {
        tuple(sorted(each.units)) if len(each.units) > 1 else (each.units[0], "obstacle")
        for each in record.happenings
        if each.kind == "collision"
    }


def test_where_braking_is_enough_it_brakes():
    (record,) = run([situation(speed=14.0, latency=0.02, distance=22.0)])
    assert survived(record) and stages(record, "A") == [IDLE, BRAKING]
    assert record.trace("A.speed")[-1] < 0.5


def test_an_answer_that_comes_too_late_is_none():
    """0.15 s each way and 0.3 s of patience: A gives up, says so and brakes, and B, which had begun to brake, goes on."""
    (record,) = run([together(latency=0.15, parameters={"patience": 0.3})])
    assert stages(record, "A")[:3] == [IDLE, ASKING, BRAKING]
    assert RESUMING in stages(record, "B") and record.trace("B.speed").min() > 20.0


def test_who_is_pressed_refuses():
    """Somebody is 22 m behind B, who wants 30 m: it says no, and A brakes."""
    (record,) = run([together(others=1, parameters={"room": 30.0})])
    assert REFUSING in stages(record, "B") and YIELDING not in stages(record, "B")
    assert BRAKING in stages(record, "A") and EVADING not in stages(record, "A")


def test_a_partner_that_falls_silent():
    """B is not heard from 60 ms after the obstacle on: it brakes for a commitment that never comes, and A brakes when its patience ends."""
    document = together(parameters={"patience": 0.3})
    document["script"]["silence"] = {"when": {"kind": "time", "at": APPEARS}, "do": {"kind": "drop_messages", "unit": "B", "count": 1000}}
    (record,) = run([document])
    assert stages(record, "A")[:3] == [IDLE, ASKING, BRAKING]
    assert stages(record, "B")[:4] == [IDLE, WEIGHING, YIELDING, RESUMING]


@pytest.mark.parametrize(("after", "evades"), [(0.02, False), (0.06, False), (0.14, True)])
def test_a_partner_that_is_gone(after, evades):
    """B is taken away before it has answered, while it brakes, and when A steers: A brakes, as is the safe default, or goes on."""
    document = together(parameters={"patience": 0.3})
    document["script"]["gone"] = {"when": {"kind": "time", "at": APPEARS + after}, "do": {"kind": "remove", "vehicle": "B"}}
    (record,) = run([document])
    assert record.time[-1] > APPEARS + 4.0 and (EVADING in stages(record, "A") or BRAKING in stages(record, "A"))
    assert ("A", "B") not in hits(record)
    assert (EVADING in stages(record, "A")) == evades


def test_followers_brake_with_those_ahead():
    """0.8 s behind, 100 km/h: who follows A stands before the obstacle, who follows B keeps off it; all by message."""
    (record,) = run([together(others=1, duration=9.0)])
    assert survived(record)
    assert FOLLOWING in stages(record, "behind_A_1") and FOLLOWING in stages(record, "behind_B_1")
    assert record.trace("behind_A_1.speed")[-1] < 1.0


def three_lanes():
    """A follower behind A and one behind B; in the third lane C with a follower; two more 200 m before A, in its lane. All hear all."""
    document = together(others=1, duration=9.0)
    a, group = document["vehicles"]["A"]["position"]["offset"], document["applications"]["evasion"]
    document["vehicles"] |= {
        "C": car(2, a - 30.0, FAST), "behind_C": car(2, a - 60.0, FAST), "far": car(1, a + 200.0, FAST), "farther": car(1, a + 245.0, FAST),
    }  # fmt: skip
    document["applications"]["evasion"] = {key: value for key, value in group.items() if key != "listens_to"} | {
        "units": list(document["vehicles"])
    }
    return document


def test_only_who_is_concerned_brakes():
    """All hear all: the followers in A's lane and in B's brake; those in the third lane and those ahead of A drive on as if nothing was."""
    (record,) = run([three_lanes()], lanes=3)
    assert survived(record)
    assert FOLLOWING in stages(record, "behind_A_1") and FOLLOWING in stages(record, "behind_B_1")
    for name in ("C", "behind_C", "far", "farther"):
        assert stages(record, name) == [IDLE], name
        assert record.trace(f"{name}.speed").min() > FAST - 3.0, name  # who keeps his own gap slows down by 2 m/s


def test_who_cannot_tell_lanes_brakes():
    """With a plain receiver, 1.5 m, lanes cannot be told: the one in the third lane that has somebody ahead brakes, to be safe."""
    plain = {"gps": {"drift": 1.5, "noise": 0.3}}
    document = three_lanes()
    document["vehicles"]["behind_C"] |= plain
    (record,) = run([document], lanes=3)
    assert stages(record, "C") == [IDLE] and stages(record, "behind_C")[:2] == [IDLE, FOLLOWING]


def then(document, along, distance, lane):
    """A further obstacle, so far [m] before A's bumper when A comes to a place of its way [m]; lane 0 is the right one."""
    box = document["script"]["obstacle"]["do"] | {"line": [[along + FRONT + distance + 0.5, lane * WIDTH]]}
    document["script"]["further"] = {"when": {"kind": "passed", "vehicle": "A", "along": along}, "do": box}
    return document


def test_a_second_evasion_after_a_first_one():
    """A has gone to the right lane; 250 m on something lies there, too: it goes around it, back to its first lane, and stays there."""
    (record,) = run([then(together(duration=18.0), 400.0, 1.25 * formula(FAST, 0.02), 0)])
    assert survived(record)
    assert stages(record, "A") == [IDLE, ASKING, COMMITTED, EVADING, ASIDE, EVADING, ASIDE]
    aside = record.trace("A.lateral_offset")
    assert aside.min() == pytest.approx(-WIDTH, abs=0.5) and abs(aside[-1]) < 0.3
    assert record.trace("A.speed")[-1] == pytest.approx(FAST, abs=2.0)


def test_an_evasion_after_one_that_was_aborted():
    """B is not heard, A brakes to a stand; that obstacle is taken away, A drives on, and goes around the next one."""
    document = situation(speed=14.0, distance=30.0, parameters={"always": True, "patience": 0.3}, duration=40.0)
    document["script"]["obstacle"]["until"] = {"kind": "time", "at": 8.0}
    document["script"]["silence"] = {"when": {"kind": "time", "at": APPEARS}, "do": {"kind": "drop_messages", "unit": "B", "count": 30}}
    (record,) = run([then(document, 350.0, 25.0, 1)])
    assert survived(record) and record.trace("A.speed").min() < 0.3
    assert stages(record, "A") == [IDLE, ASKING, BRAKING, IDLE, EVADING, ASIDE]


def test_where_there_is_no_lane_to_the_wanted_side_it_goes_to_the_other_one():
    """A is told to go to the left, where its lane is the last one: it asks B, to the right, as the map has it; without a lane it brakes."""
    two, one = together(parameters={"side": 1.0}), together(parameters={"side": 1.0})
    del one["vehicles"]["B"]
    one["vehicles"]["A"]["position"]["lane"] = 0
    one["applications"]["evasion"] |= {"units": ["A"], "listens_to": [[]]}
    one["script"]["obstacle"]["do"]["line"][0][1] = 0.0
    (wide,) = run([two])
    (narrow,) = run([one], lanes=1)
    assert survived(wide) and wide.trace("A.lateral_offset")[-1] == pytest.approx(-WIDTH, abs=0.4)
    assert stages(narrow, "A")[:2] == [IDLE, BRAKING]


def test_twenty_cars():
    """Nine behind each, 0.8 s apart: nobody touches anybody, those in A's lane slow down one behind the other, A drives on."""
    (record,) = run([together(others=9, duration=16.0)])
    assert survived(record) and record.trace("behind_A_1.speed")[-1] < 1.0
    assert max(record.trace(f"behind_A_{i}.speed").min() for i in range(1, 10)) < 15.0
    assert record.trace("A.speed")[-1] > 20.0


def test_time_to_agree_over_loss():
    """Request and answer, each repeated every 20 ms, a third of them lost: P(agreed within two repetitions) = q² (1 + 2 p + 3 p²)."""
    loss, n, latency = 0.3, 150, 0.01
    records = run(
        [situation(speed=20.0, latency=latency, distance=60.0, loss=loss, parameters=PATIENT, duration=1.8, seed=seed) for seed in range(n)]
    )
    begun = [record.time[np.argmax(record.probes["A.evasion.stage"].values >= COMMITTED)] for record in records]
    earliest = min(begun)
    share = np.mean([each <= earliest + 0.041 for each in begun])
    expected = (1.0 - loss) ** 2 * (1.0 + 2.0 * loss + 3.0 * loss**2)
    assert share == pytest.approx(expected, abs=3.0 * np.sqrt(expected * (1.0 - expected) / n) + 0.02)


def test_it_brakes_no_more_than_the_tyres_have_left():
    """Braking while evading, within 7 m/s² of grip: the sum of both stays near it, and it comes out slower than without."""
    braking = {"always": True, "evasion_braking": 4.0, "grip": 7.0}
    easy, hard = run([situation(speed=25.0, latency=0.02, distance=45.0, parameters=each) for each in ({"always": True}, braking)])
    both = np.hypot(hard.trace("A.acceleration"), hard.trace("A.lateral_acceleration"))
    assert both.max() < 8.0 and survived(hard)
    assert hard.trace("A.speed").min() < easy.trace("A.speed").min() - 1.0


def in_the_way(**who):
    """Somebody else than a box, at the distance at which the box would lie, in the middle of A's lane or on the way there."""
    document = together(duration=8.0)
    box = document["script"]["obstacle"]["do"]
    (near, lateral), after = box["line"][0], who.pop("after", 0.0)
    line = [[near + FAST * after + x, lateral + y] for x, y in who.pop("line")]
    document["script"]["obstacle"]["do"] = {"kind": "mover", "route": "along", "line": line} | who
    return document


def test_whoever_is_in_the_way():
    """A person who steps into the lane from 2 m beside; a cyclist who rides there at 4 m/s; a box without the margin."""
    person = in_the_way(who="pedestrian", line=[[0.0, 2.0], [0.0, 0.0]], speed=2.0, after=0.4)
    cyclist = in_the_way(who="cyclist", line=[[0.5, 0.0], [150.0, 0.0]], speed=4.0)
    box = in_the_way(who="box", line=[[0.0, 0.0]], width=1.8)
    records = run([person, cyclist, box])
    for record in records:
        assert survived(record) and stages(record, "A") == [IDLE, ASKING, COMMITTED, EVADING, ASIDE]
        assert stages(record, "B")[:4] == [IDLE, WEIGHING, YIELDING, RESUMING]
    into = (2.0 - 0.3 - celc.CORRIDOR) / 2.0  # [s] until the nearest of him, 0.3 m before his middle, is in the way
    assert begun(records[0]) == pytest.approx(APPEARS + into, abs=0.05), "the sensor has been sure of him before"


FOUR_LOOKS = 0.06  # [s] from the first look at which the sensor's confidence is 0.5 to the fourth one, 0.94


def begun(record):
    """When A asks [s]."""
    return float(record.time[np.argmax(record.probes["A.evasion.stage"].values == ASKING)])


@pytest.mark.parametrize(
    ("confidence", "recognition", "after"), [(0.0, 0.0, 0.0), (0.9, 0.0, FOUR_LOOKS), (0.99, 0.0, 0.12), (0.9, 0.3, 0.3), (0.99, 0.1, 0.12)]
)
def test_what_recognition_takes(confidence, recognition, after):
    """A look every 20 ms closes half of what the confidence lacks: 0.94 at the fourth, 0.992 at the seventh; and it must have lasted."""
    (record,) = run([together(parameters={"confidence": confidence, "recognition": recognition}, duration=2.0)])
    assert begun(record) - APPEARS == pytest.approx(after, abs=0.025)
    assert record.probes["A.evasion.distance"].values[-1] == pytest.approx(1.25 * formula(FAST, 0.02) - FAST * after, abs=0.03 * FAST)


def test_an_answer_to_another_maneuver_is_none():
    """Two accept the own maneuver, 5, with 6 and 4 m/s²; somebody accepts, and somebody refuses, another one."""

    def told(identity, step, braking):
        payload = Payload()._replace(identity=identity, step=step, acceleration=-braking)
        return Heard(True, 0.0, 0.02, 0.01, 0.0, payload)

    heard = (told(5.0, ACCEPT, 6.0), told(6.0, ACCEPT, 1.0), told(7.0, REJECT, 0.0), told(5.0, ACCEPT, 4.0))
    memory = celc.Memory()._replace(identity=5.0)
    assert celc.answer.py_func(memory, Inbox(4, heard)) == (2, False, 4.0, 0.02)
    assert celc.answer.py_func(memory, Inbox(1, heard[1:2]))[0] == 0


def slippery(kmh, distance, friction, *, sees=True, **changes):
    """On a wet or snowy road; without a sensor for it A goes by a dry one, as every car did before there was one."""
    document = situation(speed=kmh / 3.6, distance=distance, friction=friction, parameters={}, duration=8.0, **changes)
    if not sees:
        for each in document["vehicles"].values():
            each["sensors"] = each["sensors"] | {"condition": {"kind": "road_condition", "drop_out": 1.0}}
    return document


def used(record, friction):
    """The greatest share of what the tyres have on a road of that friction that A has used, across and along together."""
    return np.hypot(record.trace("A.acceleration"), record.trace("A.lateral_acceleration")).max() / (friction * 9.8)


def test_on_snow_it_goes_around_gently_or_brakes():
    """90 km/h at 0.3. 42 m: by the dry road it turns and slides off; now it brakes straight on. 64 m: it has the time, and takes it."""
    blind, near, far = run([slippery(90.0, 42.0, 0.3, sees=False), slippery(90.0, 42.0, 0.3), slippery(90.0, 64.0, 0.3)])
    assert EVADING in stages(blind, "A") and blind.trace("A.lateral_offset").min() < -WIDTH - 1.0
    assert BRAKING in stages(near, "A") and EVADING not in stages(near, "A")
    assert np.abs(near.trace("A.lateral_offset")).max() < 0.3 and ("A", "B") not in hits(near)
    assert survived(far) and stages(far, "A") == [IDLE, ASKING, COMMITTED, EVADING, ASIDE]
    assert used(far, 0.3) < 0.9 and far.trace("A.lateral_offset").min() > -WIDTH - 0.4


def test_on_snow_what_is_promised_is_held():
    """B falls back as it has told, BRAKE_LAG after it has begun: at every moment no slower by more than 0.1 m/s; so A touches nobody."""
    for record in run([tried(90.0, 72.0, seed, {"friction": 0.3}) for seed in range(1, 7)]):
        yields = record.probes["B.evasion.stage"].values == YIELDING
        time, speed = record.time[yields], record.trace("B.speed")[yields]
        offered = min(celc.Parameters().yielding, float(record.probes["B.evasion.road"].values[yields][0]))
        assert time.size > 100 and 1.5 < offered < 0.3 * 9.8
        assert (speed <= speed[0] - offered * (time - time[0] - BRAKE_LAG) + 0.1).all()
        assert survived(record) and stages(record, "A") == [IDLE, ASKING, COMMITTED, EVADING, ASIDE]


def test_on_a_wet_road_it_knows_where_braking_is_not_enough():
    """90 km/h at 0.6, 60 m: on a dry road it would stand, so by that it brakes and hits the obstacle; now it goes around it."""
    blind, sees = run([slippery(90.0, 60.0, 0.6, sees=False), slippery(90.0, 60.0, 0.6)])
    assert hits(blind) == {("A", "obstacle")} and EVADING not in stages(blind, "A")
    assert survived(sees) and EVADING in stages(sees, "A") and used(sees, 0.6) < 0.9


def test_ice_that_begins_on_the_way():
    """The road is dry and has 150 m of ice, which A has come onto when the obstacle appears: what its sensor has seen is what counts."""
    ice = {"kind": "friction", "route": "along", "start": 165.0, "end": 400.0, "friction": 0.3, "width": 12.0}
    seen, blind = (slippery(90.0, 64.0, 1.0, sees=sees) for sees in (True, False))
    for each in (seen, blind):
        each["script"]["ice"] = {"when": {"kind": "time", "at": 0.0}, "do": ice}
    gentle, lost = run([seen, blind])
    assert survived(gentle) and EVADING in stages(gentle, "A") and used(gentle, 0.3) < 0.9
    assert not survived(lost) and EVADING not in stages(lost, "A")  # on a dry road it would stand there
    assert gentle.probes["A.evasion.road"].values[0] > 8.0


def test_a_dry_road_is_driven_on_as_before():
    """What the sensor may be wrong by changes nothing where the road is dry: the same evasion to a decimetre, with it and without."""
    a, b = run([together(), together() | {"seed": 5}])
    (without,) = run([slippery(100.0, 1.25 * formula(FAST, 0.02), 1.0, sees=False)])
    assert survived(a) and survived(b) and survived(without)
    for each in (a, b):
        end = each.time.size
        np.testing.assert_allclose(each.trace("A.lateral_offset"), without.trace("A.lateral_offset")[:end], atol=0.3)


def sample(root, **changes):
    """The sample of CELC, with changes by path."""
    return job.run(job.load(root / "scenarios" / "celc.yaml", changes))


def test_the_sample_is_solved(root):
    outcome = sample(root)
    assert outcome.status == "done" and not outcome.unmet
    assert outcome.metrics["commit_time"].value == pytest.approx(0.1, abs=0.03) and outcome.metrics["maneuvers_aborted"].value == 0.0


def test_what_fails_and_the_measure_that_tells(root):
    """B that brakes too little: an impact at full speed though all agreed. A late radio: taken back, and an impact with braking."""
    soft = sample(root, **{"applications.evasion.parameters.yielding": 3.0}).metrics
    late = sample(root, **{"radio.delay": 0.2}).metrics
    people = sample(root, applications={}).metrics
    assert soft["commit_time"].value < 0.2 and soft["max_impact_speed"].value > 25.0
    assert late["maneuvers_aborted"].value == 1.0 and late["max_impact_speed"].value < 20.0
    assert people["collisions"].value == 1.0 and people["maneuvers_aborted"].value is None
