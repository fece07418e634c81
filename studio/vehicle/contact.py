"""Between wheel and road: the ground that a wheel stands on, and what one pass hands to the next within a step.

Columns are corner · vehicles + vehicle; directions are in the body's axes.
"""

from studio.rows import Role, Table

# The plane z = height + slope_x x + slope_y y under each wheel, and its friction.
GROUND = Table("ground", Role.DERIVED, per="wheel")
HEIGHT = GROUND.row("height", "m", "of the road's plane at the world's origin")
SLOPE_X = GROUND.row("slope_x", "1", "rise of the road to the east")
SLOPE_Y = GROUND.row("slope_y", "1", "rise of the road to the north")
MU = GROUND.row("friction", "1", "relative to the tyre's test track")

CONTACT = Table("contact", Role.SCRATCH, per="wheel")
T_X = CONTACT.row("forward_x", "1", "wheel heading in the road's plane")
T_Y = CONTACT.row("forward_y", "1", "wheel heading in the road's plane")
T_Z = CONTACT.row("forward_z", "1", "wheel heading in the road's plane")
L_X = CONTACT.row("left_x", "1", "left of it in the road's plane")
L_Y = CONTACT.row("left_y", "1", "left of it in the road's plane")
L_Z = CONTACT.row("left_z", "1", "left of it in the road's plane")
N_X = CONTACT.row("normal_x", "1", "the road's normal")
N_Y = CONTACT.row("normal_y", "1", "the road's normal")
N_Z = CONTACT.row("normal_z", "1", "the road's normal")
R_X = CONTACT.row("arm_x", "m", "centre of gravity to contact point")
R_Y = CONTACT.row("arm_y", "m", "centre of gravity to contact point")
R_Z = CONTACT.row("arm_z", "m", "centre of gravity to contact point")
KAPPA_USED = CONTACT.row("slip_used", "1", "longitudinal slip with the damping at rest")
ALPHA_USED = CONTACT.row("tangent_used", "1", "side-slip tangent with the damping at rest")
GAMMA = CONTACT.row("camber", "1", "sine of the camber against the road")
SLIP_SPIN = CONTACT.row("slip_per_spin", "s", "change of the slip with the wheel's spin within the step")
SPIN_SLOPE = CONTACT.row("spin_slope", "N s", "change of the longitudinal force with the wheel's spin")
ROLLING = CONTACT.row("rolling_torque", "Nm", "rolling resistance, a friction")
PEAK = CONTACT.row("peak_force", "N", "greatest longitudinal force of the tyre at this load")
