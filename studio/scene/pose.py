"""Layout of the array that moves the vehicles: float32[POSE_ROWS, vehicle].

The origin of a vehicle is the point of the road plane below its reference point (see Dimensions.front_axle).
"""

import numpy as np

# position [m], local east-north-up frame
X, Y, Z = 0, 1, 2
# orientation [rad], ISO 8855: yaw counter-clockwise, roll to the right and pitch nose-down positive
YAW, ROLL, PITCH = 3, 4, 5
# steer angle of the front wheels [rad], rotation of the wheels since the start [rad]
STEER, WHEEL_ANGLE = 6, 7
# 1: shown, 0: hidden
VISIBLE = 8
# of the road as it is drawn, along the vehicle [rad], nose-down positive as its pitch
TILT = 9
POSE_ROWS = 10


def standing(count: int) -> np.ndarray:
    """Poses of `count` visible vehicles at the origin, float32[POSE_ROWS, count]."""
    poses = np.zeros((POSE_ROWS, count), np.float32)
    poses[VISIBLE] = 1.0
    return poses
