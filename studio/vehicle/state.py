"""The state of vehicles and of their wheels, and what is derived from it at the end of a tick.

Columns of wheels are corner · vehicles + vehicle.
"""

from studio.rows import Role, Table

VEHICLE = Table("vehicle", Role.STATE, per="vehicle")
X = VEHICLE.row("x", "m", "east position of the centre of gravity", label="East position")
Y = VEHICLE.row("y", "m", "north position of the centre of gravity", label="North position")
Z = VEHICLE.row("z", "m", "height of the centre of gravity")
Q_W = VEHICLE.row("q_w", "1", "orientation, unit quaternion from the body's axes to the world's")
Q_X = VEHICLE.row("q_x", "1", "orientation")
Q_Y = VEHICLE.row("q_y", "1", "orientation")
Q_Z = VEHICLE.row("q_z", "1", "orientation")
V_EAST = VEHICLE.row("velocity_east", "m/s", "velocity of the centre of gravity in the world")
V_NORTH = VEHICLE.row("velocity_north", "m/s", "velocity of the centre of gravity in the world")
V_UP = VEHICLE.row("velocity_up", "m/s", "velocity of the centre of gravity in the world")
ROLL_RATE = VEHICLE.row("roll_rate", "rad/s", "about the body's x axis")
PITCH_RATE = VEHICLE.row("pitch_rate", "rad/s", "about the body's y axis")
YAW_RATE = VEHICLE.row("yaw_rate", "rad/s", "about the body's z axis", label="Yaw rate")
A_X = VEHICLE.row("acceleration", "m/s²", "along the body's x axis", role=Role.DERIVED, label="Acceleration")
A_Y = VEHICLE.row("lateral_acceleration", "m/s²", "along the body's y axis", role=Role.DERIVED, label="Lateral acceleration")
A_Z = VEHICLE.row("vertical_acceleration", "m/s²", "along the body's z axis", role=Role.DERIVED)
DELTA = VEHICLE.row("steering", "rad", "road wheel angle, mean of left and right", label="Road wheel angle")
DELTA_RATE = VEHICLE.row("steering_rate", "rad/s", "of the road wheel angle")
PRESSURE_F = VEHICLE.row("pressure_front", "Pa", "brake pressure, front")
PRESSURE_R = VEHICLE.row("pressure_rear", "Pa", "brake pressure, rear")
OMEGA_E = VEHICLE.row("engine_speed", "rad/s", "of engine or motor", label="Engine speed")
T_ENGINE = VEHICLE.row("engine_torque", "Nm", "at the shaft, negative when it brakes", label="Engine torque")
ACCELERATOR = VEHICLE.row("accelerator", "1", "pedal position that gives the torque asked for")
PEDAL_KEPT = VEHICLE.row(
    "accelerator_kept", "1", "pedal position by which the gearbox shifts up: pressed it counts at once, lifted it is forgotten slowly"
)
CLUTCH = VEHICLE.row("clutch", "1", "transmissibility of clutch or lock-up: 0 open, 1 closed")
CLUTCH_RATE = VEHICLE.row("clutch_rate", "1/s", "how fast it moves")
OPEN_TIME = VEHICLE.row("open_time", "s", "since when the clutch has been open for a shift")
GEAR = VEHICLE.row("gear", "1", "engaged gear: -1 reverse, 0 neutral, 1 first", label="Gear")
NEXT_GEAR = VEHICLE.row("next_gear", "1", "gear that is being shifted to")
RATIO = VEHICLE.row("ratio", "1", "of gearbox and final drive; 0 in neutral")
NEXT_RATIO = VEHICLE.row("next_ratio", "1", "of the gear that is being shifted to")
RATIO_RATE = VEHICLE.row("ratio_rate", "1/s", "how fast the ratio moves to it where a converter's clutches hand over; 0 where it jumps")
J_GEAR = VEHICLE.row("gear_inertia", "kg m²", "of the gearbox at its input")
TORQUE_DRIVE = VEHICLE.row("drive_torque", "Nm", "drive torque, sum of the wheels", label="Drive torque, sum of the wheels")
TORQUE_BRAKE = VEHICLE.row(
    "brake_torque", "Nm", "brake torque that the brakes can hold, sum of the wheels", role=Role.DERIVED,
    label="Brake torque, sum of the wheels",
)  # fmt: skip
PSI = VEHICLE.row("heading", "rad", "yaw angle, counter-clockwise from east, continuous", label="Heading")
ROLL = VEHICLE.row("roll", "rad", "about the x axis, right side down positive", role=Role.DERIVED, label="Roll angle")
PITCH = VEHICLE.row("pitch", "rad", "about the y axis, nose down positive", role=Role.DERIVED, label="Pitch angle")
V_X = VEHICLE.row("speed", "m/s", "velocity along the body's x axis", role=Role.DERIVED, label="Speed")
V_Y = VEHICLE.row("lateral_speed", "m/s", "velocity along the body's y axis", role=Role.DERIVED)
BEND_BEGUN = VEHICLE.row("bend_begun", "1/m", "curvature that a light vehicle has begun to take up; 0 of full ones")
BEND = VEHICLE.row("bend", "1/m", "curvature of the rear axle's way, which a light vehicle has taken up; 0 of full ones")
ACTIVE = VEHICLE.row("active", "1", "1 while the vehicle takes part, 0 once it has arrived")

WHEEL = Table("wheel", Role.STATE, per="wheel")
OMEGA = WHEEL.row("wheel_speed", "rad/s", "spin")
ROTATION = WHEEL.row("wheel_angle", "rad", "rotation since the start, for the eye")
TRAVEL = WHEEL.row("travel", "m", "suspension travel from the static position, compression positive")
TRAVEL_RATE = WHEEL.row("travel_rate", "m/s", "of the suspension")
KAPPA = WHEEL.row("slip_ratio", "1", "longitudinal slip that the contact patch has taken up")
ALPHA = WHEEL.row("slip_tangent", "1", "tangent of the side-slip that the contact patch has taken up")
F_Z = WHEEL.row("load", "N", "vertical tyre force, along the road's normal", role=Role.DERIVED)
F_X = WHEEL.row("longitudinal_force", "N", "tyre force along the wheel's heading")
F_Y = WHEEL.row("lateral_force", "N", "tyre force to the left of the wheel's heading", role=Role.DERIVED)
M_Z = WHEEL.row("aligning_torque", "Nm", "tyre torque about the road's normal", role=Role.DERIVED)
