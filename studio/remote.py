"""A studio elsewhere: what the page does, from Python, over REST.

>>> import studio
>>> there = studio.connect("http://127.0.0.1:8000")
>>> run = there.run("grosser_stern_platoon", set={"clock.duration": 30}, seed=1)
>>> run.metrics["min_ttc"].value, run.trace("leader.speed", "follower_1.gap")["leader.speed"]
>>> run.judge("candidate", "near enough")

Times are in s, all else in the units that the server tells. What it refuses is raised as a StudioError with the same problems.
"""

import time
from collections.abc import Callable
from typing import Any, NamedTuple

import httpx
import numpy as np

from studio.errors import Problem, ServerError, StudioError, UnknownError

PATIENCE = 60.0  # [s] for an answer
LOOK = 0.2  # [s] between two looks at a run that goes on
UNFINISHED = ("waiting", "running")
MOST_POINTS = 1_000_000  # samples of a trace: all of it
MISSING = 404


class Metric(NamedTuple):
    """What was measured: its value, unit, which direction is better, whom it is about, and when [s]."""

    value: float | None
    unit: str
    goal: str | None
    subject: tuple[str, ...]
    time: float | None


class Run:
    """A run there, as it stood when it was asked for last; `row` is all that the server says of it."""

    def __init__(self, studio: "Studio", row: dict[str, Any]) -> None:
        self.studio, self.row = studio, row

    def __repr__(self) -> str:
        return f"<run {self.number} of {self.row['scenario']}, {self.status}>"

    @property
    def number(self) -> int:
        """Its number in the database there."""
        return self.row["run"]

    @property
    def status(self) -> str:
        """How it stood."""
        return self.row["status"]

    @property
    def metrics(self) -> dict[str, Metric]:
        """What was measured; empty until it is over."""
        return {name: Metric(**{key: tell(key, each[key]) for key in Metric._fields}) for name, each in self.row["metrics"].items()}

    def refresh(self) -> "Run":
        """Asks how it stands now."""
        self.row = self.studio.get(f"runs/{self.number}")
        return self

    def wait(self, progress: Callable[["Run"], None] = lambda run: None) -> "Run":
        """Until it is over; `progress` is told of every look. Raises StudioError when it has failed."""
        while self.refresh().status in UNFINISHED:
            progress(self)
            time.sleep(LOOK)
        if self.status == "failed":
            raise StudioError(f"Run {self.number} has failed: {self.row['error']}")
        return self

    def cancel(self) -> None:
        """Takes it out of the queue, or ends it."""
        self.studio.post(f"runs/{self.number}/cancel")

    def trace(self, *channels: str, begin: float | None = None, end: float | None = None) -> dict[str, np.ndarray]:
        """`time` and some channels `vehicle.quantity`, float64[sample], all of it or between two times [s]; nan where there is none."""
        span = {name: value for name, value in (("begin", begin), ("end", end)) if value is not None}
        found = self.studio.get(f"runs/{self.number}/trace", channels=",".join(channels), points=MOST_POINTS, **span)
        values = {name: np.array(each["values"], dtype=np.float64) for name, each in found["channels"].items()}
        return {"time": np.array(found["time"])} | values

    def judge(self, verdict: str, reason: str, who: str = "") -> "Run":
        """Decides about it: open, candidate or discarded, with a reason of one line."""
        self.studio.post(f"runs/{self.number}/verdicts", verdict=verdict, reason=reason, who=who)
        return self.refresh()

    def remark(self, *, name: str | None = None, tags: list[str] | None = None, note: str | None = None) -> "Run":
        """Gives it a name, tags and a note; what is not said stays as it was."""
        now = self.refresh().row
        said = {"name": name, "tags": tags, "note": note}
        self.studio.ask("PUT", f"runs/{self.number}/remark", json={key: now[key] if each is None else each for key, each in said.items()})
        return self.refresh()

    def report(self) -> str:
        """One page about it, as HTML."""
        return self.studio.ask("GET", f"runs/{self.number}/report").text

    def notebook(self) -> str:
        """A notebook (Jupyter) that reads it from there."""
        return self.studio.ask("GET", f"runs/{self.number}/notebook").text


