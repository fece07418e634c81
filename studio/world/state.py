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


# State: what integrates, and what is derived from it at the end of a tick.
VEHICLE = (
    Row("x", "m", "east position of the centre of gravity"),
    Row("y", "m", "north position of the centre of gravity"),
    Row("z", "m", "height of the centre of gravity"),
    Row("q_w", "1", "orientation, unit quaternion from the body's axes to the world's"),
    Row("q_x", "1", "orientation"),
    Row("q_y", "1", "orientation"),
    Row("q_z", "1", "orientation"),
    Row("velocity_east", "m/s", "velocity of the centre of gravity in the world"),
    Row("velocity_north", "m/s", "velocity of the centre of gravity in the world"),
    Row("velocity_up", "m/s", "velocity of the centre of gravity in the world"),
    Row("roll_rate", "rad/s", "about the body's x axis"),
    Row("pitch_rate", "rad/s", "about the body's y axis"),
    Row("yaw_rate", "rad/s", "about the body's z axis"),
    Row("acceleration", "m/s²", "along the body's x axis"),
    Row("lateral_acceleration", "m/s²", "along the body's y axis"),
    Row("vertical_acceleration", "m/s²", "along the body's z axis"),
    Row("steering", "rad", "road wheel angle, mean of left and right"),
    Row("steering_rate", "rad/s", "of the road wheel angle"),
    Row("pressure_front", "Pa", "brake pressure, front"),
    Row("pressure_rear", "Pa", "brake pressure, rear"),
    Row("engine_speed", "rad/s", "of engine or motor"),
    Row("engine_torque", "Nm", "at the shaft, negative when it brakes"),
    Row("accelerator", "1", "pedal position that gives the torque asked for"),
    Row("clutch", "1", "transmissibility of clutch or lock-up: 0 open, 1 closed"),
    Row("clutch_rate", "1/s", "how fast it moves"),
    Row("open_time", "s", "since when the clutch has been open for a shift"),
    Row("gear", "1", "engaged gear: -1 reverse, 0 neutral, 1 first"),
    Row("next_gear", "1", "gear that is being shifted to"),
    Row("ratio", "1", "of gearbox and final drive; 0 in neutral"),
    Row("next_ratio", "1", "of the gear that is being shifted to"),
    Row("ratio_rate", "1/s", "how fast the ratio moves to it where a converter's clutches hand over; 0 where it jumps"),
    Row("gear_inertia", "kg m²", "of the gearbox at its input"),
    Row("drive_torque", "Nm", "drive torque, sum of the wheels"),
    Row("brake_torque", "Nm", "brake torque that the brakes can hold, sum of the wheels"),
    Row("heading", "rad", "yaw angle, counter-clockwise from east, continuous"),
    Row("roll", "rad", "about the x axis, right side down positive"),
    Row("pitch", "rad", "about the y axis, nose down positive"),
    Row("speed", "m/s", "velocity along the body's x axis"),
    Row("lateral_speed", "m/s", "velocity along the body's y axis"),
    Row("active", "1", "1 while the vehicle takes part, 0 once it has arrived"),
)
(
    X, Y, Z, Q_W, Q_X, Q_Y, Q_Z, V_EAST, V_NORTH, V_UP, ROLL_RATE, PITCH_RATE, YAW_RATE, A_X, A_Y, A_Z, DELTA, DELTA_RATE,
    PRESSURE_F, PRESSURE_R, OMEGA_E, T_ENGINE, ACCELERATOR, CLUTCH, CLUTCH_RATE, OPEN_TIME, GEAR, NEXT_GEAR, RATIO, NEXT_RATIO,
    RATIO_RATE, J_GEAR, TORQUE_DRIVE, TORQUE_BRAKE, PSI, ROLL, PITCH, V_X, V_Y, ACTIVE,
) = range(len(VEHICLE))  # fmt: skip

