"""The projection of a map, its signals and its vehicles onto a viser server on this machine."""

import socket
import threading
from collections.abc import Sequence

import numpy as np
import viser

from studio.scene import layer
from studio.scene.fleet import Fleet, Look


class Scene:
    """Owns a viser server on 127.0.0.1 and what it shows. Every method may be called from any thread."""

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self._server = viser.ViserServer(host="127.0.0.1", port=_free_port(), verbose=False)
        # any client may ask for a public tunnel, with or without the button
        self._server.request_share_url = lambda *args, **options: None
        self._server.gui.configure_theme(show_logo=False, show_share_button=False)
        self._server.scene.world_axes.visible = False
        self._fleet = Fleet(self._server, [])
        layer.light(self._server)
        self._look_from((120.0, -150.0, 110.0), (0.0, 0.0, 0.0))

    @property
    def port(self) -> int:
        """The port of the viser server, for the relay."""
        return self._server.get_port()

    def _look_from(self, position: Sequence[float], target: Sequence[float]) -> None:
        camera = self._server.initial_camera
        camera.position, camera.look_at = np.array(position), np.array(target)
        camera.fov, camera.near, camera.far = np.radians(42.0), 0.5, 7000.0

    def show_layers(self, layers):
        with self._lock, self._server.atomic():
            for each in layers:
                layer.show(self._server, each)

    def show_vehicles(self, looks: Sequence[Look]) -> None:
        """Show these vehicles instead of those before; they stay hidden until the first `update`."""
        with self._lock, self._server.atomic():
            self._fleet.remove()
            self._fleet = Fleet(self._server, looks)

    def update(self, poses: np.ndarray) -> None:
        """Move the vehicles: float32[POSE_ROWS, vehicle] (see pose.py), in the order of `show_vehicles`."""
        with self._lock:
            self._fleet.move(poses)

    def stop(self) -> None:
        """Close the viser server."""
        self._server.stop()


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]
