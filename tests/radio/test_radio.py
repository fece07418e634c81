"""Radios in a world: what is set reaches the messages, load and congestion control, cells, and the same bits whoever else is there."""

from pathlib import Path

import numpy as np
import pytest

from studio.kinds.radio import cellular, wlan
from studio.model.radio import packet
from studio.workshop.stage import stage
from studio.world.board.post import taking_turns
from studio.world.table.cause import BANDWIDTH, BUSY, NO_COVERAGE, RECEIVED

SIZE = 300.0  # [bytes] of an awareness message
CALM = {"kind": "wlan", "path_loss": "free_space", "shadowing": 0.0, "fading": False, "delay_rest": 0.0}


@pytest.fixture(autouse=True)
def listener(own_kinds):
    """The application that listens."""
    own_kinds(Path(__file__).parent)


def talk(radio, places, seconds, **parts):
    """Stations at places [m] tell each other of themselves ten times a second, as the six cars of the stage do; the record's messages."""
    stations = {f"post_{i}": {"position": {"x": float(x), "y": float(y)}} for i, (x, y) in enumerate(places)}
    group = {"application": "listener", "units": list(stations)}
    current = stage(stations=stations, applications={"listening": group}, radio=radio, clock={"duration": seconds}, **parts)
    current.advance(round(seconds / 0.02) - 1)
    assert current.cases[0].status == "running", current.cases[0].error
    return current.record().messages


def circle(n, radius, x=500.0):
    """n places on a circle."""
    angle = 2.0 * np.pi * np.arange(n) / n
    return np.stack([x + radius * np.cos(angle), radius * np.sin(angle)], axis=1)


def are_posts(messages, units):
    """Which of these units are stations."""
    return np.array([name.startswith("post_") for name in messages.units])[units]


def per_second(messages, seconds):
    """Messages that the stations sent in every second."""
    return np.bincount(messages.time[are_posts(messages, messages.sender)].astype(int), minlength=int(seconds))


def between_posts(messages):
    """The entries about messages from one station to another: causes, delays [s], times of sending [s], receivers and senders."""
    sender = messages.sender[messages.of]
    chosen = are_posts(messages, sender) & are_posts(messages, messages.receiver)
    every = (messages.cause, messages.delay, messages.time[messages.of], messages.receiver, sender)
    return tuple(each[chosen] for each in every)


# -- load --------------------------------------------------------------------------------------------


def test_congestion_control_makes_a_full_channel_emptier():
    """80 stations, ten messages of 448 µs each: 0.36 of the channel, so 400 ms by OScar's table after a second of it.

    Then the ratio is 0.09 on average. It stays so: whoever waits 400 ms sends in the same tenth of a second as before, so that every fourth
    sample is as full as at first.
    """
    assert 80 * 10 * packet.airtime(SIZE, 2) == pytest.approx(0.358, abs=0.001)
    free, full = (per_second(talk(CALM | {"congestion_control": each}, circle(80, 50.0), 8.0), 8.0) for each in ("none", "oscar"))
    assert (free[:7] == 800).all()
    assert full[0] == 800 and full[2:8] == pytest.approx(200, abs=60) and full[2:8].mean() == pytest.approx(200, abs=10)


def test_messages_are_spoilt_where_many_speak():
    """The same 80 for two seconds: more are spoilt than among eight; with contention left out none."""
    share = {}
    for n, contention in ((80, True), (8, True), (80, False)):
        cause, _, time, *_ = between_posts(talk(CALM | {"contention": contention, "hearing": 100.0}, circle(n, 50.0), 2.0))
        share[n, contention] = np.mean(cause[time > 0.2] == BUSY)
    assert share[80, False] == 0.0 and share[80, True] > 5.0 * share[8, True] > 0.0


def test_delays_and_causes_are_those_of_the_radio():
    """The shortest delay and the time on the air; too far away all are lost."""
    on_air = packet.airtime(SIZE, 2)
    near = talk(CALM | {"delay": 0.004, "delay_longest": 0.004, "contention": False}, [(500.0, 0.0), (560.0, 0.0)], 1.0)
    cause, delay, *_ = between_posts(near)
    assert cause.size >= 18 and (cause == RECEIVED).all() and delay == pytest.approx(0.004 + on_air, abs=1e-6)
    far = talk(CALM | {"transmit_power": -20.0, "range": 5000.0}, [(500.0, 0.0), (4500.0, 0.0)], 1.0)
    cause, *_ = between_posts(far)
    assert cause.size >= 18 and not (cause == RECEIVED).any()


def test_a_preset_delivers_in_a_world_what_it_delivers_alone():
    """Suburban at 300 m: 60 pairs of stations far from each other for 60 s.

    0.85 arrive of many pairs that drive. Who stands is in one shadow all the time: then the standard error of 60 pairs is 0.04.
    """
    pairs = [place for i in range(60) for place in ((500.0, 3000.0 * i), (800.0, 3000.0 * i))]
    cause, *_ = between_posts(talk({"kind": "wlan", "preset": "suburban"}, pairs, 60.0))
    assert cause.size == pytest.approx(60 * 2 * 600, rel=0.01)
    assert np.mean(cause == RECEIVED) == pytest.approx(0.85, abs=0.12)


# -- cells -------------------------------------------------------------------------------------------


