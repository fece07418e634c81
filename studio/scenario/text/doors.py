"""Version 2 to 3: what can be replaced names its kind, and units are more than vehicles."""

from typing import Any

from studio.errors import Problem, ScenarioError
from studio.scenario.text.patch import Operation, operation
from studio.scenario.text.pointer import joined
from studio.scenario.text.source import Source

Change = tuple[list[Operation], list[str]]


def sensors(now: Source) -> Change:
    """The front sensor is one of several, which have names and kinds."""
    patch, told = [], []
    for name, vehicle in mapping(now.value.get("vehicles")).items():
        if "sensor" in mapping(vehicle):
            refuse_both(now, f"vehicles.{name}", vehicle, "sensor", "sensors")
            given = {"kind": "front_radar"} | mapping(vehicle["sensor"])
            patch += [
                operation("remove", ["vehicles", name, "sensor"]),
                operation("add", ["vehicles", name, "sensors"], value={"front": given}),
            ]
            told.append(f"`vehicles.{name}.sensor` is `vehicles.{name}.sensors.front`, of the kind front_radar")
    return patch, told


def units(now: Source) -> Change:
    """Applications are on units: vehicles and stations."""
    patch, told = [], []
    for name, group in mapping(now.value.get("applications")).items():
        if "vehicles" in mapping(group):
            refuse_both(now, f"applications.{name}", group, "vehicles", "units")
            patch.append(operation("move", ["applications", name, "units"], **{"from": joined(["applications", name, "vehicles"])}))
            told.append(f"`applications.{name}.vehicles` is `applications.{name}.units`")
    return patch, told


def messages(now: Source) -> Change:
    """How often units send belongs to the message, not to the radio."""
    radio = mapping(now.value.get("radio"))
    if "period" not in radio:
        return [], []
    refuse_both(now, "the scenario", now.value, "radio.period", "messages", present="messages" in now.value)
    value = {"awareness": {"period": radio["period"]}}
    rest = [operation("remove", ["radio", "period"])] if len(radio) > 1 else [operation("remove", ["radio"])]
    return [operation("add", ["messages"], value=value), *rest], ["`radio.period` is `messages.awareness.period`"]


RENAMED = {"measured_range": "front.range", "range_rate": "front.rate", "azimuth": "front.azimuth"}


def channels(now: Source) -> Change:
    """What a sensor gives is recorded under the sensor's name."""
    named = mapping(now.value.get("recording")).get("channels")
    found = [(i, name) for i, name in enumerate(named) if name in RENAMED] if isinstance(named, list) else []
    patch = [operation("replace", ["recording", "channels", str(i)], value=RENAMED[name]) for i, name in found]
    return patch, [f"the channel `{name}` is `{RENAMED[name]}`" for _, name in found]


def mapping(value: Any) -> dict[str, Any]:
    """A section of a file; what is none is told by the schema."""
    return value if isinstance(value, dict) else {}


def refuse_both(now: Source, where: str, section: dict[str, Any], old: str, new: str, *, present: bool | None = None) -> None:
    """An old field beside the new one: one of the two would be lost."""
    if new in section if present is None else present:
        problem = Problem(f"{now.where}: {where}", f"has `{old}` and `{new}`", remedy="keep one of them")
        raise ScenarioError(f"{now.where} cannot be read as version 2.", [problem])
