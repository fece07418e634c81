"""A packet of IEEE 802.11p: how long it is on the air, and how likely it survives.

**Time on the air** (IEEE 802.11-2016, clause 17, with 10 MHz: all times are twice those of 20 MHz). A preamble of 32 µs and a signal field
of 8 µs are followed by symbols of 8 µs with N bits each; 16 bits of service come before the bytes B, 6 bits of tail behind them:

    T = 40 µs + 8 µs · ceil((16 + 8 B + 6)/N)

**Bits per symbol** N = 48 carriers · bits of the modulation · rate of the code:

    rate        0        1        2        3        4        5        6        7
    Mbit/s      3        4.5      6        9        12       18       24       27
    N           24       36       48       72       96       144      192      216
    modulation  BPSK     BPSK     QPSK     QPSK     16-QAM   16-QAM   64-QAM   64-QAM
    code        1/2      3/4      1/2      3/4      1/2      3/4      2/3      3/4

**Survival** (G. Pei, T. R. Henderson, Validation of OFDM error rate model in ns-3, 2010, after L. E. Miller, Validation of 802.11a/UWB
coexistence simulation, NIST, 2003). Of the signal to noise ratio gamma follows the probability p that a bit of the code is wrong:

    BPSK  erfc(sqrt(gamma))/2                        QPSK    erfc(sqrt(gamma/2))/2
    16-QAM  3/8 erfc(sqrt(gamma/10))                 64-QAM  7/24 erfc(sqrt(gamma/42))

The decoder leaves an error in a bit with at most (Chernoff's bound; the ten or nine least distances d of each code with their weights c_d,
as the network simulator ns-3 has them; k of a code k/n)

    p_b = 1/(2 k) sum of c_d D^d        D = sqrt(4 p (1 - p))

and a packet of n bits survives with (1 - p_b)^n. Bounds are above the truth: a real decoder does a little better.

It survives a draw u if -ln(1 - p_b), its wear per bit, is below -ln(u)/n. Wear falls with the ratio, so a table of it tells most packets'
fate without working it out: by the entries beside the ratio.
"""

from math import ceil, erfc, exp, log, log1p, sqrt

import numpy as np

from studio.compiled import compiled

PREAMBLE, SYMBOL = 40e-6, 8e-6  # [s]
AROUND = 22.0  # [bits] service and tail
RATES = (3.0, 4.5, 6.0, 9.0, 12.0, 18.0, 24.0, 27.0)  # [Mbit/s]
CARRIERS = 48.0
# Ratios [dB] by rate: below the first not one of 1e9 of the shortest packets survives, above the second not one of the longest is lost.
HOPELESS, CERTAIN = (0.9, 3.7, 3.9, 6.7, 10.0, 13.2, 17.5, 19.0), (7.7, 10.8, 10.7, 13.8, 17.5, 20.7, 25.6, 26.8)

STEP = 0.05  # [dB]
POINTS = 170  # of a table: from HOPELESS to beyond CERTAIN


@compiled
def modulation(rate):
    """Bits that one carrier has in a symbol, by the number of the rate."""
    return 1.0 if rate < 2 else 2.0 if rate < 4 else 4.0 if rate < 6 else 6.0


@compiled
def code(rate):
    """k of the code k/(k + 1), by the number of the rate."""
    return 2.0 if rate == 6 else 1.0 if rate % 2 == 0 else 3.0


@compiled
def symbol_bits(rate):
    """N, by the number of the rate."""
    k = code(rate)
    return CARRIERS * modulation(rate) * k / (k + 1.0)


@compiled
def airtime(size, rate):
    """T [s] of a packet of `size` bytes."""
    return PREAMBLE + SYMBOL * ceil((AROUND + 8.0 * size) / symbol_bits(rate))


@compiled
def wrong(gamma, rate):
    """p, the probability that a bit of the code is wrong."""
    bits = modulation(rate)
    if bits == 1.0:
        return 0.5 * erfc(sqrt(gamma))
    if bits == 2.0:
        return 0.5 * erfc(sqrt(gamma / 2.0))
    return 0.375 * erfc(sqrt(gamma / 10.0)) if bits == 4.0 else 7.0 / 24.0 * erfc(sqrt(gamma / 42.0))


@compiled
def undecoded(p, rate):
    """p_b, the bound for the probability that a bit is wrong behind the decoder."""
    D, k = sqrt(4.0 * p * (1.0 - p)), code(rate)
    bound = half(D) if k == 1.0 else two_thirds(D) if k == 2.0 else three_quarters(D)
    return min(bound / (2.0 * k), 1.0)


@compiled
def half(D):
    """Sum of c_d D^d of the code 1/2, generators 133 and 171."""
    u = D * D
    sum_ = 21292910.0 + 134365911.0 * u
    sum_ = 77433.0 + u * (502690.0 + u * (3322763.0 + u * sum_))
    return u**5 * (36.0 + u * (211.0 + u * (1404.0 + u * (11633.0 + u * sum_))))


@compiled
def two_thirds(D):
    """That of the code 2/3."""
    sum_ = 117019.0 + D * (498860.0 + D * (2103891.0 + D * 8784123.0))
    return D**6 * (3.0 + D * (70.0 + D * (285.0 + D * (1276.0 + D * (6160.0 + D * (27128.0 + D * sum_))))))


@compiled
def three_quarters(D):
    """That of the code 3/4."""
    sum_ = 2253373.0 + D * (13073811.0 + D * (75152755.0 + D * 428005675.0))
    return D**5 * (42.0 + D * (201.0 + D * (1492.0 + D * (10469.0 + D * (62935.0 + D * (379644.0 + D * sum_))))))


@compiled
def wear(gamma, rate):
    """-ln(1 - p_b) at the signal to noise ratio gamma [1]."""
    return -log1p(-undecoded(wrong(gamma, rate), rate))


@compiled
def survival(gamma, bits, rate):
    """The probability that a packet of so many bits is understood at the signal to noise ratio gamma [1]."""
    return exp(-bits * wear(gamma, rate))


@compiled
def endured(bits, draw):
    """Below which wear per bit a packet of so many bits is understood; draw in (0, 1)."""
    return -log(draw) / bits


@compiled
def worn(rate):
    """The wear at every STEP from HOPELESS on."""
    found = np.empty(POINTS)
    for k in range(POINTS):
        found[k] = wear(10.0 ** (0.1 * (HOPELESS[int(rate)] + k * STEP)), rate)
    return found


@compiled
def surely_survives(ratio, rate, bits, draw, table, first):
    """Whether a packet of so many bits is known to be understood at a ratio [dB]; wear stands in a table from `first` on."""
    if ratio < HOPELESS[int(rate)] or ratio > CERTAIN[int(rate)]:
        return ratio > CERTAIN[int(rate)]
    return table[first + int((ratio - HOPELESS[int(rate)]) / STEP)] < endured(bits, draw)


@compiled
def surely_fails(ratio, rate, bits, draw, table, first):
    """Whether it is known not to be."""
    if ratio < HOPELESS[int(rate)] or ratio > CERTAIN[int(rate)]:
        return ratio < HOPELESS[int(rate)]
    return table[first + int((ratio - HOPELESS[int(rate)]) / STEP) + 1] >= endured(bits, draw)


@compiled
def survives(ratio, rate, bits, draw, table, first):
    """Whether it is understood."""
    if surely_fails(ratio, rate, bits, draw, table, first):
        return False
    return surely_survives(ratio, rate, bits, draw, table, first) or wear(10.0 ** (0.1 * ratio), rate) < endured(bits, draw)