class Studio:
    """A studio at an address. Raises ServerError when it does not answer."""

    def __init__(self, url: str, token: str = "") -> None:
        headers = {"Authorization": f"Bearer {token}"} if token else {}
        self.url, self.client = url.rstrip("/"), httpx.Client(base_url=f"{url.rstrip('/')}/api/", headers=headers, timeout=PATIENCE)

    def __enter__(self) -> "Studio":
        return self

    def __exit__(self, *_: object) -> None:
        self.client.close()

    def scenarios(self) -> list[dict[str, Any]]:
        """The scenario files there."""
        return self.get("scenarios")

    def check(self, scenario: str, set: dict[str, Any] | None = None) -> list[str]:
        """What would be wrong with a scenario with some changes by path; nothing when it could run."""
        return [str(Problem(**each)) for each in self.post(f"scenarios/{scenario}/check", set=set or {})["problems"]]

    def start(self, scenario: str, *, set: dict[str, Any] | None = None, seed: int | None = None, parent: int | None = None) -> Run:
        """Starts a run as fast as possible, or lets it wait for its turn, and does not wait for it."""
        return self.find(self.post("runs", scenario=scenario, set=set or {}, seed=seed, parent=parent)["run"])

    def run(self, scenario: str, *, set: dict[str, Any] | None = None, seed: int | None = None, parent: int | None = None,
            progress: Callable[[Run], None] = lambda run: None) -> Run:  # fmt: skip
        """The same, and waits until it is over. Raises StudioError when it has failed."""
        return self.start(scenario, set=set, seed=seed, parent=parent).wait(progress)

    def runs(self, scenario: str = "", limit: int = 1000) -> list[Run]:
        """Runs, the newest first."""
        wanted = {"scenario": scenario} if scenario else {}
        return [Run(self, row) for row in self.get("runs", limit=limit, **wanted)]

    def find(self, number: int) -> Run:
        """One run; raises UnknownError."""
        return Run(self, self.get(f"runs/{number}"))

    def compare(self, a: int, b: int) -> dict[str, Any]:
        """Two runs side by side: parameters that differ, and every metric."""
        return self.get("compare", a=a, b=b)

    def beside(self, *runs: int, everything: bool = False) -> dict[str, Any]:
        """Up to eight runs side by side, each compared with the first: what differs, or `everything`, and every metric."""
        return self.get("beside", runs=",".join(map(str, runs)), everything=everything)

    # -- asking --------------------------------------------------------------------------------------

    def get(self, path: str, **query: Any) -> Any:
        """What the server says at a path under /api."""
        return self.ask("GET", path, params=query).json()

    def post(self, path: str, **body: Any) -> Any:
        """What it says to a body."""
        return self.ask("POST", path, json=body).json()

    def ask(self, method: str, path: str, **how: Any) -> httpx.Response:
        """An answer; raises what was refused, and ServerError where nobody answers."""
        try:
            answer = self.client.request(method, path, **how)
        except httpx.HTTPError as error:
            problem = Problem("url", f"does not answer: {error}", self.url, remedy="start one there with `studio`")
            raise ServerError(f"There is no studio at {self.url}.", [problem]) from None
        if answer.is_success:
            return answer
        raise refusal(answer)


def connect(url: str = "http://127.0.0.1:8000", token: str = "") -> Studio:
    """The studio at an address, with the token that it printed when it serves a network. Raises ServerError when none is there."""
    there = Studio(url, token)
    there.get("info")
    return there


def refusal(answer: httpx.Response) -> StudioError:
    """A refusal as the error that it is."""
    try:
        told = answer.json()
        message, problems = told["message"], [Problem(**each) for each in told["problems"]]
    except (ValueError, LookupError, TypeError):
        message, problems = f"The server answered {answer.status_code}.", []
    return (UnknownError if answer.status_code == MISSING else StudioError)(message, problems)


def tell(key: str, value: Any) -> Any:
    """A part of a metric."""
    return tuple(value) if key == "subject" else value
