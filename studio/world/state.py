"""The rows of the arrays: every quantity of the simulated world, with its unit and meaning.

One array per kind of thing and per role, float64, shaped [quantity, entity]. The entity axis runs over all vehicles of
all worlds of a batch, world after world; wheel columns are corner * vehicles + vehicle. Names of rows are constants of
this file; only `world/` indexes arrays with them.
"""

from typing import NamedTuple


class Row(NamedTuple):
    """One quantity: its name at the borders, unit and meaning."""

    name: str
    unit: str
    meaning: str


# State: what integrates.
VEHICLE = (
    Row("x", "m", "east position of the centre of gravity"),
    Row("y", "m", "north position of the centre of gravity"),
    Row("heading", "rad", "yaw angle, counter-clockwise from east"),
    Row("speed", "m/s", "forward velocity"),
    Row("lateral_speed", "m/s", "leftward velocity"),
    Row("yaw_rate", "rad/s", "yaw velocity"),
    Row("acceleration", "m/s²", "forward acceleration"),
    Row("lateral_acceleration", "m/s²", "leftward acceleration"),
    Row("transfer_x", "m/s²", "forward acceleration as the load transfer has followed it"),
    Row("transfer_y", "m/s²", "leftward acceleration as the load transfer has followed it"),
    Row("steering", "rad", "road wheel angle, mean of left and right"),
    Row("drive_torque", "Nm", "drive torque, sum of the wheels"),
    Row("brake_torque", "Nm", "brake torque, sum of the wheels"),
    Row("active", "1", "1 while the vehicle takes part, 0 once it has arrived"),
)
(X, Y, PSI, V_X, V_Y, YAW_RATE, A_X, A_Y, TRANSFER_X, TRANSFER_Y, DELTA, TORQUE_DRIVE, TORQUE_BRAKE, ACTIVE) = range(
    len(VEHICLE)
)

WHEEL = (
    Row("wheel_speed", "rad/s", "spin"),
    Row("wheel_angle", "rad", "rotation since the start, for the eye"),
)
(OMEGA, ROTATION) = range(len(WHEEL))

# Scratch: what one pass hands to the next within a step.
CONTACT = (
    Row("load", "N", "vertical tyre force"),
    Row("wheel_velocity", "m/s", "velocity of the wheel centre in the wheel's plane"),
    Row("slip_ratio", "1", "longitudinal slip"),
    Row("slip_tangent", "1", "tangent of the side-slip angle"),
    Row("wheel_steer", "rad", "angle of this wheel"),
    Row("longitudinal_force", "N", "tyre force in the wheel's plane"),
    Row("lateral_force", "N", "tyre force across the wheel's plane"),
    Row("secant_stiffness", "N", "longitudinal force over slip"),
)
(F_Z, V_XW, KAPPA, ALPHA, DELTA_W, F_X, F_Y, SECANT) = range(len(CONTACT))

# Parameters: what stays fixed during a run.
PARAMETER = (
    Row("mass", "kg", "whole vehicle with crew"),
    Row("yaw_inertia", "kg m²", "about the vertical axis"),
    Row("front_distance", "m", "centre of gravity to front axle"),
    Row("rear_distance", "m", "centre of gravity to rear axle"),
    Row("gravity_height", "m", "centre of gravity above ground"),
    Row("front_track", "m", "between the front wheels"),
    Row("rear_track", "m", "between the rear wheels"),
    Row("front_roll_share", "1", "part of the roll moment carried by the front axle"),
    Row("sprung_time", "s", "time constant of the load transfer"),
    Row("roll_compliance", "rad s²/m", "roll angle per lateral acceleration"),
    Row("pitch_compliance", "rad s²/m", "pitch angle per longitudinal acceleration"),
    Row("wheel_radius", "m", "effective rolling radius"),
    Row("wheel_inertia", "kg m²", "of one wheel with its share of the drive train"),
    Row("drag_coefficient", "1", "air drag"),
    Row("frontal_area", "m²", "air drag"),
    Row("rolling_resistance", "1", "rolling resistance over load"),
    Row("drive_front_share", "1", "part of the drive torque that goes to the front axle"),
    Row("brake_front_share", "1", "part of the brake torque that goes to the front axle"),
    Row("drive_torque_max", "Nm", "at the wheels"),
    Row("drive_power_max", "W", "at the wheels"),
    Row("brake_torque_max", "Nm", "at the wheels"),
    Row("drive_time", "s", "time constant of the drive"),
    Row("drive_delay", "s", "dead time of the drive"),
    Row("brake_time", "s", "time constant of the brake"),
    Row("brake_delay", "s", "dead time of the brake"),
    Row("steering_time", "s", "time constant of the steering"),
    Row("steering_rate_max", "rad/s", "of the road wheels"),
    Row("steering_max", "rad", "of the road wheels"),
    Row("length", "m", "body"),
    Row("width", "m", "body"),
    Row("front_overhang", "m", "centre of gravity to front bumper"),
    Row("front_stiffness", "N/rad", "cornering stiffness of the front axle, for the driver's feed-forward"),
    Row("friction", "1", "road friction relative to the tyre's test track"),
)
(
    MASS,
    J_Z,
    L_F,
    L_R,
    H,
    TRACK_F,
    TRACK_R,
    ROLL_SHARE,
    TAU_SPRUNG,
    ROLL_COMPLIANCE,
    PITCH_COMPLIANCE,
    RADIUS,
    J_W,
    C_D,
    AREA,
    C_ROLL,
    DRIVE_SHARE,
    BRAKE_SHARE,
    DRIVE_MAX,
    POWER_MAX,
    BRAKE_MAX,
    TAU_DRIVE,
    DELAY_DRIVE,
    TAU_BRAKE,
    DELAY_BRAKE,
    TAU_STEER,
    STEER_RATE,
    STEER_MAX,
    LENGTH,
    WIDTH,
    FRONT,
    C_FRONT,
    FRICTION,
) = range(len(PARAMETER))

