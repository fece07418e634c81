"""Measures of how near it was, against their closed forms."""

from math import inf, nan

import numpy as np
import pytest

from studio.assess import following, rss
from studio.assess.encroachment import Pieces, candidates, crossings, encroachments, passes, ways_of
from studio.assess.following import Pair
from studio.assess.impact import speed_change
from studio.assess.measure import measure_all
from studio.execution.record import Body
from studio.kind import registry
from studio.kind.slot import chosen
from tests.assess.drive import NAMES, behind, braking, record

STATE = Pair(*(np.array([each]) for each in (30.0, 25.0, 15.0, -1.0, -4.0)))


def measured(made, **listed):
    """The measures of a record; those with settings of their own by name, as (kind, settings)."""
    known = registry.known("metric")
    return measure_all(made, {name: chosen(known[kind])(**given) for name, (kind, given) in listed.items()})


def test_the_state_of_the_textbook():
    """s = 30 m, 25 against 15 m/s, -1 and -4 m/s²: all follow from one line each; exact to the digits that are given."""
    assert following.time_to_collision(STATE.gap, STATE.speed, STATE.ahead_speed)[0] == 3.0
    assert following.drac(STATE)[0] == pytest.approx(1.667, abs=5e-4)
    assert following.mdrac(STATE, 1.0)[0] == pytest.approx(2.5)
    assert following.mttc(STATE)[0] == pytest.approx(2.244, abs=5e-4)
    assert following.time_headway(STATE)[0] == pytest.approx(1.2)


@pytest.mark.parametrize("da", [-3.0, -0.5, -1e-9, 0.0, 0.5, 3.0])
@pytest.mark.parametrize("closing", [-5.0, 0.0, 2.0, 10.0])
def test_mttc_is_the_least_positive_root(da, closing):
    """s = Δv t + Δa t²/2 at the time that is found; no earlier root on a fine grid."""
    p = Pair(*(np.array([each]) for each in (30.0, 20.0 + closing, 20.0, da, 0.0)))
    found = following.mttc(p)[0]
    times = np.linspace(0.0, min(found, 200.0), 20_001)[:-1]
    left = 30.0 - closing * times - 0.5 * (da if abs(da) > 1e-6 else 0.0) * times**2
    assert (left > 0.0).all()
    if np.isfinite(found):
        assert closing * found + 0.5 * da * found**2 == pytest.approx(30.0, abs=1e-4)


@pytest.mark.parametrize(
    ("gap", "v_f", "v_l", "b_l"), [(30.0, 25.0, 15.0, 4.0), (30.0, 25.0, 15.0, 0.0), (12.0, 20.0, 20.0, 6.0), (50.0, 30.0, 29.0, 1.0)]
)
def test_the_required_deceleration_just_suffices(gap, v_f, v_l, b_l):
    """Braking with it, the least gap of both drives to standstill is zero within 1 cm."""
    found = following.required_deceleration(Pair(*(np.array([each]) for each in (gap, v_f, v_l, 0.0, -b_l))))[0]
    time = np.linspace(0.0, 60.0, 600_001)
    x_l = braking(time, v_l, 0.0, b_l, 0.0)[0] if b_l else v_l * time
    x_f = braking(time, v_f, 0.0, found, 0.0)[0]
    assert (gap + x_l - x_f).min() == pytest.approx(0.0, abs=0.01)


def test_nobody_ahead_and_nobody_closing():
    p = Pair(*(np.array(each) for each in ([nan, 20.0], [20.0, 20.0], [nan, 25.0], [0.0, 0.0], [nan, 0.0])))
    for each in (following.drac(p), following.mdrac(p, 1.0), following.required_deceleration(p)):
        assert np.isnan(each[0]) and each[1] == 0.0
    assert np.isnan(following.mttc(p)[0]) and following.mttc(p)[1] == inf


