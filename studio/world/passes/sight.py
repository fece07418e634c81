"""Sight: which bodies a sensor sees. What is nearer hides what is behind it, bearing by bearing; so do buildings.

The bodies in the field are gone through, the nearest first. Of the bearings between which a body's outline lies, those count that are in
the field and that nothing nearer covers; their share of all of them must reach a threshold. Then the body covers its own. Covered bearings
are kept as intervals that do not touch, in order. What is measured is the nearest point of the outline at a bearing that is seen.
A body hides what is behind its nearest point: two that stand side by side and reach into each other's depth are ordered by that.
"""

from math import atan2, cos, floor, pi, sin

from studio.compiled import inlined, lean
from studio.model.sensor import turned
from studio.model.sight import edges, far, met, nearest
from studio.road.network.grid import CELLS, COLUMNS, ROWS, SIZE, SOUTH, WEST
from studio.road.network.shadow import (
    BOX_X,
    BOX_Y,
    COLUMN_LOW,
    HALF_X,
    HALF_Y,
    OPEN,
    PARTLY,
    ROW_LOW,
    WALL_COUNT,
    WALL_FIRST,
    is_at_eye,
    is_clear,
    level,
    walk,
)
from studio.road.ways.path import PATH_SPACING
from studio.rows import Role, Table
from studio.vehicle.parameter import FRONT, LENGTH, WIDTH, H
from studio.vehicle.state import ACTIVE, V_X, X, Y, Z
from studio.world.passes.level import OTHER_LEVEL, STEEPNESS, is_thing_apart
from studio.world.passes.neighbour import COS, SIN, within
from studio.world.table.chart import LEVEL
from studio.world.table.mind import STATION
from studio.world.table.street import CONE, O_HEADING, O_HEIGHT, O_KIND, O_LENGTH, O_LEVEL, O_SPEED, O_WIDTH, O_X, O_Y, OBJECT

SIGHT = Table("sight", Role.SCRATCH, per="body in the field of the sensor that looks")
WHO = SIGHT.row("who", "1", "column of a vehicle, or OBJECT - i for object i of all worlds")
MIDDLE_X = SIGHT.row("middle_x", "m", "of its outline, ahead of the sensor")
MIDDLE_Y = SIGHT.row("middle_y", "m", "of its outline, to the left")
TURNED_COS = SIGHT.row("turned_cosine", "1", "of its heading against that of the sensor")
TURNED_SIN = SIGHT.row("turned_sine", "1", "of its heading against that of the sensor")
LONG = SIGHT.row("length", "m", "of its outline")
WIDE = SIGHT.row("width", "m", "of its outline")
NEAR = SIGHT.row("near", "m", "distance of its nearest point")
LOW = SIGHT.row("low", "rad", "bearing of its right edge")
HIGH = SIGHT.row("high", "rad", "bearing of its left edge, not below the other")
SHARE = SIGHT.row("share", "1", "of its bearings that is seen")
SEEN_X = SIGHT.row("seen_x", "m", "nearest point that is seen, ahead of the sensor")
SEEN_Y = SIGHT.row("seen_y", "m", "nearest point that is seen, to the left")
PLACE_IN_ORDER = SIGHT.row("in_order", "1", "column of the body that has this place among all, the nearest first")
BLOCK_LOW = SIGHT.row("block_low", "rad", "covered bearings: from here")
BLOCK_HIGH = SIGHT.row("block_high", "rad", "covered bearings: to here")
TRACK_WHO = SIGHT.row("track_who", "1", "number in its world of what a track follows, or OBJECT - i")
TRACK_NUMBER = SIGHT.row("track_number", "1", "of the track")
TRACK_SINCE = SIGHT.row("track_since", "s", "when it began")
TRACK_EXISTENCE = SIGHT.row("track_existence", "1", "of the track")
TRACK_SEEN = SIGHT.row("track_seen", "1", "1 when it has been seen at this look")

ROOM = 64  # columns besides one for each body: covered bearings, and tracks
PIECE, CLOSE = 24.0, 0.01  # [m] of a way, between which no building is looked for at once; beside a line, by rounding
LEAST = 1e-9  # [rad] bearings below that are rounding


# -- covered bearings ----------------------------------------------------------------------------------


