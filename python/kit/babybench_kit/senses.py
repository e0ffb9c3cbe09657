"""MIMo's proprioception, balance and vision: ``mimoProprioception``, ``mimoVestibular``, ``mimoVision``.

They run in the engine. These classes show what was sensed last, part by part.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from babybench_core import _native

from .replaceable import Replaceable

if TYPE_CHECKING:
    from .sensing import SensingEnv

Array = NDArray[np.float64]

_OUTPUTS = (("qpos", ""), ("qvel", "velocity"), ("torques", "torque"), ("limits", "limits"), ("actuation", "actuation"))
"""Parts of the output, and the components that turn them on; positions are always there."""

_THRESHOLD = 0.035
"""Distance from a limit at which the engine feels it, rad."""


class Proprioception(Replaceable):
    """The interface of proprioception.

    Attributes:
        env: The environment.
        proprio_parameters: Parameters: ``components`` and ``threshold``.
        output_components: Which components are part of the output.
    """

    VALID_COMPONENTS: ClassVar[list[str]] = []

    def __init__(self, env: SensingEnv, proprio_parameters: dict[str, Any] | None) -> None:
        """Takes the environment."""
        self.env = env
        self._core = env._core
        self.proprio_parameters = proprio_parameters
        self.output_components: list[str] = list((proprio_parameters or {}).get("components", []))
        unknown = [component for component in self.output_components if component not in self.VALID_COMPONENTS]
        if unknown:
            raise AssertionError(f"components {unknown} do not exist; there are {self.VALID_COMPONENTS}")

    def get_proprioception_obs(self) -> Array:
        """Senses, and returns the output, (n,)."""
        raise NotImplementedError


class SimpleProprioception(Proprioception):
    """Joint angles (rad), velocities (rad/s), torques (N m), nearness of limits, and the state of the actuators.

    Attributes:
        sensors: Names of the torque sensors; ``sensor_ids`` their ids, ``sensor_addrs`` (n, 3) the addresses of their values.
        joint_names: Names of the joints; ``joint_ids`` their ids, ``joint_qpos`` and ``joint_qvel`` (n, 1) their addresses,
            ``joint_limits`` (n, 2) their limits, rad.
        sensor_names: What each entry of a part of the output belongs to.
        limit_thresh: Distance from a limit at which the limit is felt, rad.
    """

    VALID_COMPONENTS: ClassVar[list[str]] = ["velocity", "torque", "limits", "actuation"]

    def __init__(self, env: SensingEnv, proprio_parameters: dict[str, Any] | None) -> None:
        """Takes the environment."""
        super().__init__(env, proprio_parameters)
        names, array = env._core.names, env._core.blueprint.model_array
        self.sensor_ids = [i for i, name in enumerate(names["sensor"]) if name.startswith("proprio:")]
        self.sensors = [names["sensor"][i] for i in self.sensor_ids]
        self.joint_ids = [i for i, name in enumerate(names["joint"]) if name.startswith("robot:")]
        self.joint_names = [names["joint"][i] for i in self.joint_ids]
        self.joint_qpos = np.asarray(array("jnt_qposadr"))[self.joint_ids].astype(np.int64)[:, None]
        self.joint_qvel = np.asarray(array("jnt_dofadr"))[self.joint_ids].astype(np.int64)[:, None]
        self.joint_limits: Array = np.asarray(array("jnt_range"))[self.joint_ids]
        first = np.asarray(array("sensor_adr"))[self.sensor_ids].astype(np.int64)
        self.sensor_addrs = first[:, None] + np.arange(3)
        on = self.output_components
        labels = (
            ("velocity", "qvel", self.joint_names),
            ("torque", "torque", self.sensors),
            ("limits", "limit", self.joint_names),
        )
        self.sensor_names = {"qpos": self.joint_names, **{key: of for component, key, of in labels if component in on}}
        self.limit_thresh = (proprio_parameters or {}).get("threshold", _THRESHOLD)
        where = env._core.layout
        keys = [key for key, component in _OUTPUTS if not component or component in on]
        self._parts = (
            _native.Blocks(env._core.engine, False, [(key, where[key].start, where[key].stop) for key in keys])
            if where
            else None
        )
        self._shown = -1
        self._outputs: dict[str, Array] = {}
        self._all = set(on) == set(self.VALID_COMPONENTS)
        self._made()
        if self.limit_thresh != _THRESHOLD:
            self._changed.add("limit_thresh")
        if not where:
            self._changed.add("joint_ids")  # more than the engine's

    @property
    def sensor_outputs(self) -> dict[str, Array]:
        """Returns the parts of the last output: ``qpos``, ``qvel``, ``torques``, ``limits``, ``actuation``."""
        moment = self._core.observed
        if self._shown != moment and self._parts is None:
            self.sensor_outputs = self._sensed()
        return self._outputs if self._parts is None or self._shown == moment else self._parts.felt(moment)

    @sensor_outputs.setter
    def sensor_outputs(self, outputs: dict[str, Array]) -> None:
        self._outputs, self._shown = outputs, self._core.observed

    def get_proprioception_obs(self) -> Array:
        """Senses, and returns the parts of the output in alphabetical order, (n,)."""
        self._core.observe()
        if self._all and self._core.plain_actuation and not self._replaced:
            return self._core.proprioception()
        if self._replaced:
            self.sensor_outputs = self._sensed()
        outputs = self.sensor_outputs
        if not self._core.plain_actuation and "actuation" in outputs:
            outputs["actuation"] = np.asarray(self.env.actuation_model.observations()).flatten()
        return np.concatenate([outputs[key] for key in sorted(outputs)])

    def _sensed(self) -> dict[str, Array]:
        """Returns the parts of the output from the attributes of this sense, some of which a script has replaced."""
        read, on = self._core.engine.state_array, self.output_components
        angles = read("qpos")[self.joint_qpos].ravel()
        outputs = {"qpos": angles}
        if "velocity" in on:
            outputs["qvel"] = read("qvel")[self.joint_qvel].ravel()
        if "torque" in on:
            outputs["torques"] = read("sensordata")[self.sensor_addrs].ravel()
        if "limits" in on:
            below, above = np.asarray(self.joint_limits).T
            nearest = np.minimum(angles - below, above - angles) - self.limit_thresh
            outputs["limits"] = np.maximum(0.0, -nearest / self.limit_thresh)
        if "actuation" in on:
            outputs["actuation"] = np.ravel(self.env.actuation_model.observations())
        return outputs


class Vestibular(Replaceable):
    """The interface of the sense of balance.

    Attributes:
        env: The environment.
        vestibular_parameters: Parameters: ``sensors``.
    """

    def __init__(self, env: SensingEnv, vestibular_parameters: dict[str, Any]) -> None:
        """Takes the environment."""
        self.env = env
        self._core = env._core
        self.vestibular_parameters = vestibular_parameters

    def get_vestibular_obs(self) -> Array:
        """Senses, and returns the output, (n,)."""
        raise NotImplementedError


class SimpleVestibular(Vestibular):
    """Acceleration (m/s^2) and angular velocity (rad/s) of the head.

    Attributes:
        sensors: Names of the sensors; ``sensor_ids`` their ids, ``sensor_addrs`` (n, 3) the addresses of their values.
    """

    def __init__(self, env: SensingEnv, vestibular_parameters: dict[str, Any]) -> None:
        """Takes the environment."""
        super().__init__(env, vestibular_parameters)
        self.sensors: list[str] = vestibular_parameters["sensors"]
        self.sensor_ids = [env._core.names["sensor"].index(name) for name in self.sensors]
        first = np.asarray(env._core.blueprint.model_array("sensor_adr"))[self.sensor_ids].astype(np.int64)
        self.sensor_addrs = first[:, None] + np.arange(3)
        # the sensors of the head are adjacent
        flat = self.sensor_addrs.ravel()
        side_by_side = np.array_equal(flat, np.arange(flat[0], flat[0] + len(flat)))
        self._where = slice(int(flat[0]), int(flat[-1]) + 1) if side_by_side else flat
        self._shown = -1
        self._outputs: Array = np.zeros(0)
        self._made()

    @property
    def sensor_outputs(self) -> Array:
        """Returns the last output, (n,)."""
        if self._shown != self._core.observed:
            where = np.ravel(self.sensor_addrs) if self._replaced else self._where
            self.sensor_outputs = self._core.engine.state_array("sensordata")[where]
        return self._outputs

    @sensor_outputs.setter
    def sensor_outputs(self, outputs: Array) -> None:
        self._outputs, self._shown = outputs, self._core.observed

    def get_vestibular_obs(self) -> Array:
        """Senses, and returns the output, (n,)."""
        self._core.observe()
        return np.array(self.sensor_outputs)


class Vision(Replaceable):
    """The interface of vision.

    Attributes:
        env: The environment.
        camera_parameters: ``width`` and ``height`` of each camera's picture, pixels.
    """

    def __init__(self, env: SensingEnv, camera_parameters: dict[str, dict[str, Any]]) -> None:
        """Takes the environment."""
        self.env = env
        self._core = env._core
        self.camera_parameters = camera_parameters

    def get_vision_obs(self) -> dict[str, NDArray[np.uint8]]:
        """Senses, and returns the pictures."""
        raise NotImplementedError


class SimpleVision(Vision):
    """A picture of each eye."""

    def __init__(self, env: SensingEnv, camera_parameters: dict[str, dict[str, Any]]) -> None:
        """Takes the environment."""
        super().__init__(env, camera_parameters)
        self._shown = -1
        self._outputs: dict[str, NDArray[np.uint8]] = {}
        self._made()

    @property
    def sensor_outputs(self) -> dict[str, NDArray[np.uint8]]:
        """Returns what the eyes saw last, (height, width, 3) each, red, green and blue."""
        if self._shown != self._core.observed:
            engine, seen = self._core.engine, {} if self._replaced else self._core.observation()
            self.sensor_outputs = {
                camera: self._seen(
                    seen[camera] if camera in seen else engine.render(camera, size["width"], size["height"]), camera
                )
                for camera, size in self.camera_parameters.items()
            }
        return self._outputs

    @sensor_outputs.setter
    def sensor_outputs(self, outputs: dict[str, NDArray[np.uint8]]) -> None:
        self._outputs, self._shown = outputs, self._core.observed

    def _seen(self, picture: NDArray[np.uint8], camera: str) -> NDArray[np.uint8]:
        """Returns the visible part of a camera's picture: all of it."""
        return picture

    def get_vision_obs(self) -> dict[str, NDArray[np.uint8]]:
        """Senses, and returns what the eyes see, (height, width, 3) each."""
        self._core.observe()
        return dict(self.sensor_outputs)

    def save_obs_to_file(self, directory: str, suffix: str = "") -> None:
        """Writes what the eyes saw last into ``directory``, as ``<camera><suffix>.png``."""
        if not self.sensor_outputs:
            raise RuntimeWarning("No image observations to save!")
        from matplotlib import image

        folder = Path(directory)
        folder.mkdir(parents=True, exist_ok=True)
        for camera, picture in self.sensor_outputs.items():
            image.imsave(folder / f"{camera}{suffix}.png", picture)
