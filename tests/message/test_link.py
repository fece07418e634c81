"""What becomes of messages on links: losses one by one and in runs, ages, channels that fill, cells that cannot carry all."""

from pathlib import Path

import numpy as np
import pytest

from studio import job
from studio.errors import ScenarioError
from studio.execution.message import messages
from studio.execution.simulation import simulation
from studio.vehicle.state import ACTIVE
from studio.workshop.stage import stage
from studio.world.snapshot import restore, snapshot
from studio.world.table.cause import ABSENT, BURST, CHANCE, DROPPED, JAMMED, RECEIVED
from studio.world.table.unit import ADDED, DROPS, H_NUMBER, H_TIME
from studio.world.table.unit import JAMMED as IS_JAMMED

HERE = Path(__file__).parent
PAIRS, SECONDS = 100, 400.0


@pytest.fixture(autouse=True)
def kinds(own_kinds):
    """Those beside this file."""
    own_kinds(HERE)


def posts(count, **each):
    """Stations in a row, by name."""
    return {f"post_{i}": {"position": {"x": 500.0 + 0.1 * i, "y": 30.0}} | each for i in range(count)}


def pairs(loss):
    """Every other station listens to the one before it: 100 links, 10 messages a second, 400 s, 4e5 messages in all."""
    names = list(posts(2 * PAIRS))
    hears = {"application": "ear", "units": names[1::2], "listens_to": names[::2]}
    current = stage(stations=posts(2 * PAIRS), applications={"hears": hears}, radio={"kind": "patchy", "delay": 0.02} | loss,
                    clock={"duration": SECONDS, "tick": 0.1, "step": 0.01}, recording={"period": 1.0})  # fmt: skip
    current.advance(round(SECONDS / 0.1) - 1)
    assert current.cases[0].status == "running", current.cases[0].error
    return current.record().messages


def ages(messages):
    """Mean age of the newest message [s], mean time between two that came [s], share of losses, runs of losses, time-weighted shares."""
    area, span, peaks, between, runs = 0.0, 0.0, [], [], []
    for entries in messages.links():
        sent, came, lost = messages.time[messages.of[entries]], messages.came[entries], ~messages.is_received[entries]
        sent, came = sent[~lost], came[~lost]
        gaps = np.diff(came)
        area += np.sum(gaps * (came[:-1] - sent[:-1] + gaps / 2.0))
        span += gaps.sum()
        between.append(gaps)
        peaks.append(came[1:] - sent[:-1])
        edges = np.flatnonzero(np.diff(np.concatenate([[0], lost.astype(int), [0]])))
        runs.append(edges[1::2] - edges[::2])
    return area / span, np.concatenate(between), np.concatenate(peaks), np.concatenate(runs)


@pytest.mark.parametrize(("p", "mean", "peak", "beyond"), [
    (0.0, 0.07, 0.12, {0.15: 0.0}),
    (0.1, 0.08111, 0.13111, {0.15: 0.073, 0.32: 0.001}),
    (0.2, 0.095, 0.145, {}),
    (0.3, 0.11286, 0.16286, {0.15: 0.237, 0.32: 0.027}),
    (0.6, 0.22, 0.27, {0.15: 0.528, 0.32: 0.216, 0.52: 0.07776}),
])  # fmt: skip
def test_ages_where_each_is_lost_by_itself(p, mean, peak, beyond):
    """T = 0.1 s, L = 0.02 s: mean age L + T (1 + p) / (2 (1 - p)), mean time between two T / (1 - p); 4e5 messages, seed 1, ±2 %."""
    found = pairs({"loss_good": p})
    age, between, peaks, runs = ages(found)
    assert found.cause.size == pytest.approx(4e5, rel=0.01) and set(found.cause) <= {RECEIVED, CHANCE}
    assert age == pytest.approx(mean, rel=0.02) and between.mean() == pytest.approx(0.1 / (1.0 - p), rel=0.02)
    assert peaks.mean() == pytest.approx(peak, rel=0.02)
    assert np.maximum(runs - 2, 0).sum() / found.cause.size == pytest.approx(p**3, rel=0.06, abs=1e-9)  # three in a row are lost
    for limit, share in beyond.items():
        beyond_it = np.minimum(np.maximum(peaks - limit, 0.0), between).sum() / between.sum()
        assert beyond_it == pytest.approx(share, rel=0.02 if share > 0.01 else 0.1, abs=1e-9)