@inlined
def cover(low, high, sight, blocks):
    """Covers the bearings from low to high, within -π and π; how many intervals there are now."""
    if high <= low or blocks >= sight.shape[1] - 1:
        return blocks
    first = 0
    while first < blocks and sight[BLOCK_HIGH, first] < low:
        first += 1
    last = first
    while last < blocks and sight[BLOCK_LOW, last] <= high:
        low, high = min(low, sight[BLOCK_LOW, last]), max(high, sight[BLOCK_HIGH, last])
        last += 1
    if last == first:
        for i in range(blocks, first, -1):
            sight[BLOCK_LOW, i], sight[BLOCK_HIGH, i] = sight[BLOCK_LOW, i - 1], sight[BLOCK_HIGH, i - 1]
        blocks += 1
    elif last > first + 1:
        gone = last - first - 1
        for i in range(last, blocks):
            sight[BLOCK_LOW, i - gone], sight[BLOCK_HIGH, i - gone] = sight[BLOCK_LOW, i], sight[BLOCK_HIGH, i]
        blocks -= gone
    sight[BLOCK_LOW, first], sight[BLOCK_HIGH, first] = low, high
    return blocks


@inlined
def free(low, high, sight, blocks):
    """How much [rad] of the bearings from low to high is not covered."""
    left = high - low
    if left <= 0.0:
        return 0.0
    for i in range(blocks):
        left -= max(min(high, sight[BLOCK_HIGH, i]) - max(low, sight[BLOCK_LOW, i]), 0.0)
    return max(left, 0.0)


@inlined
def cover_outline(low, high, sight, blocks):
    """Covers the bearings of an outline, which may go beyond π."""
    blocks = cover(low, min(high, pi), sight, blocks)
    return cover(-pi, high - 2.0 * pi, sight, blocks)


@inlined
def open_to(low, high, half, sight, blocks):
    """How much [rad] of the bearings of an outline is within the field, `half` to each side, and not covered."""
    seen = free(max(low, -half), min(high, half, pi), sight, blocks)
    return seen + free(max(low - 2.0 * pi, -half), min(high - 2.0 * pi, half), sight, blocks)


@inlined
def is_open(bearing, half, sight, blocks):
    """Whether a bearing is in the field and not covered."""
    if abs(bearing) > half:
        return False
    for i in range(blocks):
        if sight[BLOCK_LOW, i] < bearing < sight[BLOCK_HIGH, i]:
            return False
    return True


@inlined
def nearest_open(bearing, low, high, half, sight, blocks):
    """Of the bearings of an outline that are in the field and not covered, the one that is nearest to a bearing."""
    best, least = bearing, 1e9
    for turn in range(2):
        begin, end = max(low - 2.0 * pi * turn, -half), min(high - 2.0 * pi * turn, half, pi)
        for i in range(blocks + 1):
            first = max(begin, sight[BLOCK_HIGH, i - 1] if i > 0 else -pi)
            last = min(end, sight[BLOCK_LOW, i] if i < blocks else pi)
            if last - first > LEAST:
                at = min(max(bearing, first), last)
                if abs(at - bearing) < least:
                    best, least = at, abs(at - bearing)
    return best


# -- bodies --------------------------------------------------------------------------------------------


@inlined
def put(x, y, c, s, length, width, who, me, i, sight):
    """Writes a body with its middle at x, y of the world and a heading of cosine c and sine s into column i; distance and edges, too."""
    dx, dy = x - me.eye_x, y - me.eye_y
    ahead, left = dx * me.eye_cosine + dy * me.eye_sine, dy * me.eye_cosine - dx * me.eye_sine
    cosine, sine = c * me.eye_cosine + s * me.eye_sine, s * me.eye_cosine - c * me.eye_sine
    sight[WHO, i], sight[MIDDLE_X, i], sight[MIDDLE_Y, i], sight[LONG, i], sight[WIDE, i] = who, ahead, left, length, width
    sight[TURNED_COS, i], sight[TURNED_SIN, i] = cosine, sine
    near_x, near_y = nearest(ahead, left, cosine, sine, length, width)
    sight[SEEN_X, i], sight[SEEN_Y, i], sight[NEAR, i] = near_x, near_y, far(near_x, near_y)


@inlined
def frame(i, sight):
    """The bearings of the edges of the body in column i."""
    low, high = edges(sight[MIDDLE_X, i], sight[MIDDLE_Y, i], sight[TURNED_COS, i], sight[TURNED_SIN, i], sight[LONG, i], sight[WIDE, i])
    sight[LOW, i], sight[HIGH, i] = low, high


