"""Ages of what links have heard last: the same as looked up at every sample, whatever is kept."""

from pathlib import Path

import numpy as np
import pytest

from studio.execution import hearing
from studio.vehicle.state import ACTIVE
from studio.workshop.stage import stage
from studio.world.table.unit import H_NUMBER, H_TIME, PRESENT

STATIONS = {f"post_{i}": {"position": {"x": 500.0 + 0.1 * i, "y": 30.0}} for i in range(4)}


def ages_now(run):
    """Of all links, at the tick that is just over; not a number where an end has left."""
    time, found = run.recorder.times(run.recorder.count)[-1], []
    for post in run.world.units.posts:
        there = run.world.units.now[PRESENT] > 0.0
        age = np.where(post.inbox[H_NUMBER] >= 0.0, time - post.inbox[H_TIME], time)
        found.append(np.where(there[post.link_receiver] & there[post.sender[post.link_sender]], age, np.nan))
    return np.concatenate(found)


@pytest.mark.parametrize("room", [hearing.ROOM, 1])
def test_ages_are_those_of_every_sample(own_kinds, monkeypatch, room):
    """Two kinds of messages, some of them lost, and cars that leave; of all links and of some, up to now and up to a while ago."""
    monkeypatch.setattr(hearing, "ROOM", room)
    own_kinds(Path(__file__).parents[1] / "message")
    groups = {"hears": {"application": "ear", "units": list(STATIONS)}, "listens": {"application": "listener", "units": ["post_0", "own"]}}
    run = stage(stations=STATIONS, applications=groups, radio={"kind": "patchy", "loss_good": 0.3, "range": 5000.0})
    expected = []
    for k in range(60):
        if k == 40:
            run.world.vehicles.state[ACTIVE, 1:] = 0.0
        run.advance(1)
        expected.append(ages_now(run))
    links, time = np.arange(expected[0].size), run.recorder.times(60)
    whole = run.recorder.ages(links.tolist(), 60)
    np.testing.assert_array_equal(whole, np.array(expected).T)
    np.testing.assert_array_equal(run.recorder.ages([7, 2], 33), whole[[7, 2], :33])
    assert np.isnan(whole).any() and (whole < time).any() and run.recorder.ages([], 60).shape == (0, 60)
