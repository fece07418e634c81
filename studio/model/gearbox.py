"""The gearbox's control unit: which gear, and what the clutch does meanwhile. It works once a tick.

A shift is: open the clutch over the old gear's time, wait while it is open, engage the new gear, close over its time
(Massow & Radusch 2018, Eq. 7 and Table 4). Gears are chosen by the speed of the input against the accelerator, one curve
up and one down per gear; the distance between them is the hysteresis.
"""

from math import sqrt

from studio.compiled import compiled

TOUCH = 0.01  # [1] pedal position that counts as pressed
DRAGS = 1.7  # [1] of the idle speed, above which a clutch closes with the pedal lifted
SLACK = 0.05  # [m/s²] that a higher gear may lose
CALMING = 5.0  # [s] after which half of a full pedal is forgotten
WALKING = 1.0  # [m/s] above this nobody shifts between forward and reverse


@compiled
def kept(before, pedal, dt):
    """Pedal position [1] by which the schedule shifts up: what it was more before, d, fades as dd/dt = -d²/CALMING.

    So a swing of the pedal shifts nothing, and one that is left for good is soon forgotten.
    """
    over = max(before - pedal, 0.0)
    return pedal + over - over * over * dt / CALMING


@compiled
def threshold(light, full, pedal):
    """Speed [rad/s] of a shift at a pedal position: between touched and full."""
    return light + pedal * (full - light)


@compiled
def automatic(gear, top, w_in, up, down):
    """The gear that the schedule wants; w_in [rad/s], up and down the thresholds of the present gear."""
    if gear < top and w_in > up:
        return gear + 1
    if gear > 1 and w_in < down:
        return gear - 1
    return max(gear, 1)


@compiled
def pedal_after(pedal, fall):
    """Pedal position [1] that gives the same drive in the next higher gear, of `fall` [1] times the ratio; it counts as u (2 - u)."""
    return 1.0 - sqrt(1.0 - min(pedal * (2.0 - pedal) / fall, 1.0))


@compiled
def can_hold(a, a_drive, fall, time, w_out, i_next, R, w_down, pedal):
    """Whether the next higher gear would be kept: it still holds the speed, and the shift does not lose too much of it.

    a [m/s²] acceleration now, a_drive [m/s²] the part of it that the drive makes, fall [1] ratio of the next gear over this
    one, time [s] without drive, w_out [rad/s] speed of the driven wheels of radius R [m], i_next the next ratio, w_down
    [rad/s] its shift down.
    """
    holds = pedal < TOUCH or a - a_drive * (1.0 - fall) > -SLACK
    w_after = i_next * (w_out + min(a - a_drive, 0.0) * time / R)
    return holds and w_after > w_down


@compiled
def permitted(wanted, gear, top, v, w_wanted, w_present, w_limit):
    """A wanted gear, or the present one where it would do harm: over-revving by a lower gear, or reverse while driving."""
    wanted = min(max(wanted, -1), top)
    turns_back = (wanted < 0) != (gear < 0) and wanted != 0 and abs(v) > WALKING
    overspeeds = w_wanted > w_limit and w_wanted > w_present
    return gear if turns_back or overspeeds else wanted


@compiled
def clutch_closes(w_in, pedal, w_idle, is_closed):
    """Whether an automated clutch closes in gear: the driver wants to go, or the car is fast enough to drag the engine.

    A car that slows down to a stop with the clutch open keeps it open; a closed one opens at idle.
    """
    return pedal > TOUCH or w_in > (w_idle if is_closed else DRAGS * w_idle)


@compiled
def lock_up_closes(w_in, w_e, w_lock_up, coupling_ratio, is_closed):
    """Whether the lock-up of a converter closes: fast enough, and nothing to multiply any more; hysteresis of a tenth."""
    if is_closed:
        return w_in > 0.9 * w_lock_up
    return w_in > w_lock_up and w_in > coupling_ratio * w_e


@compiled
def rate(time, tick):
    """Speed [1/s] of the clutch that moves it over its whole way within `time` [s]."""
    return 1.0 / max(time, tick)
