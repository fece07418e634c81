"""The contract of an application, on one page.

An application is a file with

    KIND         "application"
    TITLE        one line for people
    Parameters   a pydantic model: what its developer tunes, with unit, range and meaning; numbers, yes or no, fixed-size arrays
                 (tuple[float, float]), and choices (Literal), which arrive as their place in the list
    Memory       a NamedTuple of numbers: what it remembers from tick to tick, with its first values
    Sees         a NamedTuple of ports: what it sees
    Does         a NamedTuple of ports: what it does
    decide       decide(parameters, memory, sees) -> (memory, does)

and, where it has use for them,

    COMMANDS     the actuators that it may command: ACCELERATION | STEERING
    NOTICES      the sentences that it may show to the driver: ("Brake!", "Car from the right")

`decide` sees what a real unit sees and nothing else, and acts only through its ports. It keeps nothing outside `memory`, so that a run
can be repeated, cut and batched. It is plain Python over NamedTuples of numbers; with `@compiled` above it, the same function is machine
code. A result that is not finite, out of range, or not declared ends the run, and names application, unit, field and tick.

    class Sees(NamedTuple):
        clock: Clock
        own: Own
        front: Annotated[Targets, "front_radar", 4]      # the sensor of this kind, up to 4 targets
        heard: Annotated[Inbox, "awareness", 8]          # the newest message of up to 8 senders

    class Does(NamedTuple):
        command: Command                                 # accelerate(u), also(accelerate(u), steer(delta)), leave()
        send: Annotated[Outbox, "intent", 1]             # up to 1 message a tick
        notice: Notice
        log: Log                                         # a NamedTuple of your own: values to be recorded

Compiled code knows no defaults: every field of a NamedTuple that `decide` makes is given.

A port for a sensor is served by the unit's sensor of the same name, or by the only one of its kind.
"""

from typing import Annotated, Any, NamedTuple

from numba.extending import register_jitable

# Actuators, as COMMANDS names them. What an application does not command stays the driver's.
ACCELERATION, STEERING, STEERING_TORQUE, ACCELERATOR, DRIVE_TORQUE, ENGINE_TORQUE, BRAKE_TORQUE, GEAR = (1 << i for i in range(8))
NOTHING = 0


class Clock(NamedTuple):
    """Time on the unit's own clock, which may be wrong."""

    time: float  # [s] since the start of the run
    tick: float  # [s] since the last call


class Own(NamedTuple):
    """What the own car's bus and its satellite receiver tell; a station knows where it is, and stands."""

    speed: Annotated[float, "m/s", "along the car"]
    acceleration: Annotated[float, "m/s²", "forward"]
    yaw_rate: Annotated[float, "rad/s", "to the left"]
    steering: Annotated[float, "rad", "road wheel angle, to the left"]
    set_speed: Annotated[float, "m/s", "that the driver has set for this stretch"]
    request: Annotated[
        float, "m/s²", "asked of the actuators at the last tick by application or script; where a person drives, `acceleration`"
    ]
    gps_x: Annotated[float, "m", "east position of the centre of gravity by satellite, with its errors"]
    gps_y: Annotated[float, "m", "north position, likewise"]


class Targets(NamedTuple):
    """What a sensor gives: `target[0]` to `target[count - 1]`, each a `Reading` of its kind, in the order of the sensor."""

    count: int
    target: tuple[Any, ...]
    age: float = 0.0  # [s] by the own clock, since it was measured; the own time while nothing has been given


class Heard(NamedTuple):
    """The newest message of one sender."""

    received: bool  # whether one ever came
    sender: float  # number of the unit that sent it
    age: float  # [s] own clock minus the sender's at sending; the own time while none has come
    delay: float  # [s] it was under way, as far as both clocks are right
    missed: float  # [1] messages of this sender that were lost since the one before
    payload: Any  # the `Payload` of the message's kind


class Inbox(NamedTuple):
    """Messages by sender: `message[0]` to `message[count - 1]`. Those of `listens_to` in its order, else the freshest first."""

    count: int
    message: tuple[Heard, ...]