WHEEL = (
    Row("wheel_speed", "rad/s", "spin"),
    Row("wheel_angle", "rad", "rotation since the start, for the eye"),
    Row("travel", "m", "suspension travel from the static position, compression positive"),
    Row("travel_rate", "m/s", "of the suspension"),
    Row("slip_ratio", "1", "longitudinal slip that the contact patch has taken up"),
    Row("slip_tangent", "1", "tangent of the side-slip that the contact patch has taken up"),
    Row("load", "N", "vertical tyre force, along the road's normal"),
    Row("longitudinal_force", "N", "tyre force along the wheel's heading"),
    Row("lateral_force", "N", "tyre force to the left of the wheel's heading"),
    Row("aligning_torque", "Nm", "tyre torque about the road's normal"),
)
(OMEGA, ROTATION, TRAVEL, TRAVEL_RATE, KAPPA, ALPHA, F_Z, F_X, F_Y, M_Z) = range(len(WHEEL))

# Ground under each wheel: the plane z = height + slope_x x + slope_y y, and its friction.
GROUND = (
    Row("height", "m", "of the road's plane at the world's origin"),
    Row("slope_x", "1", "rise of the road to the east"),
    Row("slope_y", "1", "rise of the road to the north"),
    Row("friction", "1", "relative to the tyre's test track"),
)
(HEIGHT, SLOPE_X, SLOPE_Y, MU) = range(len(GROUND))

# Changes of the road: each begins and ends at a moment, which is a time or a place that a vehicle passes.
MOMENT = (
    Row("time", "s", "infinite when a vehicle makes it"),
    Row("vehicle", "1", "column of the vehicle, -1 when there is none"),
    Row("station", "m", "on the path of this vehicle"),
)
(WHEN, BY, AT) = range(len(MOMENT))
BEFORE, ACTING, OVER = range(3)  # phases of a change

# Lines: the paths that vehicles may take.
LINE = (
    Row("first", "1", "column of its first point"),
    Row("count", "1", "of its points"),
    Row("first_stop", "1", "its first stop line"),
    Row("stops", "1", "number of its stop lines"),
    Row("first_object", "1", "first object that stands in its way"),
    Row("objects", "1", "number of them"),
)
(LINE_FIRST, LINE_COUNT, LINE_STOP, LINE_STOPS, LINE_OBJECT, LINE_OBJECTS) = range(len(LINE))

# Pieces of slippery stretches.
PIECE = (
    Row("x", "m", "middle of the piece"),
    Row("y", "m", "middle of the piece"),
    Row("heading", "rad", "of the route there"),
    Row("left", "m", "how far it reaches to the left"),
    Row("right", "m", "how far it reaches to the right"),
    Row("friction", "1", "relative to the tyre's test track"),
    Row("world", "1", "number of the world"),
    Row("change", "1", "number of the change that it belongs to"),
    Row("acts", "1", "1 while this change does"),
)
(
    PIECE_X, PIECE_Y, PIECE_HEADING, PIECE_LEFT, PIECE_RIGHT, PIECE_FRICTION, PIECE_WORLD, PIECE_CHANGE, PIECE_ACTS,
) = range(len(PIECE))  # fmt: skip

# Objects on the road: boxes at rest.
OBSTACLE = (
    Row("x", "m", "middle of the object"),
    Row("y", "m", "middle of the object"),
    Row("heading", "rad", "of its length"),
    Row("length", "m", "of the object"),
    Row("width", "m", "of the object"),
    Row("kind", "1", "0 a cone, 1 a barrier"),
    Row("change", "1", "number of the change that it belongs to"),
)
(O_X, O_Y, O_HEADING, O_LENGTH, O_WIDTH, O_KIND, O_CHANGE) = range(len(OBSTACLE))
CONE, BARRIER = range(2)
OBJECT = -2  # where a column of a vehicle may stand, object i is OBJECT - i; -1 is nothing

# Objects that a vehicle on its path may run into.
SWEEP = (
    Row("station", "m", "at which the path comes to it"),
    Row("aside", "m", "from the path to its near edge"),
    Row("object", "1", "number of the object"),
)
(SWEPT_AT, SWEPT_ASIDE, SWEPT_OBJECT) = range(len(SWEEP))

