"""The interface of the engine that the model and the state of scripts need."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from babybench_core import _native

from .course import Course
from .scene import Document


class Beneath(Protocol):
    """The engine under one environment, shared by its model and its state: :class:`babybench_kit.core.Core`."""

    config: dict[str, Any]
    assets: Path | None
    document: Document | None
    blueprint: _native.Blueprint
    engine: _native.Env
    parts: _native.Parts
    place: list[float] | None
    timestep: float
    width: int
    height: int
    mimo_joints: NDArray[np.int_]
    course: Course

    @property
    def model(self) -> Any:
        """Returns the model that scripts see."""

    def pull(self) -> None:
        """Reads back what a script has written to the model and to the state."""

    def physics_step(self) -> None:
        """Advances by one physics step."""

    def reset_data(self) -> None:
        """Resets the simulation."""

    def written(self) -> None:
        """Records that a script has written to the state."""

    def show_normals(self, frames: NDArray[np.float64]) -> None:
        """Inverts normals in the frames that a script sees, (n, 9), where touch has inverted them at this instant."""
