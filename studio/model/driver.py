"""The driver's pedals: he keeps a speed, follows what is ahead, stops at red. How he steers stands in helm.py.

Following: Intelligent Driver Model, M. Treiber, A. Hennecke, D. Helbing, Phys. Rev. E 62 (2000) 1805. Above the desired
speed its fourth power brakes too late for a bend or too hard for a trifle; there the excess dies away with a time constant.
Sight: who drives must be able to stop within what is seen, German StVO § 3 (1) sentence 4, and with less than 50 m of it goes
no faster than 50 km/h, sentence 3.
Temper: the timid, the usual and the aggressive driver of A. Kesting, M. Treiber, D. Helbing, Agents for traffic simulation (2009), as
shares of the usual one; critical gaps: the least and the greatest that the Highway Capacity Manual 2000 reports of one turn.
Foresight: M. Treiber, A. Kesting, D. Helbing, Physica A 360 (2006) 71. A driver who answers late takes what is ahead to go on with its
speed until then, and knows what he has decided already; so a late answer is a stable one.
"""

from math import exp, sqrt

from studio.compiled import compiled

COURTESY = 3.0  # [m/s²] strongest braking for a car that only will be first
STOP_FIRM = 4.0  # [m/s²] a driver who would have to brake harder than this for an amber drives on
STOP_HARD = 7.0  # [m/s²] and one who has decided to stop does so while no more than this is needed
AMBER, AMBER_PER = 3.0, 5.0  # [s], [m/s²] that a light is amber at least; at 70 km/h it is 4 s
STOP_CLOSE, STOP_LAST = 2.0, 0.5  # [m] where a driver stops before the line; and where at the latest
BRAKE_TIME = 0.3  # [s] that brakes take, which a driver knows
ROLLING_OUT = 1.0  # [s] time constant of the last metres
NEARLY = 0.1  # [m] from there on a driver lets the car come to rest
SETTLING = 0.7  # [s] in which a speed above the desired one dies away
REACTION = 1.0  # [s] from seeing to braking
FOG, FOG_SPEED = 50.0, 50.0 / 3.6  # [m], [m/s]
NO_LIMIT = 1e3  # [m/s²] stands for "nothing asks me to brake"
SHARES = {  # what the timid and the aggressive driver have of what the usual one has
    "time_headway": (1.8 / 1.5, 1.0 / 1.5), "standstill_gap": (4.0 / 2.0, 1.0 / 2.0), "acceleration": (1.0 / 1.4, 2.0 / 1.4),
    "deceleration": (1.0 / 2.0, 3.0 / 2.0),
}  # fmt: skip
GAP_SHARES = (7.2 / 6.05, 4.9 / 6.05)
MOST_SPREAD = 2.0  # standard deviations: slower or quicker than this nobody answers
GLANCE = 0.5  # standard deviation of the logarithm of how long one looks away
STARTLING = 4.0  # [m/s²] what asks for harder braking than this, sooner than one answers, is a surprise


def temper(g, timid, aggressive):
    """The share [1] that belongs to an aggressiveness g, from -1 to 1."""
    return aggressive**g if g > 0.0 else timid**-g


def reaction(median, spread, z):
    """Reaction time [s] of one driver: lognormal, z a standard normal number."""
    return median * exp(spread * min(max(z, -MOST_SPREAD), MOST_SPREAD))


@compiled
def foreseen_speed(v, gained):
    """Own speed [m/s] when `gained` [m/s] has come to it; nobody brakes to go backwards."""
    return max(v + gained, min(v, 0.0))


@compiled
def foreseen_gap(gap, v, gained, ahead, t):
    """The gap [m] after t [s]: who is ahead goes on with his speed [m/s], oneself has gained so much by then."""
    return gap - t * (foreseen_speed(v, 0.5 * gained) - ahead)


@compiled
def wandered(x, share, z):
    """The next value of an Ornstein-Uhlenbeck process of unit variance, of which a share [1] is remembered; z a standard normal number."""
    return share * x + sqrt(1.0 - share * share) * z


@compiled
def free_acceleration(v, v_desired, a, b):
    """Acceleration [m/s²] on an empty road; a comfortable acceleration, b comfortable deceleration [m/s²]."""
    if v <= v_desired:
        return a * (1.0 - (v / max(v_desired, 0.1)) ** 4)
    return max((v_desired - v) / SETTLING, -b)


@compiled
def sight_speed(d, b):
    """Speed v [m/s] from which a driver stops within d [m]: v t + v²/(2 b) = d, t the reaction, b the deceleration [m/s²]."""
    v = b * (sqrt(REACTION * REACTION + 2.0 * d / b) - REACTION)
    return min(v, FOG_SPEED) if d < FOG else v


@compiled
def desired_gap(v, closing, s_0, T, a, b):
    """s* [m] for speed v and closing speed [m/s], standstill gap s_0 [m], time headway T [s]."""
    return s_0 + max(0.0, v * T + v * closing / (2.0 * sqrt(a * b)))


@compiled
def following_acceleration(v, v_desired, gap, closing, s_0, T, a, b):
    """Acceleration [m/s²] behind something `gap` [m] ahead that comes nearer with `closing` [m/s]."""
    pressure = desired_gap(v, closing, s_0, T, a, b) / max(gap, 0.1)
    return free_acceleration(v, v_desired, a, b) - a * pressure * pressure


@compiled
def must_stop(v, distance):
    """Whether a driver at v [m/s] with a line `distance` [m] ahead decides to stop: v t + v²/(2 b) is there."""
    return v * BRAKE_TIME + v * v / (2.0 * STOP_FIRM) < distance - min(STOP_CLOSE, 0.5 * distance)


@compiled
def is_red_then(v, distance):
    """Whether a light `distance` [m] ahead that is amber now will be red for one who goes on with v [m/s]."""
    return distance > v * max(AMBER, v / AMBER_PER)


@compiled
def can_stop(v, distance):
    """Whether a driver who has decided to stop stays with it: brakes and road would do it."""
    return v * v < 2.0 * STOP_HARD * distance


@compiled
def braking_needed(v, distance):
    """Deceleration [m/s²] that brings a car to rest within a distance [m]."""
    return v * v / (2.0 * max(distance, NEARLY))


@compiled
def stopping_acceleration(v, distance, a, b):
    """Acceleration [m/s²] towards a stop line `distance` [m] ahead of the front bumper.

    Like the IDM it lets the deceleration d that is needed, once the brakes have taken hold, rise to the comfortable b, with
    u = a - (a + b) d²/b² while d < b. From there on it is d, which then stays what it is, and no more than STOP_FIRM unless the line
    itself takes more: rather a place that is missed by a little. The last metres are rolled out.
    """
    left, line = distance - STOP_CLOSE, braking_needed(v, distance - STOP_LAST)
    if left < NEARLY:
        return -max(line, b)
    d = min(braking_needed(v, left - v * BRAKE_TIME), max(line, max(STOP_FIRM, b)))
    return -d if d > b else min(a - (a + b) * d * d / (b * b), (left / ROLLING_OUT - v) / SETTLING)
