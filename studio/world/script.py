"""The script while a world runs: what has begun, what is over, and what follows from it. One pass at the beginning of a tick, one where
the actuators are commanded.

State is the phase of every entry, and which of its lines every vehicle has chosen. Limits, places on the lines, stop lines
and zones follow from these and are made anew when one turns: that happens a few times in a run, so it need not be compiled.
Conditions and maneuvers are asked only while somebody waits for them.
"""

from collections.abc import Iterator, Sequence
from math import inf

import numpy as np

from studio.compiled import lean
from studio.kind import registry
from studio.kind.number import numbers, row_of, stations
from studio.road.ways.detour import limited
from studio.road.ways.path import PATH_SPEED
from studio.vehicle.parameter import FRONT, LENGTH
from studio.vehicle.state import ACTIVE
from studio.world import condition, deed, mail, maneuver, obstacle
from studio.world.condition import View
from studio.world.effect import End, Limit
from studio.world.find import Finder, finders
from studio.world.line import Lines, starts
from studio.world.mail import MAIL
from studio.world.node import Node, nodes_of
from studio.world.setting import Setting
from studio.world.site import Laid
from studio.world.table.mind import SCRIPT, STATION
from studio.world.table.street import ACTING, BEFORE, OVER, PIECE_ACTS, PIECE_ENTRY
from studio.world.world import Asked, Deeds, Maneuvers, Script, World, Worlds


def turn(world: World) -> None:
    """The first pass: lets entries begin and end, and what follows from it."""
    s, d, o, v = world.script, world.detours, world.obstacles, world.vehicles
    if s.waiting.size:
        ask(world)
    if s.deeds.regions:
        deed.jam(world)
    if not d.held.size:
        return
    chosen = d.choice.copy()
    if choose(s.phase, d.vehicle, d.work, d.base, d.span, v.state, v.parameter, v.mind, d.held, d.choice, chosen):
        go_over(world, chosen)
    obstacle.put_up(o.table, s.phase, d.held, o.standing)
    m = o.movers
    if m.object.size:
        lines, treads = (m.object, m.first, m.count, m.corner, m.speed, m.stays), (m.tread, m.tread_first, m.tread_count)
        obstacle.walk(world.clock.time, s.turned, *lines, *treads, o.table, o.standing)


def ask(world: World) -> None:
    """Asks the conditions that somebody waits for, those within others before these."""
    s, time = world.script, world.clock.time
    if s.reader:
        s.reader.read(s.values)
    if s.reads_mail:
        mail.sort(world.units.posts, time, world.clock.tick, s.mail)
    view = view_of(world)
    for each in (s.asked[i] for i in s.waiting):
        each.run(
            view, each.node, each.entry, each.turn, each.settings, each.part_first, each.part_count, each.part, s.phase, s.again, s.since,
            s.met, s.held,
        )  # fmt: skip
    decide(s.root, s.node_entry, s.again, s.held, s.phase, s.since, s.met, s.come)
    if proceed(time, s.come, s.vehicle, s.takes, s.momentary, s.phase, s.turned, s.cut):
        s.commands[:] = 0.0
        post(world)
        deed.begin(world)


def view_of(world: World) -> View:
    """What conditions look at now."""
    v, r, o, s, clock = world.vehicles, world.roads, world.obstacles, world.script, world.clock
    return View(
        clock.time, clock.tick, v.state, v.parameter, v.mind, r.points, r.path_first, r.path_count, s.turned, r.shown, r.stop_first,
        r.stop_count, r.stop_station, r.stop_link, o.table, o.standing, s.pool, s.mail, s.values,
    )  # fmt: skip


@lean
def decide(root, node_entry, again, held, phase, since, met, come):
    """Whose turn has come; an entry that is over waits anew once what it waited for does not hold any more."""
    for e in range(phase.size):
        if phase[e] != OVER:
            come[e] = 1 if root[phase[e], e] >= 0 and held[root[phase[e], e]] != 0 else 0
        elif again[e] != 0 and held[root[BEFORE, e]] == 0:
            phase[e] = BEFORE
            for n in range(node_entry.size):
                if node_entry[n] == e:
                    since[n] = met[n] = inf


