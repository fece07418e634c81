"""Ages of information against their closed forms: messages every T, delayed by L, of which some are lost."""

from dataclasses import replace

import numpy as np
import pytest

from studio.assess import freshness
from studio.assess.measure import measure_all
from studio.execution.message import none
from studio.execution.record import Traced
from studio.kind import registry
from studio.kind.slot import chosen
from studio.world.table.cause import FADING, RECEIVED
from tests.assess.drive import record

T, L, MANY = 0.1, 0.02, 400_000


def stream(lost):
    """When messages were made and came [s]."""
    made = T * np.arange(len(lost))
    return made, np.where(lost, np.inf, made + L)


def independent(p):
    """Losses by chance, seed 11."""
    return stream(np.random.default_rng(11).random(MANY) < p)


def bursty(to_bad, to_good, in_good, in_bad):
    """Losses of a channel that is good or bad (E. N. Gilbert, E. O. Elliott), from the stationary state on; seed 13."""
    draw = np.random.default_rng(13)
    turn, loss, bad, lost = draw.random(MANY), draw.random(MANY), draw.random() < to_bad / (to_bad + to_good), np.empty(MANY, bool)
    for i in range(MANY):
        lost[i] = loss[i] < (in_bad if bad else in_good)
        bad = turn[i] >= to_good if bad else turn[i] < to_bad
    return stream(lost)


@pytest.mark.parametrize(
    ("p", "mean", "peak", "older"),
    [
        (0.0, 0.07, 0.12, (0.0, 0.0, 0.0)),
        (0.1, 0.08111, 0.13111, (0.073, 0.001, 0.00001)),
        (0.3, 0.11286, 0.16286, (0.237, 0.027, 0.00243)),
        (0.6, 0.22, 0.27, (0.528, 0.216, 0.07776)),
    ],
)
def test_ages_with_independent_losses(p, mean, peak, older):
    """400 000 messages: mean age and mean peak within 2 %, shares of time within 2 % or 0.0006."""
    made, came = independent(p)
    assert freshness.mean_age(made, came) == pytest.approx(mean, rel=0.02)
    assert freshness.mean_age(made, came) == pytest.approx(L + T * (1 + p) / (2 * (1 - p)), rel=0.02)
    assert freshness.peaks(made, came).mean() == pytest.approx(peak, rel=0.02)
    for limit, share in zip((0.15, 0.32, 0.52), older, strict=True):
        assert freshness.share_of_time_older(made, came, limit) == pytest.approx(share, rel=0.02, abs=6e-4)


def test_time_between_receptions_and_losses_in_a_row():
    """p = 0.2 at 10 Hz: 0.125 s between receptions, mean age 75 ms + L, three lost in a row 0.008; within 3 %."""
    made, came = independent(0.2)
    assert freshness.inter_reception(came).mean() == pytest.approx(0.125, rel=0.03)
    assert freshness.mean_age(made, came) == pytest.approx(0.075 + L, rel=0.03)
    runs = freshness.runs_of_losses(came)
    assert np.maximum(runs - 2, 0).sum() / MANY == pytest.approx(0.008, rel=0.03)


@pytest.mark.parametrize(
    ("channel", "loss", "run", "between", "age"),
    [((0.05, 0.25, 0.01, 0.6), 0.10833, 1.7263, 0.11215, 0.08912), ((0.02, 0.2, 0.0, 1.0), 0.09091, 5.0, 0.110, 0.11545)],
)
def test_ages_with_losses_in_bursts(channel, loss, run, between, age):
    """400 000 messages over a channel with memory: within 2 %."""
    made, came = bursty(*channel)
    assert np.isinf(came).mean() == pytest.approx(loss, rel=0.02)
    assert freshness.runs_of_losses(came).mean() == pytest.approx(run, rel=0.02)
    assert freshness.inter_reception(came).mean() == pytest.approx(between, rel=0.02)
    assert freshness.mean_age(made, came) == pytest.approx(age, rel=0.02)


def test_what_is_overtaken_is_no_news():
    """The second message comes before the first: the first changes no age."""
    made, came = freshness.newest(np.array([0.0, 1.0, 2.0]), np.array([5.0, 3.0, np.inf]))
    assert (made.tolist(), came.tolist()) == ([1.0], [3.0])


def test_sampled_ages():
    """Two links, the second with a gap: means and shares over what is known."""
    ages = np.array([[0.1, 0.2, 0.3, 0.4], [np.nan, 0.5, 0.7, np.nan]])
    assert freshness.mean(ages) == pytest.approx([0.25, 0.6])
    assert freshness.share_older(ages, 0.25) == pytest.approx([0.5, 1.0])


def sent(rows, link=("a", "b")):
    """A record of two cars and messages of one to the other: when sent, what became of it, delay, distance [m]."""
    times, causes, delays, distances = (np.array(each) for each in zip(*rows, strict=True))
    ones = np.ones(times.size, dtype=np.int32)
    messages = replace(
        none(("awareness",), link), time=times, sender=0 * ones, kind=0 * ones, number=np.arange(times.size), size=200.0 * ones,
        said_0=0.0 * ones, said_1=0.0 * ones, count=ones, receiver=ones, cause=causes, delay=delays, distance=distances,
    )  # fmt: skip
    made = record(np.linspace(0.0, 1.0, 51), link)
    return replace(made, messages=messages, links=("→".join(link),), ages=np.full((1, 51), 0.1))


def test_measures_of_messages():
    """Of five messages three came: 60 %, within 100 m two of three; receptions at 0.01, 0.21 and 0.41 s are 0.2 s apart."""
    rows = [(0.1 * i, RECEIVED if i % 2 == 0 else FADING, 0.01 if i % 2 == 0 else np.nan, 60.0 * i) for i in range(5)]
    made, metrics = sent(rows), registry.known("metric")
    near = chosen(metrics["packet_delivery"])(farthest=150)
    found = measure_all(made, {"near": near})
    assert found["packet_delivery"].value == pytest.approx(0.6) and found["near"].value == pytest.approx(2 / 3)
    assert found["inter_reception"].value == pytest.approx(0.2, abs=1e-6) and found["inter_reception"].subject == ("a", "b")
    first = measure_all(made, {"first": chosen(metrics["packet_delivery"])(end={"at": 0.15})})["first"]
    assert first.value == 0.5
    far = measure_all(made, {"far": chosen(metrics["packet_delivery"])(nearest=5000)})["far"]
    assert far.value is None and far.about == "nobody was 5000 to 100000 m from a sender, and in range of its radio"
    assert measure_all(replace(made, messages=none()))["packet_delivery"].about == "no message was sent"
    nobody = measure_all(made, {"to_a": chosen(metrics["packet_delivery"])(vehicles=["a"])})["to_a"]
    assert nobody.value is None


def test_the_load_of_the_channel_where_it_is_greatest():
    made = sent([(0.0, RECEIVED, 0.01, 10.0)])
    loads = {f"{unit}.channel_load": Traced(np.full(51, load), "1", "") for unit, load in (("a", 0.2), ("b", 0.3))}
    found = measure_all(replace(made, probes=loads))["channel_load"]
    assert (found.value, found.subject) == (pytest.approx(0.3), ("b",))
