"""Drivers: what they are like, what they know and want at this tick, and what maneuvers of the script command.

The settings of a kind of driver that it alone has stand with its seats, not here.
"""

from studio.rows import Role, Table

DRIVER = Table("driver", Role.PARAMETER, per="vehicle")
COMFORT = DRIVER.row("acceleration", "m/s²", "comfortable acceleration")
BRAKE_COMFORT = DRIVER.row("deceleration", "m/s²", "comfortable deceleration")
HEADWAY = DRIVER.row("time_headway", "s", "wanted headway")
STANDSTILL = DRIVER.row("standstill_gap", "m", "wanted gap at rest")
SPEED_FACTOR = DRIVER.row("speed_factor", "1", "wanted speed over the permitted one")
EXPECTED = DRIVER.row("expected_reaction", "s", "from seeing what is expected to answering it, as drawn for this driver")
SURPRISED = DRIVER.row("surprised_reaction", "s", "the same for what comes up by surprise")
SPREAD = DRIVER.row("reaction_spread", "1", "standard deviation of the logarithm of both among drivers")
GAP_ERROR = DRIVER.row("gap_error", "1", "relative error of gaps and times that are estimated, standard deviation")
CLOSING_ERROR = DRIVER.row("closing_error", "1/s", "error of the speed of what is ahead, per gap, standard deviation")
DISTRACTION_RATE = DRIVER.row("distraction_rate", "1/min", "how often he looks away")
DISTRACTION_LENGTH = DRIVER.row("distraction_length", "s", "for how long, median")
SWAY = DRIVER.row("sway", "m", "standard deviation of the place in the lane that he wants")
SWAY_TIME = DRIVER.row("sway_time", "s", "in which this is forgotten")
POLITENESS = DRIVER.row("politeness", "1", "what others gain or lose by a change of lanes counts so much of one's own")
GAIN = DRIVER.row("changing_threshold", "m/s²", "what a change of lanes has to gain")
IMPOSED = DRIVER.row("imposed_braking", "m/s²", "harder nobody is made to brake by it, nor does one brake oneself")
KEEP_SIDE = DRIVER.row("keep_side", "m/s²", "what the lane nearer to the kerb is worth outside towns")
SIGHT = DRIVER.row("sight", "m", "how far the weather lets the driver see")
SIGHT_SPEED = DRIVER.row("sight_speed", "m/s", "from which the driver stops within sight")
MINDS_COLLISION = DRIVER.row("minds_collision", "1", "1 when the driver overrules an application before a collision")
MINDS_RED = DRIVER.row("minds_red_light", "1", "1 when he does before a red light")
MINDS_WAY = DRIVER.row("minds_right_of_way", "1", "1 when he does before a car that goes first")
REACTION_TIME = DRIVER.row("reaction_time", "s", "that it has to be needed before he does")
GAP_SHARE = DRIVER.row("gap_share", "1", "of the usual critical gap that he takes")

