"""Turns narrower than a car's lock are told, with what is driven."""

from dataclasses import replace

import numpy as np
import pytest

from studio.road.assembly.narrow import bend_of, tell
from studio.road.network import Connection, Lane, Net, Road, curve
from studio.road.network.report import Notes, Spot


def net_of(radius, turn=90.0, *, others=True):
    """East on `in`, then to the left by a turn [deg] with this radius [m] onto `up`; with others, straight on to `on`, and from `by`
    straight onto `up`."""
    angle = np.linspace(0.0, np.radians(turn), 60)
    bend = np.array([100.0 + radius * np.sin(angle), radius * (1.0 - np.cos(angle))])
    end, ahead = bend[:, -1], np.array([np.cos(angle[-1]), np.sin(angle[-1])])

    def along(start, stop):
        return np.column_stack([end + start * ahead, end + stop * ahead])

    lines = {
        "in": np.array([[0.0, 100.0], [0.0, 0.0]]), ":turn": bend, "up": along(0.0, 80.0), "on": np.array([[120.0, 200.0], [0.0, 0.0]]),
        ":on": np.array([[100.0, 120.0], [0.0, 0.0]]), "by": along(-100.0, -20.0), ":by": along(-20.0, 0.0),
    }  # fmt: skip
    lanes = tuple(Lane(i, name, 0, 3.2, 10.0, line, name[0] == ":", curve.length(line)) for i, (name, line) in enumerate(lines.items()))
    roads = {each.road: Road(each.road, "", (each.id,), "", "", 10.0, each.length, each.internal) for each in lanes}
    made = [Connection(0, 2, (1,), -1, "left")]
    made += [Connection(0, 3, (4,), -1, "straight"), Connection(5, 2, (6,), -1, "straight")] if others else []
    return Net(lanes, roads, tuple(made), (), frozenset(), {})


def told(net):
    notes = Notes()
    tell(net, lambda each: Spot("here", 0.0, 0.0), notes)
    return notes.guesses


@pytest.mark.parametrize(("radius", "turn"), [(0.8, 90.0), (2.0, 90.0), (4.5, 90.0), (5.0, 60.0), (1.2, 120.0)])
def test_a_turn_that_is_driven_wider_is_told(radius, turn):
    """Drawn narrower than the lock's radius of 5.3 m; the line that is driven uses the room beside it."""
    made = net_of(radius, turn)
    (entry,) = told(made)
    assert "from road in to road up, drawn with a radius of" in entry.what and "driven with" in entry.what
    assert bend_of(made, made.connections[0]) < 1.0 / radius


def test_where_short_roads_leave_no_room_cars_leave_their_lane():
    """Both roads are two metres long: the driven line has their ends, and cannot be wide."""
    made = net_of(0.5, 150.0)
    short = {0: np.array([[98.0, 100.0], [0.0, 0.0]]), 2: made.lanes[2].centre[:, :1] + np.array([[0.0, -1.5], [0.0, 1.0]])}
    lanes = tuple(replace(each, centre=short.get(each.id, each.centre)) for each in made.lanes)
    (entry,) = told(replace(made, lanes=lanes))
    assert "cars leave their lane" in entry.source and entry.sure == "low"


@pytest.mark.parametrize("radius", [6.0, 12.0, 40.0])
def test_of_a_turn_with_room_nobody_speaks(radius):
    assert not told(net_of(radius))
