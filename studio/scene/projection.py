"""The projection of a map, its signals and its vehicles onto a viser server on this machine."""

import hmac
import secrets
import socket
import threading
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from http import HTTPStatus

import numpy as np
import rich
import shapely
import viser
import websockets.asyncio.server
from websockets.asyncio.server import ServerConnection
from websockets.http11 import Request, Response

from studio.road.network import Network
from studio.scene import city
from studio.scene.city import tree
from studio.scene.fleet import Fleet, Look
from studio.scene.ghost import Ghosts
from studio.scene.light import HAZE_FAR, SKY_RADIUS, air, light
from studio.scene.obstacle import Obstacles, Place
from studio.scene.signal import Lamps

FIELD_OF_VIEW = np.radians(42.0)
COMPACT = 700.0  # [m] half extent of a map that can be seen as a whole
CLOSER = 150.0  # [m] the same of the part of a larger one that is seen first
FROM = np.array([0.24, -0.80, 0.36])  # the overview's place over its half extent: in the south
SIGHT = 20.0  # [m] to both sides of the line of sight
KEY = "x-studio-key"  # header of who may talk to the viser server
CLOSED = "This port is the studio's own. Open the studio at the address that it printed.\n"
TURNS = np.radians([0, 45, -45, 90, -90, 135, -135, 180])  # of this place, where houses stand in the way


class Scene:
    """Owns a viser server on 127.0.0.1 and what it shows. Every method may be called from any thread.

    Browsers that come later, or come back, get everything that is shown from the server.
    """

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self._key = secrets.token_urlsafe()
        self._server = _server(self._key)
        self._city: list[viser.SceneNodeHandle] = []
        self._lamps: Lamps | None = None
        self._fleet = Fleet(self._server, [])
        self._obstacles = Obstacles(self._server, [])
        self._ghosts = Ghosts(self._server, [])
        self._visibility, self._reach, self._horizon = HAZE_FAR, 0.0, SKY_RADIUS
        light(self._server)
        self._look_at(np.zeros(2), 150.0, 150.0 * FROM)

    @property
    def door(self) -> tuple[int, dict[str, str]]:
        """The port of the viser server, and the headers without which it lets nobody in; for the relay."""
        return self._server.get_port(), {KEY: self._key}

    def show_city(self, network: Network, around: np.ndarray | None = None) -> None:
        """Show this map instead of the one before; a large one is first seen `around` these places, float64[2, n] [m]."""
        made = city.city(network)
        with self._lock, self._server.atomic():
            self._clear_city()
            self._city = [self._add(layer) for layer in made.layers]
            self._city += tree.plant(self._server, made.trees, foot=city.AREA, shade=city.TREE_SHADOW)
            # comes after everything else: who finds it has the rest of this map
            self._city.append(self._server.scene.add_frame(f"/map/{network.digest}", visible=False))
            self._lamps = Lamps(self._server, network) if len(network.signals) else None
            self._reach = _reach(network)
            self._horizon = city.horizon(network)
            self._look_at(*_overview(network, around))
            air(self._server, self._visibility, reach=self._reach, radius=self._horizon)

    def _clear_city(self) -> None:
        for node in self._city:
            node.remove()
        if self._lamps is not None:
            self._lamps.remove()

    def _add(self, layer: city.Layer) -> viser.SceneNodeHandle:
        place = (0.0, 0.0, layer.height)
        return self._server.scene.add_glb(f"/city/{layer.name}", layer.data, position=place, cast_shadow=False, receive_shadow=False)

    def _look_at(self, middle: np.ndarray, reach: float, away: np.ndarray) -> None:
        """The overview: from so far `away`, float64[3] [m], over the middle to the horizon."""
        camera = self._server.initial_camera
        camera.position = np.array([*middle, 0.0]) + away
        camera.look_at = np.array([*middle, 0.05 * reach])
        camera.fov, camera.near, camera.far = FIELD_OF_VIEW, 0.5, 2.5 * self._horizon

    def show_vehicles(self, looks: Sequence[Look]) -> None:
        """Show these vehicles instead of those before; they stay hidden until the first `update`."""
        with self._lock, self._server.atomic():
            self._fleet.remove()
            self._fleet = Fleet(self._server, looks)

    def show_ghosts(self, looks: Sequence[Look]) -> None:
        """Show these cars of other runs instead of those before, seen through; they stay hidden until `update_ghosts`."""
        with self._lock, self._server.atomic():
            self._ghosts.remove()
            self._ghosts = Ghosts(self._server, looks)

    def update_ghosts(self, poses: np.ndarray) -> None:
        """Move the ghosts: float32[POSE_ROWS, ghost], in the order of `show_ghosts`."""
        with self._lock:
            self._ghosts.move(poses)

    def show_obstacles(self, places: Sequence[Place]) -> None:
        """Have these objects instead of those before; they stay hidden until `update_obstacles`."""
        with self._lock, self._server.atomic():
            self._obstacles.remove()
            self._obstacles = Obstacles(self._server, places)

    def update_obstacles(self, standing: np.ndarray, objects: np.ndarray) -> None:
        """Show the objects that stand, int8[object] in the order of `show_obstacles`, where they are, float32[x, y and heading, object];
        quick when nothing has changed."""
        with self._lock, self._server.atomic():
            self._obstacles.show(standing, objects)

    def show_weather(self, visibility: float) -> None:
        """Haze, or fog where one sees less far [m]."""
        far = min(visibility, HAZE_FAR)
        with self._lock, self._server.atomic():
            if far != self._visibility:
                air(self._server, far, reach=self._reach, radius=self._horizon)
                self._visibility = far

    def update(self, poses: np.ndarray) -> None:
        """Move the vehicles: float32[POSE_ROWS, vehicle] (see pose.py), in the order of `show_vehicles`."""
        with self._lock:
            self._fleet.move(poses)

    def show_signals(self, states: np.ndarray) -> None:
        """Light the signals: one of RED, RED_AMBER, GREEN, AMBER per link; quick when nothing has changed."""
        with self._lock, self._server.atomic():
            if self._lamps is not None:
                self._lamps.show(states)

    def stop(self) -> None:
        """Close the viser server; may take some seconds."""
        with _quiet():
            self._server.stop()


