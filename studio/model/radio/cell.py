"""A cell: where it covers the road, and what happens to more bytes than it carries.

A link that carries c bytes a second keeps what comes beyond in a queue, and every byte waits for those before it (a fluid queue):

    q(t + dt) = max(q(t) - c dt, 0) + bytes that came            delay = q/c

so that with a load of n c the delay grows by n - 1 seconds a second.

A polygon holds a point if a ray from it to the right crosses the edges an odd number of times.
"""

from studio.compiled import compiled


@compiled
def backlog(q, dt, c):
    """What is left of a queue [bytes] after dt [s]."""
    return max(q - c * dt, 0.0)


@compiled
def waiting(q, c):
    """The delay [s] behind a queue of q bytes."""
    return q / c


@compiled
def in_circle(x, y, x_0, y_0, radius):
    """Whether a point lies in a circle [m]."""
    return (x - x_0) ** 2 + (y - y_0) ** 2 <= radius * radius


@compiled
def crosses(x, y, x_1, y_1, x_2, y_2):
    """Whether the ray from a point to the right crosses an edge."""
    return (y_1 > y) != (y_2 > y) and x < x_1 + (y - y_1) / (y_2 - y_1) * (x_2 - x_1)