@inlined
def put_vehicle(view, me, v, i):
    """Writes vehicle v into column i."""
    c, s, length = view.places[COS, v], view.places[SIN, v], view.parameter[LENGTH, v]
    ahead = view.parameter[FRONT, v] - 0.5 * length
    put(view.state[X, v] + ahead * c, view.state[Y, v] + ahead * s, c, s, length, view.parameter[WIDTH, v], v, me, i, view.sight)


@inlined
def put_object(view, me, o, i):
    """Writes object o into column i."""
    table, heading = view.table, view.table[O_HEADING, o]
    put(table[O_X, o], table[O_Y, o], cos(heading), sin(heading), table[O_LENGTH, o], table[O_WIDTH, o], OBJECT - o, me, i, view.sight)


@inlined
def speed_of(view, who):
    """Speed [m/s] along its heading of a vehicle, or of an object, OBJECT - o."""
    return view.state[V_X, int(who)] if who >= 0 else view.table[O_SPEED, OBJECT - int(who)]


@inlined
def is_thing(view, me, o, cones):
    """Whether object o stands there, on the level that is seen, for a sensor that sees cones or does not."""
    return view.standing[o] != 0 and (cones or view.table[O_KIND, o] != CONE) and not is_thing_on_other_level(view, me, o)


@inlined
def enlist(i, reach, sight):
    """Whether the body in column i is within reach, so that it stays; it is put into its place in the order."""
    if sight[NEAR, i] >= reach:
        return False
    j = i
    while j > 0 and sight[NEAR, int(sight[PLACE_IN_ORDER, j - 1])] > sight[NEAR, i]:
        sight[PLACE_IN_ORDER, j] = sight[PLACE_IN_ORDER, j - 1]
        j -= 1
    sight[PLACE_IN_ORDER, j] = i
    return True


@inlined
def is_beside(view, me, v, half_cosine, half_sine):
    """Whether vehicle v is clearly outside of a field that opens to less than half a turn, by its centre of gravity; without an angle."""
    dx, dy = view.state[X, v] - me.eye_x, view.state[Y, v] - me.eye_y
    ahead, left = dx * me.eye_cosine + dy * me.eye_sine, abs(dy * me.eye_cosine - dx * me.eye_sine)
    return half_cosine > 0.0 and left * half_cosine - ahead * half_sine > view.longest


@inlined
def is_on_other_level(view, me, v):
    """Whether vehicle v is clearly above or below what the unit's own vehicle sees, on a bridge for instance."""
    if me.vehicle < 0:
        return False
    dx, dy, dz = view.state[X, v] - me.eye_x, view.state[Y, v] - me.eye_y, view.state[Z, v] - view.state[Z, me.vehicle]
    beyond = abs(dz) - OTHER_LEVEL
    if beyond <= 0.0:
        return False
    return beyond * beyond > STEEPNESS * STEEPNESS * (dx * dx + dy * dy) or abs(layer(view, v) - layer(view, me.vehicle)) >= 0.5


@inlined
def is_thing_on_other_level(view, me, o):
    """Whether object o is clearly above or below what the unit's own vehicle sees."""
    if me.vehicle < 0 or abs(view.state[Z, me.vehicle] - view.parameter[H, me.vehicle] - view.table[O_HEIGHT, o]) <= OTHER_LEVEL:
        return False
    if is_thing_apart(me.vehicle, o, view.state, view.parameter, view.table):
        return True
    return abs(view.table[O_LEVEL, o] - layer(view, me.vehicle)) >= 0.5


@inlined
def layer(view, v):
    """The level on which vehicle v is."""
    at = min(max(view.mind[STATION, v] / PATH_SPACING, 0.0), view.path_count[v] - 1.0)
    return view.chart[LEVEL, view.path_first[v] + int(at)]


@inlined
def field(view, me, reach, half, cones):
    """Puts all bodies that may be in the field into `view.sight`, the nearest first; how many. The field opens `half` to each side."""
    count, most, behind, half_cosine, half_sine = 0, reach + view.longest, view.longest, cos(half), sin(half)
    aside = (reach * half_sine if half < 0.5 * pi else reach) + view.longest
    if half > 0.5 * pi:
        behind -= reach * half_cosine
    found = within(
        me.world, me.eye_x, me.eye_y, me.eye_cosine, me.eye_sine, -behind, most, -aside, aside, view.grid, view.places, view.found
    )
    for k in range(found):
        v = view.found[k]
        if v == me.vehicle or view.state[ACTIVE, v] == 0.0 or is_on_other_level(view, me, v):
            continue
        if not is_beside(view, me, v, half_cosine, half_sine):
            put_vehicle(view, me, v, count)
            count += 1 if enlist(count, reach, view.sight) else 0
    first = view.first_object[me.world]
    for o in range(first, first + view.object_count[me.world]):
        if is_thing(view, me, o, cones):
            put_object(view, me, o, count)
            count += 1 if enlist(count, reach, view.sight) else 0
    return count