@pytest.mark.parametrize(("settings", "loss", "run", "between", "mean", "in_a_row"), [
    ((0.05, 0.25, 0.01, 0.6), 0.10833, 1.7263, 0.11215, 0.08912, {2: 0.045579, 3: 0.020489}),
    ((0.02, 0.2, 0.0, 1.0), 0.09091, 5.0, 0.110, 0.11545, {2: 0.072727, 3: 0.058182, 5: 0.037236}),
])  # fmt: skip
def test_losses_in_runs(settings, loss, run, between, mean, in_a_row):
    """Gilbert-Elliott, good to bad, bad to good, losses in both: what a link remembers makes the runs; 4e5 messages, seed 1, ±3 %.

    2 % are met by 4e5 messages drawn alone; runs of five make neighbours alike, and the standard error of the second row's loss is 1 %.
    """
    worsens, betters, good, bad = settings
    found = pairs({"worsens": worsens, "betters": betters, "loss_good": good, "loss_bad": bad})
    age, times, _, runs = ages(found)
    assert np.mean(found.cause != RECEIVED) == pytest.approx(loss, rel=0.03)
    assert runs.mean() == pytest.approx(run, rel=0.03)
    assert times.mean() == pytest.approx(between, rel=0.02) and age == pytest.approx(mean, rel=0.02)
    for count, share in in_a_row.items():  # the share of messages at which so many in a row are lost
        assert np.maximum(runs - count + 1, 0).sum() / found.cause.size == pytest.approx(share, rel=0.05)
    assert np.count_nonzero(found.cause == BURST) > 20 * np.count_nonzero(found.cause == CHANCE) * good


def test_a_channel_fills_and_congestion_control_answers():
    """Twenty stations, ten messages a second of 2 ms each: 0.4 of the time busy where all are heard; 3 ms are 0.6, and they wait 0.4 s."""
    names = list(posts(20))
    group = {"hears": {"application": "ear", "units": names[:1]}}
    for airtime, period in ((0.002, 0.1), (0.003, 0.4)):
        current = stage(stations=posts(20), vehicles={}, applications=group, radio={"kind": "patchy", "airtime": airtime, "range": 30.0,
                        "heard": 30.0}, clock={"duration": 10})  # fmt: skip
        current.advance(400)
        record = current.record()
        load = record.probes["post_3.channel_load"].values
        sent = record.messages.time[record.messages.sender == record.messages.units.index("post_3")]
        if period == 0.1:
            np.testing.assert_allclose(load[10:], 20 * 10 * airtime, atol=1e-9)
        assert np.diff(sent)[5:] == pytest.approx(period, abs=1e-9)
        assert record.probes["far.channel_load"].values[-1] == pytest.approx(10 * airtime * (1 if period == 0.1 else 0.25), abs=0.1)


def test_what_a_cell_cannot_carry_waits():
    """26 units send 300 bytes ten times a second, 78 kB/s, in a cell of 39 kB/s: the wait grows by a second every second."""
    names = list(posts(20))
    current = stage(stations=posts(20), applications={"hears": {"application": "ear", "units": names[:1]}}, clock={"duration": 20},
                    radio={"kind": "patchy", "bandwidth": 39e3, "longest_wait": 30.0, "range": 5000.0})  # fmt: skip
    current.advance(450)
    found = current.record().messages
    rate = found.size.sum() / (found.time[-1] - found.time[0]) / 39e3
    slope = np.polyfit(found.time[found.of], found.delay, 1)[0]
    assert slope == pytest.approx(rate - 1.0, rel=0.02) and slope > 0.9


def test_what_is_old_is_forgotten():
    """The far car falls silent when it leaves; who keeps messages for a second knows nobody a second later, others know it for ever."""
    for keeps, known in ((1.0, 0.0), (None, 1.0)):
        for senders in ([], ["far"]):
            group = {"application": "ear", "units": ["post_0"], "keeps": keeps, "listens_to": [senders] if senders else []}
            current = stage(
                stations=posts(1), applications={"hears": group}, radio={"kind": "patchy", "range": 5000.0}, recording={"period": 0.02}
            )
            current.advance(20)
            current.world.vehicles.state[ACTIVE] = 0.0  # all cars leave
            current.advance(60)
            record = current.record()
            received = record.probes["post_0.hears.received"].values
            assert received[18] == 1.0 and received[-1] == known
            if not senders:
                assert record.probes["post_0.hears.count"].values[-1] == 6.0 * known


