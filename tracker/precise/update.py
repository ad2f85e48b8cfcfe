"""The algebra of one measurement: what it is of, what it did, and the covariance after it."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import log, pi
from typing import TypeAlias

import numpy as np

from tracker.measurements import Matrix

Blocks: TypeAlias = Sequence[tuple[slice, Matrix]]
"""Columns of H that are not zero, each (m, width of the slice)."""
Observation: TypeAlias = tuple[Matrix, Blocks]
"""Residual, measured minus predicted, (m,), and its H."""


@dataclass(frozen=True)
class Correction:
    """What an update did."""

    nis: float
    """Squared innovation by its covariance, per dimension."""
    log_likelihood: float
    used: bool


def dense(blocks: Blocks, rows: int, columns: int) -> Matrix:
    """Return H, (rows, columns)."""
    H = np.zeros((rows, columns))
    for where, block in blocks:
        H[:, where] += block
    return H


def joseph(cov: Matrix, K: Matrix, H: Matrix, noise: Matrix) -> Matrix:
    """Return (I - K H) cov (I - K H)^T + K noise K^T, symmetric to the last bit."""
    reduced = cov - K @ (H @ cov)
    reduced = reduced - (reduced @ H.T) @ K.T + K @ noise @ K.T
    return np.asarray(0.5 * (reduced + reduced.T))


def log_likelihood(nis: float, S: Matrix) -> float:
    """Return it of an innovation, squared by its covariance S, (m, m), and per dimension `nis`."""
    m = len(S)
    return -0.5 * (m * nis + log(float(np.linalg.det(S))) + m * log(2.0 * pi))