@inlined
def see(i, half, sight, blocks):
    """Which share of the body in column i is seen, and its nearest point that is; whether any is."""
    low, high = sight[LOW, i], sight[HIGH, i]
    seen = open_to(low, high, half, sight, blocks)
    sight[SHARE, i] = seen / (high - low)
    if seen <= LEAST:
        return False
    if seen >= high - low - LEAST:
        return True
    at = atan2(sight[SEEN_Y, i], sight[SEEN_X, i])
    if not is_open(at, half, sight, blocks):
        at = nearest_open(at, low, high, half, sight, blocks)
        distance = met(
            at, sight[MIDDLE_X, i], sight[MIDDLE_Y, i], sight[TURNED_COS, i], sight[TURNED_SIN, i], sight[LONG, i], sight[WIDE, i]
        )
        distance = distance if distance < 1e9 else sight[NEAR, i]
        sight[SEEN_X, i], sight[SEEN_Y, i] = distance * cos(at), distance * sin(at)
    return True


# -- buildings -----------------------------------------------------------------------------------------


@inlined
def cover_buildings(view, me, i, sight, blocks):
    """Covers what buildings hide of the body in column i; how many intervals there are now.

    Mostly there is none around. Else lines to both edges and to its nearest point are followed through cells: mostly all are open, or all
    end in a building. Where they differ, or one only passes by a building, walls are looked at.
    """
    place = view.place_of[me.world]
    distance = far(sight[MIDDLE_X, i], sight[MIDDLE_Y, i])
    if is_way_clear(view.shadow, place, me, i, distance, sight):
        return blocks
    x0, y0 = of_world(me, distance * cos(sight[LOW, i]), distance * sin(sight[LOW, i]))
    x1, y1 = of_world(me, distance * cos(sight[HIGH, i]), distance * sin(sight[HIGH, i]))
    x2, y2 = of_world(me, sight[SEEN_X, i], sight[SEEN_Y, i])
    frame, mass = view.shadow.grid.frame, view.shadow.mass
    found = walk(frame, mass, place, me.eye_x, me.eye_y, x0, y0, False)
    if (
        found == PARTLY
        or walk(frame, mass, place, me.eye_x, me.eye_y, x1, y1, False) != found
        or walk(frame, mass, place, me.eye_x, me.eye_y, x2, y2, False) != found
    ):
        return cover_walls(view.shadow, place, me, i, x0, y0, x1, y1, sight, blocks)
    return blocks if found == OPEN else cover_outline(sight[LOW, i], sight[HIGH, i], sight, blocks)


@inlined
def is_way_clear(shadow, place, me, i, distance, sight):
    """Whether there is no building around the lines from the sensor to the edges and the nearest point of the body in column i.

    A corner is no farther from the middle than half the diagonal, and the end of the line to an edge, which is as far as the middle, no
    farther from it than the corner is from the middle. So these lines are within a strip that is nowhere wider, to each side, than the
    diagonal times the share of the way; it is looked at piece by piece.
    """
    x, y = of_world(me, sight[MIDDLE_X, i], sight[MIDDLE_Y, i])
    pieces, aside = 1 + int(distance / PIECE), sight[LONG, i] + sight[WIDE, i]
    step_x, step_y = (x - me.eye_x) / pieces, (y - me.eye_y) / pieces
    for k in range(pieces):
        x0, y0, margin = me.eye_x + k * step_x, me.eye_y + k * step_y, aside * (k + 1) / pieces + CLOSE
        x1, y1 = x0 + step_x, y0 + step_y
        west, east, south, north = min(x0, x1) - margin, max(x0, x1) + margin, min(y0, y1) - margin, max(y0, y1) + margin
        if not is_clear(shadow.grid.frame, shadow.filled, place, west, south, east, north):
            return False
    return True


@inlined
def are_there_houses(view, me):
    """Whether there is any building on the map."""
    return view.shadow.grid.frame[COLUMNS, view.place_of[me.world]] > 0.0