def test_trouble_has_its_cause():
    """A jammed receiver, messages that are dropped, one that has left; an added delay. What is delayed comes later by as much."""
    names = list(posts(3))
    current = stage(stations=posts(3), applications={"hears": {"application": "ear", "units": names}}, radio={"kind": "patchy"})
    current.advance(10)
    trouble, units = current.world.units.trouble, current.world.units
    trouble[IS_JAMMED, units.number("post_1")] = 1.0
    trouble[DROPS, units.number("post_2")] = 3.0
    trouble[ADDED, units.number("post_0")] = 0.01
    current.advance(50)
    found = current.record().messages
    late = found.time[found.of] > 0.19
    assert set(found.cause[found.link("post_0", "post_1", "awareness")][-9:]) == {JAMMED}
    dropped = found.cause[found.link("post_2", "post_0", "awareness")]
    assert np.count_nonzero(dropped == DROPPED) == 3 and dropped[-1] == RECEIVED
    np.testing.assert_allclose(found.delay[found.link("post_0", "post_2", "awareness")][-9:], 0.03, rtol=1e-5)
    assert late.any() and ABSENT not in found.cause


def test_times_are_those_of_arriving():
    """20 ms and a bit at ticks of 20 ms: the application sees it at the next tick, its delay and the record tell when it was there."""
    current = stage(stations=posts(2), applications={"hears": {"application": "ear", "units": ["post_1"], "listens_to": ["post_0"]}},
                    radio={"kind": "patchy", "delay": 0.0225})  # fmt: skip
    current.advance(100)
    record = current.record()
    delay, age = (record.probes[f"post_1.hears.{name}"].values for name in ("delay", "age"))
    np.testing.assert_allclose(delay[20:], 0.0225, atol=1e-12)
    assert age[20:].min() == pytest.approx(0.04, abs=1e-9)


def before(each, time):
    """The links before every member that hears everybody, as they would be sorted anew."""
    inbox, found = each.post.inbox, []
    for j in np.flatnonzero(each.is_open):
        unit = next(u for u in range(each.member_first.size - 1) if j in each.member[each.member_first[u] : each.member_first[u + 1]])
        known = (each.post.link_receiver == unit) & (inbox[H_NUMBER] >= 0.0) & (time - inbox[H_TIME] <= each.kept[j])
        found.append(sorted(np.flatnonzero(known).tolist(), key=lambda link: (-inbox[H_TIME, link], link))[: each.slots.shape[0]])
    return found


@pytest.mark.parametrize("keeps", [None, 0.15])
def test_the_freshest_are_first(keeps):
    """Four hear all, two hear one each: at every tick as sorted anew; also after going back to a moment."""
    names = list(posts(6))
    groups = {"all": {"application": "ear", "units": names[:4], "keeps": keeps},
              "some": {"application": "ear", "units": names[3:5], "listens_to": [names[:1], names[1:2]], "keeps": keeps}}  # fmt: skip
    current = stage(stations=posts(6), applications=groups, radio={"kind": "patchy", "loss_good": 0.4, "delay": 0.03, "range": 5000.0})
    for k in range(80):
        if k == 30:
            kept = snapshot(current.world)
        if k == 60:
            restore(current.world, kept)
        current.advance(1)
        for each in current.world.open_inboxes:
            time = current.world.clock.time - current.world.clock.tick
            told = [each.slots[: each.heard[j], j].tolist() for j in np.flatnonzero(each.is_open)]
            assert told == before(each, time) and (k < 10 or keeps or all(len(one) > 1 for one in told))
            assert all((each.slots[each.heard[j] :, j] == -1).all() for j in np.flatnonzero(each.is_open))


def batch(seeds, order=1):
    """The same scenario with several seeds side by side."""
    names = list(posts(6))[::order]
    stations = {name: posts(6)[name] for name in names}
    group = {"hears": {"application": "ear", "units": sorted(names)}}
    current = [
        stage(stations=stations, applications=group, seed=seed, radio={"kind": "patchy", "worsens": 0.1, "betters": 0.3, "loss_bad": 0.8,
              "airtime": 0.001, "bandwidth": 25e3, "longest_wait": 3.0}) for seed in seeds
    ]  # fmt: skip
    return simulation(*(each.cases[0].setting for each in current))


