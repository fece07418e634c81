"""A handshake of three messages below the tick: how long it takes follows from the losses alone."""

from math import comb, sqrt
from pathlib import Path

import numpy as np
import pytest

from studio.workshop.stage import stage
from studio.world.table.cause import RECEIVED

PAIRS, SECONDS, ROUND, CYCLE = 40, 120.0, 0.8, 0.005
WAY = 0.015  # [s] of one message
BYTES, BIT_RATE = 120, 6e6


def run(loss):
    """Pairs of stations that shake hands again and again, without a difference between them but chance."""
    names = [(f"asks_{i}", f"answers_{i}") for i in range(PAIRS)]
    stations = {name: {"position": {"x": 500.0, "y": 20.0 + 0.1 * i}} for i, pair in enumerate(names) for name in pair}
    groups = {
        "asking": {"units": [a for a, _ in names], "listens_to": [b for _, b in names], "parameters": {"asks": True}},
        "answering": {"units": [b for _, b in names], "listens_to": [a for a, _ in names]},
    }
    radio = {"delay": WAY - 8 * BYTES / BIT_RATE, "delay_variation": 0.0, "loss": loss, "range": 5000.0, "buildings": False}
    current = stage(
        stations=stations,
        applications={name: each | {"application": "handshake", "cycle": CYCLE} for name, each in groups.items()},
        radio=radio,
        clock={"duration": SECONDS},
    )
    current.advance(round(SECONDS / 0.02) - 1)
    assert current.cases[0].status == "running", current.cases[0].error
    return current.record()


def times(messages):
    """How long each handshake took [s], from its first request to the first commitment that came; rounds that are over only.

    Stages are told apart by who sends: of the asker's messages of a round, those after the first acknowledgement that came commit.
    """
    rounds = int(SECONDS / ROUND) - 1
    found = np.full((PAIRS, rounds), np.nan)
    came, received = messages.came, messages.is_received
    sender, of = messages.sender[messages.of], messages.of
    for pair in range(PAIRS):
        asks, answers = messages.units.index(f"asks_{pair}"), messages.units.index(f"answers_{pair}")
        acknowledged = came[received & (sender == answers)]
        sent, arrived = messages.time[of[received & (sender == asks)]], came[received & (sender == asks)]
        for i in range(rounds):
            begin, end = i * ROUND - 1e-6, (i + 1) * ROUND - 1e-6
            first = acknowledged[(acknowledged > begin) & (acknowledged < end)]
            commits = arrived[(sent >= first.min() - 1e-6) & (sent < end)] if first.size else np.zeros(0)
            found[pair, i] = commits.min() - i * ROUND if commits.size else np.inf
    return found.ravel()


def unheard(messages, times_sent):
    """In which rounds none of the first so many commitments came: they begin with the first acknowledgement that the asker has heard."""
    sender, lost = messages.sender, []
    heard = np.zeros(sender.size, dtype=bool)
    heard[messages.of[messages.is_received]] = True
    for pair in range(PAIRS):
        asks, answers = messages.units.index(f"asks_{pair}"), messages.units.index(f"answers_{pair}")
        acknowledged = messages.came[messages.is_received & (sender[messages.of] == answers)]
        mine = np.flatnonzero(sender == asks)
        for i in range(int(SECONDS / ROUND) - 1):
            first = acknowledged[(acknowledged > i * ROUND - 1e-6) & (acknowledged < (i + 1) * ROUND - 1e-6)].min()
            commits = mine[messages.time[mine] >= first - 1e-6][:times_sent]
            lost.append(not heard[commits].any())
    return np.array(lost)


def heard_within(messages, tries):
    """In which rounds one of the first so many requests was heard, and one of the first so many acknowledgements after it."""
    sender, found = messages.sender, []
    heard = np.zeros(sender.size, dtype=bool)
    heard[messages.of[messages.is_received]] = True
    came = np.full(sender.size, np.inf)
    np.minimum.at(came, messages.of[messages.is_received], messages.came[messages.is_received])
    for pair in range(PAIRS):
        mine = np.flatnonzero(sender == messages.units.index(f"asks_{pair}"))
        other = np.flatnonzero(sender == messages.units.index(f"answers_{pair}"))
        for i in range(int(SECONDS / ROUND) - 1):
            begin, end = i * ROUND - 1e-6, (i + 1) * ROUND - 1e-6
            answers = other[(messages.time[other] >= begin) & (messages.time[other] < end)]
            known = came[answers].min()  # until then who asks sends requests
            requests = mine[(messages.time[mine] >= begin) & (messages.time[mine] < known)]
            found.append(heard[requests[:tries]].any() and heard[answers[:tries]].any())
    return np.array(found)


@pytest.mark.parametrize("loss", [0.1, 0.3, 0.5])
def test_time_of_a_handshake(own_kinds, loss):
    """P(done by 45 + 20 m ms) is that of at most m failures before the third success: 5960 handshakes, three standard errors, seed 1."""
    own_kinds(Path(__file__).parent)
    record = run(loss)
    took = times(record.messages)
    n, q = took.size, 1.0 - loss
    assert n == PAIRS * (SECONDS / ROUND - 1)
    for m in range(6):
        expected = sum(comb(k + 2, 2) * loss**k * q**3 for k in range(m + 1))
        error = 3.0 * sqrt(expected * (1.0 - expected) / n) + 1e-12
        assert np.mean(took < 0.0451 + 0.02 * m) == pytest.approx(expected, abs=error), m
    waits = (took - 0.045) / 0.02
    np.testing.assert_allclose(waits, np.round(waits), atol=1e-3)  # no wait for ticks: every loss costs one repetition
    assert took.mean() == pytest.approx(0.045 + 0.02 * 3.0 * loss / q, abs=3.0 * 0.02 * sqrt(3.0 * loss / q**2 / n))
    both = (1.0 - loss**3) ** 2  # request and answer within three tries each: 0.947 at a loss of 0.3
    assert np.mean(heard_within(record.messages, 3)) == pytest.approx(both, abs=3.0 * sqrt(both * (1.0 - both) / n) + 1.0 / n)
    never = loss**5  # a commitment that is sent five times: 0.00243 at a loss of 0.3
    assert np.mean(unheard(record.messages, 5)) == pytest.approx(never, abs=3.0 * sqrt(never * (1.0 - never) / n) + 1.0 / n)


def test_the_application_knows_it_at_its_own_next_cycle(own_kinds):
    """Without losses every handshake is done after 45 ms, where ticks of 20 ms would make it 60; what arrives is dated as it arrives."""
    own_kinds(Path(__file__).parent)
    record = run(0.0)
    done = record.probes["answers_0.answering.took"].values
    np.testing.assert_allclose(done[done > 0.0], 0.045, atol=1e-9)
    assert done[-1] > 0.0
    messages = record.messages
    assert np.unique(np.round(messages.time % 0.02, 6)).size > 2 and np.all(messages.cause == RECEIVED)
    np.testing.assert_allclose(messages.delay, WAY, rtol=1e-5)
