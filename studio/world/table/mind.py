"""Drivers: what they are like, what they know and want at this tick, and what maneuvers of the script command."""

from studio.rows import Role, Table

DRIVER = Table("driver", Role.PARAMETER, per="vehicle")
COMFORT = DRIVER.row("acceleration", "m/s²", "comfortable acceleration")
BRAKE_COMFORT = DRIVER.row("deceleration", "m/s²", "comfortable deceleration")
HEADWAY = DRIVER.row("time_headway", "s", "wanted headway")
STANDSTILL = DRIVER.row("standstill_gap", "m", "wanted gap at rest")
SPEED_FACTOR = DRIVER.row("speed_factor", "1", "wanted speed over the permitted one")
STEER_GAIN = DRIVER.row("steering_gain", "1/s", "how fast an offset is steered away")
YAW_DAMPING = DRIVER.row("yaw_damping", "s", "how much a wrong yaw rate is corrected")
SIGHT = DRIVER.row("sight", "m", "how far the weather lets the driver see")
SIGHT_SPEED = DRIVER.row("sight_speed", "m/s", "from which the driver stops within sight")

MIND = Table("mind", Role.DERIVED, per="vehicle")
STATION = MIND.row("station", "m", "arc length along the own path", role=Role.STATE, label="Distance along the route")
OFFSET = MIND.row("lateral_offset", "m", "offset from the own path, left positive", label="Offset from the path")
PATH_KAPPA = MIND.row("path_curvature", "1/m", "curvature of the path at the car")
D_PSI = MIND.row("heading_error", "rad", "heading minus path heading at the front axle")
FRONT_OFFSET = MIND.row("front_offset", "m", "offset of the front axle from the path")
V_DESIRED = MIND.row("desired_speed", "m/s", "speed that route and bends permit", label="Permitted speed")
GAP = MIND.row(
    "gap", "m", "bumper to bumper, to the vehicle or object ahead on the own path; not a number when there is none",
    label="Gap to the car ahead",
)  # fmt: skip
AHEAD_SPEED = MIND.row("ahead_speed", "m/s", "speed of what is ahead", label="Speed of the car ahead")
AHEAD = MIND.row("ahead", "1", "number in its world of the vehicle ahead, or OBJECT - i; -1 when there is none")
RED_STATION = MIND.row("red_station", "m", "station of the next stop line that shows no green; infinite when there is none")
FOLLOWING = MIND.row("following", "m/s²", "acceleration that traffic ahead permits")
YIELDING = MIND.row("yielding", "m/s²", "acceleration that cars permit which reach a merge or crossing first")
STOPPING = MIND.row("stopping", "m/s²", "acceleration that the next light permits")
WISH = MIND.row("wish", "m/s²", "acceleration the driver asks for")
STEER_WISH = MIND.row("steer_wish", "rad", "road wheel angle the driver asks for")

SCRIPT = Table("script", Role.DERIVED, per="vehicle")
DRIVES = SCRIPT.row("drives", "1", "1 while a maneuver of the script commands the pedals")
SCRIPT_ACCELERATION = SCRIPT.row("acceleration", "m/s²", "that it asks for")
STEERS = SCRIPT.row("steers", "1", "1 while a maneuver of the script commands the wheel")
SCRIPT_STEERING = SCRIPT.row("steering", "rad", "road wheel angle that it asks for")