@inlined
def of_world(me, x, y):
    """A place [m] ahead and to the left of the sensor in the world."""
    return me.eye_x + x * me.eye_cosine - y * me.eye_sine, me.eye_y + x * me.eye_sine + y * me.eye_cosine


@lean
def cover_walls(shadow, place, me, i, x0, y0, x1, y1, sight, blocks):
    """The same wall by wall, of all buildings between the sensor and the edges of the body."""
    frame = shadow.grid.frame
    columns, rows = int(frame[COLUMNS, place]), int(frame[ROWS, place])
    west, east = min(me.eye_x, x0, x1), max(me.eye_x, x0, x1)
    south, north = min(me.eye_y, y0, y1), max(me.eye_y, y0, y1)
    first_column, first_row = max(cell(west, frame[WEST, place], frame), 0), max(cell(south, frame[SOUTH, place], frame), 0)
    wedge = wedge_of(me, x0, y0, x1, y1, sight[HIGH, i] - sight[LOW, i])
    for column in range(first_column, min(cell(east, frame[WEST, place], frame), columns - 1) + 1):
        for row in range(first_row, min(cell(north, frame[SOUTH, place], frame), rows - 1) + 1):
            at = int(frame[CELLS, place]) + row * columns + column
            for k in range(shadow.grid.first[at], shadow.grid.first[at + 1]):
                b = shadow.grid.item[k]
                is_new = column == max(first_column, shadow.spans[b, COLUMN_LOW]) and row == max(first_row, shadow.spans[b, ROW_LOW])
                if is_new and is_at_eye(shadow, b) and not is_box_beside(shadow.bodies, b, me, wedge):
                    first = shadow.spans[b, WALL_FIRST]
                    for w in range(first, first + shadow.spans[b, WALL_COUNT]):
                        blocks = cover_wall(shadow.walls, w, me, i, wedge, sight, blocks)
    return blocks


@inlined
def wedge_of(me, x0, y0, x1, y1, width):
    """The directions in the world of a body's edges, right and left; of one that is half around the sensor nothing that excludes any."""
    if width >= 3.0:
        return 0.0, 0.0, 0.0, 0.0
    return x0 - me.eye_x, y0 - me.eye_y, x1 - me.eye_x, y1 - me.eye_y


@inlined
def is_box_beside(bodies, b, me, wedge):
    """Whether the box around a building lies wholly to the right of the right edge or to the left of the left one."""
    east, north = bodies[b, BOX_X] - me.eye_x, bodies[b, BOX_Y] - me.eye_y
    east_half, north_half = bodies[b, HALF_X], bodies[b, HALF_Y]
    x0, y0, x1, y1 = wedge
    return (
        x0 * north - y0 * east < -(abs(x0) * north_half + abs(y0) * east_half)
        or x1 * north - y1 * east > abs(x1) * north_half + abs(y1) * east_half
    )


@inlined
def is_wall_beside(ax, ay, bx, by, wedge):
    """The same of a wall from a to b, as seen from the sensor along the axes of the world."""
    x0, y0, x1, y1 = wedge
    return (x0 * ay < y0 * ax and x0 * by < y0 * bx) or (x1 * ay > y1 * ax and x1 * by > y1 * bx)


@inlined
def cell(place, edge, frame):
    """Column or row of the buildings' cells in which a coordinate [m] lies."""
    return int(floor((place - edge) / frame[SIZE, 0]))


@inlined
def cover_wall(walls, w, me, i, wedge, sight, blocks):
    """Covers the part of a wall that is nearer than the body in column i and before it."""
    from_x, from_y, to_x, to_y = walls[0, w] - me.eye_x, walls[1, w] - me.eye_y, walls[2, w] - me.eye_x, walls[3, w] - me.eye_y
    if is_wall_beside(from_x, from_y, to_x, to_y, wedge):
        return blocks
    ax, ay = turned(from_x, from_y, me.eye_cosine, me.eye_sine)
    bx, by = turned(to_x, to_y, me.eye_cosine, me.eye_sine)
    x, y, near = sight[SEEN_X, i], sight[SEEN_Y, i], max(sight[NEAR, i], 1e-6)
    one, other = (ax * x + ay * y) / near, (bx * x + by * y) / near  # along the line to the body's nearest point
    begin, end = level(one, other, 0.01, near)
    if begin >= end:
        return blocks
    px, py, qx, qy = ax + begin * (bx - ax), ay + begin * (by - ay), ax + end * (bx - ax), ay + end * (by - ay)
    low, high = atan2(py, px), atan2(qy, qx)
    low, high = min(low, high), max(high, low)
    if high - low > pi:
        low, high = high, low + 2.0 * pi
    if free_of(low, high, sight[LOW, i], sight[HIGH, i]):
        return blocks
    return cover_outline(low, high, sight, blocks)