def act(world: World) -> None:
    """The second pass: maneuvers command their vehicles, and end."""
    s, v, time = world.script, world.vehicles, world.clock.time
    if not s.acting.size:
        return
    any_over = False
    for each in (s.maneuvers[i] for i in s.acting):
        any_over |= each.run(
            time,
            each.entry,
            each.vehicle,
            each.settings,
            s.pool,
            s.phase,
            s.turned,
            v.state,
            v.mind,
            v.parameter,
            s.commands,
            s.come,
            s.unfit,
        )
    if any_over:
        world.unfit += int(s.unfit.sum())
        proceed(time, s.come, s.vehicle, s.takes, s.momentary, s.phase, s.turned, s.cut)
        post(world)


@lean
def proceed(time, come, vehicle, takes, momentary, phase, turned, cut):
    """Entries whose turn has come begin or end; whether one did. A maneuver that begins ends the one before it that has what it takes."""
    any_turned = False
    for e in range(phase.size):
        is_due, come[e] = come[e] != 0 and phase[e] != OVER, 0
        if not is_due:
            continue
        any_turned = True
        turned[phase[e], e] = time
        phase[e] += 1
        if phase[e] == ACTING:
            cut[e] = -1
            cut_short(e, time, vehicle, takes, phase, turned, cut)
            if momentary[e] != 0:
                turned[1, e] = time
                phase[e] = OVER
    return any_turned


@lean
def cut_short(e, time, vehicle, takes, phase, turned, cut):
    """Ends the maneuvers that have what entry e takes of the same vehicle."""
    for other in range(phase.size):
        if other != e and phase[other] == ACTING and vehicle[other] == vehicle[e] >= 0 and takes[other] & takes[e] != 0:
            turned[1, other] = time
            phase[other] = OVER
            cut[other] = e


@lean
def is_within(v, enter, leave, state, parameter, mind):
    """Whether a part of a vehicle is between two stations of its line."""
    bumper = mind[STATION, v] + parameter[FRONT, v]
    return state[ACTIVE, v] > 0.0 and bumper > enter and bumper - parameter[LENGTH, v] < leave


@lean
def choose(phase, vehicle, work, base, span, state, parameter, mind, held, choice, chosen):
    """Everybody who is not within a work takes the line that it asks for now; counts those who are held by one; whether one went over."""
    held[:] = 0
    any_new = False
    for j in range(vehicle.size):
        chosen[j] = choice[j]
        for b in range(work.shape[0]):
            c = work[b, j]
            if c < 0:
                break
            if (choice[j] >> b & 1) == (phase[c] == ACTING):
                continue
            line = base[j] + choice[j]
            if is_within(vehicle[j], span[2 * b, line], span[2 * b + 1, line], state, parameter, mind):
                held[c] += 1
            else:
                chosen[j] ^= 1 << b
                any_new = True
    return any_new


def go_over(world: World, chosen: np.ndarray) -> None:
    """Vehicles take other lines: place on it, stop lines, objects in the way, and strands."""
    d, o, v, r = world.detours, world.obstacles, world.vehicles, world.roads
    for j in np.flatnonzero(chosen != d.choice):
        column, old, new = d.vehicle[j], d.base[j] + d.choice[j], d.base[j] + chosen[j]
        v.mind[STATION, column] = carried(v.mind[STATION, column], d.span[:, old], d.span[:, new])
        carry_stations(world.script, column, d.span[:, old], d.span[:, new])
        (
            r.path_first[column], r.path_count[column], r.stop_first[column], r.stop_count[column],
            o.sweep_first[column], o.sweep_count[column], r.drive_first[column], r.drive_count[column],
        ) = d.lines[:, new]  # fmt: skip
    d.choice[:] = chosen


