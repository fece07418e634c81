"""What theory says of a platoon: the transfer function from the speed of one car to that of the next, over frequency.

    actuated(tau, phi)                 A(s) = e^(-phi s)/(tau s + 1)        from a request to the acceleration
    ploeg(A, ...)                      (D + A K/s²)/(H (1 + A K/s²))        K = k_p + k_d s, H = h s + 1
    least_headway(gain)                the least h whose gain is nowhere above 1

J. Ploeg, N. van de Wouw, H. Nijmeijer, Lp string stability of cascaded systems, IEEE Trans. Control Systems Technology 22 (2014) 786,
Eq. 26. D is what feeds forward: e^(-theta s) for the request of the car ahead, theta [s] old; A for its acceleration as it is; 0 without.
Any A may be given, one that was measured too. In the limit s → 0 all gains are 1.
"""

from collections.abc import Callable

import numpy as np

FREQUENCIES = np.geomspace(0.005, 1.0, 400)  # [Hz]
TOLERANCE = 1e-9  # [1] above 1 that is not yet counted as growing
LONGEST = 8.0  # [s] headway
Gain = Callable[[float], np.ndarray]


def laplace(frequency=FREQUENCIES) -> np.ndarray:
    """s [1/s] at frequencies [Hz]."""
    return 2j * np.pi * np.asarray(frequency)


def actuated(tau: float, phi: float, frequency=FREQUENCIES) -> np.ndarray:
    """A: drive and brakes as a lag tau [s] behind a dead time phi [s]."""
    s = laplace(frequency)
    return np.exp(-phi * s) / (tau * s + 1.0)


def delayed(theta: float, frequency=FREQUENCIES) -> np.ndarray:
    """D of a message that is theta [s] old."""
    return np.exp(-theta * laplace(frequency))


def ploeg(A, D, headway: float, *, k_p: float = 0.2, k_d: float = 0.7, frequency=FREQUENCIES) -> np.ndarray:
    """V_i/V_{i-1} of Ploeg's law with a headway [s]."""
    s = laplace(frequency)
    loop = A * (k_p + k_d * s) / (s * s)
    return (D + loop) / ((headway * s + 1.0) * (1.0 + loop))


def least_headway(gain: Gain) -> float:
    """The least headway [s] at which no frequency grows, to a millisecond; `gain` gives |V_i/V_{i-1}| over frequency for a headway [s]."""
    low, high = 0.0, LONGEST
    while high - low > 1e-3:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if gain(middle).max() <= 1.0 + TOLERANCE else (middle, high)
    return high