# Scratch: what one pass hands to the next within a step, per wheel; directions in the body's axes.
CONTACT = (
    Row("forward_x", "1", "wheel heading in the road's plane"),
    Row("forward_y", "1", "wheel heading in the road's plane"),
    Row("forward_z", "1", "wheel heading in the road's plane"),
    Row("left_x", "1", "left of it in the road's plane"),
    Row("left_y", "1", "left of it in the road's plane"),
    Row("left_z", "1", "left of it in the road's plane"),
    Row("normal_x", "1", "the road's normal"),
    Row("normal_y", "1", "the road's normal"),
    Row("normal_z", "1", "the road's normal"),
    Row("arm_x", "m", "centre of gravity to contact point"),
    Row("arm_y", "m", "centre of gravity to contact point"),
    Row("arm_z", "m", "centre of gravity to contact point"),
    Row("slip_used", "1", "longitudinal slip with the damping at rest"),
    Row("tangent_used", "1", "side-slip tangent with the damping at rest"),
    Row("camber", "1", "sine of the camber against the road"),
    Row("slip_per_spin", "s", "change of the slip with the wheel's spin within the step"),
    Row("spin_slope", "N s", "change of the longitudinal force with the wheel's spin"),
    Row("rolling_torque", "Nm", "rolling resistance, a friction"),
    Row("peak_force", "N", "greatest longitudinal force of the tyre at this load"),
)
(
    T_X, T_Y, T_Z, L_X, L_Y, L_Z, N_X, N_Y, N_Z, R_X, R_Y, R_Z, KAPPA_USED, ALPHA_USED, GAMMA, SLIP_SPIN, SPIN_SLOPE,
    ROLLING, PEAK,
) = range(len(CONTACT))  # fmt: skip

