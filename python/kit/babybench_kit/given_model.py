"""Models that a program compiles itself, and their states, which replace ``env.model`` and ``env.data``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from babybench_core.mujoco.data import MjData
from babybench_core.mujoco.model import MjModel, Source

from . import given_mujoco
from .actuation import MODELS
from .core import Core
from .known_scenes import known_scene
from .live import STATE
from .scene import Document, Scene, document_scene

if TYPE_CHECKING:
    from .actuation import ActuationModel

_COPIED = {"tex_data"}
"""Arrays that the renderer stores in another form."""


@dataclass
class Given:
    """A model that a program has compiled, and the state that goes with it, until an environment has adopted them."""

    model: Any
    _data: Any = None

    @property
    def data(self) -> Any:
        """The state: the program's own, or one at ``qpos0``."""
        if self._data is None:
            self._data = given_mujoco.state(self.model) if given_mujoco.is_model(self.model) else MjData(self.model)
        return self._data

    @data.setter
    def data(self, data: Any) -> None:
        check_state(data, self.model)
        self._data = data


def check_state(data: Any, model: Any = None) -> None:
    """Raises an error unless this is a ``babybench.mujoco`` state of the given model.

    Raises:
        TypeError, ValueError: It is not.
    """
    if given_mujoco.is_state(data) and (model is None or given_mujoco.is_model(model)):
        return  # the sizes are compared when it is adopted
    if not isinstance(data, MjData):
        raise TypeError(f"env.data must be a state of babybench.mujoco, MjData(model), not {type(data).__name__}")
    if model is not None and data.model is not model:
        raise ValueError("env.data is the state of another model, not of env.model: make it with MjData(env.model)")


def given_scene(model: Any) -> Scene:
    """Returns the scene that a model was compiled from.

    Raises:
        TypeError: It is not a model of ``babybench.mujoco``, or was not compiled from a document there.
    """
    if not isinstance(model, MjModel):
        raise TypeError(
            f"env.model must be a model of MuJoCo or of babybench.mujoco, not {type(model).__module__}.{type(model).__name__}"
        )
    source: Source | None = model._source
    if source is None:
        raise TypeError("env.model must have been compiled from a document in UTF-8: MjModel.from_xml_string(text)")
    document = Document(source.text, Path(source.folder).absolute(), source.files)
    return document_scene(document, set(model._names["body"]))


def take_model(core: Core, model: Any, path: str) -> None:
    """Passes to an environment what a program has written into a model since it was compiled.

    Raises:
        AttributeError, ValueError: The environment cannot use a value.
    """
    if given_mujoco.is_model(model):
        given_mujoco.adopt(core, model, path)
        return
    fresh = MjModel._made(model._source.compile(), None)
    shown = core.model
    for name in (name for name in model.writable if name not in _COPIED):
        now, before = getattr(model, name), getattr(fresh, name)
        if not np.array_equal(now, before, equal_nan=now.dtype.kind == "f"):
            _write(shown, name, now, now != before)
    for name in dir(model.opt):
        now, before = getattr(model.opt, name), getattr(fresh.opt, name)
        if not np.array_equal(now, before):
            setattr(shown.opt, name, now)
    for part in ("global_", "map", "headlight"):
        own, first, target = (getattr(each.vis, part) for each in (model, fresh, shown))
        for name in dir(own):
            now = getattr(own, name)
            if not np.array_equal(now, getattr(first, name)):
                setattr(target, name, now)


def _write(model: Any, name: str, now: NDArray[Any], written: NDArray[np.bool_]) -> None:
    array = np.array(getattr(model, name))
    array[written] = now[written]
    setattr(model, name, array)


