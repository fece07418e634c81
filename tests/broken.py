"""Kinds of one's own: applications that raise or hang half a second into the run, a file that does not load, and a sound sensor."""

BROKEN = '''
"""Raises after half a second."""
from typing import NamedTuple
from studio.application.contract import Clock, Command, leave
from studio.kind.settings import Part

KIND = "application"
TITLE = "Broken"
COMMANDS = 1

class Parameters(Part):
    pass

class Memory(NamedTuple):
    pass

class Sees(NamedTuple):
    clock: Clock

class Does(NamedTuple):
    command: Command

def decide(parameters, memory, sees):
    if sees.clock.time > 0.5:
        raise RuntimeError("the idea was not so good")
    return memory, Does(leave())
'''

# Leaves a sign beside itself before it hangs, and never lets go of the interpreter.
HANGING = BROKEN.replace("Raises", "Hangs").replace(
    'raise RuntimeError("the idea was not so good")',
    """import re
        from pathlib import Path
        Path(__file__).with_suffix(".sign").touch()
        re.match("(a*)*b", 100 * "a")""",
)

TORN = """'''A driver that nobody has finished.'''
KIND = "driver"
from studio.nowhere import nothing
"""

FLAWLESS = '''
"""A radar without noise: the gap to the car ahead as it is."""
from typing import Annotated, NamedTuple

from studio.compiled import compiled
from studio.kind.sensor import Looking
from studio.kind.settings import number
from studio.kinds.sensor.front_radar import nearest_car
from studio.model.sensor import own_curvature
from studio.world.view import report

KIND = "sensor"
TITLE = "Radar without noise"


class Settings(Looking):
    """How far it sees."""

    range: float = number(80.0, unit="m", title="Reach", ge=0, le=300)
    opening_angle: float = number(0.5, unit="rad", title="Opening angle", gt=0, le=3.2)
    patience: float = number(2.0, unit="s", title="Patience", ge=0, le=10)


class Reading(NamedTuple):
    """The target."""

    clearance: Annotated[float, "m", "to the rear of the car ahead"] = 0.0
    closing: Annotated[float, "m/s", "of the two, not measured"] = 0.0


@compiled
def measure(view, me, settings, memory, out):
    """One look."""
    other, distance, _ = nearest_car(view, me, settings, own_curvature(me.speed, me.yaw_rate), -1.0)
    if other == -1:
        return 0
    report(out, me, 0, Reading(distance, 0.0))
    return 1
'''

# What every sensor has, and one that looks, when nothing is given.
EVERY = {"delay": 0.0, "delay_variation": 0.0, "period": 0.0, "drop_out": 0.0, "forward": 0.0, "left": 0.0, "yaw": 0.0}
