"""Our network beside netconvert's own of the same file: turns, lanes, signals, right of way. Each difference is one that we meant."""

from dataclasses import dataclass
from pathlib import Path

import pytest

from studio.road.assembly import alignment, extract, narrow, priority, restriction, turn
from studio.road.assembly.plan import Plan, Wish
from studio.road.formats import netconvert
from studio.road.library.place import linked
from studio.road.network import Net
from studio.road.network.signals import signals

ROOT = Path(__file__).parents[2]
FOLDERS = ROOT / "tests" / "reference" / "maps", ROOT / "scenarios" / "maps"
MAPS = {each.name.split(".")[0]: each for folder in FOLDERS for each in sorted(folder.iterdir()) if each.name.endswith(extract.ENDINGS)}


@dataclass(frozen=True)
class Stages:
    """The network after each step, netconvert's own first; the turns that restrictions name, the forks with arrows, the plan."""

    raw: Net
    restricted: Net
    mended: Net
    narrow: Net
    named: frozenset
    only: frozenset
    forks: frozenset
    plan: Plan


@pytest.fixture(scope="module", params=MAPS)
def stages(request):
    """An import, with what every step of it gave."""
    seen, named, only = {}, set(), set()

    def kept(room, name):
        real = getattr(room, name)

        def step(*given, **more):
            seen[name] = real(*given, **more)
            return seen[name]

        patch.setattr(room, name, step)

    def roads_of(each, net):
        found = real_roads(each, net)
        (only if each.kind.startswith("only") else named).add((found[0], found[-1]) if found else None)
        return found

    path = MAPS[request.param]
    with pytest.MonkeyPatch.context() as patch:
        for room, name in ((netconvert, "convert"), (restriction, "restricted"), (turn, "forks"), (turn, "mended"), (narrow, "drivable")):
            kept(room, name)
        real_roads = restriction.roads_of
        patch.setattr(restriction, "roads_of", roads_of)
        plan = extract.plan(path, extract.read(path), extract.part(path, Wish(None, None, False, ())), lambda text: None)
    forks = frozenset(each.road for each in seen["forks"] if each.wanted)
    return Stages(seen["convert"], seen["restricted"][0], seen["mended"], seen["drivable"], frozenset(named), frozenset(only), forks, plan)


def turns(net):
    """Which roads lead to which."""
    return {(net.lanes[c.from_lane].road, net.lanes[c.to_lane].road) for c in net.connections if c.direction != "turn"}


def lane_turns(net):
    """Which lanes lead to which, by road and index."""
    return {
        tuple((net.lanes[lane].road, net.lanes[lane].index) for lane in (c.from_lane, c.to_lane))
        for c in net.connections
        if c.direction != "turn"
    }


def test_roads_and_lanes_are_netconverts(stages):
    """Widths and numbers of lanes are settled by tags that it is given; nothing changes them afterwards."""
    ours, its = (
        {road.id: [(net.lanes[lane].open, round(net.lanes[lane].width, 2)) for lane in road.lanes] for road in net.roads.values()}
        for net in (stages.plan.net, stages.raw)
    )
    assert {name: own for name, own in ours.items() if not name.startswith(":")} == {
        name: own for name, own in its.items() if not name.startswith(":")
    }


def test_turns_are_lost_only_by_restrictions(stages):
    """netconvert forgets some where it joins nodes; what an `only` leaves out starts at its first road."""
    lost = turns(stages.raw) - turns(stages.restricted)
    assert all(pair in stages.named or pair[0] in {each[0] for each in stages.only if each} for pair in lost)
    assert not turns(stages.restricted) - turns(stages.raw)


def test_lanes_lead_elsewhere_only_where_arrows_say_so(stages):
    assert turns(stages.mended) == turns(stages.restricted)
    changed = lane_turns(stages.mended) ^ lane_turns(stages.restricted)
    assert {start[0] for start, _ in changed} <= stages.forks


def test_turns_are_left_out_where_no_car_gets_round_and_told(stages):
    lost = len(stages.mended.connections) - len(stages.narrow.connections)
    told = [each for each in stages.plan.report(finished(stages)).skipped if each.kind == "turn"]
    assert lost == len(told)
    sharp = [each for each in stages.narrow.connections if each.direction != "turn"]
    assert all(alignment.sharpest(stages.narrow, each) == each.sharpest for each in sharp)


def test_lights_stand_where_it_has_them_and_at_the_edge_of_the_map(stages):
    """Lanes that lead out of the map have lights too; netconvert has none where nothing follows."""
    more = stages.plan.signalled - stages.raw.signalled
    following = {each.from_lane for each in stages.raw.connections if each.direction != "turn"}
    assert stages.raw.signalled <= stages.plan.signalled
    assert not more & following


def finished(stages):
    """The network as a report looks at it, without the rest of an import."""
    from studio.road.network import Network

    net, plan = stages.plan.net, stages.plan
    lights = signals(net.lanes, net.roads, net.connections, plan.signalled)
    made = priority.ruled(net, plan.law, linked(net, lights), lights)
    return Network("x", "", plan.origin, plan.bounds, "", net.lanes, net.roads, made, net.junctions, lights, plan.scenery)


def test_who_gives_way_is_netconverts_answer_unless_something_is_mapped(stages):
    """One gives way to whom it says, of those whom he meets; others only by signs, lights, priority roads, rings, mini-roundabouts, or
    at equal roads by side."""
    net, law = stages.plan.net, stages.plan.law
    made = finished(stages).connections
    pair = [(net.lanes[each.from_lane].road, net.lanes[each.to_lane].road) for each in made]
    settled = set(law.signs) | set(law.major) | net.rings
    for own, each in zip(pair, made, strict=True):
        junction = net.roads[own[0]].to_junction
        if each.direction == "turn" or each.link >= 0 or junction in law.equal or junction in law.circles or own[0] in settled:
            continue
        others = {pair[other] for other in each.yields if not {pair[other][0], pair[other][1]} & settled}
        assert {other for other in others if net.roads[other[0]].to_junction == junction} <= law.yields.get(own, frozenset()) | {own}
