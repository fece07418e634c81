"""Axes, signs, symbols, units.

Axes      ISO 8855: x forward, y left, z up. The world is east-north-up; yaw is counter-clockwise from east.
Wheels    1 front left, 2 front right, 3 rear left, 4 rear right (columns 0 to 3 in the arrays).
Units     SI and radians everywhere inside; a unit stands in the name only at the borders (files, REST, charts).
Time      the world advances in ticks (20 ms); between ticks vehicles integrate in steps (5 ms) and do not meet.

Symbol        Word at the borders          Unit     Meaning
x, y, z       x, y, z                      m        position of the centre of gravity in the world
psi           heading                      rad      yaw angle, continuous
phi, theta    roll, pitch                  rad      angles about x (right side down positive) and y (nose down positive)
v_x, v_y      speed, lateral_speed         m/s      velocity of the centre of gravity in the body's axes
p, q, r       roll_rate, ..., yaw_rate     rad/s    angular velocity in the body's axes
a_x, a_y      acceleration, ...            m/s²     acceleration of the centre of gravity in the body's axes
delta         steering                     rad      angle of the road wheels, mean of left and right
omega         wheel_speed                  rad/s    spin of a wheel
kappa         slip_ratio                   1        longitudinal slip, (R omega - v_xw) / |v_xw|
alpha         slip_angle                   rad      side-slip of a wheel, atan(v_yw / |v_xw|); positive alpha, negative F_y
gamma         camber                       rad      lean of a wheel about its x axis against the road
F_x, F_y, F_z longitudinal_force, ..., load N       tyre forces: wheel heading, left of it, road normal (never negative)
M_z           aligning_torque              Nm       tyre torque about the road normal
mu            friction                     1        friction of the road over that of the tyre's test track
omega_e, T_e  engine_speed, engine_torque  rad/s, Nm
i             ratio                        1        gearbox times final drive
u_c           clutch                       1        transmissibility of clutch or lock-up
s, e          station, lateral_offset      m        arc length along the own path, offset from it (left positive)
kappa_p       path_curvature               1/m      curvature of the path (left positive)
h             headway                      s        time headway of a controller
u             requested_acceleration       m/s²     what a controller asks of the actuators
"""

GRAVITY = 9.81  # [m/s²] standard value, rounded as vehicle handbooks do
AIR_DENSITY = 1.293  # [kg/m³] Massow & Radusch 2018, Table 4

DEFAULT_STEP = 0.005  # [s] integration of one vehicle
DEFAULT_TICK = 0.02  # [s] vehicles, sensors, messages and applications meet
