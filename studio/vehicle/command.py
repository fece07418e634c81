"""Commands: what the actuators are asked for, one column per vehicle and slot of the ring of past ticks.

What is not commanded is not a number.
"""

from studio.rows import Role, Table

RING = 64  # past ticks that commands and messages are kept; bounds dead times and radio delays

COMMAND = Table("command", Role.COMMAND, per="vehicle and tick of the ring")
U = COMMAND.row("requested_acceleration", "m/s²", "what driver, application or maneuver ask for", label="Requested acceleration")
U_STEER = COMMAND.row("requested_steering", "rad", "road wheel angle")
U_STEER_TORQUE = COMMAND.row("requested_steering_torque", "Nm", "at the steering wheel; instead of the angle")
U_DRIVE = COMMAND.row("requested_drive", "Nm", "drive torque at the wheels, through the powertrain")
U_PEDAL = COMMAND.row("requested_accelerator", "1", "pedal position; instead of the drive torque")
U_ENGINE = COMMAND.row("requested_engine", "Nm", "engine torque; instead of both")
U_BRAKE = COMMAND.row("requested_brake", "Nm", "brake torque, sum of the wheels")
U_GEAR = COMMAND.row("requested_gear", "1", "-1 reverse, 0 neutral, 1 first; else the gearbox shifts by itself")
U_APPLIED = COMMAND.row("applied_drive", "Nm", "put on the wheels past the powertrain, as a test stand does; 0 on the road")
U_APPLIED_BRAKE = COMMAND.row("applied_brake", "Nm", "put on the wheels past the brake, as a test stand does; 0 on the road")
