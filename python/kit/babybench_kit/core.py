"""The engine under an environment: its parts, its data about the scene, and the state that scripts hold."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from babybench_core import _native
from babybench_core.mujoco.functions import has_diverged

from .course import Course, Turn
from .live import Live, ViewLive
from .models import Watched, make_model, mujoco_module
from .mujoco_live import MujocoLive
from .scene import Scene
from .settings import Settings, blueprint
from .views import ModelView

Array = NDArray[np.float64]


class Poses:
    """The poses of bodies and geoms at the start of the last physics step, as ``MjData`` gives them."""

    def __init__(self, engine: _native.Env) -> None:
        """Reads all poses."""
        self.xpos, self.xmat = engine.state_array("xpos"), engine.state_array("xmat")
        self.geom_xpos, self.geom_xmat = engine.state_array("geom_xpos"), engine.state_array("geom_xmat")

    def body(self, number: int) -> SimpleNamespace:
        """Returns position and orientation of a body."""
        return SimpleNamespace(xpos=self.xpos[number], xmat=self.xmat[number])

    def geom(self, number: int) -> SimpleNamespace:
        """Returns position and orientation of a geom."""
        return SimpleNamespace(xpos=self.geom_xpos[number], xmat=self.geom_xmat[number])


class Core:
    """The engine under one environment.

    Attributes:
        config: The complete configuration of the engine.
        assets: The folder of MJCF files and textures; nothing for the embedded ones.
        document: The document, if it is compiled as it stands.
        settled: Whether the engine has let the scene come to rest.
        whole: Whether the engine drives and senses all joints and actuators with MIMo's names.
        engine: The environment in Rust; ``parts`` are the parts of its reset and step.
        names: Names of all elements, by kind.
        course: What is known of the current instant, and who may write to it.
        observed: Number of observations so far.
        frames: A function that returns the frames of all contacts, (n, 9), as touch has left them, with or without reading back
            what a script has written; ``None`` without touch.
        width, height: Size of rendered pictures, pixels.
    """

    def __init__(self, settings: Settings, scene: Scene, width: int, height: int) -> None:
        """Compiles a scene, or takes a compiled one."""
        self.config, self.assets, self.width, self.height = settings.config, scene.assets, width, height
        self.document = scene.document
        self.settled = scene.document is None and settings.spacing is None
        self.blueprint = blueprint(settings, scene)
        self.engine = _native.Env(self.blueprint)
        self.parts = _native.Parts(self.engine)
        self.names: dict[str, list[str]] = {kind: list(names) for kind, names in self.blueprint.model_names.items()}
        self.place: list[float] | None = None if scene.place is None else scene.place["pos"]
        self.course = Course()
        self.observed = 0
        self.frames: Callable[[bool], Array] | None = None
        self.plain_actuation = True
        self.timestep = float(self.blueprint.model_options["timestep"])
        array = self.blueprint.model_array
        self.body_of_geom: NDArray[np.int32] = array("geom_bodyid")
        self.tree = SimpleNamespace(
            body_parentid=array("body_parentid"), body_geomadr=array("body_geomadr"), body_geomnum=array("body_geomnum")
        )
        joints = self.names["joint"]
        self.mimo_joints: NDArray[np.int_] = np.asarray(
            [i for i, name in enumerate(joints) if name.startswith("robot:")]
        )
        self._contacts: dict[str, NDArray[Any]] | None = None
        self._poses: Poses | None = None
        self._watched: Watched | None = None
        self._live: Live | None = None
        self.whole = self._is_whole()
        self.layout = self._proprioception_layout() if self.whole else {}

    def _is_whole(self) -> bool:
        """Returns whether the engine drives and senses all elements with MIMo's prefixes; other bodies may use these, too."""
        motors = sum(name.startswith("act:") for name in self.names["actuator"])
        torques = 3 * sum(name.startswith("proprio:") for name in self.names["sensor"])
        per_motor, seen = {"spring_damper": (1, 2), "muscle": (2, 4), "positional": (1, 1)}[
            self.config["actuation_model"]
        ]
        expected = 3 * len(self.mimo_joints) + torques + seen * motors
        sizes = len(self.engine.action_bounds[0]), len(self.parts.proprioception)
        return sizes == (per_motor * motors, expected)

    def _proprioception_layout(self) -> dict[str, slice]:
        """Returns the position of each part of proprioception, in alphabetical order of their names."""
        joints = len(self.mimo_joints)
        torques = 3 * sum(name.startswith("proprio:") for name in self.names["sensor"])
        total = len(self.parts.proprioception)
        sizes = {
            "actuation": total - 3 * joints - torques,
            "limits": joints,
            "qpos": joints,
            "qvel": joints,
            "torques": torques,
        }
        layout, at = {}, 0
        for name, size in sizes.items():
            layout[name] = slice(at, at + size)
            at += size
        return layout

    # --- time ---

    def _change(self, change: str) -> None:
        """Clears cached values after the state has changed."""
        self.course.change(change)
        self._contacts = self._poses = None

    def changed(self) -> None:
        """Records that the state has been replaced, and is computed."""
        self._change("compute")
        if self._live is not None:
            self._live.advance()

    def written(self) -> None:
        """Records that a script has written to the state."""
        self._change("write")

    def pull(self) -> None:
        """Reads back what a script has written to the model and to the state."""
        if self.course.turn is not Turn.SCRIPT:
            return
        if self._watched is not None:
            self._watched.follow()
        if self._live is not None:
            self._live.pull()

    def reset_data(self) -> None:
        """Resets the state, as ``mujoco.mj_resetData`` does, and applies the locks that a script has set."""
        if self._watched is not None:
            self._watched.check()
        self.parts.reset_data()
        self.course.change("advance")
        self._change("clear")

    def forward(self, qpos: Any, qvel: Any) -> None:
        """Computes everything at positions and velocities."""
        self.parts.forward(qpos, qvel)
        self.changed()

    def set_action(self, action: Any) -> None:
        """Passes an action to the actuators."""
        self.parts.set_action(action)
        self._show_controls()

    def set_controls(self, actuators: NDArray[np.int_], controls: Any) -> None:
        """Sets the controls of some of the actuators."""
        ctrl = self.engine.state_array("ctrl")
        ctrl[actuators] = controls
        self.engine.write_state("ctrl", ctrl)
        self._show_controls()

    def substep(self) -> None:
        """Updates the actuators, as before each physics step of a step except the first."""
        self.parts.substep()
        self._show_controls()

    def _show_controls(self) -> None:
        """Copies new controls to the state that scripts hold; otherwise the old ones would be read back."""
        if self._live is not None and self.course.copy.present:
            self._live.data.ctrl[:] = self.engine.state_array("ctrl")

    def physics_step(self) -> None:
        """Advances by one physics step. A simulation that diverges restarts at ``qpos0`` with a warning, as in MuJoCo."""
        self.pull()
        try:
            self.parts.physics_step()
        except RuntimeError as error:
            if not has_diverged(error):
                raise
            warnings.warn(f"{error} (it restarts at qpos0, as in MuJoCo)", RuntimeWarning, stacklevel=2)
            self.reset_data()
            self.parts.physics_step()
        self.changed()

    def read(self, name: str) -> Array:
        """Returns an array of the current state."""
        self.pull()
        return self.engine.state_array(name)

    def move(self, qpos: Any) -> None:
        """Moves the scene to other positions without computing anything from them; velocities do not change."""
        self.parts.set_position(qpos, self.engine.state_array("qvel"))
        self.written()
        if self._live is not None:
            self._live.advance()

    def change_model(self, changes: dict[str, Any]) -> None:
        """Changes numbers of the model, which scripts then see."""
        self.pull()
        self.engine.change_model(changes)
        if self._watched is not None:
            self._watched.show(changes)

    def show_model(self, watched: Watched) -> None:
        """Shows scripts another model of the same scene."""
        self._watched, self._live = watched, None

    def check_model(self) -> None:
        """Gives the engine what a script has written into the model.

        Raises:
            ValueError: The engine cannot use a value.
        """
        if self._watched is not None:
            self._watched.check()

    # --- senses ---

    def observe(self) -> None:
        """Senses the current state, if that has not been done."""
        self.pull()
        if not self.course.moment.sensed:
            self.parts.observe()
            self.observed += 1
            self.course.change("sense")

    def observation(self) -> dict[str, NDArray[Any]]:
        """Returns the last observation in new arrays."""
        return self.engine.observation()

    def proprioception(self) -> Array:
        """Returns the last proprioception, (n,)."""
        return self.parts.proprioception

    def touch(self) -> NDArray[np.float32]:
        """Returns the last touch forces, (n,), N."""
        felt = self.parts.touch
        return np.zeros(0, np.float32) if felt is None else felt

    def contacts(self, pull: bool = True) -> dict[str, NDArray[Any]]:
        """Returns the contacts of the current state as columns, optionally without reading back a script's changes."""
        if pull:
            self.pull()
        if self._contacts is None:
            self._contacts = self.engine.contacts()
        return self._contacts

    def show_normals(self, frames: Array) -> None:
        """Inverts normals in the frames that a script sees, (n, 9), where touch has inverted them at this instant."""
        if self.frames is None or not self.course.moment.felt:
            return
        known = self.frames(False)
        if len(known) == len(frames):
            frames[np.einsum("ij,ij->i", known[:, :3], frames[:, :3]) < 0, :3] *= -1

    @property
    def poses(self) -> Poses:
        """Returns the poses of the current state."""
        if self._poses is None:
            self._poses = Poses(self.engine)
        return self._poses

    @property
    def present(self) -> Poses:
        """Returns the poses of the current state, with what a script has written and computed."""
        self.pull()
        return self.poses

    # --- what scripts hold ---

    @property
    def model(self) -> Any:
        """Returns the model that scripts see."""
        if self._watched is None:
            self._watched = Watched(self, make_model(self))
        return self._watched.model

    @property
    def data(self) -> Any:
        """Returns the state that scripts see, up to date."""
        if self._live is None:
            self._live = self._make_live()
        elif not self.course.copy.present:
            self._live.refresh()
        return self._live.data

    def _make_live(self) -> Live:
        """Makes the state that scripts hold: MuJoCo's own where it is installed."""
        mujoco = mujoco_module()
        return ViewLive(self) if mujoco is None or isinstance(self.model, ModelView) else MujocoLive(self, mujoco)