# Parameters: what stays fixed during a run.
CURVE = 12  # knots of the engine's full-load curve
PARAMETER = (
    Row("mass", "kg", "whole vehicle with crew"),
    Row("sprung_mass", "kg", "without the wheels' vertical motion"),
    Row("roll_inertia", "kg m²", "of the body about its x axis"),
    Row("pitch_inertia", "kg m²", "of the body about its y axis"),
    Row("yaw_inertia", "kg m²", "of the whole vehicle about its z axis"),
    Row("front_distance", "m", "centre of gravity to front axle"),
    Row("rear_distance", "m", "centre of gravity to rear axle"),
    Row("gravity_height", "m", "centre of gravity above ground"),
    Row("front_track", "m", "between the front wheels"),
    Row("rear_track", "m", "between the rear wheels"),
    Row("unsprung_front", "kg", "one front wheel"),
    Row("unsprung_rear", "kg", "one rear wheel"),
    Row("spring_front", "N/m", "at one front wheel"),
    Row("spring_rear", "N/m", "at one rear wheel"),
    Row("damper_front", "N s/m", "at one front wheel"),
    Row("damper_rear", "N s/m", "at one rear wheel"),
    Row("anti_roll_front", "N/m", "force at each front wheel per difference of travel"),
    Row("anti_roll_rear", "N/m", "force at each rear wheel per difference of travel"),
    Row("link_front", "1", "vertical link force per lateral force, front"),
    Row("link_rear", "1", "vertical link force per lateral force, rear"),
    Row("camber_front", "rad", "static, front"),
    Row("camber_rear", "rad", "static, rear"),
    Row("camber_gain_front", "rad/m", "per travel, front"),
    Row("camber_gain_rear", "rad/m", "per travel, rear"),
    Row("static_front", "N", "load of one front wheel at rest on the level"),
    Row("static_rear", "N", "load of one rear wheel at rest on the level"),
    Row("tyre_stiffness_front", "N/m", "vertical, front"),
    Row("tyre_stiffness_rear", "N/m", "vertical, rear"),
    Row("tyre_damping", "N s/m", "vertical"),
    Row("wheel_radius", "m", "effective rolling radius"),
    Row("wheel_inertia_front", "kg m²", "spin of one front wheel"),
    Row("wheel_inertia_rear", "kg m²", "spin of one rear wheel"),
    Row("rest_slip_front", "1", "slip at which the patch slides at rest, front"),
    Row("rest_slip_rear", "1", "slip at which the patch slides at rest, rear"),
    Row("rest_tangent_front", "1", "side-slip tangent at which the patch slides at rest, front"),
    Row("rest_tangent_rear", "1", "side-slip tangent at which the patch slides at rest, rear"),
    Row("rest_damping", "s", "damping of the contact patch at rest, over its stiffness"),
    Row("rolling_resistance", "1", "rolling resistance over load"),
    Row("steering_ratio", "1", "steering wheel over road wheel angle"),
    Row("steering_max", "rad", "of the road wheels"),
    Row("steering_rate_max", "rad/s", "of the road wheels"),
    Row("steering_time", "s", "time constant of the steering"),
    Row("steering_inertia", "kg m²", "about the steering wheel's axis"),
    Row("steering_damping", "Nm s/rad", "about the steering wheel's axis"),
    Row("steering_trail", "m", "mechanical trail"),
    Row("steering_unassisted", "1", "part of the aligning torque that the steering wheel feels"),
    Row("brake_gain", "Nm/Pa", "brake torque, sum of the wheels, over pressure"),
    Row("brake_front_share", "1", "part of the brake torque that goes to the front axle"),
    Row("brake_torque_max", "Nm", "at the wheels"),
    Row("brake_time", "s", "time constant of the brake"),
    Row("brake_delay", "s", "dead time of the brake"),
    Row("engine_inertia", "kg m²", "with flywheel"),
    Row("idle_speed", "rad/s", "of the engine"),
    Row("limit_speed", "rad/s", "of the engine"),
    Row("drag_torque", "Nm", "of the engine, pedal lifted"),
    Row("drag_slope", "Nm s/rad", "growth of the drag with speed"),
    Row("regeneration", "Nm", "braking torque of the motor on request"),
    Row("drive_time", "s", "time constant of the drive"),
    Row("drive_delay", "s", "dead time of the drive"),
    Row("knot", "rad/s", "spacing of the knots of the full-load curve"),
    *(Row(f"curve_{i}", "Nm", "full-load curve: torque at standstill, then the changes of its slope") for i in range(CURVE)),
    Row("clutch_capacity", "Nm", "of the closed clutch or lock-up"),
    Row("launch_speed", "rad/s", "of the engine while a clutch slips at full load"),
    Row("lock_up_speed", "rad/s", "of the turbine, above which the lock-up closes"),
    Row("coupling_kind", "1", "0 rigid, 1 clutch, 2 converter"),
    Row("pump_1", "Nm s²", "converter, times engine speed squared"),
    Row("pump_2", "Nm s²", "converter, times both speeds"),
    Row("pump_3", "Nm s²", "converter, times turbine speed squared"),
    Row("turbine_1", "Nm s²", "converter, times engine speed squared"),
    Row("turbine_2", "Nm s²", "converter, times both speeds"),
    Row("turbine_3", "Nm s²", "converter, times turbine speed squared"),
    Row("fluid_1", "Nm s²", "fluid coupling, times engine speed squared"),
    Row("fluid_2", "Nm s²", "fluid coupling, times both speeds"),
    Row("fluid_3", "Nm s²", "fluid coupling, times turbine speed squared"),
    Row("coupling_ratio", "1", "speed ratio above which the converter is a fluid coupling"),
    Row("loss_torque", "Nm", "of the gearbox at its input"),
    Row("loss_share", "1", "of the gearbox, over transmitted torque"),
    Row("drive_front_share", "1", "part of the drive torque that goes to the front axle"),
    Row("drag_coefficient", "1", "air drag"),
    Row("frontal_area", "m²", "air drag"),
    Row("length", "m", "body"),
    Row("width", "m", "body"),
    Row("front_overhang", "m", "centre of gravity to front bumper"),
    Row("front_stiffness", "N/rad", "cornering stiffness of the front axle, for the driver's feed-forward"),
)
(
    MASS, MASS_S, J_X, J_Y, J_Z, L_F, L_R, H, TRACK_F, TRACK_R, M_UF, M_UR, K_F, K_R, D_F, D_R, ARB_F, ARB_R, LINK_F, LINK_R,
    CAMBER_F, CAMBER_R, GAIN_F, GAIN_R, STATIC_F, STATIC_R, K_TF, K_TR, D_T, RADIUS, J_WF, J_WR, REST_KF, REST_KR, REST_AF,
    REST_AR, REST_DAMPING, C_ROLL, STEER_RATIO, STEER_MAX, STEER_RATE, TAU_STEER, J_STEER, D_STEER, TRAIL, UNASSISTED, K_BRAKE,
    BRAKE_SHARE, BRAKE_MAX, TAU_BRAKE, DELAY_BRAKE, J_E, IDLE, LIMIT, DRAG, DRAG_SLOPE, REGEN, TAU_DRIVE, DELAY_DRIVE, KNOT,
) = range(60)  # fmt: skip
CURVE_0 = 60
(
    CAPACITY, LAUNCH, LOCK_UP, COUPLING, PUMP_1, PUMP_2, PUMP_3, TURBINE_1, TURBINE_2, TURBINE_3, FLUID_1, FLUID_2, FLUID_3,
    FLUID_RATIO, LOSS_TORQUE, LOSS_SHARE, DRIVE_SHARE, C_D, AREA, LENGTH, WIDTH, FRONT, C_FRONT,
) = range(CURVE_0 + CURVE, len(PARAMETER))  # fmt: skip

