"""Our signals: what of a recorded drive is used, in which unit, and between what a passenger car, or a truck, can have it.

Axes are ISO 8855: x forward, y left, z up. A value outside the range is no drive but a wrong unit, sign or sensor, and is refused.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Quantity:
    """One of our signals: unit, range that a road vehicle can have, and meaning. `column` is its name on the rig, where it has one."""

    unit: str
    low: float
    high: float
    meaning: str
    column: str = ""


QUANTITIES = {
    "speed": Quantity("m/s", -20.0, 110.0, "forward speed", "vx_mps"),
    "lateral_speed": Quantity("m/s", -20.0, 20.0, "speed to the left", "vy_mps"),
    "acceleration": Quantity("m/s²", -20.0, 20.0, "forward acceleration", "ax_mps2"),
    "lateral_acceleration": Quantity("m/s²", -25.0, 25.0, "acceleration to the left", "ay_mps2"),
    "yaw_rate": Quantity("rad/s", -4.0, 4.0, "turning left", "yaw_rate_radps"),
    "roll_rate": Quantity("rad/s", -6.0, 6.0, "right side down", "roll_rate_radps"),
    "steering_wheel_angle": Quantity("rad", -20.0, 20.0, "steering wheel, turned left", "steering_wheel_angle_rad"),
    "road_wheel_angle": Quantity("rad", -1.3, 1.3, "road wheels, turned left", "road_wheel_angle_rad"),
    "throttle": Quantity("1", -0.05, 1.05, "accelerator pedal", "throttle"),
    "brake": Quantity("1", -0.05, 1.05, "brake pedal", "brake"),
    "brake_torque": Quantity("Nm", -100.0, 500_000.0, "sum at the wheels", "brake_torque_Nm"),
    "engine_torque_request": Quantity("Nm", -10_000.0, 10_000.0, "what is asked of the engine", "engine_torque_request_Nm"),
    "drive_torque": Quantity("Nm", -200_000.0, 200_000.0, "sum at the wheels", "drive_torque_Nm"),
    "engine_speed": Quantity("rad/s", -50.0, 2500.0, "crankshaft", "engine_speed_radps"),
    "gear": Quantity("1", -1.0, 12.0, "-1 reverse, 0 neutral, 1 first ..."),
    "clutch": Quantity("1", -0.05, 1.05, "1 closed, 0 open", "clutch"),
    "x": Quantity("m", -1e7, 1e7, "position east", "x_m"),
    "y": Quantity("m", -1e7, 1e7, "position north", "y_m"),
}
