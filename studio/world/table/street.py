"""What happens on the roads: lines that vehicles may take, slippery pieces, objects, and collisions."""

from studio.rows import Role, Table

LINE = Table("line", Role.PARAMETER, per="path that vehicles may take")
LINE_FIRST = LINE.row("first", "1", "column of its first point")
LINE_COUNT = LINE.row("count", "1", "of its points")
LINE_STOP = LINE.row("first_stop", "1", "its first stop line")
LINE_STOPS = LINE.row("stops", "1", "number of its stop lines")
LINE_OBJECT = LINE.row("first_object", "1", "first object that stands in its way")
LINE_OBJECTS = LINE.row("objects", "1", "number of them")
LINE_DRIVE = LINE.row("first_drive", "1", "its first drive on a strand")
LINE_DRIVES = LINE.row("drives", "1", "number of them")

BEFORE, ACTING, OVER = range(3)  # phases of an entry of the script

# Pieces of slippery stretches.
PIECE = Table("piece", Role.PARAMETER, per="piece of a slippery stretch")
PIECE_X = PIECE.row("x", "m", "middle of the piece")
PIECE_Y = PIECE.row("y", "m", "middle of the piece")
PIECE_HEADING = PIECE.row("heading", "rad", "of the route there")
PIECE_LEFT = PIECE.row("left", "m", "how far it reaches to the left")
PIECE_RIGHT = PIECE.row("right", "m", "how far it reaches to the right")
PIECE_FRICTION = PIECE.row("friction", "1", "relative to the tyre's test track")
PIECE_WORLD = PIECE.row("world", "1", "number of the world")
PIECE_ENTRY = PIECE.row("entry", "1", "number of the entry of the script that it belongs to")
PIECE_ACTS = PIECE.row("acts", "1", "1 while this entry does", role=Role.STATE)

# Objects on the road: boxes at rest, and movers.
OBSTACLE = Table("obstacle", Role.PARAMETER, per="object on the road")
O_X = OBSTACLE.row("x", "m", "middle of the object")
O_Y = OBSTACLE.row("y", "m", "middle of the object")
O_HEADING = OBSTACLE.row("heading", "rad", "of its length")
O_LENGTH = OBSTACLE.row("length", "m", "of the object")
O_WIDTH = OBSTACLE.row("width", "m", "of the object")
O_KIND = OBSTACLE.row("kind", "1", "0 a cone, 1 a barrier, 2 somebody on foot, 3 a cyclist, 4 a box")
O_ENTRY = OBSTACLE.row("entry", "1", "number of the entry of the script that it belongs to")
O_SPEED = OBSTACLE.row("speed", "m/s", "along its heading", role=Role.STATE)
O_HEIGHT = OBSTACLE.row("height", "m", "of the road or the land that it stands on")
O_LEVEL = OBSTACLE.row("level", "1", "on which level of the map that is")
O_LIFT = OBSTACLE.row("lift", "m", "how high above the land it is drawn")
CONE, BARRIER, PEDESTRIAN, CYCLIST, BOX = range(5)
OBJECT = -2  # where the number of a vehicle may stand, object i of its world is OBJECT - i; -1 is nothing

# Objects that a vehicle on its path may run into.
SWEEP = Table("sweep", Role.PARAMETER, per="object on a path")
SWEPT_AT = SWEEP.row("station", "m", "at which the path comes to it")
SWEPT_ASIDE = SWEEP.row("aside", "m", "from the path to its near edge")
SWEPT_LEFT = SWEEP.row("left", "m", "of its middle from the path, left positive")
SWEPT_OBJECT = SWEEP.row("object", "1", "number of the object")

# Zebra crossings that somebody on foot comes to on his line.
ZEBRA = Table("zebra", Role.PARAMETER, per="zebra crossing on somebody's line")
Z_FROM = ZEBRA.row("from_station", "m", "of his line, where he steps onto the crossing")
Z_TO = ZEBRA.row("to_station", "m", "of his line, where he has left it")
Z_X = ZEBRA.row("x", "m", "its middle")
Z_Y = ZEBRA.row("y", "m", "its middle")
Z_HEADING = ZEBRA.row("heading", "rad", "from edge to edge of the road")
Z_LENGTH = ZEBRA.row("length", "m", "from edge to edge of the road")
Z_WIDTH = ZEBRA.row("width", "m", "of the strip on which one walks")

COLLISION = Table("collision", Role.RECORD, per="collision")
HIT_TIME = COLLISION.row("time", "s", "of the first contact")
HIT_FIRST = COLLISION.row("first", "1", "number of one vehicle in its world")
HIT_SECOND = COLLISION.row("second", "1", "number of the other, or OBJECT - i")
HIT_SPEED = COLLISION.row("impact_speed", "m/s", "relative speed at contact")
