"""Radio over levels: distance has three dimensions, and the road of a bridge is between who is on it and who is near below."""

import numpy as np
import pytest

from studio import job
from studio.execution.simulation import simulation
from studio.kinds.radio import ad_hoc, wlan
from studio.workshop import draw
from studio.world.board.post import decks_between
from studio.world.table.cause import CAUSES, DECK, OUT_OF_RANGE, RECEIVED, TOO_WEAK
from studio.world.view import Draw, Way
from tests.kinds.link import table
from tests.road.plot import plot

FLYOVER = """
version: 1
title: Over and under
map: {{file: map.osm, radius: 900}}
clock: {{duration: 1}}
radio: {{kind: ad_hoc, buildings: false, range: {range}, delay: 0.001, delay_variation: 0.0, loss: 0.0, deck_loss: {loss}}}
routes: {{over: {{roads: ["11"]}}, under: {{roads: ["14"]}}}}
applications: {{behind: {{application: cacc, units: [down], listens_to: [up]}}}}
vehicles:
  up: {{route: over, position: {{along: 398}}, speed: 0}}
  down: {{route: under, position: {{along: 298}}, speed: 0}}
"""


def sent(tmp_path, monkeypatch, *, tags, loss=20.0, range=60.0):
    """The record of messages between a car on the middle of a street and one on that which crosses it there."""
    monkeypatch.setenv("STUDIO_CACHE", str(tmp_path / "cache"))
    nodes = {1: (-400, 0), 2: (-50, 0), 3: (50, 0), 4: (400, 0), 5: (0, -300), 6: (0, 300)}
    plot(tmp_path / "map.osm", nodes, {11: ([1, 2], {}), 12: ([2, 3], tags), 13: ([3, 4], {}), 14: ([5, 6], {})})
    path = tmp_path / "flyover.yaml"
    path.write_text(FLYOVER.format(loss=loss, range=range), encoding="utf-8")
    running = simulation(job.prepare(job.load(path)))
    while not running.is_over:
        running.advance()
    return running.record(0).messages


@pytest.mark.parametrize(("tags", "loss", "cause"), [
    ({"bridge": "yes"}, 20.0, DECK), ({"tunnel": "yes"}, 20.0, DECK), ({"bridge": "yes"}, 0.0, RECEIVED),
])  # fmt: skip
def test_who_is_under_a_bridge_hears_nothing_from_above(tmp_path, monkeypatch, tags, loss, cause):
    """20 dB are ten times the distance in free space: some 8 m become more than the range of 60 m."""
    messages = sent(tmp_path, monkeypatch, tags=tags, loss=loss)
    assert messages.cause.size > 5 and set(messages.cause.tolist()) == {cause}
    assert messages.distance.min() > 5.4


def test_bounds_of_a_deck():
    assert [decks_between(*each) for each in ((5.5, 10.0), (-5.5, 10.0), (5.5, 60.0), (2.9, 0.0), (0.0, 0.0))] == [1.0, 1.0, 0.0, 0.0, 0.0]


@pytest.mark.parametrize(("distance", "lost"), [(30.0, RECEIVED), (100.0, DECK), (400.0, OUT_OF_RANGE)])
def test_an_ad_hoc_radio_says_why(distance, lost):
    of = draw.settings_tuple(ad_hoc, ad_hoc.Settings(range=300.0, deck_loss=20.0, path_loss_exponent=2.0, loss=0.0, loss_per_metre=0.0))
    assert ad_hoc.transmit(of, Way(distance, size=100.0, decks=1.0), Draw(1)).lost == (lost if distance * 10.0 > 300.0 else RECEIVED)


def test_a_wlan_loses_so_many_decibels():
    """Where a message is just understood without a bridge, it is not with one; where it has 20 dB to spare, it is."""
    calm = {"path_loss": "free_space", "shadowing": 0.0, "fading": False, "buildings": False, "contention": False, "deck_loss": 20.0}
    settings = wlan.Settings(**calm)
    of = draw.settings_tuple(wlan, settings)
    known = table(of)

    def lost(distance, decks):
        return [int(wlan.transmit(of, Way(distance, size=350.0, table=known, decks=decks), Draw(1, number=k)).lost) for k in range(50)]

    far = max(d for d in np.geomspace(10.0, 1400.0, 60) if set(lost(float(d), 0.0)) == {RECEIVED})
    under = max(d for d in np.geomspace(1.0, 1400.0, 90) if set(lost(float(d), 1.0)) == {RECEIVED})
    assert far > 1000.0 or far / under == pytest.approx(10.0, rel=0.15)
    assert DECK in lost(float(far), 1.0) and TOO_WEAK not in lost(float(far), 1.0)


def test_the_cause_has_a_name():
    assert CAUSES[DECK].name == "deck"
