"""Cars that park themselves, on whole vehicles in the drawn deck: ten at once, and everything that gets in their way."""

from math import cos, sin

import numpy as np
import pytest

from docs.figures.pace import deck, gone, run, touched
from studio import job
from studio.assess.encroachment import encroachments
from studio.assess.parking import clearance, detours, errors, middle, parking_times, stays
from studio.garage import plan, way
from studio.garage.reeds_shepp import wrapped
from studio.garage.way import Car

COMPACT = Car(2.765, 4.261, 1.809, 0.84, 4.6)
LATERAL, LONGITUDINAL, YAW = 0.15, 0.25, np.radians(3.0)  # of a parked car: domain notes, section 3


def trace(record, name, of, group="parking"):
    return record.probes[f"{name}.{group}.{of}"].values


def first(record, name, phase, group="parking"):
    """The sample at which a phase begins."""
    return int(np.argmax(trace(record, name, "phase", group) == phase))


def off(record, name, group="parking", deck=plan.SIXTY):
    """How far a parked car is from the middle of its space: along, across [m], turned [rad]."""
    k = first(record, name, 3.0, group) - 1
    it = plan.spaces(deck)[int(trace(record, name, "space", group)[k])]
    x, y = middle(record, name)
    dx, dy, c, s = x[k] - it.x, y[k] - it.y, cos(it.heading), sin(it.heading)
    return dx * c + dy * s, dy * c - dx * s, wrapped(float(record.trace(f"{name}.heading")[k]) - it.heading)


@pytest.fixture(scope="module")
def ten():
    return run([deck(10, duration=400.0, stay=100.0)])[0]


def test_ten_cars_park_and_leave(ten):
    assert len(list(parking_times(ten))) == 10 and gone(ten) == 10
    assert touched(ten) == 0
    assert clearance(ten).value >= 0.15


def test_they_stand_in_the_middle_of_their_spaces(ten):
    spaces = {trace(ten, stay.vehicle, "space").max() for stay in stays(ten)}
    assert len(spaces) == 10
    for stay in stays(ten):
        along, across, turned = off(ten, stay.vehicle)
        assert abs(across) <= LATERAL and abs(along) <= LONGITUDINAL and abs(turned) <= YAW


def test_they_know_where_they_are_and_keep_to_their_way(ten):
    """Root of the mean square of the offset from the way at most 0.10 m; true, not as the car takes it."""
    for stay in stays(ten):
        assert np.sqrt(np.mean(errors(ten, stay) ** 2)) < 0.12
        path, on = way.into(plan.SIXTY, int(trace(ten, stay.vehicle, "space").max()), COMPACT), stay.phase == 1.0
        x, y = middle(ten, stay.vehicle)
        heading = ten.trace(f"{stay.vehicle}.heading")
        rear = np.column_stack([x - COMPACT.middle * np.cos(heading), y - COMPACT.middle * np.sin(heading)])[on]
        away = np.array([np.hypot(path.x - a, path.y - b).min() for a, b in rear[::5]])
        assert np.sqrt(np.mean(away**2)) <= 0.10


def test_they_drive_hardly_more_than_their_way(ten):
    """The way itself is the shortest with the clearance that is kept; the dead reckoning of the distance is as good as the speed."""
    assert all(1.0 <= each.value + 0.03 <= 1.15 for each in detours(ten))


def test_nobody_is_ahead_of_a_parked_car(ten):
    """Who drives past on the aisle is beside it: no gap, no time to collision, and no post-encroachment time of ways that only touch."""
    for stay in stays(ten):
        row = ten.vehicles.index(stay.vehicle)
        parked = (trace(ten, stay.vehicle, "phase") == 2.0) & (np.abs(ten.channel("speed")[row]) < 0.01)
        assert parked.sum() > 100 and np.isnan(ten.channel("gap")[row][parked]).all()
    assert min((each.value for each in encroachments(ten)), default=0.0) >= 0.0


PERSON = {"kind": "mover", "who": "pedestrian", "line": [[-14.0, -8.0]]}
STRANGER = {
    "kind": "mover",
    "who": "box",
    "line": [[plan.spaces(plan.SIXTY)[0].x, plan.spaces(plan.SIXTY)[0].y]],
    "length": 4.2,
    "width": 1.7,
}
WALKER = {"kind": "mover", "who": "pedestrian", "line": [[-14.0, -12.0], [-14.0, -3.0]], "speed": 1.2, "stays": False}
OUTAGE = {"kind": "sensor_fault", "unit": "garage", "sensor": "cameras"}
NEAREST = {"allocation": "first_come"}


