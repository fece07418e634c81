"""Impact: what a collision does to a vehicle.

Two bodies of masses m_1, m_2 that meet with the relative speed v and stay together change their speeds by

    Δv_1 = m_2/(m_1 + m_2) v,    Δv_2 = m_1/(m_1 + m_2) v

(momentum is kept; with restitution e both are (1 + e) times that, and e is small at the speeds at which people are hurt). What stands
fast has an infinite mass. Δv tells best how badly people are hurt (L. Evans, Driver injury and fatality risk in two-car crashes versus
mass ratio, Accident Analysis and Prevention 26 (1994) 609).
"""

from collections.abc import Iterator
from math import inf

from studio.execution.record import Record
from studio.kind.metric import Found

COLLISION = "collision"


def speed_change(mass: float, other: float, speed: float) -> float:
    """Δv [m/s] of a vehicle of a mass [kg] that meets another one with a relative speed [m/s]."""
    return speed if other == inf else other / (mass + other) * speed


def impacts(record: Record) -> Iterator[Found]:
    """Relative speeds [m/s] of all collisions."""
    for event in record.happenings:
        if event.kind == COLLISION:
            yield Found(event.numbers["impact_speed"].value, event.units, event.time)


def speed_changes(record: Record) -> Iterator[Found]:
    """Δv [m/s] of every vehicle in a collision, with the other one."""
    for found in impacts(record):
        masses = [record.bodies[name].mass if name in record.bodies else inf for name in found.subject]
        for name, mass, others in zip(found.subject, masses, reversed(masses), strict=True):
            other = next(each for each in found.subject if each != name)
            if mass != inf:
                yield Found(speed_change(mass, others, found.value), (name, other), found.time)
