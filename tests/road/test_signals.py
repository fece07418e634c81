"""Programmes keep conflicting traffic apart, and change in the right order."""

import numpy as np
import pytest

from studio.road.network.signals import AMBER, GREEN, RED, RED_AMBER, signal_state

STEP = 0.25  # [s]


@pytest.fixture(scope="module")
def shown(place):
    """What every link shows over two cycles, int[links, times]."""
    times = np.arange(0.0, 2.0 * place.signals.cycle[0], STEP)
    return np.array([[place.signals.state(link, t) for t in times] for link in range(len(place.signals))])


def test_conflicting_links_are_never_open_together(place, shown):
    assert place.signals.conflicts.shape[1] > 20
    for a, b in place.signals.conflicts.T:
        assert not ((shown[a] != RED) & (shown[b] != RED)).any()


def test_between_amber_and_the_others_start_nobody_goes(place, shown):
    for a, b in place.signals.conflicts.T:
        clear = (shown[a] == RED) & (shown[b] == RED)
        runs = np.diff(np.flatnonzero(np.diff(np.concatenate([[0], clear, [0]]))))[::2] * STEP
        assert runs[1:-1].min() >= 2.0 - STEP


def test_states_follow_in_order(shown):
    order = {(RED, RED_AMBER), (RED_AMBER, GREEN), (GREEN, AMBER), (AMBER, RED)}
    for states in shown:
        changes = np.flatnonzero(np.diff(states))
        assert {(states[i], states[i + 1]) for i in changes} == order


def test_durations(place, shown):
    seconds = {state: (shown == state).sum(axis=1) * STEP / 2.0 for state in (RED, RED_AMBER, GREEN, AMBER)}
    assert seconds[RED_AMBER] == pytest.approx(1.0, abs=STEP) and seconds[AMBER] == pytest.approx(3.0, abs=STEP)
    crossing = ~np.isin(np.arange(len(place.signals)), place.signals.conflicts)
    assert crossing.any() and seconds[GREEN].min() >= 10.0
    alone = seconds[RED][crossing]
    assert ((np.abs(alone - 12.0) <= STEP) | (alone > 30.0)).all()


def test_lanes_of_one_road_show_the_same(place, shown):
    by_road = {}
    for link, lane in enumerate(place.signals.link_lane):
        by_road.setdefault(place.lanes[lane].road, []).append(link)
    for links in by_road.values():
        assert (shown[links] == shown[links[0]]).all()


def test_ring_and_entries_alternate(place, shown):
    """Every programme with a stop line on the ring has an entry against it, and each goes about half the time."""
    on_ring = {}
    for link, lane in enumerate(place.signals.link_lane):
        name = place.roads[place.lanes[lane].road].name
        on_ring.setdefault(place.signals.programme[link], {}).setdefault(name == "Großer Stern", link)
    pairs = [found for found in on_ring.values() if True in found]
    assert len(pairs) == 5
    for found in pairs:
        assert set(found) == {True, False}
        assert (shown[found[True]] == GREEN).mean() == pytest.approx((shown[found[False]] == GREEN).mean(), abs=0.02)


def test_stop_lines_stand_across_their_lanes(place):
    signals = place.signals
    for link, lane in enumerate(signals.link_lane):
        centre = place.lanes[lane].centre
        assert (signals.link_x[link], signals.link_y[link]) == tuple(centre[:, -1])
        step = centre[:, -1] - centre[:, -2]
        ahead = [np.cos(signals.link_heading[link]), np.sin(signals.link_heading[link])]
        assert step @ ahead == pytest.approx(np.hypot(*step))


def test_connections_know_their_signal(place):
    lanes = set(place.signals.link_lane.tolist())
    for connection in place.connections:
        assert (connection.link >= 0) == (connection.from_lane in lanes)
        if connection.link >= 0:
            assert place.signals.link_lane[connection.link] == connection.from_lane


def test_time_runs_both_ways():
    ends, states = np.array([0.0, 0.0, 1.0, 21.0, 24.0, 60.0]), np.array([9, 9, RED_AMBER, GREEN, AMBER, RED])
    for t, state in (
        (5.0, RED_AMBER),
        (6.0, GREEN),
        (26.0, AMBER),
        (29.0, RED),
        (4.9, RED),
        (-55.0, RED_AMBER),
    ):
        assert signal_state(t, 60.0, 5.0, 2, 4, ends, states) == state
        assert signal_state(t + 600.0, 60.0, 5.0, 2, 4, ends, states) == state
