"""Vehicle specific power on a level road: what a car's engine must give per mass, which fuel and emissions follow from.

    VSP = v (1.1 a + 0.132) + 0.000302 v³   [kW/t] with v [m/s], a [m/s²]

J. L. Jiménez-Palacios, Understanding and quantifying motor vehicle emissions with vehicle specific power, Massachusetts Institute of
Technology, 1999.
"""

KIND = "channel"
TITLE = "Vehicle specific power"
UNIT = "kW/t"
ROTATING = 1.1  # [1] rotating masses count as so much more mass
ROLLING = 0.132  # [m/s²] rolling resistance
DRAG = 0.000302  # [1/m] drag


def trace(read):
    """float64[vehicle, n] [kW/t]."""
    v, a = read("speed"), read("acceleration")
    return v * (ROTATING * a + ROLLING) + DRAG * v**3
