"""Random numbers by counter: Philox 4x32 with 10 rounds.

Source: J. K. Salmon et al., Parallel random numbers: as easy as 1, 2, 3, SC 2011. A number depends on nothing but
(seed, entity, stream, tick): not on the order of calls, the number of threads, or a world's place in a batch. Worlds of
one batch that are to differ by chance have different seeds.
"""

from math import cos, log, pi, sin, sqrt

import numpy as np

from studio.compiled import compiled

MULTIPLY_A, MULTIPLY_B = np.uint64(0xD2511F53), np.uint64(0xCD9E8D57)
WEYL_A, WEYL_B = np.uint64(0x9E3779B9), np.uint64(0xBB67AE85)
LOW, HALF = np.uint64(0xFFFFFFFF), np.uint64(32)

# Streams: one per purpose, so that switching noise on in one place changes nothing elsewhere.
(
    RANGE_NOISE, RATE_NOISE, MESSAGE_LOSS, MESSAGE_DELAY, TRAFFIC_ROUTE, TRAFFIC_PLACE, TRAFFIC_STYLE, GPS_DRIFT, GPS_NOISE, TRIP,
    BUS_NOISE,
) = range(11)  # fmt: skip


@compiled
def philox(c0, c1, c2, c3, k0, k1):
    """Four 32-bit words (in uint64) from a counter of four and a key of two."""
    c0, c1, c2, c3 = np.uint64(c0), np.uint64(c1), np.uint64(c2), np.uint64(c3)
    k0, k1 = np.uint64(k0), np.uint64(k1)
    for _ in range(10):
        p0 = MULTIPLY_A * c0
        p1 = MULTIPLY_B * c2
        c0, c1, c2, c3 = (p1 >> HALF) ^ c1 ^ k0, p1 & LOW, (p0 >> HALF) ^ c3 ^ k1, p0 & LOW
        k0 = (k0 + WEYL_A) & LOW
        k1 = (k1 + WEYL_B) & LOW
    return c0, c1, c2, c3


@compiled
def unit(high, low):
    """Uniform in the open interval (0, 1) from 53 of 64 bits."""
    bits = (np.uint64(high) << np.uint64(21)) ^ (np.uint64(low) >> np.uint64(11))
    return (np.float64(bits) + 0.5) * 2.0**-53


@compiled
def uniform(seed, entity, stream, tick, about=0):
    """A number in (0, 1); `about` tells draws for several things apart."""
    a, b, _, _ = philox(tick, entity, stream, about, np.uint64(seed) & LOW, np.uint64(seed) >> HALF)
    return unit(a, b)


@compiled
def normal(seed, entity, stream, tick, about=0):
    """A number of the standard normal distribution (Box & Muller 1958); `about` tells draws for several things apart."""
    a, b, c, d = philox(tick, entity, stream, about, np.uint64(seed) & LOW, np.uint64(seed) >> HALF)
    return sqrt(-2.0 * log(unit(a, b))) * cos(2.0 * pi * unit(c, d))


@compiled
def normal_pair(seed, entity, stream, tick):
    """Two independent numbers of the standard normal distribution; the first is that of `normal`."""
    a, b, c, d = philox(tick, entity, stream, 0, np.uint64(seed) & LOW, np.uint64(seed) >> HALF)
    radius, angle = sqrt(-2.0 * log(unit(a, b))), 2.0 * pi * unit(c, d)
    return radius * cos(angle), radius * sin(angle)
