"""A sensor of a unit, or all of its sensors, gives nothing or is noisier than it should be, while the entry acts."""

from pydantic import Field

from studio.kind.settings import Name, Part, UnitName, number
from studio.world.effect import SensorFault

KIND = "action"
TITLE = "Fail or degrade a sensor"


class Settings(Part):
    """Whose, which, and how."""

    unit: UnitName = Field(..., title="Unit")
    sensor: Name | None = Field(None, title="Sensor", description="its name on the unit; left out: all of them")
    fails: bool = Field(True, title="Fails", description="gives nothing at all")
    noise: float = number(1.0, unit="1", title="Noise", description="factor on all noise of one that does not fail", ge=0, le=1000)


def effects(settings, place):
    """A fault."""
    return [SensorFault(settings.unit, settings.sensor, settings.fails, settings.noise)]


def told(settings):
    """In words."""
    which = settings.sensor or "all sensors"
    return f"{which} of {settings.unit} {'gives nothing' if settings.fails else f'with noise times {settings.noise:g}'}"
