"""The contract of an application, on one page.

An application is a module with

    TITLE        one line for people
    Parameters   a pydantic model: what its developer tunes, with unit, range and meaning
    Memory       a NamedTuple of floats: what it remembers from tick to tick, with its first values as defaults
    decide       decide(parameters, memory, observation) -> (memory, command)

`decide` sees what a real unit sees and nothing else: its clock, its own car's bus and satellite receiver, its front sensor,
the messages that reached it. It acts only through the actuators. It keeps nothing outside `memory`, so a run can be repeated, cut and
batched. It is plain Python over NamedTuples of floats; with `COMPILED = True`, and `@compiled` above it, the same function is machine code.

What a command leaves at `LEAVE` stays the driver's. Most applications return a `Command`; one that works closer to the
hardware returns `Actuators`.
"""

from math import nan
from typing import NamedTuple

LEAVE = nan  # "not commanded": the driver keeps this actuator


class Clock(NamedTuple):
    """Time on the unit's own clock."""

    time: float  # [s] since the start of the run
    tick: float  # [s] since the last call


class Own(NamedTuple):
    """What the own car's bus and its satellite receiver tell."""

    speed: float  # [m/s]
    acceleration: float  # [m/s²] forward
    yaw_rate: float  # [rad/s]
    steering: float  # [rad] road wheel angle
    set_speed: float  # [m/s] that the driver has set for this stretch
    driver_acceleration: float  # [m/s²] that the driver's pedals ask for
    gps_x: float  # [m] east position of the centre of gravity by satellite, with its errors
    gps_y: float  # [m] north


class Front(NamedTuple):
    """The target of the front sensor; zeros while there is none."""

    detected: bool
    range: float  # [m] bumper to bumper
    range_rate: float  # [m/s] negative when coming nearer
    azimuth: float  # [rad] left positive


class Message(NamedTuple):
    """The newest message of the unit that this application listens to."""

    received: bool  # whether one ever came
    age: float  # [s] since it was sent; since the start of the run while none has come
    x: float  # [m] position of the sender by satellite, with its errors
    y: float  # [m]
    speed: float  # [m/s]
    acceleration: float  # [m/s²] measured by the sender
    intention: float  # [m/s²] that the sender has requested of its actuators


class Observation(NamedTuple):
    """All that an application sees at a tick."""

    clock: Clock
    own: Own
    front: Front
    message: Message


class Command(NamedTuple):
    """What an application asks of the car, as production cars offer it to their own assistance."""

    acceleration: float  # [m/s²]
    steering: float  # [rad] road wheel angle


class Actuators(NamedTuple):
    """The same, and every actuator by itself. Of several that do the same, the last given one counts."""

    acceleration: float  # [m/s²] drive and brake together
    steering: float  # [rad] road wheel angle
    steering_torque: float  # [Nm] at the steering wheel, left positive; instead of the angle
    accelerator: float  # [1] pedal position
    drive_torque: float  # [Nm] at the wheels, sum; negative for engine braking or regeneration
    engine_torque: float  # [Nm] at the shaft
    brake_torque: float  # [Nm] at the wheels, sum, through the hydraulics
    gear: float  # [1] -1 reverse, 0 neutral, 1 first ...; what would do harm is not done


ACTUATORS = Actuators._fields
