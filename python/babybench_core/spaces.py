"""Spaces of Gymnasium from the descriptions of the native part."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from babybench_core import _native


def observation_space(core: _native.Env | _native.VectorEnv) -> Any:
    """Returns the space of the observations of one environment, a ``Dict`` (whose type differs from release to release).

    Entries without bounds are unbounded, so that wrappers that scale or clip bounded observations skip or refuse them.
    """
    boxes: dict[str, spaces.Space[Any]] = {}
    for key, shape, dtype, low, high in core.observation_spaces:
        kind = np.dtype(dtype).type
        boxes[key] = _box(low, high, tuple(shape), kind)
    return spaces.Dict(boxes)


def batch(single: Any, count: int) -> Any:
    """Returns the space of the observations of many environments, a row for each."""
    boxes = single.spaces.items()
    return spaces.Dict(
        {key: _box(box.low.flat[0], box.high.flat[0], (count, *box.shape), box.dtype) for key, box in boxes}
    )


def _box(low: Any, high: Any, shape: tuple[int, ...], dtype: Any) -> spaces.Box:
    """Returns a ``Box`` whose bounds are the same everywhere.

    A ``Box`` keeps four arrays of its shape, which for pictures are larger than the environments. Here each is one number.
    """
    kind = np.dtype(dtype).type
    box = spaces.Box(kind(low), kind(high), (1,) * len(shape), kind)
    box._shape = shape
    for name in ("low", "high", "bounded_below", "bounded_above"):
        setattr(box, name, np.broadcast_to(getattr(box, name), shape))
    return box


class Actions(spaces.Box):
    """A ``Box`` whose bounds are all finite: it draws the same samples, in a quarter of the time."""

    def __init__(self, low: npt.NDArray[np.float32], high: npt.NDArray[np.float32]) -> None:
        """Takes the bounds."""
        super().__init__(low, high, low.shape, np.float32)

    def sample(self, mask: None = None, probability: None = None) -> npt.NDArray[np.float32]:
        """Draws an action, each number uniformly between its bounds.

        Raises:
            gymnasium.error.Error: A mask or probabilities, which a ``Box`` does not have.
        """
        if mask is not None or probability is not None:
            raise gymnasium.error.Error("Box.sample: a Box has neither mask nor probability")
        low = self.low.astype(np.float64)
        drawn = self.np_random.random(self._shape)
        drawn *= self.high - low
        drawn += low
        return drawn.astype(np.float32)


def action_space(bounds: tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]) -> Any:
    """Returns the space of the actions of one environment, a ``Box``."""
    return Actions(*bounds)
