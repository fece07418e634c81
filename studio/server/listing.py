"""The list of runs as JSON text: 10 000 runs have half a million metrics, for each of which an object here would take seconds."""

from collections.abc import Sequence
from typing import Any

from pydantic_core import to_json

from studio.server import answer
from studio.store.runs import Row, Runs
from studio.store.setting import settings

APART = ("metrics", "settings")
FIELDS = [name for name in answer.ListedRun.model_fields if name not in APART]


def listing(runs: Runs, *, where: str, values: Sequence[Any], limit: int) -> bytes:
    """Runs, newest first, each as `answer.ListedRun` describes it."""
    rows = runs.select(where=where, values=values, limit=limit, measured=False)
    had, metrics = settings(runs, rows), runs.metrics_as_text([row.run for row in rows])
    return b"[" + b",".join(listed(row, had[row.run], metrics.get(row.run, "{}")) for row in rows) + b"]"


def listed(row: Row, had: dict[str, Any], metrics: str) -> bytes:
    """One run."""
    plain = {name: getattr(row, name) for name in FIELDS} | {"settings": had}
    return to_json(plain)[:-1] + b',"metrics":' + metrics.encode() + b"}"