def _server(key: str) -> viser.ViserServer:
    with _quiet(), _locked(key):
        server = viser.ViserServer(host="127.0.0.1", port=_free_port(), verbose=False)
    # any client may ask for a public tunnel, with or without the button
    server.request_share_url = lambda *args, **options: None
    server.gui.configure_theme(show_logo=False, show_share_button=False)
    server.scene.world_axes.visible = False
    return server


@contextmanager
def _locked(key: str) -> Generator[None]:
    """Servers that are made in it answer nobody but who has the key: viser asks nobody who they are, and any page of any browser on this
    machine may call its port. It has no place for that, so the function that it serves with is another meanwhile."""
    usual = websockets.asyncio.server.serve

    class Locked(usual):
        """The same, behind the question for the key."""

        def __init__(self, handler, *places, process_request=None, **options):
            def look(connection: ServerConnection, request: Request) -> Response | None:
                given = request.headers.get_all(KEY)
                if len(given) != 1 or not hmac.compare_digest(given[0].encode(), key.encode()):
                    return connection.respond(HTTPStatus.FORBIDDEN, CLOSED)
                return process_request(connection, request) if process_request else None

            super().__init__(handler, *places, process_request=look, **options)

    websockets.asyncio.server.serve = Locked
    try:
        yield
    finally:
        websockets.asyncio.server.serve = usual


@contextmanager
def _quiet() -> Generator[None]:
    # viser prints its own address, and that is not the one to open
    console = rich.get_console()
    before, console.quiet = console.quiet, True
    try:
        yield
    finally:
        console.quiet = before


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def _reach(network: Network) -> float:
    """About half the extent of the streets [m], but never so little that one sees nothing."""
    points = np.concatenate([lane.centre for lane in network.lanes], axis=1)
    return max(60.0, 0.8 * float(np.percentile(np.hypot(*points), 90)))


def _overview(network: Network, around: np.ndarray | None) -> tuple[np.ndarray, float, np.ndarray]:
    """What the overview looks at [m], the half extent of it, and from how far away: from where no house hides it."""
    middle, reach = np.zeros(2), _reach(network)
    if reach > COMPACT and around is not None and around.size:
        middle, reach = around.mean(axis=1), CLOSER
    places = [reach * _turned(FROM, angle) for angle in TURNS]
    return middle, reach, min(places, key=lambda away: _hidden(network, middle, away))  # of equal ones the first


def _turned(place: np.ndarray, angle: float) -> np.ndarray:
    """A place turned about the vertical [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * place[0] - s * place[1], s * place[0] + c * place[1], place[2]])


def _hidden(network: Network, middle: np.ndarray, away: np.ndarray) -> float:
    """How far houses rise above the line of sight from there to the middle [m]; below the eye's place they count as well."""
    sight = shapely.LineString([middle, middle + away[:2]]).buffer(SIGHT)
    most = 0.0
    for each in network.scenery.buildings:
        form = shapely.Polygon(each.outline.T)
        if form.intersects(sight):
            share = shapely.Point(middle).distance(form) / np.hypot(*away[:2])
            most = max(most, each.height - share * away[2])
    return most