def test_a_source_far_away_is_heard_by_cell_only():
    places = [(500.0, 0.0), (90_000.0, 0.0)]
    cause, delay, *_ = between_posts(talk({"kind": "cellular", "loss": 0.0, "delay": 0.03, "delay_variation": 0.0}, places, 2.0))
    assert cause.size >= 38 and (cause == RECEIVED).all()
    assert delay.min() > 0.03 + SIZE / 1e6 - 1e-6 and delay.max() < 0.03 + 8 * SIZE / 1e6
    assert between_posts(talk({"kind": "wlan"}, places, 1.0))[0].size == 0


def test_outside_the_cell_nobody_is_heard():
    """Two of three are in the polygon."""
    corners = [[400.0, -50.0], [600.0, -50.0], [600.0, 50.0], [400.0, 50.0]]
    radio = {"kind": "cellular", "coverage": "polygon", "corners": corners, "loss": 0.0}
    messages = talk(radio, [(450.0, 0.0), (550.0, 0.0), (700.0, 0.0)], 2.0)
    cause, _, _, receiver, sender = between_posts(messages)
    outside = messages.units.index("post_2")
    involved = (receiver == outside) | (sender == outside)
    assert (cause[involved] == NO_COVERAGE).all() and (cause[~involved] == RECEIVED).all()
    assert involved.sum() == pytest.approx(2 * (~involved).sum(), abs=4) and (~involved).sum() >= 38


def test_twice_the_bandwidth_delays_a_second_a_second():
    """30 units with ten messages of 300 bytes a second are 90 kB/s, on 45 kB/s: the delay grows by 1 s each second, up to 4 s."""
    radio = {"kind": "cellular", "bandwidth": 45e3, "longest_wait": 4.0, "delay": 0.0, "delay_variation": 0.0, "loss": 0.0}
    messages = talk(radio, circle(24, 20.0), 6.0)
    time, delay = messages.time[messages.of], messages.delay
    early, late = messages.is_received & (time < 3.8), time > 4.2
    assert np.polyfit(time[early], delay[early], 1)[0] == pytest.approx(1.0, abs=0.03)
    assert np.mean(messages.cause[late] == BANDWIDTH) == pytest.approx(0.5, abs=0.03) and np.nanmax(delay) <= 4.0 + 1e-6


def test_whoever_sends_at_the_same_instant_has_the_same_chance():
    """A network for half of what is sent, which keeps nothing for long: of those who speak together nobody is served more than others."""
    radio = {"kind": "cellular", "bandwidth": 45e3, "longest_wait": 0.02, "delay": 0.0, "delay_variation": 0.0, "loss": 0.0}
    messages = talk(radio, circle(24, 20.0), 20.0)
    came = np.zeros(messages.time.size, dtype=bool)
    came[messages.of[messages.is_received]] = True
    phase = np.round(messages.time / 0.02).astype(int) % 5
    for each in range(5):
        senders = np.unique(messages.sender[phase == each])
        share = np.array([came[(messages.sender == sender) & (phase == each)].mean() for sender in senders])
        assert share.mean() > 0.0 and np.ptp(share) < 6.0 * (share.mean() * (1.0 - share.mean()) / 200.0) ** 0.5 + 1e-9
    assert 0.3 < came.mean() < 0.7


def test_kinds_of_messages_take_turns_before_a_network():
    """Each is before the other about half of the time, whoever else is there; where nothing waits, they stay as they are."""

    class Kind:
        def __init__(self, stream, radio):
            self.stream, self.radio = stream, type("Radio", (), {"module": radio})

    one, other, third = (Kind(stream, cellular) for stream in (1000, 2000, 3000))
    orders = [taking_turns([one, other], k) for k in range(400)]
    assert 140 < sum(order[0] is one for order in orders) < 260
    for k, order in enumerate(orders):
        assert [each for each in taking_turns([third, one, other], k) if each is not third] == order
    assert taking_turns([Kind(1, wlan), Kind(2, wlan)], 3)[0].stream == 1


# -- bits --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("radio", [{"kind": "wlan", "preset": "urban"}, {"loss": 0.2, "loss_run": 4.0}])
def test_who_else_is_there_changes_nothing(radio):
    """Three stations talk; with two more, which do not hinder, they hear the same of each other, bit for bit."""
    places = [(500.0, 0.0), (750.0, 0.0), (600.0, 200.0)]
    radio = radio | ({"contention": False} if radio.get("kind") == "wlan" else {})
    few, many = (talk(radio, each, 5.0) for each in (places, [*places, (400.0, 100.0), (900.0, -100.0)]))

    def among(messages):
        names = [messages.units.index(f"post_{i}") for i in range(3)]
        found = np.isin(messages.receiver, names) & np.isin(messages.sender[messages.of], names)
        who = [(messages.time[m], messages.units[messages.sender[m]]) for m in messages.of[found]]
        return list(zip(who, (messages.units[r] for r in messages.receiver[found]), messages.cause[found].tolist(), strict=True))

    assert sorted(among(few)) == sorted(among(many)) and len(among(few)) > 250
    assert {cause for *_, cause in among(few)} > {RECEIVED}


def test_the_radio_varies_by_its_own_seed():
    places = [(500.0, 0.0), (800.0, 0.0)]
    one, same, other = (talk({"kind": "wlan", "preset": "urban"}, places, 10.0, seeds={"radio": seed}) for seed in (1, 1, 2))
    assert one.cause.tolist() == same.cause.tolist() != other.cause.tolist()
