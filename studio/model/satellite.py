"""A position by satellites: a slow error, as of the atmosphere and of echoes, and white noise on top.

The slow error to the east and to the north is a Gauss-Markov process: with a draw w of the standard normal distribution

    z(t + dt) = phi z(t) + sqrt(1 - phi²) w,    phi = exp(-dt/tau)        error = sigma z

so z keeps variance 1 and its autocorrelation is exp(-|dt|/tau) (A. Gelb, Applied Optimal Estimation, 1974, section 3.8).
Where buildings hide the sky, fewer satellites and more echoes are received: sigma grows in proportion to the hidden share,
up to `factor` times where no sky is left. The sky is looked at once in LOOK: it changes within some metres, as the error does within tens
of seconds.
"""

from math import exp, floor, sqrt

from studio.compiled import compiled

LOOK = 1.0  # [s] from one look at the sky to the next
GOLDEN = 0.6180339887498949  # its multiples, without whole parts, are spread evenly: Knuth, The Art of Computer Programming 3, section 6.4


@compiled
def kept(dt, tau):
    """Share phi of the slow error that is left after dt [s]; tau is its correlation time [s]."""
    return exp(-dt / tau)


@compiled
def drift(z, phi, draw):
    """The slow error one step later, in units of its standard deviation."""
    return phi * z + sqrt(1.0 - phi * phi) * draw


@compiled
def spread(sigma, factor, sky):
    """Standard deviation [m] of the slow error where the share `sky` of the sky is open."""
    return sigma * (1.0 + (factor - 1.0) * (1.0 - sky))


@compiled
def looks_up(before, now, entity):
    """Whether a receiver looks at the sky after the time `before` and until `now` [s]; each has instants of its own."""
    share = entity * GOLDEN
    return floor(now / LOOK + share) != floor(before / LOOK + share)