def follow(world: World) -> None:
    """Makes anew what follows from phases and choices, after both have been set from outside."""
    if world.script.phase.size:
        post(world)


def carry_stations(script: Script, column: int, old: np.ndarray, new: np.ndarray) -> None:
    """What waits for a vehicle at a station of its path waits there on its new one."""
    for each in script.asked:
        for station, vehicle in each.stations:
            for i in np.flatnonzero(each.settings[vehicle] == column):
                each.settings[station, i] = carried(each.settings[station, i], old, new)


def carried(station: float, old: np.ndarray, new: np.ndarray) -> float:
    """A station [m] of one line on another that differs within works; old and new are where they enter and leave these."""
    known = ~np.isnan(old)
    order = np.argsort(old[known])
    here, there = old[known][order], new[known][order]
    if station <= here[0]:
        return station
    return float(np.interp(station, here, there) + max(station - here[-1], 0.0))


def post(world: World) -> None:
    """What the phases mean: limits, slippery pieces, which conditions are waited for, which maneuvers last."""
    s, pieces = world.script, world.roads.pieces
    post_limits(s, world.roads.points)
    deed.hold(world)
    pieces[PIECE_ACTS] = s.phase[pieces[PIECE_ENTRY].astype(np.int64)] == ACTING
    s.waiting = np.flatnonzero([is_waited_for(each, s).any() for each in s.asked])
    s.acting = np.flatnonzero([(s.phase[each.entry] == ACTING).any() for each in s.maneuvers])


def is_waited_for(each: Asked, s: Script) -> np.ndarray:
    """Which of the conditions of a kind somebody waits for."""
    phase = s.phase[each.entry]
    return (phase == each.turn) | ((phase == OVER) & (each.turn == 0) & (s.again[each.entry] != 0))


def post_limits(script: Script, points: np.ndarray) -> None:
    """The speeds of all paths under the limits that act."""
    columns, speed = script.free
    points[PATH_SPEED, columns] = speed
    for number, columns, speed in script.limits:
        if script.phase[number] == ACTING:
            points[PATH_SPEED, columns] = np.minimum(points[PATH_SPEED, columns], speed)


# -- at the start --------------------------------------------------------------------------------------


def script_of(settings: Sequence[Setting], worlds: Worlds, lines: Lines, movers: list[dict[str, int]]) -> Script:
    """The scripts of all worlds before anything begins."""
    placed = [(w, site) for w, each in enumerate(settings) for site in each.sites]
    limits = [each for number, (w, site) in enumerate(placed) for laid in site.laid for each in limits_of(number, laid, w, lines)]
    limited_at = np.unique(np.concatenate([np.zeros(0, np.int64), *(columns for _, columns, _ in limits)]))
    finds, found = finders(settings, worlds, movers)
    maneuvers, vehicle, takes = maneuvers_of(settings, finds)
    nodes, root = nodes_of(settings, finds)
    asked = asked_of(nodes)
    n = len(placed)
    return Script(
        world=np.array([w for w, _ in placed], dtype=np.int64),
        vehicle=vehicle,
        takes=takes,
        again=np.array([int(site.entry.again) for _, site in placed], dtype=np.int64),
        momentary=np.array([int(site.is_momentary) for _, site in placed], dtype=np.int64),
        ends=np.array([int(any(isinstance(each, End) for each in site.effects)) for _, site in placed], dtype=np.int64),
        phase=np.zeros(n, dtype=np.int64),
        turned=np.full((2, n), np.nan),
        cut=np.full(n, -1),
        come=np.zeros(n, dtype=np.int64),
        unfit=np.zeros(n, dtype=np.int64),
        commands=np.zeros((len(SCRIPT), worlds.of.size)),
        root=root,
        node_entry=np.array([each.entry for each in nodes], dtype=np.int64),
        held=np.zeros(len(nodes), dtype=np.int64),
        since=np.full(len(nodes), np.inf),
        met=np.full(len(nodes), np.inf),
        asked=asked,
        maneuvers=maneuvers,
        pool=found.pool,
        watched=found.watched,
        values=np.zeros(len(found.watched)),
        reader=None,
        mail=np.zeros((len(MAIL), 0)),
        reads_mail=any(hasattr(each.kind.module, "READS_MAIL") for each in asked),
        deeds=Deeds(),
        limits=limits,
        free=(limited_at, lines.points[PATH_SPEED, limited_at]),
        waiting=np.flatnonzero([(each.turn == 0).any() for each in asked]),
        acting=np.zeros(0, dtype=np.int64),
    )


