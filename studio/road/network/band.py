"""Symmetric systems with three bands beside the diagonal, as smoothing makes them: A = L D Lᵀ, then two substitutions.

With D = diag(d) and w_m = L[j, j - m] d[j - m]:

    w_m = A[j, j - m] - sum over q > m of w_q L[j - m, j - q]        d[j] = A[j, j] - sum of w_m L[j, j - m]

G. H. Golub, C. F. Van Loan, Matrix Computations, 4.3. LAPACK does the same in an order that depends on the processor, and
smoothed ways must be equal on all of them (see portable.py).
"""

import numpy as np

from studio.compiled import compiled

BANDS = 3  # beside the diagonal


@compiled
def factor(band, low, d):
    """Writes L into low[m, j] = L[j, j - m] and D into d[j]; band[3 - m, j] = A[j, j - m]."""
    w = np.zeros(BANDS + 1)
    for j in range(d.size):
        d[j] = band[BANDS, j]
        for m in range(min(BANDS, j), 0, -1):
            w[m] = band[BANDS - m, j]
            for q in range(m + 1, min(BANDS, j) + 1):
                w[m] -= w[q] * low[q - m, j - m]
            low[m, j] = w[m] / d[j - m]
            d[j] -= w[m] * low[m, j]


@compiled
def substitute(low, d, x):
    """Solves L D Lᵀ x = x in its place."""
    n = d.size
    for j in range(n):
        for m in range(1, min(BANDS, j) + 1):
            x[j] -= low[m, j] * x[j - m]
    for j in range(n - 1, -1, -1):
        x[j] /= d[j]
        for m in range(1, min(BANDS, n - 1 - j) + 1):
            x[j] -= low[m, j + m] * x[j + m]


def solve(band: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solutions of A x = right, float64[k, n], row by row.

    band: float64[4, n], the upper form of A: the diagonal stands in the last row, band[3 - m, j] = A[j - m, j].
    """
    low, d = np.zeros(band.shape), np.empty(band.shape[1])
    factor(band, low, d)
    solutions = np.array(right, dtype=float)
    for x in solutions:
        substitute(low, d, x)
    return solutions