DRIVER = (
    Row("acceleration", "m/s²", "comfortable acceleration"),
    Row("deceleration", "m/s²", "comfortable deceleration"),
    Row("time_headway", "s", "wanted headway"),
    Row("standstill_gap", "m", "wanted gap at rest"),
    Row("speed_factor", "1", "wanted speed over the permitted one"),
    Row("steering_gain", "1/s", "how fast an offset is steered away"),
    Row("yaw_damping", "s", "how much a wrong yaw rate is corrected"),
)
(COMFORT, BRAKE_COMFORT, HEADWAY, STANDSTILL, SPEED_FACTOR, STEER_GAIN, YAW_DAMPING) = range(len(DRIVER))

# What a driver knows and wants at this tick.
MIND = (
    Row("station", "m", "arc length along the own path"),
    Row("lateral_offset", "m", "offset from the own path, left positive"),
    Row("path_curvature", "1/m", "curvature of the path at the car"),
    Row("heading_error", "rad", "heading minus path heading at the front axle"),
    Row("front_offset", "m", "offset of the front axle from the path"),
    Row("desired_speed", "m/s", "speed that route and bends permit"),
    Row("gap", "m", "bumper to bumper, to the vehicle ahead on the own path; not a number when there is none"),
    Row("ahead_speed", "m/s", "speed of the vehicle ahead"),
    Row("ahead", "1", "column of the vehicle ahead, -1 when there is none"),
    Row("red_station", "m", "station of the next stop line that shows no green; infinite when there is none"),
    Row("following", "m/s²", "acceleration that traffic ahead permits"),
    Row("yielding", "m/s²", "acceleration that cars permit which reach a merge or crossing first"),
    Row("stopping", "m/s²", "acceleration that the next light permits"),
    Row("wish", "m/s²", "acceleration the driver asks for"),
    Row("steer_wish", "rad", "road wheel angle the driver asks for"),
)
(
    STATION,
    OFFSET,
    PATH_KAPPA,
    D_PSI,
    FRONT_OFFSET,
    V_DESIRED,
    GAP,
    AHEAD_SPEED,
    AHEAD,
    RED_STATION,
    FOLLOWING,
    YIELDING,
    STOPPING,
    WISH,
    STEER_WISH,
) = range(len(MIND))

# Scripted maneuvers: what a trigger has set going on a vehicle.
SCRIPT = (
    Row("deceleration", "m/s²", "scripted braking"),
    Row("until", "s", "end of the maneuver"),
    Row("to_speed", "m/s", "speed at which it ends earlier"),
)
(SCRIPT_BRAKE, SCRIPT_UNTIL, SCRIPT_SPEED) = range(len(SCRIPT))

# Commands: what the actuators are asked for, one column per vehicle and slot of the ring of past ticks.
COMMAND = (
    Row("requested_acceleration", "m/s²", "what driver, application or maneuver ask for"),
    Row("requested_steering", "rad", "road wheel angle"),
    Row("requested_drive", "Nm", "drive torque"),
    Row("requested_brake", "Nm", "brake torque"),
)
(U, U_STEER, U_DRIVE, U_BRAKE) = range(len(COMMAND))
RING = 16  # past ticks that commands and messages are kept; bounds dead times and radio delays

SENSOR = (
    Row("detected", "1", "1 when the front sensor has a target"),
    Row("range", "m", "front bumper to the target's rear"),
    Row("range_rate", "m/s", "change of the range"),
    Row("azimuth", "rad", "direction of the target, left positive"),
    Row("target", "1", "column of the target, for the record only"),
)
(DETECTED, RANGE, RANGE_RATE, AZIMUTH, TARGET) = range(len(SENSOR))

SENSOR_SET = (
    Row("range", "m", "reach"),
    Row("opening_angle", "rad", "whole angle"),
    Row("range_noise", "m", "standard deviation"),
    Row("rate_noise", "m/s", "standard deviation"),
)
(REACH, OPENING, RANGE_SIGMA, RATE_SIGMA) = range(len(SENSOR_SET))

RADIO_SET = (
    Row("period", "s", "between two messages of a unit"),
    Row("delay", "s", "mean"),
    Row("delay_variation", "s", "half width"),
    Row("loss", "1", "rate"),
    Row("loss_per_metre", "1/m", "growth of the loss with distance"),
    Row("range", "m", "beyond it nothing is heard"),
)
(PERIOD, DELAY, VARIATION, LOSS, LOSS_DISTANCE, RADIO_RANGE) = range(len(RADIO_SET))

MESSAGE = (
    Row("sent", "s", "time of sending"),
    Row("x", "m", "position of the sender"),
    Row("y", "m", "position of the sender"),
    Row("speed", "m/s", "speed of the sender"),
    Row("acceleration", "m/s²", "acceleration of the sender"),
    Row("intention", "m/s²", "acceleration that the sender has requested of its actuators"),
)
(SENT, M_X, M_Y, M_SPEED, M_ACCELERATION, M_INTENTION) = range(len(MESSAGE))

COLLISION = (
    Row("time", "s", "of the first contact"),
    Row("first", "1", "column of one vehicle"),
    Row("second", "1", "column of the other"),
    Row("impact_speed", "m/s", "relative speed at contact"),
)
(HIT_TIME, HIT_FIRST, HIT_SECOND, HIT_SPEED) = range(len(COLLISION))