class Command(NamedTuple):
    """What is asked of the car: `mask` says which of the fields count. Made by the functions below, and joined by `also`."""

    mask: int
    acceleration: Annotated[float, "m/s²", (-20.0, 20.0), "drive and brake together"]
    steering: Annotated[float, "rad", (-1.6, 1.6), "road wheel angle"]
    steering_torque: Annotated[float, "Nm", (-100.0, 100.0), "at the steering wheel, left positive; instead of the angle"]
    accelerator: Annotated[float, "1", (0.0, 1.0), "pedal position; of several that drive, the last of these counts"]
    drive_torque: Annotated[float, "Nm", (-20000.0, 20000.0), "at the wheels, sum; negative for engine braking"]
    engine_torque: Annotated[float, "Nm", (-2000.0, 2000.0), "at the shaft"]
    brake_torque: Annotated[float, "Nm", (0.0, 50000.0), "at the wheels, sum, through the hydraulics"]
    gear: Annotated[float, "1", (-1.0, 12.0), "-1 reverse, 0 neutral, 1 first; what would do harm is not done"]


class Outbox(NamedTuple):
    """Messages to be sent now: `message[0]` to `message[count - 1]`; `message` holds as many payloads as the port says."""

    count: int
    message: tuple[Any, ...]


class Notice(NamedTuple):
    """What the driver is shown: 0 nothing, 1 the first sentence of NOTICES, and so on."""

    number: int


# -- commands ------------------------------------------------------------------------------------------


@register_jitable
def leave() -> Command:
    """Nothing is commanded: everything stays the driver's."""
    return Command(NOTHING, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@register_jitable
def accelerate(acceleration: float) -> Command:
    """Drive and brake for an acceleration [m/s²]."""
    return Command(ACCELERATION, float(acceleration), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@register_jitable
def steer(angle: float) -> Command:
    """Steer to a road wheel angle [rad]."""
    return Command(STEERING, 0.0, float(angle), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@register_jitable
def steer_by(torque: float) -> Command:
    """Steer with a torque [Nm] at the steering wheel."""
    return Command(STEERING_TORQUE, 0.0, 0.0, float(torque), 0.0, 0.0, 0.0, 0.0, 0.0)


@register_jitable
def press(accelerator: float) -> Command:
    """Press the accelerator pedal, 0 to 1."""
    return Command(ACCELERATOR, 0.0, 0.0, 0.0, float(accelerator), 0.0, 0.0, 0.0, 0.0)


@register_jitable
def drive(torque: float) -> Command:
    """Drive with a torque [Nm] at the wheels."""
    return Command(DRIVE_TORQUE, 0.0, 0.0, 0.0, 0.0, float(torque), 0.0, 0.0, 0.0)


@register_jitable
def turn_engine(torque: float) -> Command:
    """Drive with a torque [Nm] of the engine."""
    return Command(ENGINE_TORQUE, 0.0, 0.0, 0.0, 0.0, 0.0, float(torque), 0.0, 0.0)


@register_jitable
def brake(torque: float) -> Command:
    """Brake with a torque [Nm] at the wheels."""
    return Command(BRAKE_TORQUE, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, float(torque), 0.0)


@register_jitable
def shift(gear: float) -> Command:
    """Put in a gear."""
    return Command(GEAR, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, float(gear))


@register_jitable
def also(first: Command, second: Command) -> Command:
    """Both; where they command the same, the second does."""
    return Command(
        first.mask | second.mask,
        second.acceleration if second.mask & ACCELERATION else first.acceleration,
        second.steering if second.mask & STEERING else first.steering,
        second.steering_torque if second.mask & STEERING_TORQUE else first.steering_torque,
        second.accelerator if second.mask & ACCELERATOR else first.accelerator,
        second.drive_torque if second.mask & DRIVE_TORQUE else first.drive_torque,
        second.engine_torque if second.mask & ENGINE_TORQUE else first.engine_torque,
        second.brake_torque if second.mask & BRAKE_TORQUE else first.brake_torque,
        second.gear if second.mask & GEAR else first.gear,
    )
