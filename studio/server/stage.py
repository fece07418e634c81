"""The stage: what the scene shows now. A scenario as it would start, a live run, or one that is over; the last choice counts."""

import threading
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from studio.job import Loaded, prepare
from studio.scene.projection import Scene
from studio.server import answer
from studio.server.frame import Frame, first_frame, looks, places
from studio.server.ghost import Ghost
from studio.server.live import LiveRun
from studio.server.replay import Replay
from studio.world.car import position
from studio.world.setting import Setting


@dataclass
class Stage:
    """Owns the scene. `showing` is the live run whose frames are drawn, `playing` the run that is played back."""

    scene: Scene = field(default_factory=Scene)
    showing: LiveRun | None = None
    playing: Replay | None = None
    city: str = ""
    cast: tuple = ()
    props: tuple = ()
    ghosts: tuple[Ghost, ...] = ()
    lock: threading.RLock = field(default_factory=threading.RLock)

    def show(self, loaded: Loaded, live: LiveRun | None = None) -> dict[str, Any]:
        """Shows a scenario at its start, or the live run that it became; returns who is to be seen."""
        prepared = prepare(loaded)
        with self.lock:
            self.set_up(prepared)
            self.haunt(())
            self.showing, self.playing = live, None
            self.draw(live.frame if live and live.frame else first_frame(prepared))
        return described(prepared)

    def play(self, replay: Replay, time: float | None = None, ghosts: tuple[Ghost, ...] = ()) -> dict[str, Any]:
        """Shows a run that is over at a time [s], by default at its end, among the ghosts of others; returns who is to be seen, from
        when to when, and what is not."""
        first, last = float(replay.time[0]), float(replay.time[-1])
        about = {
            "begin": first,
            "end": last,
            "step": (last - first) / max(replay.time.size - 1, 1),
            "notes": list(replay.notes),
            "missing": replay.missing,
        }
        with self.lock:
            self.set_up(replay.setting)
            self.haunt(ghosts)
            self.showing, self.playing = None, replay
            self.draw(replay.frame(last if time is None else time))
            self.move_ghosts(replay, last if time is None else time)
        told, shown = described(replay.setting), set(replay.columns.tolist())
        about["vehicles"] = [each for each in told["vehicles"] if each["index"] in shown]
        return told | about | {"ghosts": [each.told() for each in ghosts]}

    def seek(self, run: int, time: float) -> Replay | None:
        """Shows the run that is played back at another time [s] and returns it; None when it is another, or none."""
        with self.lock:
            if self.playing is None or self.playing.run != run:
                return None
            self.draw(self.playing.frame(time))
            self.move_ghosts(self.playing, time)
            return self.playing

    def layers(self, played: Replay, time: float) -> answer.Layers | None:
        """What can be drawn over the picture of a run that is played back at a time [s], with the lines to its ghosts."""
        found = played.layers(time)
        return found and found.model_copy(update={"links": [link for each in self.ghosts for link in each.links(played, time)]})

    def set_up(self, prepared: Setting) -> None:
        """City, vehicles and objects, as far as they are others than before; the weather."""
        if self.city != prepared.network.digest:
            named = [car for car in prepared.cars if not car.returns]
            self.scene.show_city(prepared.network, np.array([position(car.path, car.station) for car in named]).T)
            self.city = prepared.network.digest
        cast = tuple(looks(prepared))
        if self.cast != cast:
            self.scene.show_vehicles(cast)
            self.cast = cast
        props = tuple(places(prepared))
        if self.props != props:
            self.scene.show_obstacles(props)
            self.props = props
        self.scene.show_weather(prepared.scenario.weather.visibility)

    def haunt(self, ghosts: tuple[Ghost, ...]) -> None:
        """Other runs among the cars instead of those before."""
        if ghosts or self.ghosts:
            self.ghosts = ghosts
            self.scene.show_ghosts([look for each in ghosts for look in each.looks])

    def move_ghosts(self, played: Replay, time: float) -> None:
        """Where the cars of the other runs were when this one was there [s]."""
        if self.ghosts:
            self.scene.update_ghosts(np.concatenate([each.seen(played, time) for each in self.ghosts], axis=1))

    def on_frame(self, live: LiveRun, frame: Frame) -> None:
        """A frame of some live run; drawn when it is the one that is shown."""
        with self.lock:
            if live is self.showing and frame.poses.shape[1] == len(self.cast) and frame.standing.size == len(self.props):
                self.draw(frame)

    def draw(self, frame: Frame) -> None:
        """Puts a picture on the scene."""
        self.scene.update(frame.poses)
        self.scene.show_signals(frame.lights)
        self.scene.update_obstacles(frame.standing, frame.objects)


def described(prepared: Setting) -> dict[str, Any]:
    """Who is to be seen, for the page."""
    vehicles = [
        {
            "name": each.name,
            "index": i,
            "color": each.color,
            "length": size.length,
            "width": size.width,
            "height": size.height,
            "middle": size.centre,
        }
        for i, each in enumerate(looks(prepared))
        for size in [each.dimensions]
    ]
    return {"vehicles": vehicles, "attribution": prepared.network.attribution, "map": prepared.network.digest}