TWO = {"rho": 1.0, "a": 3.5, "b_min": 4.0, "b_max": 8.0}
HALF = {"rho": 0.5, "a": 2.0, "b_min": 4.0, "b_max": 8.0}


@pytest.mark.parametrize(
    ("v_r", "v_f", "rules", "distance"),
    [(27.78, 27.78, TWO, 103.60), (13.89, 13.89, TWO, 41.38), (27.78, 27.78, HALF, 69.44), (20.0, 27.78, HALF, 17.14),
     (27.78, 20.0, HALF, 92.68)],
)  # fmt: skip
def test_rss_in_the_same_direction(v_r, v_f, rules, distance):
    assert rss.longitudinal(v_r, v_f, **rules) == pytest.approx(distance, abs=0.01)


def test_rss_in_opposite_directions_and_beside():
    for rho, distance in ((1.0, 103.424), (0.5, 79.056)):
        assert rss.opposite(13.89, 13.89, rho=rho, a=2.0, b_correct=3.0, b_min=4.0) == pytest.approx(distance, abs=2e-3)
    for v, distance in ((0.5, 0.6312), (0.0, 0.1625)):
        assert rss.lateral(v, 0.0, rho=0.5, a=0.2, b=0.8, margin=0.1) == pytest.approx(distance, abs=2e-3)


def test_closing_to_impact():
    """10 m/s closing over 60 m, until it happens: TET(3) is 3 s and TIT(3) 4.5 s², within a sample."""
    dt = 0.02
    time = np.arange(0.0, 6.0, dt)
    still = (np.zeros(time.size),) * 3
    made = behind(time, 60.0, still, (10.0 * time, np.full(time.size, 10.0), np.zeros(time.size)))
    found = measured(made)
    assert found["time_exposed_ttc"].value == pytest.approx(3.0, abs=dt)
    assert found["time_integrated_ttc"].value == pytest.approx(4.5, abs=3 * dt)
    assert found["time_exposed_ttc"].subject == ("b",) and found["time_exposed_ttc"].time is None


@pytest.fixture(params=[0.01, 0.02])
def hard(request):
    """Both 20 m/s, gap 14 m; the leader brakes with 4 m/s² from 2 s, the follower with 6 m/s² from 3.5 s, both until 8 m/s."""
    time = np.arange(0.0, 10.0 + 1e-9, request.param)
    return behind(time, 14.0, braking(time, 20.0, 2.0, 4.0, 8.0), braking(time, 20.0, 3.5, 6.0, 8.0))


def test_a_hard_brake(hard):
    """Every figure within ±0.002; the least gap and the least TTC with who and when."""
    found = measured(hard)
    gap, ttc = found["min_gap"], found["min_ttc"]
    assert (gap.value, gap.subject, gap.time) == (pytest.approx(2.0, abs=2e-3), ("b", "a"), pytest.approx(5.5, abs=1e-6))
    assert gap.about == "b behind a at 5.50 s"
    assert (ttc.value, ttc.time) == (pytest.approx(0.9167, abs=2e-3), pytest.approx(5.0, abs=1e-6))
    assert found["time_exposed_ttc"].value == pytest.approx(2.3867, abs=2e-3)
    assert found["time_integrated_ttc"].value == pytest.approx(3.6385, abs=2e-3)
    assert found["max_drac"].value == pytest.approx(1.8947, abs=2e-3)
    assert found["min_time_gap"].value == pytest.approx(0.2301, abs=2e-3)


def test_passing_a_conflict_area():
    """A of 4.5 m with 10 m/s, 20 m before an area of 3.5 m, leaves at 2.8 s; B with 8 m/s and 1.5 m/s², 34 m before, enters at 3.2561 s."""
    time = np.arange(0.0, 6.0, 0.001)
    _, leaves = passes(10.0 * time, time, front=0.0, length=4.5, begin=20.0, end=23.5)
    enters, _ = passes(8.0 * time + 0.75 * time**2, time, front=0.0, length=4.5, begin=34.0, end=37.5)
    assert leaves == pytest.approx(2.8, abs=2e-3) and enters == pytest.approx(3.2561, abs=2e-3)
    assert enters - leaves == pytest.approx(0.4561, abs=2e-3)


