"""Means over seeds with intervals, as ``babybench benchmark`` computes them."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
_SAMPLES = 10_000


def interval(values: Floats) -> tuple[Floats, Floats, Floats]:
    """Returns mean, lower and upper end of the interval that holds 95 % of the means of samples with replacement.

    Args:
        values: (seeds, points).

    Returns:
        Three arrays (points,).
    """
    seeds = len(values)
    mean = values.mean(0)
    if seeds == 1:
        return mean, mean, mean
    # the same samples serve all points
    drawn = np.random.default_rng(0).integers(seeds, size=(_SAMPLES, seeds))
    weights = np.apply_along_axis(np.bincount, 1, drawn, minlength=seeds) / seeds
    low, high = np.percentile(weights @ values, [2.5, 97.5], axis=0)
    return mean, low, high
