"""The chart: what a map says of the road under a point of a path."""

from studio.rows import Role, Table

CHART = Table("chart", Role.PARAMETER, per="point of a path")
LANE_WIDTH = CHART.row("lane_width", "m", "of the lane that the path is on")
LANES_LEFT = CHART.row("lanes_left", "1", "lanes of the same direction to its left")
LANES_RIGHT = CHART.row("lanes_right", "1", "lanes of the same direction to its right")
LIMIT = CHART.row("limit", "m/s", "speed that is allowed there")
JUNCTION = CHART.row("junction", "m", "along the path to the next junction, 0 within one, 1e6 where none comes")
LEVEL = CHART.row("level", "1", "on which level the road is there, as bridges, tunnels and layers of the map tell")
BENT = CHART.row("bent", "1/m", "sum of the curvatures of the path's points up to there, so that a mean takes two of them")