# The gearbox, one row for each gear from reverse upwards: row = quantity * GEARS + gear + 1.
GEARS = 10  # reverse, neutral and eight gears
GEARBOX = (
    Row("gear_ratio", "1", "with the final drive; negative for reverse, 0 for neutral or a gear that does not exist"),
    Row("gear_inertia", "kg m²", "at the input"),
    Row("disengage_time", "s", "to open the clutch in this gear"),
    Row("open_time", "s", "that the clutch stays open to engage this gear"),
    Row("engage_time", "s", "to close the clutch in this gear"),
    Row("up_light", "rad/s", "shift up above, pedal just touched"),
    Row("up_full", "rad/s", "shift up above, full pedal"),
    Row("down_light", "rad/s", "shift down below, pedal just touched"),
    Row("down_full", "rad/s", "shift down below, full pedal"),
)
(G_RATIO, G_INERTIA, G_DISENGAGE, G_OPEN, G_ENGAGE, G_UP_LIGHT, G_UP_FULL, G_DOWN_LIGHT, G_DOWN_FULL) = range(len(GEARBOX))

DRIVER = (
    Row("acceleration", "m/s²", "comfortable acceleration"),
    Row("deceleration", "m/s²", "comfortable deceleration"),
    Row("time_headway", "s", "wanted headway"),
    Row("standstill_gap", "m", "wanted gap at rest"),
    Row("speed_factor", "1", "wanted speed over the permitted one"),
    Row("steering_gain", "1/s", "how fast an offset is steered away"),
    Row("yaw_damping", "s", "how much a wrong yaw rate is corrected"),
    Row("sight", "m", "how far the weather lets the driver see"),
    Row("sight_speed", "m/s", "from which the driver stops within sight"),
)
(COMFORT, BRAKE_COMFORT, HEADWAY, STANDSTILL, SPEED_FACTOR, STEER_GAIN, YAW_DAMPING, SIGHT, SIGHT_SPEED) = range(len(DRIVER))

