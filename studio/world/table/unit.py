"""Units: where they are and what their bus and receivers tell, how satellites and messages are kept.

A unit senses, talks and decides. Units are the named vehicles of a world, then its stations, world after world.
"""

from studio.application.port import OWN
from studio.rows import Role, Table

UNIT = Table("unit", Role.DERIVED, per="unit")
TRUE_X = UNIT.row("true_x", "m", "where it is; for sensors and radio, not for applications")
TRUE_Y = UNIT.row("true_y", "m", "where it is; for sensors and radio, not for applications")
TRUE_Z = UNIT.row("true_z", "m", "height of its road; for the radio, not for applications")
TRUE_SPEED = UNIT.row("true_speed", "m/s", "along its heading; for the radio, not for applications")
HEADING = UNIT.row("heading", "rad", "that its sensors look along")
COSINE = UNIT.row("cosine", "1", "of the heading")
SINE = UNIT.row("sine", "1", "of the heading")
BUMPER = UNIT.row("bumper", "m", "from its position to its front, where sensors are mounted")
PRESENT = UNIT.row("present", "1", "1 until its vehicle has arrived")
OWN_FIRST = len(UNIT)  # the rows of `Own`, in its order
OWN_SPEED, OWN_ACCELERATION, OWN_YAW_RATE, OWN_STEERING, OWN_SET_SPEED, OWN_REQUEST, OWN_X, OWN_Y = [
    UNIT.row(each.name, each.unit, each.meaning) for each in OWN
]

UNIT_SET = Table("unit_setting", Role.PARAMETER, per="unit")
OFFSET = UNIT_SET.row("clock_offset", "s", "of its clock at the start")
DRIFT = UNIT_SET.row("clock_drift", "1", "seconds that it gains a second")
HEIGHT = UNIT_SET.row("antenna_height", "m", "above the road")
SPEED_NOISE = UNIT_SET.row("speed_noise", "m/s", "of the speed on its bus, standard deviation")
ACCELERATION_NOISE = UNIT_SET.row("acceleration_noise", "m/s²", "of the acceleration on its bus")
YAW_RATE_NOISE = UNIT_SET.row("yaw_rate_noise", "rad/s", "of the yaw rate on its bus")
STEERING_NOISE = UNIT_SET.row("steering_noise", "rad", "of the road wheel angle on its bus")

TROUBLE = Table("trouble", Role.STATE, per="unit")
JAMMED = TROUBLE.row("jammed", "1", "above 0 it hears nothing")
DROPS = TROUBLE.row("drops", "1", "so many of its next messages reach nobody")
ADDED = TROUBLE.row("added_delay", "s", "added to the delay of what it sends")

SATELLITE = Table("satellite", Role.DERIVED, per="vehicle")
DRIFT_EAST = SATELLITE.row("drift_east", "1", "slow error of the satellite position, over its standard deviation", role=Role.STATE)
DRIFT_NORTH = SATELLITE.row("drift_north", "1", "slow error of the satellite position, over its standard deviation", role=Role.STATE)
SKY = SATELLITE.row("sky", "1", "share of the sky that was open when the receiver looked up last", role=Role.STATE)
GPS_EAST = SATELLITE.row("gps_error_east", "m", "measured minus true position", label="Error of the satellite position to the east")
GPS_NORTH = SATELLITE.row("gps_error_north", "m", "measured minus true position", label="Error of the satellite position to the north")

GPS_SET = Table("satellite_setting", Role.PARAMETER, per="vehicle")
DRIFT_SIGMA = GPS_SET.row("drift", "m", "standard deviation of the slow error under an open sky")
DRIFT_TIME = GPS_SET.row("correlation_time", "s", "of the slow error")
GPS_SIGMA = GPS_SET.row("noise", "m", "standard deviation of the white noise")
CANYON = GPS_SET.row("canyon_factor", "1", "by how much the slow error is larger where no sky is open")

SENSOR = Table("sensor", Role.STATE, per="sensor")
FAILS = SENSOR.row("fails", "1", "1 while it gives nothing: a fault that the script may set")
NOISE = SENSOR.row("noise", "1", "factor on all of its noise, 1 when it is well: a fault that the script may set")
MEASURED = SENSOR.row("measured", "s", "true time at which what it gives was measured; -1 while it has given nothing")
NEXT = SENSOR.row("next", "s", "true time from which on the next measurement is given; infinite while none is under way")

# What a sensor has measured and not given yet stands in a ring, one column per slot; these rows beside what it gives.
OUTPUT = Table("output", Role.STATE, per="slot of the ring of a sensor")
DUE = OUTPUT.row("due", "s", "true time from which on it is given; infinite in a slot that waits for nothing")
TAKEN = OUTPUT.row("taken", "s", "true time at which it was measured")

# A message that was sent stands in a ring, one column per slot and sender; behind these rows comes what it carries.
SENT = Table("sent", Role.STATE, per="slot of the ring and sender")
S_NUMBER = SENT.row("number", "1", "how many this sender had sent before, of this kind; -1 in a slot that was never used")
S_TIME = SENT.row("time", "s", "true time of sending, for the record")
S_STAMP = SENT.row("stamp", "s", "time of sending on the sender's clock")
S_X = SENT.row("x", "m", "where the antenna was; for the radio, not for the receiver")
S_Y = SENT.row("y", "m", "where the antenna was; for the radio, not for the receiver")
S_Z = SENT.row("z", "m", "height of the road where the antenna was; for the radio, not for the receiver")
S_SIZE = SENT.row("size", "byte", "of the message, with everything")
S_NEXT = SENT.row("next", "s", "when it will be there at the next of its receivers; infinite when it has reached all that it reaches")

# What a link has received last; behind these rows comes what it carries.
HEARD = Table("heard", Role.STATE, per="link")
H_NUMBER = HEARD.row("number", "1", "of the message; -1 while none has come")
H_TIME = HEARD.row("time", "s", "true time of sending, for the record")
H_STAMP = HEARD.row("stamp", "s", "time of sending on the sender's clock")
H_CAME = HEARD.row("came", "s", "true time at which it was there, between two ticks as a rule")
H_MISSED = HEARD.row("missed", "1", "messages of this sender that were lost since the one before")
H_SENDER = HEARD.row("sender", "1", "number of the unit in its world", role=Role.PARAMETER)

# What is kept of every message for the record; its links stand in arrays beside it, from `first` on.
LOGGED = Table("logged", Role.RECORD, per="message")
L_TIME = LOGGED.row("time", "s", "true time of sending")
L_SENDER = LOGGED.row("sender", "1", "the unit")
L_NUMBER = LOGGED.row("number", "1", "how many of this kind it had sent before")
L_SIZE = LOGGED.row("size", "byte", "with everything")
L_FIRST = LOGGED.row("first", "1", "where its links begin")
L_SAID = LOGGED.block("said", 2, "1", "the first numbers that it carries, as it has them; not a number where it carries fewer")