def asked_of(nodes: list[Node]) -> list[Asked]:
    """All conditions, kind by kind, those that are about others behind these."""
    together: dict[tuple[int, str], list[int]] = {}
    for number, each in enumerate(nodes):
        together.setdefault((each.height, each.kind), []).append(number)
    return [asked(name, numbers, nodes) for (_, name), numbers in sorted(together.items(), key=lambda each: each[0][0])]


def asked(name: str, numbers: list[int], nodes: list[Node]) -> Asked:
    """Everybody who waits for one kind of condition."""
    kind = registry.find("condition", name)
    made, some = kind.module.Settings, [nodes[each] for each in numbers]
    counts = np.array([len(each.parts) for each in some])
    return Asked(
        kind=kind,
        node=np.array(numbers),
        entry=np.array([each.entry for each in some]),
        turn=np.array([each.turn for each in some]),
        settings=np.array([each.row for each in some], dtype=float).reshape(len(some), -1).T.copy(),
        part_first=starts(counts),
        part_count=counts,
        part=np.array([number for each in some for number in each.parts], dtype=np.int64),
        stations=[(row_of(made, station), row_of(made, vehicle)) for station, vehicle in stations(made)],
        run=condition.loop(kind),
    )


def maneuvers_of(settings: Sequence[Setting], finds: list[Finder]) -> tuple[list[Maneuvers], np.ndarray, np.ndarray]:
    """All maneuvers, kind by kind; the vehicle of every entry, -1 for none; what each takes of it."""
    together: dict[str, list[tuple[int, int, list[float]]]] = {}
    vehicles: list[int] = []
    taken: list[int] = []
    for each, find in zip(settings, finds, strict=True):
        for entry in each.scenario.script.values():
            module = registry.find("action", entry.do.kind).module
            column = int(find("vehicle", entry.do.vehicle)) if hasattr(module, "act") else -1
            if column >= 0:
                together.setdefault(entry.do.kind, []).append((len(vehicles), column, numbers(entry.do, find)))
            vehicles.append(column)
            taken.append(maneuver.takes(module))
    found = [maneuvers(name, rows) for name, rows in together.items()]
    return found, np.array(vehicles, dtype=np.int64), np.array(taken, dtype=np.int64)


def maneuvers(name: str, rows: list[tuple[int, int, list[float]]]) -> Maneuvers:
    """All maneuvers of one kind."""
    kind = registry.find("action", name)
    return Maneuvers(
        kind=kind,
        entry=np.array([entry for entry, _, _ in rows]),
        vehicle=np.array([column for _, column, _ in rows]),
        settings=np.array([row for _, _, row in rows]).T.copy(),
        run=maneuver.loop(kind),
    )


def limits_of(number: int, laid: Laid, world: int, lines: Lines) -> Iterator[tuple[int, np.ndarray, np.ndarray]]:
    """What a limit means for every line of its world that it concerns: its entry, columns of points, speed."""
    do = laid.effect
    if not isinstance(do, Limit):
        return
    for each in lines.laid:
        if each.world == world:
            speed = limited(each.path, laid.line, do.stretch.start, do.stretch.end, do.speed)
            concerned = np.flatnonzero(np.isfinite(speed))
            if concerned.size:
                yield number, each.first + concerned, speed[concerned]