def between(begin, end, do):
    """An entry of the script."""
    return {"when": {"kind": "time", "at": begin}, "until": {"kind": "time", "at": end}, "do": do}


@pytest.fixture(scope="module")
def trouble():
    """One run for each thing that gets in the way."""
    cases = {
        "full": deck(2, duration=190.0, stay=20.0, garage={"spaces": 1}),
        "person": deck(1, duration=100.0, garage=NEAREST, script={"person": between(10.0, 45.0, PERSON)}),
        "stranger": deck(1, duration=70.0, garage=NEAREST, script={"box": {"do": STRANGER}}),
        "minutes": deck(1, duration=260.0, garage=NEAREST, script={"person": between(10.0, 200.0, PERSON)}),
        "late": deck(1, duration=80.0, garage=NEAREST, script={"box": {"when": {"kind": "time", "at": 12.0}, "do": STRANGER}}),
        "short": deck(1, duration=70.0, garage=NEAREST, script={"dark": between(14.0, 15.6, OUTAGE)}),
        "long": deck(1, duration=90.0, garage=NEAREST, script={"dark": between(14.0, 34.0, OUTAGE)}),
        "lossy": deck(2, duration=90.0, garage=NEAREST, loss=0.5),
    }
    return {name: run([case])[0] for name, case in cases.items()}


def test_when_all_spaces_are_taken_the_next_waits_at_the_gate(trouble):
    """First in, first out: the second is taken in after the first has left, and stands where that stood."""
    record = trouble["full"]
    assert len(list(parking_times(record))) == 2 and touched(record) == 0
    assert first(record, "car_2", 1.0) > first(record, "car_1", 4.0)
    waited = record.time[first(record, "car_2", 1.0)] - record.time[first(record, "car_1", 1.0)]
    assert waited > 60.0
    assert np.nanmin(np.abs(record.trace("car_2.speed"))[first(record, "car_1", 2.0) : first(record, "car_1", 3.0)]) < 0.05


def test_somebody_who_stands_in_the_aisle_is_waited_for(trouble):
    """Only the cameras see him: the car stops a metre or more before him, and parks when he is gone."""
    record = trouble["person"]
    at = (record.time > 35.0) & (record.time < 44.0)
    assert np.all(np.abs(record.trace("car_1.speed")[at]) < 0.05)
    front = middle(record, "car_1")[0][at] + COMPACT.length / 2.0
    assert np.all((-14.3 - front > 0.9) & (-14.3 - front < 4.0))
    assert touched(record) == 0 and len(list(parking_times(record))) == 1


def test_a_space_in_which_a_stranger_stands_is_not_given_away(trouble):
    record = trouble["stranger"]
    assert trace(record, "car_1", "space").max() != 0.0 and trace(trouble["short"], "car_1", "space").max() == 0.0
    assert len(list(parking_times(record))) == 1 and touched(record) == 0


def test_who_stands_in_the_aisle_for_minutes(trouble):
    """190 s: the car waits as long, nothing is given up, and it parks when the way is free again."""
    record = trouble["minutes"]
    at = (record.time > 40.0) & (record.time < 199.0)
    assert np.all(np.abs(record.trace("car_1.speed")[at]) < 0.05)
    assert touched(record) == 0 and len(list(parking_times(record))) == 1


def test_a_stranger_who_takes_the_space_that_was_given_away(trouble):
    """At 12 s, while the car is on its way there: it is given another one, and nobody is touched."""
    record = trouble["late"]
    given = trace(record, "car_1", "space")[trace(record, "car_1", "phase") == 1.0]
    assert given[0] == 0.0 and given[-1] != 0.0
    assert touched(record) == 0 and len(list(parking_times(record))) == 1


def walked(begin):
    """Somebody walks across the aisle from a time on; 3.3 s later he is in the middle of it."""
    return deck(1, duration=60.0, garage=NEAREST, script={"walker": {"when": {"kind": "time", "at": begin}, "do": WALKER}})


