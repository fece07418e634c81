"""A run as MCAP: what the format's own reader finds is what was recorded, value for value, at its time."""

import io
import json
from itertools import pairwise
from math import cos, hypot, isfinite, sin

import numpy as np
import pytest
from mcap.reader import make_reader

from studio import job
from studio.cli import app
from studio.errors import UnknownError
from studio.store import trace
from studio.store.mcap import mcap
from studio.store.runs import open_runs
from studio.world.table.cause import CAUSES
from tests.conftest import ROOT

CHANGES = {"clock.duration": 3, "traffic.count": 2, "recording.traffic": True, "recording.period": 0.1}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A database with a run of a platoon, that run, and its file read with the library of the format: schema, channel, message of each."""
    folder = tmp_path_factory.mktemp("mcap")
    runs = open_runs(folder / "runs.db")
    run = job.run(job.load(ROOT / "scenarios" / "grosser_stern_platoon.yaml", CHANGES), runs=runs).row.run
    return folder, runs, run, list(make_reader(io.BytesIO(b"".join(mcap(runs, run)))).iter_messages())


def of(made, topic):
    """Log time [ns] and content of every message of a topic."""
    return [(message.log_time, json.loads(message.data)) for _, channel, message in made[3] if channel.topic == topic]


def test_every_recorded_value_is_there_with_all_its_bits_and_nothing_else(made):
    _, runs, run, found = made
    names = [each["name"] for each in runs.channels(run)]
    kept = runs.trace(run, names)
    assert len(names) > 100
    compared = 0
    for owner in {name.partition(".")[0] for name in names}:
        own = [name.partition(".")[2] for name in names if name.startswith(f"{owner}.")]
        told = [each for _, channel, message in found if channel.topic.endswith(f"/{owner}") for each in [json.loads(message.data)]]
        at = {time: i for i, time in enumerate(kept["time"])}
        values = {quantity: np.full(kept["time"].size, np.nan) for quantity in own}
        for each in told:
            for quantity in each.keys() - {"time"}:
                values[quantity][at[each["time"]]] = each[quantity]
        for quantity in own:
            recorded = kept[f"{owner}.{quantity}"]
            expected = np.where(np.isfinite(recorded), recorded, np.nan)
            assert np.array_equal(values[quantity], expected, equal_nan=True), (owner, quantity)
            compared += np.isfinite(expected).sum()
    assert compared > 10_000


def test_times_are_those_of_the_run_in_order(made):
    times = [message.log_time for _, _, message in made[3]]
    assert all(one <= other for one, other in pairwise(times))
    for when, data in of(made, "/vehicles/leader"):
        assert when == round(data["time"] * 1e9)
    assert [data["time"] for _, data in of(made, "/vehicles/leader")] == made[1].trace(made[2], ["leader.speed"])["time"].tolist()


def test_units_stand_in_the_schema_and_beside_the_channel(made):
    schema, channel = next((schema, channel) for schema, channel, _ in made[3] if channel.topic == "/vehicles/leader")
    units = {each["name"].partition(".")[2]: each["unit"] for each in made[1].channels(made[2]) if each["name"].startswith("leader.")}
    assert channel.metadata == units
    assert schema.encoding == "jsonschema"
    assert json.loads(schema.data)["properties"]["speed"] == {"type": "number", "title": "Speed", "description": "[m/s]"}


def test_the_scene_has_everybody_as_a_box_around_the_middle_of_the_body(made):
    _, runs, run, _ = made
    body = trace.about_of(runs.parquet(run))["bodies"]["leader"]
    x, y, heading = (runs.trace(run, [f"leader.{each}"])[f"leader.{each}"] for each in ("x", "y", "heading"))
    scenes = of(made, "/scene")
    assert len(scenes) == x.size
    for i, (_, data) in enumerate(scenes):
        (own,) = [each for each in data["entities"] if each["id"] == "leader"]
        (box,) = own["cubes"]
        place, turn = box["pose"]["position"], box["pose"]["orientation"]
        front = (place["x"] + body.length / 2 * cos(heading[i]), place["y"] + body.length / 2 * sin(heading[i]))
        bumper = (x[i] + body.front * cos(heading[i]), y[i] + body.front * sin(heading[i]))
        assert hypot(front[0] - bumper[0], front[1] - bumper[1]) < 1e-9
        assert 2 * np.arctan2(turn["z"], turn["w"]) == pytest.approx(heading[i], abs=1e-12)
        assert (box["size"]["x"], box["size"]["y"]) == (body.length, body.width)


def test_who_has_left_the_road_is_taken_out_of_the_scene(made):
    names = [{each["id"] for each in data["entities"]} for _, data in of(made, "/scene")]
    gone = [{each["id"] for each in data["deletions"]} for _, data in of(made, "/scene")]
    assert gone == [set(), *(before - now for before, now in pairwise(names))]


def test_events_are_told_with_their_numbers(made):
    events = made[1].events(made[2])
    assert events
    assert [data["text"] for _, data in of(made, "/events")] == [each.text for each in events]
    assert [(when, data["message"]) for when, data in of(made, "/log")] == [(round(each.time * 1e9), each.text) for each in events]
    numbers = [json.loads(json.dumps(each.as_json()))["numbers"] for each in events]
    assert [data["numbers"] for _, data in of(made, "/events")] == numbers


def test_messages_have_what_became_of_them_at_everybody(made):
    kept, told = made[1].messages(made[2]), of(made, "/messages")
    assert [(data["time"], data["sender"], data["size"]) for _, data in told] == [
        (time, kept.units[sender], size) for time, sender, size in zip(kept.time, kept.sender, kept.size, strict=True)
    ]
    entries = [each for _, data in told for each in data["receivers"]]
    assert [each["receiver"] for each in entries] == [kept.units[each] for each in kept.receiver]
    assert [each["cause"] for each in entries] == [CAUSES[each].name for each in kept.cause]
    assert [each.get("delay") for each in entries] == [float(each) if isfinite(each) else None for each in kept.delay]
    assert len(entries) > 100


def test_the_command_writes_the_same_file(made, tmp_path):
    folder, runs, run, _ = made
    app(["export", str(run), "--out", str(tmp_path / "run.mcap"), "--db", str(folder / "runs.db")], standalone_mode=False)
    assert (tmp_path / "run.mcap").read_bytes() == b"".join(mcap(runs, run))


def test_a_run_that_is_not_there_is_told_before_the_first_byte(made):
    with pytest.raises(UnknownError):
        mcap(made[1], 99)