@pytest.mark.parametrize("angle", [90.0, 60.0, 130.0])
def test_post_encroachment_of_two_crossing_ways(angle):
    """10 m/s each through a crossing at an angle, the second 3 s later: PET is 3 s less the way through the area and a car's length."""
    time, phi = np.arange(0.0, 12.0, 0.02), np.radians(angle)
    s_a, s_b = 10.0 * time - 30.0, 10.0 * time - 60.0
    x = np.array([s_a, s_b * np.cos(phi)])
    y = np.array([np.zeros(time.size), s_b * np.sin(phi)])
    (found,) = encroachments(record(time, x=x, y=y, speed=10.0, heading=np.array([[0.0], [phi]])))
    e = (0.9 + abs(np.cos(phi)) * 0.9) / np.sin(phi)
    assert found.value == pytest.approx(3.0 - (2.0 * e + 4.5) / 10.0, abs=1e-6)
    assert found.subject == ("b", "a") and found.time == pytest.approx(6.0 - (e + 2.25) / 10.0, abs=1e-6)


def test_post_encroachment_of_one_who_backs():
    """He backs across a street with his rear first, 2 m/s, the other comes with 10 m/s 8 s later: PET by hand, with what goes first."""
    time = np.arange(0.0, 25.0, 0.02)
    back, along = 10.0 - 2.0 * time, 10.0 * time - 130.0
    x, y = np.array([np.zeros(time.size), along]), np.array([back, np.zeros(time.size)])
    bodies = {"a": Body(4.5, 1.8, 1.5, 1500.0, 0.3), "b": Body(4.5, 1.8, 2.25, 1500.0, 0.3)}
    speed = np.array([np.full(time.size, -2.0), np.full(time.size, 10.0)])
    (found,) = encroachments(record(time, bodies=bodies, x=x, y=y, speed=speed, heading=np.array([[np.pi / 2], [0.0]])))
    leaves = (10.0 + 0.9 + 1.5) / 2.0  # his front, now at the back, 1.5 m behind, is past the street's strip
    enters = (130.0 - 0.9 - 2.25) / 10.0
    assert found.value == pytest.approx(enters - leaves, abs=1e-6) and found.subject == ("b", "a")


def test_who_turns_round_where_another_crosses_has_not_passed_there():
    """He comes to the street, stands on its strip, and backs again before the other comes: no way through it is made of both of his."""
    time = np.arange(0.0, 20.0, 0.02)
    speed = np.where(time < 10.0, 1.0, -1.0)
    y = np.cumsum(speed) * 0.02 - 9.9
    made = record(
        time,
        x=np.array([np.zeros(time.size), 10.0 * time - 170.0]),
        y=np.array([y, np.zeros(time.size)]),
        speed=np.array([speed, np.full(time.size, 10.0)]),
    )
    assert y.max() < 0.9 + 0.5 and list(encroachments(made)) == []


def test_who_begins_on_a_crossing_came_to_it_at_no_time():
    """He stands over the street at first and drives off after the other is past: when he came there nobody knows, so nothing is told."""
    time = np.arange(0.0, 20.0, 0.02)
    y = np.maximum(2.0 * (time - 10.0), 0.0) - 1.0
    made = record(
        time,
        x=np.array([np.zeros(time.size), 10.0 * time - 60.0]),
        y=np.array([y, np.zeros(time.size)]),
        speed=np.array([np.where(time > 10.0, 2.0, 0.0), np.full(time.size, 10.0)]),
    )
    assert list(encroachments(made)) == []


def test_who_follows_on_the_same_way_crosses_nobody():
    time = np.arange(0.0, 10.0, 0.02)
    made = record(time, x=np.array([10.0 * time, 10.0 * time - 20.0]), y=0.1 * np.sin(np.array([time, 2.0 * time])), speed=10.0)
    assert list(encroachments(made)) == []


