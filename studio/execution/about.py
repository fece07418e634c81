"""What of a record is no series over time, as plain data: vehicles, chains, bodies, and the names that numbers stand for."""

from collections.abc import Sequence
from typing import Any

from studio.execution.brought import Brought, Fault
from studio.execution.cast import NOBODY, of_plain
from studio.execution.record import Body, Chain, Mount, Record


def about(record: Record) -> dict[str, Any]:
    """That of a record."""
    return {
        "vehicles": record.vehicles,
        "chains": [vars(each) for each in record.chains],
        "bodies": record.bodies,
        "called": list(record.called.items()),
        "commanders": record.commanders,
        "mounts": record.mounts,
        "brought": record.brought,
        "faults": record.faults,
        "cast": record.cast,
    }


def of_about(known: dict[str, Any]) -> dict[str, Any]:
    """The fields of the record that it was taken of."""
    return {
        "vehicles": tuple(known["vehicles"]),
        "chains": tuple(Chain(each["group"], each["application"], tuple(each["vehicles"])) for each in known["chains"]),
        "bodies": {name: Body(*each) for name, each in known["bodies"].items()},
        "called": {int(number): name for number, name in known["called"]},
        "commanders": tuple(known["commanders"]),
        "mounts": {name: Mount(*each) for name, each in known["mounts"].items()},
        "brought": {name: brought_of(*each) for name, each in known.get("brought", {}).items()},
        "faults": tuple(Fault(*each) for each in known.get("faults", ())),
        "cast": of_plain(known.get("cast", NOBODY)),
    }


def brought_of(entry: str, line: Sequence[Sequence[float]], *rest: Any) -> Brought:
    """What the script has brought to the road."""
    return Brought(entry, tuple((x, y) for x, y in line), *rest)