def take_state(core: Core, data: Any) -> None:
    """Moves an environment to a state, and computes everything there.

    Raises:
        ValueError: The state is that of a model with other joints or actuators.
    """
    model, own = data.model, core.blueprint.model_options
    for size in ("nq", "nv", "nu", "na", "nbody", "nmocap"):
        if getattr(model, size) != own[size]:
            raise ValueError(
                f"env.data: the state has {size} {getattr(model, size)}, but that of env.model is {own[size]}"
            )
    core.pull()
    core.forward(data.qpos, data.qvel)
    for name in STATE[2:]:
        array = getattr(data, name)
        if np.size(array):
            core.engine.write_state(name, array)
    core.changed()


class TakesModels:
    """An environment whose model and state a program can replace."""

    _core: Core
    _given: Given | None
    _making: bool
    _source: Source | None
    fullpath: str
    _any_scene: bool
    _actuation: type[ActuationModel]
    _config: Mapping[str, Any]
    actuation_model: Any
    mimo_actuators: NDArray[np.int_]
    init_qpos: NDArray[np.float64]
    init_qvel: NDArray[np.float64]

    def _compile(
        self, scene: Scene, actuation_model: type[ActuationModel], config: Mapping[str, Any], age: float | None
    ) -> Core:
        """Compiles a scene."""
        raise NotImplementedError

    def _name_parts(self) -> None:
        """Finds MIMo's elements in the scene."""
        raise NotImplementedError

    def _make_actuation(self) -> None:
        """Makes the actuation model."""
        raise NotImplementedError

    def _sense_anew(self) -> None:
        """Makes spaces and senses for the model."""
        raise NotImplementedError

    @property
    def model(self) -> Any:
        """Returns MuJoCo's model of the scene, or its stand-in."""
        return self._core.model if self._given is None else self._given.model

    @model.setter
    def model(self, model: Any) -> None:
        """Takes a model that a program has compiled, and begins at its ``qpos0``: ``env.data`` can be assigned after it."""
        given = Given(model)
        # the program's model keeps its own age
        mine = given_mujoco.is_model(model)
        scene = known_scene(self.fullpath, self._any_scene) if mine else given_scene(model)
        core = self._compile(scene, self._actuation, self._config, None)
        if self._making:
            self._core, self._given = core, given
            return
        before = dict(self.__dict__)
        self._core, self._given = core, given
        try:
            self._name_parts()
            self._end_given()
            self._source = None if mine else model._source
            self._make_actuation()
            self._sense_anew()
        except Exception:
            self.__dict__.update(before)
            raise

    @property
    def data(self) -> Any:
        """Returns MuJoCo's current state, or its stand-in."""
        return self._core.data if self._given is None else self._given.data

    @data.setter
    def data(self, data: Any) -> None:
        """Copies the numbers of a state: positions, velocities, controls, applied forces, mocap poses."""
        if self._given is not None:
            self._given.data = data
        elif data is not self._core.data:
            check_state(data)
            take_state(self._core, data)

    def _take_over(self, made: tuple[Any, Any] | None) -> None:
        """Takes the model and the state that a replaced :meth:`_initialize_simulation` has made."""
        if made is not None:
            model, data = made
            if "_core" not in self.__dict__ or model is not self.model:
                self.model = model
            if data is not self.data:
                self.data = data
        if "_core" not in self.__dict__:
            raise TypeError(
                f"{type(self).__name__}._initialize_simulation neither calls that of MIMoEnv nor makes a model: assign env.model "
                "(babybench.mujoco.MjSpec.from_file(env.fullpath).compile()) and env.data, or return both"
            )
        if self._given is not None:
            if "mimo_joints" not in self.__dict__ or "mimo_actuators" not in self.__dict__:
                self._name_parts()
            if isinstance(self.actuation_model, type):
                self._make_actuation()
            self._end_given()
        self._making = False

    def _end_given(self) -> None:
        """Passes a program's changes to its own model and state to the engine."""
        given, self._given = self._given, None
        assert given is not None
        take_model(self._core, given.model, self.fullpath)
        take_state(self._core, given.data)
        self.init_qpos, self.init_qvel = given.data.qpos.copy(), given.data.qvel.copy()
        self._core.plain_actuation = self._core.whole and self._actuation in MODELS.values()