def test_the_change_of_speed_keeps_momentum():
    """1500 kg meet 1000 kg at 10 m/s: 4 and 6 m/s, whose momenta are equal; a wall takes all of it."""
    one, other = speed_change(1500.0, 1000.0, 10.0), speed_change(1000.0, 1500.0, 10.0)
    assert (one, other) == (4.0, 6.0) and 1500.0 * one == 1000.0 * other
    assert speed_change(1500.0, inf, 10.0) == 10.0


def test_margins_beside_and_oncoming():
    """Two at 1 m from side to side: 1 m less 0.2625 m of RSS at rest laterally (rho 1). Two that come towards each other: 50 m too near."""
    time = np.arange(0.0, 1.0, 0.02)
    beside = record(time, x=np.array([[0.0], [1.0]]) + 20.0 * time, y=np.array([[0.0], [2.8]]) + 0.0 * time, speed=20.0)
    safe = 0.1 + 2.0 * (0.1 + 0.2**2 / 1.6)
    found = measured(beside)["rss_lateral_margin"]
    assert found.value == pytest.approx(1.0 - safe) and found.subject == ("a", "b") and found.about.startswith("a beside b")
    x = np.array([20.0 * time, 100.0 - 20.0 * time])
    oncoming = record(time, x=x, y=0.0, heading=np.array([[0.0], [np.pi]]), speed=20.0)
    safe = rss.opposite(20.0, 20.0, rho=1.0, a=3.5, b_correct=3.0, b_min=4.0)
    least = measured(oncoming)["rss_oncoming_margin"]
    assert least.value == pytest.approx(100.0 - 40.0 * time[-1] - 4.5 - safe) and least.time == pytest.approx(time[-1])


def test_steering_past_what_stands():
    """At 20 m/s, 40 m before a car that stands 0.3 m to the left: 1.5 m to the right within 2 s needs 0.75 m/s²."""
    time = np.array([0.0, 0.001])
    made = behind(time, 40.0, (np.zeros(2),) * 3, (20.0 * time, np.full(2, 20.0), np.zeros(2)))
    made.values[NAMES.index("y"), 0] = 0.3
    found = measured(made, threat=("max_steer_threat", {"lateral_acceleration": 7.5}))
    assert found["threat"].value == pytest.approx(2.0 * 1.5 / 2.0**2 / 7.5, rel=2e-3) and found["threat"].subject == ("b", "a")


def test_crossings_among_many_vehicles():
    """200 cars in four lanes of a straight road and 20 that cross it: every crossing is found, and pieces that lie alike are not paired."""
    time = np.arange(0.0, 20.0, 0.1)
    along = [(12.0 * time + 9.0 * i, np.full(time.size, 3.5 * (i % 4))) for i in range(200)]
    across = [(np.full(time.size, 400.0 + 30.0 * i), 10.0 * time - 100.0 - 7.0 * i) for i in range(20)]
    x, y = (np.array(each) for each in zip(*along, *across, strict=True))
    names = [*(f"along_{i}" for i in range(200)), *(f"across_{i}" for i in range(20))]
    made = record(time, names, x=x, y=y, speed=12.0)
    ways = [way for row in range(len(names)) for way in ways_of(made, row)]
    pieces = Pieces.of(ways)
    assert len(candidates(pieces)) < 200_000
    pairs = {(a.vehicle, b.vehicle) for a, b, _ in crossings(ways)}
    wanted = {
        (f"along_{i}", f"across_{j}") for i in range(200) for j in range(20) if passes_by(x[i], 3.5 * (i % 4), x[200 + j], y[200 + j])
    }
    assert pairs == wanted and len(wanted) > 300


def passes_by(x, y, column, driven):
    """Whether a way along x at a height y crosses one along y in a column."""
    return x[0] < column[0] < x[-1] and driven[0] < y < driven[-1]