def told(messages):
    """All of it, by the names of units."""
    order = np.lexsort([messages.receiver, messages.sender[messages.of], messages.of])
    names = [(messages.units[messages.sender[messages.of[e]]], messages.units[messages.receiver[e]]) for e in order]
    rows = zip(names, messages.time[messages.of][order], messages.cause[order], np.nan_to_num(messages.delay[order], nan=-1.0), strict=True)
    return sorted((float(t), s, r, int(c), float(d)) for (s, r), t, c, d in rows)


def test_batch_and_order_change_no_bit():
    """Alone, beside others, with the stations in another order: the same messages, losses and delays to the last bit."""
    alone, beside, turned = batch([7]), batch([3, 7, 5]), batch([7], order=-1)
    for each in (alone, beside, turned):
        each.advance(150)
    first = told(alone.record().messages)
    assert first == told(beside.record(1).messages) == told(turned.record().messages)
    assert {cause for *_, cause, _ in first} >= {RECEIVED, BURST} and first != told(beside.record(0).messages)


def test_another_delay_beside_changes_no_hash():
    """Where others' messages are longer under way, more is kept; the hash of a world's state is the same as alone."""

    def made(delay):
        return stage(stations=posts(4), applications={"hears": {"application": "ear", "units": list(posts(4))}},
                     radio={"kind": "patchy", "delay": delay}).cases[0].setting  # fmt: skip

    alone, both = simulation(made(0.02)), simulation(made(0.9), made(0.02))
    for each in (alone, both):
        each.advance(60)
    assert alone.world.digest(0) == both.world.digest(1) != both.world.digest(0)


def test_a_snapshot_knows_what_links_remember():
    """Back to a moment, and on again: the same state, with what the radio remembers of links, units and cells."""
    current = batch([7])
    current.advance(50)
    kept, found = snapshot(current.world), []
    for _ in range(2):
        restore(current.world, kept)
        current.advance(40)
        found.append((current.world.digest(), told(messages(current.world, 0))))
    assert found[0] == found[1]
    straight = batch([7])
    straight.advance(90)
    assert found[0] == (straight.world.digest(), told(straight.record().messages))


@pytest.mark.parametrize(("change", "where", "what"), [
    ({"radio.loss": 1.5}, "radio.loss", "1"),
    ({"radio.delay": -0.1}, "radio.delay", "0"),
    ({"applications.platoon.cycle": 0.007}, "applications.platoon.cycle", "is not a whole part of a tick"),
    ({"applications.platoon.cycle": 0.04}, "applications.platoon.cycle", "is not a whole part of a tick"),
    ({"applications.platoon.keeps": -1.0}, "applications.platoon.keeps", "0"),
])  # fmt: skip
def test_bad_input_is_refused_with_its_place(sample, change, where, what):
    with pytest.raises(ScenarioError) as error:
        job.prepare(job.load(sample, change))
    problem = next(each for each in error.value.problems if where in each.where)
    assert what in f"{problem.what} {problem.allowed}" and problem.value != ""


def test_messages_may_go_over_another_radio():
    """Awareness over a network without distance, the others over the usual radio: a far station hears the cars, each has its own log."""
    groups = {"hears": {"application": "ear", "units": ["far_post"]}, "listens": {"application": "listener", "units": ["far_post"]}}
    current = stage(stations={"far_post": {"position": {"x": 9e4, "y": 0.0}}}, applications=groups, radios={"awareness": {"kind": "patchy",
                    "range": 5000.0}}, radio={"kind": "ad_hoc"})  # fmt: skip
    assert [(each.kind.name, each.radio.name) for each in current.world.units.posts] == [("cam", "ad_hoc"), ("awareness", "patchy")]
    current.advance(20)
    found = current.record().messages
    assert set(found.kinds) == {"cam", "awareness"} and found.cause.size == 0  # 90 km are out of reach of both


def test_radios_of_messages_that_do_not_fit_are_refused(sample):
    for radios, what in (({"gossip": {"kind": "patchy"}}, "names no kind of message"),
                         ({"awareness": {"kind": "ad_hoc", "loss": 0.5}}, "is set differently from radio")):  # fmt: skip
        with pytest.raises(ScenarioError, match="valid") as error:
            job.prepare(job.load(sample, {"radios": radios}))
        assert any(what in each.what for each in error.value.problems)
