"""Random numbers by counter: Philox 4x32 with 10 rounds.

Source: J. K. Salmon et al., Parallel random numbers: as easy as 1, 2, 3, SC 2011. A number depends on nothing but
(seed, entity, stream, tick): not on the order of calls, the number of threads, or a world's place in a batch. Worlds of
one batch that are to differ by chance have different seeds.
"""

from math import cos, log, pi, sqrt

import numpy as np

from studio.compiled import compiled

MULTIPLY_A, MULTIPLY_B = np.uint64(0xD2511F53), np.uint64(0xCD9E8D57)
WEYL_A, WEYL_B = np.uint64(0x9E3779B9), np.uint64(0xBB67AE85)
LOW, HALF = np.uint64(0xFFFFFFFF), np.uint64(32)

# Streams: one per purpose, so that switching noise on in one place changes nothing elsewhere.
(
    RANGE_NOISE, RATE_NOISE, MESSAGE_LOSS, MESSAGE_DELAY, TRAFFIC_ROUTE, TRAFFIC_PLACE, TRAFFIC_STYLE, GPS_DRIFT, GPS_NOISE, TRIP,
    BUS_NOISE, TRAFFIC_MODEL, TRAFFIC_HEADWAY, DRIVER_REACTION, DRIVER_ATTENTION, DRIVER_ERROR,
) = range(16)  # fmt: skip


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
def uniforms(seed, entity, stream, tick, about=0):
    """Four independent numbers in (0, 1), from 32 bits each: for about the cost of one."""
    a, b, c, d = philox(tick, entity, stream, about, np.uint64(seed) & LOW, np.uint64(seed) >> HALF)
    return share(a), share(b), share(c), share(d)


@compiled
def normal(seed, entity, stream, tick, about=0):
    """A number of the standard normal distribution (Box & Muller 1958); `about` tells draws for several things apart."""
    a, b, c, d = philox(tick, entity, stream, about, np.uint64(seed) & LOW, np.uint64(seed) >> HALF)
    return sqrt(-2.0 * log(unit(a, b))) * cos(2.0 * pi * unit(c, d))


@compiled
def normals(seed, entity, stream, tick, about=0):
    """Four independent numbers of the standard normal distribution, from 32 bits each: for much noise at little cost."""
    a, b, c, d = philox(tick, entity, stream, about, np.uint64(seed) & LOW, np.uint64(seed) >> HALF)
    return quantile(share(a)), quantile(share(b)), quantile(share(c)), quantile(share(d))


@compiled
def first_normal(seed, entity, stream, tick, about=0):
    """The first of the numbers that `normals` gives."""
    a, _, _, _ = philox(tick, entity, stream, about, np.uint64(seed) & LOW, np.uint64(seed) >> HALF)
    return quantile(share(a))


@compiled
def share(word):
    """Uniform in the open interval (0, 1) from 32 bits."""
    return (np.float64(word) + 0.5) * 2.0**-32


@compiled
def quantile(p):
    """The number that a standard normal number is below with the probability p, to 1e-7.

    Source: M. J. Wichura, The percentage points of the normal distribution, Applied Statistics 37 (1988) 477, algorithm AS 241, PPND7.
    """
    q = p - 0.5
    if abs(q) <= 0.425:
        r = 0.180625 - q * q
        above = ((59.109374720 * r + 159.29113202) * r + 50.434271938) * r + 3.3871327179
        return q * above / (((67.187563600 * r + 78.757757664) * r + 17.895169469) * r + 1.0)
    r = sqrt(-log(p if q < 0.0 else 1.0 - p))
    if r <= 5.0:
        r -= 1.6
        above = ((0.17023821103 * r + 1.3067284816) * r + 2.7568153900) * r + 1.4234372777
        z = above / ((0.12021132975 * r + 0.73700164250) * r + 1.0)
    else:
        r -= 5.0
        above = ((0.017337203997 * r + 0.42868294337) * r + 3.0812263860) * r + 6.6579051150
        z = above / ((0.012258202635 * r + 0.24197894225) * r + 1.0)
    return -z if q < 0.0 else z