# What a driver knows and wants at this tick.
MIND = (
    Row("station", "m", "arc length along the own path"),
    Row("lateral_offset", "m", "offset from the own path, left positive"),
    Row("path_curvature", "1/m", "curvature of the path at the car"),
    Row("heading_error", "rad", "heading minus path heading at the front axle"),
    Row("front_offset", "m", "offset of the front axle from the path"),
    Row("desired_speed", "m/s", "speed that route and bends permit"),
    Row("gap", "m", "bumper to bumper, to the vehicle or object ahead on the own path; not a number when there is none"),
    Row("ahead_speed", "m/s", "speed of what is ahead"),
    Row("ahead", "1", "column of the vehicle ahead, or OBJECT - i; -1 when there is none"),
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
# What is not commanded is not a number.
COMMAND = (
    Row("requested_acceleration", "m/s²", "what driver, application or maneuver ask for"),
    Row("requested_steering", "rad", "road wheel angle"),
    Row("requested_steering_torque", "Nm", "at the steering wheel; instead of the angle"),
    Row("requested_drive", "Nm", "drive torque at the wheels, through the powertrain"),
    Row("requested_accelerator", "1", "pedal position; instead of the drive torque"),
    Row("requested_engine", "Nm", "engine torque; instead of both"),
    Row("requested_brake", "Nm", "brake torque, sum of the wheels"),
    Row("requested_gear", "1", "-1 reverse, 0 neutral, 1 first; else the gearbox shifts by itself"),
    Row("applied_drive", "Nm", "put on the wheels past the powertrain, as a test stand does; 0 on the road"),
    Row("applied_brake", "Nm", "put on the wheels past the brake, as a test stand does; 0 on the road"),
)
(U, U_STEER, U_STEER_TORQUE, U_DRIVE, U_PEDAL, U_ENGINE, U_BRAKE, U_GEAR, U_APPLIED, U_APPLIED_BRAKE) = range(len(COMMAND))
RING = 64  # past ticks that commands and messages are kept; bounds dead times and radio delays

SENSOR = (
    Row("detected", "1", "1 when the front sensor has a target"),
    Row("range", "m", "front bumper to the target's rear"),
    Row("range_rate", "m/s", "change of the range"),
    Row("azimuth", "rad", "direction of the target, left positive"),
    Row("target", "1", "column of the target, or OBJECT - i, for the record only"),
    Row("drift_east", "1", "slow error of the satellite position, over its standard deviation"),
    Row("drift_north", "1", "slow error of the satellite position, over its standard deviation"),
    Row("gps_error_east", "m", "measured minus true position"),
    Row("gps_error_north", "m", "measured minus true position"),
)
(DETECTED, RANGE, RANGE_RATE, AZIMUTH, TARGET, DRIFT_EAST, DRIFT_NORTH, GPS_EAST, GPS_NORTH) = range(len(SENSOR))

SENSOR_SET = (
    Row("range", "m", "reach"),
    Row("opening_angle", "rad", "whole angle"),
    Row("range_noise", "m", "standard deviation"),
    Row("rate_noise", "m/s", "standard deviation"),
)
(REACH, OPENING, RANGE_SIGMA, RATE_SIGMA) = range(len(SENSOR_SET))

GPS_SET = (
    Row("drift", "m", "standard deviation of the slow error under an open sky"),
    Row("correlation_time", "s", "of the slow error"),
    Row("noise", "m", "standard deviation of the white noise"),
    Row("canyon_factor", "1", "by how much the slow error is larger where no sky is open"),
)
(DRIFT_SIGMA, DRIFT_TIME, GPS_SIGMA, CANYON) = range(len(GPS_SET))

RADIO_SET = (
    Row("period", "s", "between two messages of a unit"),
    Row("delay", "s", "mean"),
    Row("delay_variation", "s", "half width"),
    Row("loss", "1", "rate"),
    Row("loss_per_metre", "1/m", "growth of the loss with distance"),
    Row("range", "m", "beyond it nothing is heard"),
    Row("buildings", "1", "1 where they weaken the signal"),
    Row("path_loss_exponent", "1", "power falls with distance to this power"),
)
(PERIOD, DELAY, VARIATION, LOSS, LOSS_DISTANCE, RADIO_RANGE, BUILDINGS, EXPONENT) = range(len(RADIO_SET))

MESSAGE = (
    Row("sent", "s", "time of sending"),
    Row("x", "m", "position of the sender"),
    Row("y", "m", "position of the sender"),
    Row("speed", "m/s", "speed of the sender"),
    Row("acceleration", "m/s²", "acceleration of the sender"),
    Row("intention", "m/s²", "acceleration that the sender has requested of its actuators"),
    Row("true_x", "m", "where the antenna was; for the radio, not for the receiver"),
    Row("true_y", "m", "where the antenna was; for the radio, not for the receiver"),
)
(SENT, M_X, M_Y, M_SPEED, M_ACCELERATION, M_INTENTION, M_TRUE_X, M_TRUE_Y) = range(len(MESSAGE))

COLLISION = (
    Row("time", "s", "of the first contact"),
    Row("first", "1", "column of one vehicle"),
    Row("second", "1", "column of the other, or OBJECT - i"),
    Row("impact_speed", "m/s", "relative speed at contact"),
)
(HIT_TIME, HIT_FIRST, HIT_SECOND, HIT_SPEED) = range(len(COLLISION))
