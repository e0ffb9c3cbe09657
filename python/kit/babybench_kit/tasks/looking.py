"""Head and eyes that follow a point."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core import Core

_EYE_HEIGHT = 0.067375
"""Height of the eyes above the origin of the head, m."""
_EYE_FORWARD = 0.07
"""Distance of the eyes from the middle of the head, m."""
_EYE_SIDEWARD = 0.0245
"""Distance of an eye from the plane of symmetry, m."""
_STRAIGHT = ("head_tilt_side", "left_eye_vertical", "left_eye_torsional", "right_eye_vertical", "right_eye_torsional")


class HeadTracking:
    """The joints of head and eyes, as indices in ``qpos``."""

    def __init__(self, core: Core, free: tuple[str, ...] = (), straight: tuple[str, ...] = ()) -> None:
        """Finds the joints; those in ``free`` are not moved.

        With joints in ``straight``, which are held at zero, the distance of a point counts from the height of the eyes: MIMo 3.
        """
        addresses = core.blueprint.model_array("jnt_qposadr")

        def address(name: str) -> int:
            return int(addresses[core.names["joint"].index(f"robot:{name}")])

        self._core, self._from_eyes = core, bool(straight)
        self._head = core.names["body"].index("head")
        self._swivel, self._tilt = address("head_swivel"), address("head_tilt")
        eyes = [f"{side}_eye_horizontal" for side in ("left", "right")]
        self._eyes = [address(name) for name in eyes if name not in straight]
        self._straight = [address(name) for name in (*_STRAIGHT, *straight) if name not in free]

    def look_at(self, point: ArrayLike) -> None:
        """Turns head and eyes towards a point of the world, m, as if it lay in front of the head; velocities stay."""
        x, y, z = np.asarray(point) - self._core.present.xpos[self._head]
        distance = np.linalg.norm([x, y, z - _EYE_HEIGHT * self._from_eyes]) - _EYE_FORWARD
        qpos: NDArray[Any] = self._core.read("qpos")
        qpos[self._swivel] = np.arctan(y / x)
        qpos[self._tilt] = np.arctan((_EYE_HEIGHT - z) / x)
        qpos[self._eyes] = np.arctan(-_EYE_SIDEWARD / distance)
        qpos[self._straight] = 0.0
        self._core.move(qpos)
