"""How a signal weakens on its way: by distance, by the ground, by buildings. Losses are in dB, what is lost of the power that was sent.

Free space (H. T. Friis, Proc. IRE 34, 1946), with the wavelength lambda:

    L = 20 lg(4 pi d/lambda)

One, two or three slopes: free space up to 1 m, then n_1 up to the first break, n_2 up to the second, n_3 beyond:

    L(d) = L(d_i) + 10 n_i lg(d/d_i)      from break d_i on

(one slope: T. S. Rappaport, Wireless Communications, 2nd ed., 2002, section 4.9; two, measured between cars: L. Cheng et al., IEEE JSAC 25,
2007: 2.1 and 3.8, break at 100 m; three: the network simulator ns-3, 1.9, 3.8 and 3.8, breaks at 200 m and 500 m).

Two rays, one direct, one from the ground, which interfere (C. Sommer, S. Joerer, F. Dressler, On the applicability of two-ray path loss
models for vehicular network simulation, VNC 2012), antennas at the heights h_t and h_r, relative permittivity eps_r of the ground:

    d_dir = sqrt(d² + (h_t - h_r)²)       d_ref = sqrt(d² + (h_t + h_r)²)       phi = 2 pi (d_dir - d_ref)/lambda
    sin(theta) = (h_t + h_r)/d_ref        cos(theta) = d/d_ref
    Gamma = (sin(theta) - sqrt(eps_r - cos²(theta))) / (sin(theta) + sqrt(eps_r - cos²(theta)))
    L = 20 lg(4 pi d/lambda · |1 + Gamma e^(i phi)|^-1)

Buildings take A = 9 dB a wall and 0.4 dB a metre inside (C. Sommer, D. Eckhoff, R. German, F. Dressler, A computationally inexpensive
empirical model of IEEE 802.11p radio shadowing in urban environments, WONS 2011). Where power falls with distance as d^-n, that is as much
as a distance of d · 10^(A/(10 n)) without buildings.
"""

from math import cos, log, log10, pi, sin, sqrt

from studio.compiled import compiled

LIGHT = 299792458.0  # [m/s]
CLOSEST = 1.0  # [m] no antenna is nearer to another
WALL_LOSS = 9.0  # [dB]
METRE_LOSS = 0.4  # [dB/m]
DECIBEL = 10.0 / log(10.0)  # of a power e times as large


@compiled
def wavelength(frequency):
    """Of a frequency [Hz], in metres."""
    return LIGHT / frequency


@compiled
def free_space(distance, lambda_):
    """Loss [dB] over a distance [m] at a wavelength [m]."""
    return 20.0 * log10(4.0 * pi * max(distance, CLOSEST) / lambda_)


@compiled
def slopes(distance, closest, n_1, n_2, n_3, first, second):
    """Loss [dB], `closest` at 1 m, with exponent n_1 up to the first break [m], n_2 up to the second, n_3 beyond.

    Equal exponents are one slope; with a second break that is not reached there are two.
    """
    d = max(distance, CLOSEST)
    if d <= first:
        return closest + DECIBEL * n_1 * log(d)
    if d <= second:
        return closest + DECIBEL * (n_1 * log(first) + n_2 * log(d / first))
    return closest + DECIBEL * (n_1 * log(first) + n_2 * log(second / first) + n_3 * log(d / second))


@compiled
def two_ray(distance, lambda_, h_t, h_r, eps_r):
    """Loss [dB] with a ray from the ground, antennas at h_t and h_r [m]."""
    d = max(distance, CLOSEST)
    d_dir, d_ref = sqrt(d * d + (h_t - h_r) ** 2), sqrt(d * d + (h_t + h_r) ** 2)
    phi = 2.0 * pi * (d_dir - d_ref) / lambda_
    sin_theta, cos_theta = (h_t + h_r) / d_ref, d / d_ref
    root = sqrt(max(eps_r - cos_theta * cos_theta, 0.0))
    gamma = (sin_theta - root) / (sin_theta + root)
    power = (1.0 + gamma * cos(phi)) ** 2 + (gamma * sin(phi)) ** 2
    return free_space(d, lambda_) - 10.0 * log10(max(power, 1e-12))


@compiled
def attenuation(walls, inside):
    """What buildings take from a signal [dB]: walls crossed, metres inside."""
    return WALL_LOSS * walls + METRE_LOSS * inside


@compiled
def screened(walls, inside, decks, buildings, deck_loss):
    """What buildings, where they count, and decks of bridges and tunnels take from a signal [dB]."""
    weakened = deck_loss * decks
    if buildings > 0.0:
        weakened += attenuation(walls, inside)
    return weakened


@compiled
def felt_distance(distance, weakened, exponent):
    """Distance [m] at which a signal would be as weak without buildings; `weakened` is their attenuation [dB]."""
    return distance * 10.0 ** (weakened / (10.0 * exponent))
