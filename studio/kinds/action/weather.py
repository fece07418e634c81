"""The weather changes everywhere: how slippery the roads are, how far one sees. With `until` it is as before again."""

from pydantic import Field, model_validator

from studio.kind.settings import Part
from studio.world.effect import WeatherChange

KIND = "action"
TITLE = "Change the weather"


class Settings(Part):
    """Friction, visibility, or both."""

    friction: float | None = Field(
        None, ge=0.02, le=1.5, title="Friction", description="over that of a dry test track", json_schema_extra={"unit": "1"}
    )
    visibility: float | None = Field(None, ge=10, le=100_000, title="Visibility", json_schema_extra={"unit": "m"})

    @model_validator(mode="after")
    def changes_something(self):
        if self.friction is None and self.visibility is None:
            raise ValueError("give `friction`, `visibility` or both")
        return self


def effects(settings, place):
    """Another weather."""
    return [WeatherChange(settings.friction, settings.visibility)]


def told(settings):
    """In words."""
    parts = {"friction": settings.friction, "visibility": settings.visibility}
    return ", ".join(f"{name} {value:g}" for name, value in parts.items() if value is not None)
