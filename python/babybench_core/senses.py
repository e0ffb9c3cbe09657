"""The meaning of an observation's numbers: names, places, units; and touch beyond the vector."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from babybench_core import _native, hints

Floats = npt.NDArray[np.float64]

UNITS = {"angles": "rad", "velocities": "rad/s", "torques": "N m", "limits": "", "actuation": ""}
"""Units of the components of proprioception; limits and actuation have none."""


class Proprioception:
    """The entry ``observation``: the sense of his own body.

    Example:
        >>> import babybench
        >>> env = babybench.make("self_touch", vision_active=False)
        >>> env.proprioception.names[0]
        'angles robot:hip_lean1'
        >>> observation, info = env.reset(seed=0)
        >>> observation["observation"][env.proprioception.slices["angles"]].shape  # rad
        (47,)
    """

    def __init__(self, core: _native.Env) -> None:
        """Describes what an environment observes."""
        self._entries = core.proprioception_entries

    @cached_property
    def slices(self) -> dict[str, slice]:
        """The slice of each component: ``angles`` (rad), ``velocities`` (rad/s), ``torques`` (N m), ``limits``, ``actuation``."""
        slices: dict[str, slice] = {}
        for component, _, start, stop in self._entries:
            first = slices[component].start if component in slices else start
            slices[component] = slice(first, stop)
        return slices

    @cached_property
    def joint_names(self) -> list[str]:
        """Joints, in the order of angles, velocities and limits."""
        return [name for component, name, _, _ in self._entries if component == "angles"]

    @cached_property
    def sensor_names(self) -> list[str]:
        """Torque sensors, in the order of torques, three numbers (x, y, z in the frame of its site) each."""
        return [name for component, name, _, _ in self._entries if component == "torques"]

    @cached_property
    def names(self) -> list[str]:
        """A name for every number: component, joint or sensor, and axis where there are three."""
        names: list[str] = []
        for component, name, start, stop in self._entries:
            axes = [""] if stop - start == 1 else [f".{axis}" for axis in "xyz"]
            names += [f"{component} {name}{axis}" for axis in axes]
        return names

    def where(self, component: str, name: str) -> slice:
        """Returns the index of a joint or sensor in the vector.

        Raises:
            KeyError: The component or name does not exist.
        """
        for found, entry, start, stop in self._entries:
            if (found, entry) == (component, name):
                return slice(start, stop)
        names: dict[str, list[str]] = {found: [] for found, *_ in self._entries}
        for found, entry, *_ in self._entries:
            names[found].append(entry)
        if component not in names:
            meant = hints.nearest(component, names)
            raise KeyError(f"proprioception has no {component!r}; it has {', '.join(names)}{meant}")
        raise KeyError(f"proprioception has no {name!r} in {component!r}{hints.nearest(name, names[component])}")

    def __getattr__(self, name: str) -> Any:
        """Suggests replacements for attributes that the starter kit's sense has.

        Raises:
            AttributeError: Always.
        """
        hints.refuse(self, name, hints.PROPRIOCEPTION)


class TouchLayout:
    """The layout of the entry ``touch``: thousands of sensors all over the skin.

    Sensors are ordered by body, and each has ``width`` numbers, in N: one (normal force) or three (a vector, in the
    frame that ``touch_function`` names).
    """

    def __init__(self, core: _native.Env) -> None:
        """Describes what an environment feels."""
        self._layout = core.touch_layout()
        self.width: int = core.touch_width
        """Numbers of each sensor: 1 or 3."""
        self.sensors: int = sum(len(body["positions"]) for body in self._layout)
        """Number of sensors."""

    @cached_property
    def bodies(self) -> list[str]:
        """Names of the bodies with sensors, in the order of the observation."""
        return [body["name"] for body in self._layout]

    @cached_property
    def body_ids(self) -> npt.NDArray[np.intp]:
        """The body of each sensor, by id (sensors)."""
        counts = [len(body["positions"]) for body in self._layout]
        return np.repeat(np.array([body["body"] for body in self._layout], np.intp), counts)

    @cached_property
    def positions(self) -> dict[str, Floats]:
        """Positions of the sensors of each body, (sensors of the body, 3), m, in the frame of the body."""
        return {body["name"]: body["positions"] for body in self._layout}

    @cached_property
    def slices(self) -> dict[str, slice]:
        """The slice of each body in the observation."""
        starts = [(body["name"], body["offset"], len(body["positions"])) for body in self._layout]
        return {name: slice(self.width * at, self.width * (at + count)) for name, at, count in starts}

    @cached_property
    def names(self) -> list[str]:
        """A name for every number: body, sensor, and axis where there are three."""
        axes = [""] if self.width == 1 else [f".{axis}" for axis in "xyz"]
        bodies = ((body["name"], len(body["positions"])) for body in self._layout)
        return [f"{name}[{k}]{axis}" for name, count in bodies for k in range(count) for axis in axes]


class Touch(TouchLayout):
    """The entry ``touch`` of one environment, and touch beyond the vector: few sensors feel anything at a time.

    Example:
        >>> import babybench
        >>> env = babybench.make("self_touch", vision_active=False)
        >>> observation, info = env.reset(seed=0)
        >>> sensors, forces = env.touch.sparse()
        >>> bool(abs(forces).sum() == abs(observation["touch"]).sum())
        True
    """

    def __init__(self, core: _native.Env) -> None:
        """Describes what an environment feels."""
        super().__init__(core)
        self._core = core

    def sparse(self) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.float32]]:
        """Returns the active sensors, ascending (K), and their forces, (K, width), N. All others are 0."""
        return self._core.touched()

    def of(self, body: str) -> npt.NDArray[np.float32]:
        """Returns what the sensors of a body feel, (sensors of the body, width), N.

        Raises:
            KeyError: The body has no sensors.
        """
        for found in self._layout:
            if found["name"] == body:
                return self._core.touch_of(found["body"])
        raise KeyError(f"{body!r} has no touch sensors; these have: {', '.join(self.bodies)}")

    def contacts(self) -> dict[str, npt.NDArray[Any]]:
        """Returns the contacts with skin before they are spread over sensors, an entry for each side that feels.

        Returns:
            ``body``, ``geom`` and ``other`` (ids), ``normal`` (N), ``force`` (N) and ``point`` (m) in the world,
            ``force_body`` and ``point_body`` in the frame of the body.
        """
        return self._core.touch_contacts()

    def world_positions(self) -> Floats:
        """Returns the current positions of all sensors, (sensors, 3), m, in the world."""
        positions = np.concatenate([np.zeros((0, 3)), *(body["positions"] for body in self._layout)])
        frames = self._core.state_array("xmat").reshape(-1, 3, 3)[self.body_ids]
        origins: Floats = self._core.state_array("xpos")[self.body_ids]
        world: Floats = origins + np.einsum("nij,nj->ni", frames, positions)
        return world

    def __getattr__(self, name: str) -> Any:
        """Suggests replacements for attributes that the starter kit's sense has.

        Raises:
            AttributeError: Always.
        """
        hints.refuse(self, name, hints.TOUCH)