MIND = Table("mind", Role.DERIVED, per="vehicle")
STATION = MIND.row("station", "m", "arc length along the own path", role=Role.STATE, label="Distance along the route")
OFFSET = MIND.row("lateral_offset", "m", "offset from the own path, left positive", label="Offset from the path")
PATH_KAPPA = MIND.row("path_curvature", "1/m", "curvature of the path at the car")
D_PSI = MIND.row("heading_error", "rad", "heading minus path heading at the front axle")
FRONT_OFFSET = MIND.row("front_offset", "m", "offset of the front axle from the path")
V_DESIRED = MIND.row("desired_speed", "m/s", "speed that route and bends permit", label="Permitted speed")
CAREFUL = MIND.row(
    "careful_speed", "m/s", "speed from which one can still stop for somebody whom a corner hides; infinite where none matters",
)  # fmt: skip
GAP = MIND.row(
    "gap", "m", "bumper to bumper, to the nearest on the own path that the body is not clear of sideways; not a number when there is none",
    label="Gap to the car ahead",
)  # fmt: skip
AHEAD_SPEED = MIND.row("ahead_speed", "m/s", "speed of what is ahead", label="Speed of the car ahead")
AHEAD = MIND.row(
    "ahead", "1", "number of the vehicle ahead, in a record in the order of names, or -2 - i of an object; -1 when there is none",
    label="Number of the vehicle ahead",
)  # fmt: skip
RED_STATION = MIND.row(
    "red_station",
    "m",
    "station of the next stop line without green at which the driver stops; infinite when there is none",
    role=Role.STATE,
)
WAY_STATION = MIND.row(
    "way_station", "m", "station before which the driver waits for those who go first; infinite when for nobody", role=Role.STATE
)
STOOD = MIND.row("stood", "s", "how long the vehicle has stood, and has not driven faster than 2 m/s since", role=Role.STATE)
HALTED = MIND.row("halted", "m", "station of the last line at which the vehicle has come to a halt", role=Role.STATE)
FOLLOWING = MIND.row("following", "m/s²", "acceleration that traffic ahead permits")
FOLLOW_GAP = MIND.row("follow_gap", "m", "gap to whoever ahead permits least; infinite when there is nobody")
FOLLOW_SPEED = MIND.row("follow_speed", "m/s", "speed of the same; for one who crosses ahead, that with which one comes when he is gone")
YIELDING = MIND.row("yielding", "m/s²", "acceleration that cars permit which reach a merge or crossing first")
FIRST_GAP = MIND.row("first_gap", "m", "gap to the one of these that permits least, as if it drove ahead; infinite when there is none")
FIRST_SPEED = MIND.row("first_speed", "m/s", "speed of the same")
MINDED = MIND.row(
    "minded", "1", "number, as of `ahead`, of the vehicle or object that permits the driver least, ahead or first at a merge or "
    "crossing; -1 when nobody does, or a stop line permits less", label="Number of whom the driver minds",
)  # fmt: skip
STOPPING = MIND.row("stopping", "m/s²", "acceleration that the next stop line permits")
FIRST = MIND.row("first", "1", "number in its world of who goes first, and is waited for; -1 for nobody")
WAITED_FOR = MIND.row("waited_for", "1", "the same at the tick before", role=Role.STATE)
AWAY = MIND.row("inattentive", "1", "1 while the driver looks away", role=Role.STATE, label="Driver looks away")
LOOKS_UNTIL = MIND.row("looks_until", "s", "when he looks away, or back, the next time; 0 before it was drawn", role=Role.STATE)
SEEN_GAP = MIND.row(
    "seen_gap", "m", "gap to whoever ahead permits least as the driver takes it to be when he will have answered; infinite when there is "
    "nobody", role=Role.STATE,
)  # fmt: skip
SEEN_SPEED = MIND.row("seen_speed", "m/s", "speed of the same as he takes it to be", role=Role.STATE)
SEEN_FIRST_GAP = MIND.row("seen_first_gap", "m", "the same gap to whoever goes first", role=Role.STATE)
SEEN_FIRST_SPEED = MIND.row("seen_first_speed", "m/s", "and his speed", role=Role.STATE)
SEEN_STOP = MIND.row("seen_stop", "m", "distance to the next line to stop at, likewise", role=Role.STATE)
WRONG_GAP = MIND.row("wrong_gap", "1", "how wrong gaps are estimated just now, in standard deviations", role=Role.STATE)
WRONG_CLOSING = MIND.row("wrong_closing", "1", "the same for speeds", role=Role.STATE)
MISJUDGED = MIND.row("misjudged", "1", "an estimated gap over the true one", role=Role.STATE, label="Estimated over true gap")
SWAY_FROM = MIND.row("sway_from", "m", "place in the lane that the driver wanted last, left positive", role=Role.STATE)
SWAY_TO = MIND.row("sway_to", "m", "the one that he moves to", role=Role.STATE)
SWAYED = MIND.row("swayed", "m", "place in the lane that he wants now, left of the path", label="Wanted place in the lane")
INTENT = MIND.row("intent", "m/s²", "acceleration that the driver has decided on, which his foot will do", role=Role.STATE)
PENDING = MIND.row("pending", "m/s", "change of speed that is decided and not done yet", role=Role.STATE)
UNMET = MIND.row("unmet", "m/s²", "acceleration of the car beyond what his foot has asked for, as he feels it", role=Role.STATE)
GAINED = MIND.row("gained", "m/s", "change of own speed until he will have answered, as he expects it")
STARTLED = MIND.row(
    "startled",
    "s",
    "until when a surprise keeps him from deciding anew; 0 when none does",
    role=Role.STATE,
    label="Driver is surprised until",
)
CHANGING = MIND.row("changing", "1", "share of a change of lanes that is done", role=Role.STATE)
ASIDE_FROM = MIND.row("aside_from", "m", "where it began, left of the path over there", role=Role.STATE)
ASIDE = MIND.row("still_aside", "m", "place in the lane that this asks for now, left of the path", label="Still to go over to the new lane")
BESIDE = MIND.row("lanes_beside", "1", "lanes beside the usual one of his way, towards the middle", label="Lanes beside the usual one")
CHANGED = MIND.row("since_change", "s", "how long ago the last change of lanes began", role=Role.STATE)
OUT_BY = MIND.row(
    "passing_by", "m", "place on the oncoming lane from which the driver passes what stands, left of the path; 0 while he passes nothing",
    role=Role.STATE, label="Passes on the oncoming lane",
)  # fmt: skip
OUT_FROM = MIND.row("out_from", "m", "station from which he goes out to it", role=Role.STATE)
OUT_OVER = MIND.row("out_over", "m", "over so long a way", role=Role.STATE)
BACK_FROM = MIND.row("back_from", "m", "station from which he comes back", role=Role.STATE)
BACK_OVER = MIND.row("back_over", "m", "over so long a way", role=Role.STATE)
STUCK = MIND.row("stuck", "s", "how long he has stood so near behind what stands that he cannot go out to pass it", role=Role.STATE)
OUT_SLOPE = MIND.row("out_slope", "1", "of this way to the path, at the front axle")
OUT_BEND = MIND.row("out_bend", "1/m", "curvature of this way beyond that of the path, where the car is about to be")
IDLED = MIND.row("idled", "s", "how long he has stood though no line, light, car or object kept him from driving", role=Role.STATE)
LEFT_BY = MIND.row("left_by", "m", "station on the line that is being left, beyond that on the own one", role=Role.STATE)
WISH = MIND.row("wish", "m/s²", "acceleration the driver asks for")
STEER_WISH = MIND.row("steer_wish", "rad", "road wheel angle the driver asks for")
NEEDED_COLLISION = MIND.row("needed_collision", "s", "since when he would brake before a collision; infinite when not", role=Role.STATE)
NEEDED_RED = MIND.row("needed_red_light", "s", "since when he would brake before a red light", role=Role.STATE)
NEEDED_WAY = MIND.row("needed_right_of_way", "s", "since when he would brake before a car that goes first", role=Role.STATE)
ACTS_COLLISION = MIND.row("acts_collision", "1", "1 while he overrules the application before a collision", role=Role.STATE)
ACTS_RED = MIND.row("acts_red_light", "1", "1 while he does before a red light", role=Role.STATE)
ACTS_WAY = MIND.row("acts_right_of_way", "1", "1 while he does before a car that goes first", role=Role.STATE)
INTERVENING = MIND.row("intervening", "1", "1 while the driver overrules an application", label="Driver overrules the application")
DRIVER_HAS, SCRIPT_HAS, INTERVENTION_HAS, GEARBOX_HAS, APPLICATION = range(5)  # who commands: world/commander.py
WHO = "0 driver, 1 script, 2 driver's intervention, 3 gearbox, 4 and on the groups of applications, by name"
COMMANDS_WHEEL = MIND.row("commands_wheel", "1", f"who has the steering wheel: {WHO}", label="Who steers")
COMMANDS_BRAKE = MIND.row("commands_brake", "1", f"who has the brake: {WHO}", label="Who brakes")
COMMANDS_DRIVE = MIND.row("commands_drive", "1", f"who has the drive: {WHO}", label="Who drives")
COMMANDS_GEAR = MIND.row("commands_gear", "1", f"who chooses the gear: {WHO}", label="Who chooses the gear")
COMMANDED = tuple(row.name for row in MIND[COMMANDS_WHEEL : COMMANDS_GEAR + 1])

SCRIPT = Table("script", Role.DERIVED, per="vehicle")
DRIVES = SCRIPT.row("drives", "1", "1 while a maneuver of the script commands the pedals")
SCRIPT_ACCELERATION = SCRIPT.row("acceleration", "m/s²", "that it asks for")
STEERS = SCRIPT.row("steers", "1", "1 while a maneuver of the script commands the wheel")
SCRIPT_STEERING = SCRIPT.row("steering", "rad", "road wheel angle that it asks for")