@inlined
def free_of(low, high, first, last):
    """Whether the bearings from low to high do not meet those from first to last; both may go beyond π."""
    return (high < first or low > last) and high - 2.0 * pi < first and low > last - 2.0 * pi


# -- looking -------------------------------------------------------------------------------------------


@inlined
def look(view, me, reach, half, least, most, cones):
    """The bodies that a sensor sees: how many, `most` at most; the columns of `view.sight` in their order are told by `target`.

    Of a body the share `least` of its bearings must be seen, in a field of `reach` [m] that opens `half` [rad] to each side. With a share
    of 0 nothing hides anything: as from high above. `cones`: whether the sensor sees cones of plastic.
    """
    sight, blocks, found, has_houses = view.sight, 0, 0, least > 0.0 and are_there_houses(view, me)
    for j in range(field(view, me, reach, half, cones)):
        i = int(sight[PLACE_IN_ORDER, j])
        frame(i, sight)
        if has_houses and open_to(sight[LOW, i], sight[HIGH, i], half, sight, blocks) > LEAST:
            blocks = cover_buildings(view, me, i, sight, blocks)
        if see(i, half, sight, blocks) and sight[SHARE, i] >= least:
            sight[PLACE_IN_ORDER, found] = i
            found += 1
            if found == most:
                break
        if least > 0.0:
            blocks = cover_outline(sight[LOW, i], sight[HIGH, i], sight, blocks)
    return found


@inlined
def target(view, j):
    """The column of `view.sight` of the j-th body that was seen, 0 the nearest."""
    return int(view.sight[PLACE_IN_ORDER, j])


@inlined
def glimpse(view, me, half, cones, least, found):
    """Looks at the body in column 0 of `view.sight` alone: whether the share `least` of it is seen, past all that is nearer.

    The vehicles that may be nearer are the first `found` of `view.found`, as `around` has left them.
    """
    sight, blocks, near = view.sight, 0, view.sight[NEAR, 0]
    for k in range(found):
        v = view.found[k]
        if v != me.vehicle and v != int(sight[WHO, 0]) and view.state[ACTIVE, v] > 0.0 and not is_aside(view, me, v, near):
            put_vehicle(view, me, v, 1)
            blocks = cover_if_nearer(near, sight, blocks)
    first = view.first_object[me.world]
    for o in range(first, first + view.object_count[me.world]):
        if is_thing(view, me, o, cones) and OBJECT - o != int(sight[WHO, 0]):
            put_object(view, me, o, 1)
            blocks = cover_if_nearer(near, sight, blocks)
    has_houses = are_there_houses(view, me)
    if ((blocks == 0 and not has_houses) or least <= 0.0) and is_amid(half, sight):
        return True
    frame(0, sight)
    if least <= 0.0:
        return see(0, half, sight, 0)
    if has_houses:
        blocks = cover_buildings(view, me, 0, sight, blocks)
    return see(0, half, sight, blocks) and sight[SHARE, 0] >= least


@inlined
def is_aside(view, me, v, near):
    """Whether vehicle v covers nothing that is as near as that [m]."""
    return is_beyond(view, me, v, near) or is_on_other_level(view, me, v)


@inlined
def is_beyond(view, me, v, near):
    """Whether no part of vehicle v can be as near as that [m], by its centre of gravity."""
    dx, dy = view.state[X, v] - me.eye_x, view.state[Y, v] - me.eye_y
    reach = near + view.longest + 0.5 * view.parameter[WIDTH, v]
    return dx * dx + dy * dy > reach * reach


@inlined
def is_amid(half, sight):
    """Whether the body in column 0 is wholly and clearly in a field that opens to less than half a turn; without an angle."""
    around = 0.5 * (sight[LONG, 0] + sight[WIDE, 0])
    return half < 0.5 * pi and abs(sight[MIDDLE_Y, 0]) + around < (sight[MIDDLE_X, 0] - around) * half


@inlined
def cover_if_nearer(near, sight, blocks):
    """Covers the bearings of the body in column 1 when it is nearer."""
    if sight[NEAR, 1] >= near:
        return blocks
    frame(1, sight)
    return cover_outline(sight[LOW, 1], sight[HIGH, 1], sight, blocks)