def test_somebody_who_walks_into_its_way():
    """At moments while the car comes: it stops for him, softly or hard, or he is through before; nobody is touched, and it parks."""
    slowest = []
    for record in run([walked(begin) for begin in (7.0, 12.0, 14.0, 15.0, 16.0, 17.0)]):
        assert touched(record) == 0 and len(list(parking_times(record))) == 1
        (x, y), v = middle(record, "car_1"), record.trace("car_1.speed")
        slowest.append(v[(abs(y + 8.0) < 0.5) & (x > -24.0) & (x < -16.0) & (v > -0.05)].min())
    assert min(slowest) < 0.3 and max(slowest) > 1.5, "some of them are stopped for, some are not in the way"


OTHER = plan.Plan(3, 4, 5.2, 2.6, 6.5)  # 48 spaces in shorter rows, wider


def test_another_deck():
    """The garage is told its measures, and tells the cars: three come and leave, in the middle of their spaces."""
    (record,) = run([deck(3, duration=200.0, stay=20.0, shape=OTHER)], OTHER)
    assert len(list(parking_times(record))) == gone(record) == 3 and touched(record) == 0 and clearance(record).value >= 0.15
    for stay in stays(record):
        along, across, turned = off(record, stay.vehicle, deck=OTHER)
        assert abs(across) <= LATERAL and abs(along) <= LONGITUDINAL and abs(turned) <= YAW


MEASURES = ("wheelbase", "length", "width", "front_overhang", "radius", "mass", "wheel")
MODELS = {
    "car_1": ("suv", (2.81, 4.7, 1.89, 0.87, 4.8, 2000.0, 0.359)),
    "car_2": ("smart_fortwo", (1.81, 2.5, 1.52, 0.35, 4.0, 900.0, 0.279)),
    "car_3": ("electric_compact", (2.765, 4.261, 1.809, 0.84, 4.6, 1850.0, 0.34)),
}


def test_models_of_all_sizes():
    """A large one with a converter, a small one with a clutch, a compact one: each by its own measures, within the same tolerances."""
    document = deck(3, duration=230.0, stay=20.0)
    group = document["applications"].pop("parking")
    for name, (model, measures) in MODELS.items():
        parameters = dict(zip(MEASURES, measures, strict=True))
        document["vehicles"][name] |= {"model": model}
        document["applications"][f"{name}_parks"] = group | {"units": [name], "listens_to": ["garage"], "parameters": parameters}
    (record,) = run([document])
    assert len(list(parking_times(record))) == gone(record) == 3 and touched(record) == 0 and clearance(record).value >= 0.15
    for name in MODELS:
        along, across, turned = off(record, name, f"{name}_parks")
        assert abs(across) <= LATERAL and abs(along) <= LONGITUDINAL and abs(turned) <= YAW


def test_a_short_gap_of_the_cameras_is_bridged(trouble):
    """1.6 s without a look at 2.5 m/s: 0.1 m and 2 % of what was driven meanwhile, on top of what noise leaves (checks 55)."""
    record = trouble["short"]
    stay = next(stays(record))
    x, y = middle(record, "car_1")
    at = (record.time > 14.0) & (record.time < 16.0)
    assert np.min(record.trace("car_1.speed")[at]) > 1.0, "it goes on"
    assert np.max(np.hypot(stay.x - x, stay.y - y)[at]) < 0.1 + 0.02 * 4.0 + 0.1


def test_in_a_long_gap_it_stands(trouble):
    """From `blind` seconds on, and goes on when it is seen again."""
    record = trouble["long"]
    at = (record.time > 20.0) & (record.time < 33.9)
    assert np.all(np.abs(record.trace("car_1.speed")[at]) < 0.05)
    assert len(list(parking_times(record))) == 1 and touched(record) == 0


def test_half_of_the_messages_are_enough(trouble):
    record = trouble["lossy"]
    assert len(list(parking_times(record))) == 2 and touched(record) == 0
    for name in ("car_1", "car_2"):
        assert trace(record, name, "phase").max() >= 2.0


def test_the_sample_meets_its_goals(root):
    outcome = job.run(job.load(root / "scenarios" / "parking_pace.yaml"))
    assert outcome.status == "done" and not outcome.unmet, outcome.unmet


def test_the_measure_that_tells_first_come_from_optimal(root):
    """Each in front of the next: of five cars one is not parked after 90 s, which is the one goal that is missed."""
    outcome = job.run(job.load(root / "scenarios" / "parking_pace.yaml", {"applications.house.parameters.allocation": "first_come"}))
    assert outcome.status == "done" and len(outcome.unmet) == 1 and outcome.unmet[0].startswith("parking_time is ")
