"""A town small enough to know by heart: one street of two lanes, a signal, a house, a park and a pond."""

import numpy as np
import pytest

from studio.road.network import Area, Building, Lane, Network, Road, Scenery
from studio.road.network.signals import Signals

LENGTH = 300.0


def straight(number: int, index: int, y: float) -> Lane:
    centre = np.array([np.linspace(-LENGTH / 2, LENGTH / 2, 31), np.full(31, y)])
    return Lane(number, "main", index, 3.5, 13.9, centre, False, LENGTH)


def square(x: float, y: float, half: float) -> np.ndarray:
    return np.array([[x - half, x + half, x + half, x - half], [y - half, y - half, y + half, y + half]])


def lights() -> Signals:
    """Both lanes stop at x = 150 m: red-amber, green, amber, red."""
    two = np.full(2, 1.0)
    return Signals(
        link_lane=np.array([0, 1]),
        link_x=150.0 * two,
        link_y=np.array([-1.75, 1.75]),
        link_heading=0.0 * two,
        link_width=3.5 * two,
        programme=np.zeros(2, int),
        cycle=60.0 * two,
        offset=0.0 * two,
        first=np.array([0, 4]),
        count=np.array([4, 4]),
        phase_end=np.array([1.0, 27.0, 30.0, 60.0] * 2),
        phase_state=np.array([1, 2, 3, 0] * 2),
        conflicts=np.empty((2, 0), int),
    )


@pytest.fixture(scope="session")
def town() -> Network:
    lanes = (straight(0, 0, -1.75), straight(1, 1, 1.75))
    road = Road("main", "Main Street", (0, 1), "a", "b", 13.9, LENGTH, False)
    house = Building(square(0.0, 30.0, 8.0), (square(0.0, 30.0, 2.0)[:, ::-1],), 12.0, 0.0, "")
    tower = Building(square(60.0, 30.0, 5.0), (), 30.0, 0.0, "#b0705a")
    scenery = Scenery(
        buildings=(house, tower),
        areas=(Area("green", square(-60.0, -60.0, 50.0), ()), Area("water", square(-60.0, -60.0, 10.0), ())),
        trees=np.array([[20.0, 40.0], [-12.0, -12.0]]),
    )
    return Network(
        name="town",
        attribution="made for the tests",
        origin=(52.5, 13.4),
        bounds=(-160.0, -160.0, 160.0, 160.0),
        digest="town",
        lanes=lanes,
        roads={"main": road},
        connections=(),
        junctions=(),
        signals=lights(),
        scenery=scenery,
    )
