"""The contract of a driver, on one page.

A driver is a file with

    KIND         "driver"
    TITLE        one line for people
    Settings     what such a driver is like: a `Driver`, with settings of its own where it needs some
    decide       decide(settings, sees) -> Wish, with `@compiled` above it

`decide` is asked at every tick, for every vehicle that has such a driver. It gets the settings and what the driver sees as NamedTuples
of plain numbers, and says what the driver wants of pedals and steering wheel. It keeps nothing, so that a run can be repeated, cut and
batched. Who the driver minds on the road is found before, and how he perceives it: the settings of `Driver` are used for that. His
foot does what `decide` wants one reaction time later; what concerns the pedals is told as he expects it to be then.

Reaction times: M. Green, "How long does it take to stop?", Transportation Human Factors 2 (2000) 195. Errors: M. Treiber, A. Kesting,
D. Helbing, Delays, inaccuracies and anticipation in microscopic traffic models, Physica A 360 (2006) 71. Changes of lanes: A. Kesting,
M. Treiber, D. Helbing, General lane-changing model MOBIL, Transportation Research Record 1999 (2007) 86: politeness 0 to 0.5, threshold
0.1, safe braking 4, a bias of 0.3 m/s² to the right.
"""

from math import inf
from typing import Annotated, NamedTuple

from studio.kind.settings import Part, number
from studio.model.driver import SHARES, temper


class Driver(Part):
    """What every driver has: how hurried and how careful he is."""

    acceleration: float = number(1.4, unit="m/s²", title="Comfortable acceleration", gt=0.1, le=5)
    deceleration: float = number(2.0, unit="m/s²", title="Comfortable deceleration", gt=0.1, le=8)
    time_headway: float = number(1.2, unit="s", title="Wanted headway", ge=0.3, le=5)
    standstill_gap: float = number(2.0, unit="m", title="Gap at rest", ge=0.5, le=10)
    speed_factor: float = number(1.0, unit="1", title="Wanted over permitted speed", ge=0.3, le=1.5)
    aggressiveness: float = number(
        0.0, unit="1", title="Aggressiveness", ge=-1, le=1,
        description="at 1 headway, gap at rest and critical gaps are smaller and accelerations greater, at -1 the other way round",
    )  # fmt: skip
    expected_reaction: float = number(
        0.0, unit="s", title="Reaction, expected", ge=0, le=2, description="from seeing to braking: median of such drivers"
    )
    surprised_reaction: float = number(
        0.0, unit="s", title="Reaction, surprised", ge=0, le=4, description="the same for what comes up sooner than that; counts if longer"
    )
    reaction_spread: float = number(
        0.3, unit="1", title="Spread of reactions", ge=0, le=0.6, description="standard deviation of the logarithm of both, among drivers"
    )
    gap_error: float = number(
        0.0, unit="1", title="Error of gaps", ge=0, le=0.5, description="relative, of gaps and times; standard deviation"
    )
    closing_error: float = number(
        0.0, unit="1/s", title="Error of speeds", ge=0, le=0.1, description="of what is ahead, per gap; standard deviation"
    )
    distraction_rate: float = number(0.0, unit="1/min", title="Looks away", ge=0, le=60, description="how often, per minute that he looks")
    distraction_length: float = number(2.0, unit="s", title="Looks away for", ge=0.2, le=20, description="median")
    sway: float = number(0.0, unit="m", title="Sway in the lane", ge=0, le=0.5, description="standard deviation of the place that he wants")
    sway_time: float = number(5.0, unit="s", title="Time of the sway", ge=1, le=60, description="in which he forgets it")
    politeness: float = number(
        0.2, unit="1", title="Politeness", ge=0, le=1,
        description="in changing lanes where nothing asks for it: how much what others gain or lose counts of one's own gain",
    )  # fmt: skip
    changing_threshold: float = number(
        0.1, unit="m/s²", title="Threshold of changing", ge=0, le=3, description="acceleration that a change of lanes has to gain"
    )
    imposed_braking: float = number(
        4.0, unit="m/s²", title="Imposed braking", gt=0, le=8, description="harder a change of lanes makes nobody brake behind"
    )
    keep_side: float = number(
        0.3, unit="m/s²", title="Keeping to the kerb", ge=0, le=3,
        description="what the lane nearer to the kerb is worth outside towns; 0 where the law does not ask for it",
    )  # fmt: skip

    def tempered(self) -> "Driver":
        """The same driver with what his aggressiveness makes of it."""
        shares = {name: getattr(self, name) * temper(self.aggressiveness, *SHARES[name]) for name in SHARES}
        return self.model_copy(update=shares) if self.aggressiveness else self


class Sees(NamedTuple):
    """What a driver knows at a tick. What is not there is infinitely far away."""

    speed: Annotated[float, "m/s"] = 0.0  # own, when the foot will have answered
    yaw_rate: Annotated[float, "rad/s"] = 0.0  # own, left positive
    desired_speed: Annotated[float, "m/s"] = 0.0  # that limits, bends and sight permit, times the own speed factor
    ahead_gap: Annotated[float, "m"] = inf  # bumper to bumper, to the vehicle or object ahead that asks most
    ahead_speed: Annotated[float, "m/s"] = 0.0  # of the same; for one who crosses ahead, that with which one comes when he is gone
    first_gap: Annotated[float, "m"] = inf  # to the car that goes first at a merge or crossing, as if it drove ahead already
    first_speed: Annotated[float, "m/s"] = 0.0  # of the same
    stop_distance: Annotated[float, "m"] = inf  # from the front bumper to the next line where a light or those who go first ask for a stop
    offset: Annotated[float, "m"] = 0.0  # of the front axle from the path, left positive
    heading: Annotated[float, "rad"] = 0.0  # of the car minus that of the path at the front axle
    curvature: Annotated[float, "1/m"] = 0.0  # of the path where the car will be in a moment, left positive
    compliance: Annotated[float, "rad s²/m"] = 0.0  # slip angle of the front axle per lateral acceleration
    steering_max: Annotated[float, "rad"] = 0.0  # largest road wheel angle
    steering_rate: Annotated[float, "rad/s"] = 0.4  # fastest change of it
    wheelbase: Annotated[float, "m"] = 2.7
    understeer: Annotated[float, "rad s²/m"] = 0.0  # slip angle of the front axle less that of the rear one, per lateral acceleration
    sideways: Annotated[float, "m/s"] = 0.0  # speed of the front axle to the left of where the car points
    rolling: Annotated[float, "m/s"] = 0.0  # own speed as it is, for the steering wheel


class Wish(NamedTuple):
    """What a driver wants."""

    acceleration: Annotated[float, "m/s²"] = 0.0  # forward
    steering: Annotated[float, "rad"] = 0.0  # road wheel angle, left positive
