"""What every sensor has: delay, period, drop-out, faults; its ring in snapshots and batches; the age of what it gives."""

import numpy as np
import pytest
from pydantic import ValidationError

from studio.kinds.sensor.front_radar import Settings
from studio.vehicle.parameter import LENGTH
from studio.vehicle.state import PSI, V_X, X, Y
from studio.workshop.stage import stage
from studio.world.snapshot import restore, snapshot
from studio.world.table.unit import FAILS, MEASURED, NOISE
from studio.world.tick import gather, sense

TICK = 0.02
GAP = 80.0  # [m] from bumper to bumper at first
PLACES = {"own": 0.0, "ahead": 0.0, "behind": -900.0, "beside": -700.0, "other": -500.0, "far": -300.0}  # [m]
EXACT = {"range_noise": 0.0, "rate_noise": 0.0}
SEEN, RANGE, RATE, AGE, TRUE = range(5)


def made(**sensor):
    """A stage with a front radar without noise on `own`; everybody on one line, all but `ahead` behind it."""
    run = stage(vehicles={"own": {"sensors": {"front": {"kind": "front_radar"} | EXACT | sensor}}})
    world = run.world
    for name, x in PLACES.items():
        world.vehicles.state[[X, Y, PSI, V_X], world.column(name)] = x, 0.0, 0.0, 0.0
    return world


def looks(world, ticks, *, closing=10.0, braking=0.0, gap=GAP):
    """What the radar gives at every tick, [SEEN, RANGE, RATE, AGE, TRUE; tick], while the gap closes: by speed, and ever faster.

    Cars are moved as points, so that what is true is known to the last bit: the gap is `gap` - closing t - braking t²/2.
    """
    state, own, ahead = world.vehicles.state, world.column("own"), world.column("ahead")
    length, (each,) = float(world.vehicles.parameter[LENGTH, ahead]), world.units.mounted
    found = []
    for k in range(world.clock.k, world.clock.k + ticks):
        world.clock.k, t = k, k * TICK
        true = gap - closing * t - braking * t * t / 2.0
        state[[X, V_X], own], state[[X, V_X], ahead] = (0.0, 20.0), (true + length, 20.0 - closing - braking * t)
        gather(world)
        sense(world)
        found.append((*each.out[0, :3], age(each, t), true))
    world.clock.k += 1
    return np.array(found).T


def age(each, time):
    """Of what the first sensor gives [s]; the time while it has given nothing."""
    return time - each.health[MEASURED, 0] if each.health[MEASURED, 0] >= 0.0 else time


# -- delay ---------------------------------------------------------------------------------------------


def test_without_a_delay_the_present_is_given():
    found = looks(made(), 50)
    assert found[SEEN].all() and (found[AGE] == 0.0).all()
    np.testing.assert_allclose(found[RANGE], found[TRUE], atol=1e-9)
    np.testing.assert_allclose(found[RATE], -10.0, atol=1e-9)


def test_a_tenth_of_a_second_late_reads_a_metre_too_far():
    """At 10 m/s closing: +1.00 m; nothing is given before the first delay has passed."""
    found = looks(made(delay=0.1), 100)
    assert not found[SEEN, :5].any() and found[SEEN, 5:].all()
    np.testing.assert_allclose(found[AGE, 5:], 0.1, atol=1e-9)
    np.testing.assert_allclose(found[RANGE, 5:] - found[TRUE, 5:], 1.0, atol=1e-9)
    np.testing.assert_allclose(found[AGE, :5], TICK * np.arange(5), atol=1e-12)


def test_late_while_the_other_brakes():
    """1 s after equal speeds at 6 m/s² relative: +0.57 m and +0.6 m/s."""
    found = looks(made(delay=0.1), 51, closing=0.0, braking=6.0)
    assert found[RANGE, 50] - found[TRUE, 50] == pytest.approx(0.57, abs=1e-9)
    assert found[RATE, 50] - -6.0 == pytest.approx(0.6, abs=1e-9)


def test_a_delay_is_no_whole_number_of_ticks():
    """0.07 s: given at the first tick that is not before, 0.08 s after the measurement."""
    found = looks(made(delay=0.07), 60)
    np.testing.assert_allclose(found[AGE, 4:], 0.08, atol=1e-9)


def test_the_delay_varies_and_nothing_older_comes_after_something_newer():
    """Mean 0.1 s, standard deviation 0.04 s, a measurement every 0.5 s: mean and deviation of 398 delays, within four standard errors."""
    world = made(delay=0.1, delay_variation=0.04, period=0.5)
    found = looks(world, 10_000, closing=0.001)
    taken = np.round((np.arange(10_000) * TICK - found[AGE]) / TICK).astype(int)
    new = np.flatnonzero(np.diff(taken)) + 1
    assert (np.diff(taken)[5:] >= 0).all()
    delays = found[AGE, new][1:]  # at the tick, half a tick later on average
    assert len(delays) == 398
    assert delays.mean() == pytest.approx(0.1 + TICK / 2.0, abs=4.0 * 0.04 / 398**0.5)
    assert delays.std() == pytest.approx(0.04, abs=4.0 * 0.04 / (2.0 * 398) ** 0.5 + 0.002)
    often = looks(made(delay=0.1, delay_variation=0.04), 2000, closing=0.001)
    stamps = np.arange(2000) * TICK - often[AGE]
    assert (np.diff(stamps[20:]) >= -1e-9).all() and often[AGE, 20:].min() >= 0.0


