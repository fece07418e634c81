"""Traffic lights: a mast at the kerb of every approach, a head above every lane, and the lit lamps."""

from collections import defaultdict

import numpy as np
import viser

from studio.road.network import Network
from studio.road.network.signals import AMBER, GREEN, RED, RED_AMBER
from studio.road.ways.relief import relief_of
from studio.scene.glb import Material, glb
from studio.scene.shape import Surface, ball, box, cylinder, joined

MAST_HEIGHT, ARM_HEIGHT = 6.0, 5.75
BEHIND_LINE = 1.6  # [m] from the stop line to the mast
KERB = 0.9  # [m] from the edge of the lane to the mast
LAMP_HEIGHTS = {"red": 5.62, "amber": 5.22, "green": 4.82}
LAMP_COLOURS = {"red": "#ff1a0a", "amber": "#ff9a00", "green": "#00d35a"}
LIT_IN = {"red": (RED, RED_AMBER), "amber": (RED_AMBER, AMBER), "green": (GREEN,)}
STEEL, HOUSING, OFF = "#6f757a", "#1b1e20", "#33302c"
# a lit lamp stands a little before the dark one [m]
PROUD = 0.02
HIDDEN = np.array([0.0, 0.0, -500.0], np.float32)


def masts(network: Network) -> Surface:
    """Masts and arms of all signals as one mesh."""
    lift = lifts(network)
    return joined([_mast(network, links).moved(z=float(lift[links[0]])) for links in _approaches(network).values()])


def head_places(network: Network) -> tuple[np.ndarray, np.ndarray]:
    """x and y of the signal head of every link [m]."""
    signals = network.signals
    ahead = BEHIND_LINE
    return signals.link_x + ahead * np.cos(signals.link_heading), signals.link_y + ahead * np.sin(signals.link_heading)


def lifts(network: Network) -> np.ndarray:
    """How high above the land the stop line of every link is [m]."""
    relief = relief_of(network)
    return np.array([relief.of_lane(lane)[2][-1] if relief else 0.0 for lane in network.signals.link_lane])


def _approaches(network: Network) -> dict[str, list[int]]:
    found = defaultdict(list)
    for link, lane in enumerate(network.signals.link_lane):
        found[network.lanes[lane].road].append(link)
    return found


def _mast(network: Network, links: list[int]) -> Surface:
    signals = network.signals
    x, y = (axis[links] for axis in head_places(network))
    heading = float(signals.link_heading[links[0]])
    # distance of the lanes from the first one towards the kerb, in the frame of the approach
    across = network.middle * ((x - x[0]) * np.sin(heading) - (y - y[0]) * np.cos(heading))
    kerb = float(across.max()) + float(signals.link_width[links].mean()) / 2.0 + KERB
    reach = kerb - float(across.min())
    pole = cylinder(0.09, MAST_HEIGHT, STEEL).moved(y=-network.middle * kerb)
    arm = box((0.11, reach + 0.3, 0.11), STEEL)
    arm = arm.moved(y=network.middle * (reach / 2.0 + 0.15 - kerb), z=ARM_HEIGHT + 0.12)
    return joined([pole, arm]).turned(heading).moved(x=float(x[0]), y=float(y[0]))


def _head() -> Surface:
    """A head with three dark lamps, facing traffic that drives along +x."""
    lamps = [ball((0.06, 0.15, 0.15), OFF, segments=12).moved(x=-0.14, z=z) for z in LAMP_HEIGHTS.values()]
    visors = [box((0.16, 0.30, 0.025), HOUSING).moved(x=-0.21, z=z + 0.165) for z in LAMP_HEIGHTS.values()]
    board = box((0.05, 0.62, 1.42), HOUSING).moved(x=-0.05, z=LAMP_HEIGHTS["amber"])
    return joined([board, box((0.20, 0.40, 1.22), HOUSING).moved(x=-0.04, z=LAMP_HEIGHTS["amber"]), *lamps, *visors])


class Lamps:
    """Heads and lit lamps on a viser server: a batch of heads, and one per colour; what is not lit is hidden."""

    def __init__(self, server: viser.ViserServer, network: Network) -> None:
        x, y = head_places(network)
        heading = network.signals.link_heading
        turns = np.stack([np.cos(heading / 2), 0 * heading, 0 * heading, np.sin(heading / 2)], 1).astype(np.float32)
        lift = lifts(network)
        heads = np.stack([x, y, lift], 1).astype(np.float32)
        self._heads = server.scene.add_batched_glb(
            "/signals/heads", glb(_head(), Material(roughness=0.6)), turns, heads, lod="off", cast_shadow=False, receive_shadow=False
        )
        before = 0.14 + PROUD
        x, y = x - before * np.cos(heading), y - before * np.sin(heading)
        self._places = {name: np.stack([x, y, lift + z], 1).astype(np.float32) for name, z in LAMP_HEIGHTS.items()}
        self._nodes = {name: self._add(server, name, turns) for name in LAMP_HEIGHTS}
        self._shown = np.full(len(x), -1)

    def _add(self, server: viser.ViserServer, name: str, turns: np.ndarray) -> viser.BatchedGlbHandle:
        lamp = glb(ball((0.07, 0.165, 0.165), LAMP_COLOURS[name], segments=12), Material(unlit=True))
        hidden = np.tile(HIDDEN, (len(turns), 1))
        return server.scene.add_batched_glb(f"/signals/{name}", lamp, turns, hidden, lod="off", cast_shadow=False, receive_shadow=False)

    def show(self, states: np.ndarray) -> None:
        """Light the lamps of these states, one per link; costs nothing when nothing has changed."""
        states = np.asarray(states)
        if np.array_equal(states, self._shown):
            return
        self._shown = states.copy()
        for name, node in self._nodes.items():
            lit = np.isin(states, LIT_IN[name])
            node.batched_positions = np.where(lit[:, None], self._places[name], HIDDEN)

    def remove(self) -> None:
        """Take the lamps off the server."""
        for node in (self._heads, *self._nodes.values()):
            node.remove()