def test_the_time_of_a_measurement_is_recorded():
    sensors = {"late": {"kind": "front_radar", "delay": 0.1}, "now": {"kind": "front_radar"}}
    run = stage(vehicles={"own": {"sensors": sensors}})
    run.advance(50)
    record = run.record()
    np.testing.assert_allclose((record.time - record.trace("own.late.measured"))[6:], 0.1, atol=1e-9)
    np.testing.assert_allclose(record.time, record.trace("own.now.measured"), atol=1e-9)


# -- period, drop-out ----------------------------------------------------------------------------------


def test_a_period_holds_what_was_measured():
    """0.05 s with ticks of 0.02 s: measured at 0, 0.06, 0.10, 0.16, 0.20 ..., twenty times a second."""
    found = looks(made(period=0.05), 101)
    at = np.arange(101) * TICK - found[AGE]
    assert np.unique(np.round(at[:11], 9)).tolist() == [0.0, 0.06, 0.1, 0.16, 0.2]
    assert len(np.unique(np.round(at, 9))) == 41
    np.testing.assert_allclose(found[RANGE], GAP - 10.0 * at, atol=1e-9)


def test_a_share_of_the_looks_fails():
    """0.3 of 4000: what was given stays and ages; within four standard errors, and a run of three failures as often as 0.3³."""
    found = looks(made(drop_out=0.3), 4000, closing=0.001)
    failed = found[AGE, 20:] > 1e-9
    assert failed.mean() == pytest.approx(0.3, abs=4.0 * (0.3 * 0.7 / 3980) ** 0.5)
    three = failed[:-2] & failed[1:-1] & failed[2:]
    assert three.mean() == pytest.approx(0.027, abs=0.012)
    assert looks(made(drop_out=1.0), 20)[SEEN].sum() == 0


@pytest.mark.parametrize(
    ("field", "value"),
    [("opening_angle", 6.3), ("opening_angle", 0.0), ("delay", -0.01), ("delay_variation", -0.01), ("period", -1.0), ("drop_out", 1.1)],
)
def test_what_cannot_be_is_refused_with_its_path(field, value):
    with pytest.raises(ValidationError, match=field):
        Settings.model_validate({field: value})
    assert Settings.model_validate({"opening_angle": 6.28}).opening_angle == 6.28


# -- faults --------------------------------------------------------------------------------------------


def test_a_sensor_that_fails_gives_nothing_and_forgets_what_was_under_way():
    world = made(delay=0.1)
    looks(world, 20)
    (each,) = world.units.mounted
    each.health[FAILS, 0] = 1.0
    failed = looks(world, 10)
    assert not failed[SEEN].any() and np.isfinite(failed).all()
    each.health[FAILS, 0] = 0.0
    again = looks(world, 10)
    assert not again[SEEN, :5].any() and again[SEEN, 5:].all()


def test_noise_grows_by_its_factor():
    """The same draws, times 3."""
    errors = []
    for factor in (1.0, 3.0):
        world = made(range_noise=0.2)
        world.units.mounted[0].health[NOISE, 0] = factor
        found = looks(world, 200)
        errors.append(found[RANGE] - found[TRUE])
    np.testing.assert_allclose(errors[1], 3.0 * errors[0], atol=1e-9)


# -- noise ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("gap", "sigma"), [(80.0, 0.26), (20.0, 0.14)])
def test_noise_grows_with_the_distance(gap, sigma):
    """0.1 m and 0.002 a metre: 0.26 m at 80 m, 0.14 m at 20 m, of 4000 draws each within four standard errors."""
    found = looks(made(range_noise=0.1, range_growth=0.002), 4000, closing=0.0, gap=gap)
    assert (found[RANGE] - found[TRUE]).std() == pytest.approx(sigma, rel=4.0 / (2.0 * 4000) ** 0.5)


# -- repeatability -------------------------------------------------------------------------------------


def test_a_snapshot_keeps_what_is_under_way():
    """Taken in the middle of a delay: what comes afterwards is the same to the last bit."""
    sensor = {"delay": 0.1, "delay_variation": 0.03, "drop_out": 0.2, "range_noise": 0.3, "period": 0.05}
    world = made(**sensor)
    looks(world, 33)
    kept = snapshot(world)
    first = looks(world, 60)
    restore(world, kept)
    assert np.array_equal(looks(world, 60), first)
    fresh = made(**sensor)
    looks(fresh, 33)
    assert np.array_equal(looks(fresh, 60), first)
