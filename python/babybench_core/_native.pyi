"""The native part: scenes, environments and vectors of environments, in Rust.

Prefer the package itself, which is built on this module. Every array that is returned is a fresh copy, unless said
otherwise. Errors are Python's own: ``ValueError``, ``TypeError``, ``KeyError``, ``FileNotFoundError``, ``RuntimeError``.
"""

import os
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, Optional, final

import numpy as np
import numpy.typing as npt

from babybench_core.records import LockReport, TouchBody

__all__ = [
    "CHANGEABLE",
    "ActionNoise",
    "Blocks",
    "Blueprint",
    "Env",
    "Folder",
    "MjcfDocument",
    "Parts",
    "PhysicsData",
    "PhysicsModel",
    "PhysicsRenderer",
    "Recorder",
    "VectorEnv",
    "View",
    "Watch",
    "__version__",
    "command_line",
    "config_examples",
    "config_from_mapping",
    "config_from_yaml",
    "config_keys",
    "embedded_files",
    "measure_record",
    "model_columns",
    "model_extras",
    "movement_of_record",
    "paint",
    "play_senses",
    "protocol_description",
    "protocol_names",
    "replay_record",
    "run_protocol",
    "scene_file",
    "set_equalities",
    "spread_linear",
    "write_video",
]

CHANGEABLE: list[str]
"""The names of the numbers of a model that :meth:`Env.change_model` changes."""

__version__: str

_Camera = str | tuple[Sequence[float], float, float, float]
"""A camera of the scene by name, or a free one: the point that it looks at (m), distance (m), azimuth, elevation (degrees)."""

_Space = tuple[str, list[int], str, float, float]
_Floats = npt.NDArray[np.float64]
_Flags = npt.NDArray[np.bool_]
_Array = npt.NDArray[Any]

def command_line(arguments: Sequence[str], program: str) -> int:
    """Runs a command of the command line, and returns the exit code of the process; ``program`` is what users type before it."""

def config_keys() -> dict[str, dict[str, Any]]:
    """Returns every key of a configuration: ``default``, ``section``, ``expected``, ``doc`` and, for names, ``choices``."""

def config_examples() -> dict[str, dict[str, Any]]:
    """Returns the example configurations: ``self_touch``, ``hand_regard``, ``test_installation`` and those of tasks."""

def config_from_mapping(mapping: Mapping[str, object]) -> dict[str, Any]:
    """Checks a configuration and returns all its keys; missing keys get their default."""

def config_from_yaml(text: str, file: str = "configuration", folder: str | os.PathLike[str] = ...) -> dict[str, Any]:
    """Reads a configuration from YAML and returns all its keys.

    ``file`` names the text in errors; ``folder`` is where the path of a scene starts, by default the working directory.
    """

def measure_record(folder: str | os.PathLike[str], episode: int | None = None) -> str:
    """Returns the measures of an episode of a record, or the means of all, as JSON."""

def movement_of_record(
    folder: str | os.PathLike[str],
    episode: int | None,
    fps: float,
    band: tuple[float, float],
    window: int,
    jitter: float,
    seed: int,
    frame: str,
) -> str:
    """Returns measures of the movements in an episode of a record, or the means of all, as JSON."""

def protocol_names() -> list[str]:
    """Returns the names of the protocols of the library."""

def protocol_description(name: str) -> str:
    """Returns a protocol as JSON."""

def run_protocol(
    name: str,
    out: str | os.PathLike[str],
    policies: list[str],
    ages: list[float] | None,
    seeds: int,
    length: float,
    keys: str,
    jobs: int | None,
    keep_records: bool,
    policy_timeout: float,
) -> str:
    """Runs a protocol into a folder and returns the results as JSON."""

def play_senses(
    env: Env,
    recorder: Recorder,
    motion: str | os.PathLike[str],
    degrees: bool,
    track: bool,
    episode: int,
) -> tuple[int, float, tuple[str, float] | None, list[str]]:
    """Plays a motion in an environment that was reset, and records it as an episode.

    Returns steps, error (rad), the joint with the largest error and that error, and joints whose range the motion leaves.
    """

def replay_record(folder: str | os.PathLike[str], episode: int) -> int | None:
    """Repeats an episode of a record; returns the first step whose bits differ."""

@final
class Recorder:
    """Records an environment into a folder: steps go through it."""

    def __new__(
        cls,
        env: Env,
        folder: str | os.PathLike[str],
        senses: bool = False,
        eyes_every: int | None = None,
        policy: str = "",
    ) -> Recorder:
        """Makes the folder."""

    def begin(self, env: Env, episode: int) -> None:
        """Starts an episode at the current moment."""
    def step(self, env: Env, action: npt.ArrayLike) -> tuple[dict[str, _Array], float, bool, bool]:
        """Applies an action, as ``Env.step`` does, and records the result."""
    def end(self, env: Env, unfinished: bool = False) -> bool:
        """Writes the episode, marked if it was abandoned. Returns whether it had steps."""

@final
class Folder:
    """A folder that this process owns until the object is freed."""

    def __new__(cls, folder: str | os.PathLike[str]) -> Folder:
        """Locks the folder; an ``OSError`` names the process that holds it."""

@final
class Blueprint:
    """A compiled scene with its configuration and its settled state, which environments share."""

    MODEL_ARRAYS: ClassVar[list[str]]
    """The names of :meth:`model_array`."""

    def __new__(
        cls,
        config: Mapping[str, object] | str | os.PathLike[str],
        assets: str | os.PathLike[str] | None = None,
    ) -> Blueprint:
        """Compiles a scene. A ``str`` is the path of a YAML file; ``assets`` is a folder laid out like the kit's."""

    def with_body_number(self, number: int) -> Blueprint:
        """Compiles the scene with another infant of the configuration's population. Both share textures."""

    @staticmethod
    def by_hand(
        config: Mapping[str, object] | str | os.PathLike[str],
        document: str | None = None,
        version: str = "v1",
        folder: str | os.PathLike[str] = ...,
        files: Mapping[str, bytes] = ...,
        touch_spacing: Sequence[tuple[str, float]] = ...,
        assets: str | os.PathLike[str] | None = None,
    ) -> Blueprint:
        """Compiles a document, by default the configuration's, for a program that composes its own resets and steps.

        ``folder`` is the document's absolute folder; ``files`` replace some of its files; ``touch_spacing`` lists bodies with
        the distances between their touch sensors, m.
        """

    @property
    def config(self) -> dict[str, Any]:
        """All keys with their values."""
    @property
    def eye_sizes(self) -> tuple[tuple[int, int], tuple[int, int]]:
        """Width and height of the pictures of the left eye, and of those of the right one, pixels."""
    @property
    def init_qpos(self) -> _Floats:
        """The settled positions (nq), from which episodes start."""
    @property
    def init_qvel(self) -> _Floats:
        """The settled velocities (nv)."""
    @property
    def model_names(self) -> dict[str, list[str]]:
        """Names by kind: body, joint, geom, site, camera, equality, tendon, actuator, sensor; some are empty."""
    @property
    def model_options(self) -> dict[str, Any]:
        """Sizes (``nq``, ``nbody``, ...) and options (``timestep``, ``gravity``, ...)."""
    def model_array(self, name: str) -> _Array:
        """Returns an array of the scene by MuJoCo's name, in MuJoCo's order, numbers and units."""

@final
class Env:
    """An environment. One thread uses it at a time; steps and pictures do not hold Python's lock."""

    STATE_ARRAYS: ClassVar[list[str]]
    """The names of :meth:`state_array`."""

    def __new__(cls, blueprint: Blueprint, views: bool = False, lazy: bool = False) -> Env:
        """Makes an environment; with ``views``, observations are read-only arrays that each step updates.

        With ``lazy``, observations and their spaces have no images: :meth:`eyes` returns them.
        """

    def reset(self, seed: int | None = None) -> dict[str, _Array]:
        """Starts an episode: the settled state, then ten random start actions (none without a behavior).

        Under ``compat: api`` a seed reseeds every random choice; under ``compat: reference`` it is ignored:
        see :meth:`seed_action_space` and :meth:`reset_with`.
        """
    def reset_with(self, actions: npt.ArrayLike) -> dict[str, _Array]:
        """Starts an episode with the given start actions (any number, action size), a physics step each."""
    def reset_to(self, qpos: npt.ArrayLike, qvel: npt.ArrayLike) -> dict[str, _Array]:
        """Starts an episode at positions (nq) and velocities (nv), without start actions."""
    def set_state(self, qpos: npt.ArrayLike, qvel: npt.ArrayLike) -> dict[str, _Array]:
        """Moves the scene to positions (nq) and velocities (nv) in the middle of an episode and computes everything."""
    def set_mocap(self, body: str, pos: Sequence[float], quat: Sequence[float]) -> None:
        """Moves a body with ``mocap="true"`` to a position (m) and an orientation (w, x, y, z), from the next step."""
    def refresh(self) -> dict[str, _Array]:
        """Computes poses, contacts, forces and senses of the current state, without advancing."""
    def step(self, action: npt.ArrayLike) -> tuple[dict[str, _Array], float, bool, bool]:
        """Applies an action; returns observation, reward, terminated and truncated."""
    def run(self, actions: npt.ArrayLike) -> None:
        """Applies actions, (K, action size), one after the other, and returns nothing: for replays and for timing the core."""
    def observation(self) -> dict[str, _Array]:
        """Returns the observation of the last reset, step or :meth:`refresh`."""
    def eyes(self) -> dict[str, _Array]:
        """Returns the images of the last observation, and draws them if they are not drawn yet."""
    def info(self, details: bool = True) -> dict[str, Any]:
        """Returns the information of the last step; ``details`` adds names of touched parts and angles of gaze (rad)."""
    def second_spaces(self) -> Optional[tuple[tuple[_Array, _Array], int]]:
        """Returns the bounds of an action of the second infant and the length of its observation, if there is one."""
    def act_second(self, action: npt.ArrayLike) -> None:
        """Sets the action of the second infant, which holds until the next one or a reset."""
    def observe_second(self) -> _Array:
        """Returns the second infant's observation: angles (rad), velocities (rad/s), the head's motion, torques (N m)."""
    def set_goal(self, desired: npt.ArrayLike) -> dict[str, _Array]:
        """Changes the desired goal of the episode; returns the observation with it."""
    def compute_reward(self, achieved: npt.ArrayLike, desired: npt.ArrayLike, terms: npt.ArrayLike) -> _Floats:
        """Returns the reward of each row of goals, (K, goal) twice, and terms, (K, reward_terms)."""
    @property
    def reward_terms(self) -> int:
        """Number of values besides goals that the reward depends on."""
    def accumulate_info(self, on: bool) -> None:
        """Sets whether resets keep the counters and lists of the behavior."""
    def close(self) -> None:
        """Frees the environment. Later calls other than ``close`` and ``closed`` raise ``RuntimeError``."""
    @property
    def closed(self) -> bool:
        """Whether :meth:`close` was called."""
    @property
    def ready(self) -> bool:
        """Whether a step may follow: there was a reset, and nothing has diverged since."""
    @property
    def blueprint(self) -> Blueprint:
        """The blueprint that it was made from."""

    @property
    def action_bounds(self) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
        """Lower and upper bounds of actions."""
    @property
    def observation_spaces(self) -> list[_Space]:
        """Key, shape, number type, lower and upper bound of each observation."""
    def seed_action_space(self, seed: int) -> None:
        """Seeds the generator of :meth:`sample_action` and of start actions, as ``action_space.seed`` does."""
    def draw_from(self, drawn: int) -> None:
        """Moves the generator of random choices to its position after ``drawn`` numbers."""
    def sample_action(self) -> npt.NDArray[np.float32]:
        """Returns a random action, the same that ``action_space.sample()`` draws from the same seed."""

    time: float
    """Simulated time, s."""

    def state_array(self, name: str) -> _Array:
        """Returns an array of the state by MuJoCo's name: ``qpos``, ``xpos`` (nbody, 3), ``xmat`` (nbody, 9), ...

        Quantities that are computed describe the start of the last physics step.
        """
    def write_state(self, name: str, values: npt.ArrayLike) -> None:
        """Writes ``qpos``, ``qvel``, ``ctrl``, ``act``, ``qfrc_applied`` or ``qacc_warmstart``.

        The next step, or :meth:`forward`, computes derived quantities.
        """
    def push(
        self, body: int, force: Sequence[float], torque: Sequence[float], point: Sequence[float] | None = None
    ) -> None:
        """Replaces the forces on a body by a force (N, world) at a point (m, world) and a torque (N m)."""
    def apply_force(self, body: int, force: Sequence[float], point: Sequence[float]) -> None:
        """Adds a force (N, world) on a body at a point (m, world); it acts until :meth:`release_forces` or a reset."""
    def release_forces(self) -> None:
        """Removes all applied forces."""
    def contacts(self) -> dict[str, _Array]:
        """Returns the contacts of the start of the last physics step, in MuJoCo's order.

        Entries: ``geom1``, ``geom2``, ``dim``, ``dist`` (m), ``pos`` (m), ``frame`` (9), ``friction`` (5), ``solref``,
        ``solreffriction``, ``solimp``, ``includemargin``, ``efc_address``, ``force`` (6, contact frame, N and N m).
        """
    def snapshot(self) -> bytes:
        """Takes a snapshot, from which a run continues with the same bits."""
    def restore(self, snapshot: bytes) -> None:
        """Goes back to a snapshot of this environment, or of another of the same configuration and scene."""
    def resume(self, snapshot: bytes) -> dict[str, _Array]:
        """Goes back to a snapshot and computes touch and images; returns the observation."""
    def swap_facial_expression(self, expression: str) -> None:
        """Changes MIMo's face in all later pictures.

        Raises:
            ValueError: The face does not exist.
        """
    def model_array(self, name: str) -> _Array:
        """Returns an array of the model by MuJoCo's name, with all changes, or an option: ``opt.gravity``."""
    def change_model(self, changes: dict[str, _Array]) -> None:
        """Changes numbers of the model from the next step; takes whole arrays."""
    def set_age(self, age: float | None) -> dict[str, Any]:
        """Sets MIMo's age, months; returns the configuration. The next call is a reset."""
    @property
    def age(self) -> float | None:
        """The age of MIMo's body, months."""
    @property
    def model_changes(self) -> dict[str, _Array]:
        """The arrays that differ from those of the scene."""
    @property
    def dt(self) -> float:
        """The time between two steps, s."""
    def lock(self, target: str | int, angle: float = 0.0) -> LockReport:
        """Locks a joint (name or number), or all joints of a part such as ``"head"``, at an angle in rad."""
    def unlock(self, target: str | int) -> LockReport:
        """Unlocks a joint, or all joints of a part."""

    @property
    def touch_width(self) -> int:
        """Values of each touch sensor: 1 or 3; 0 without touch."""
    def touch_layout(self) -> list[TouchBody]:
        """Returns the positions of the touch sensors, body by body, in the order of the observation."""
    def touch_of(self, body: int) -> npt.NDArray[np.float32]:
        """Returns the values of the sensors of a body, (sensors, 1 or 3), N; (0, 1 or 3) if it has none."""
    def touched(self) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.float32]]:
        """Returns sparse touch: the sensors that contacts reach, ascending (K), and their values, (K, 1 or 3), N."""
    def touch_contacts(self) -> dict[str, _Array]:
        """Returns the contacts with skin, an entry for each side with sensors.

        Entries: ``contact`` (index in :meth:`contacts`), ``body``, ``geom``, ``other`` (geom, -1 for a flex), ``normal`` (N),
        ``force`` and ``point`` (world, N and m), ``force_body`` and ``point_body`` (frame of the body).
        """
    @property
    def reflexes(self) -> list[str]:
        """Names of the reflexes that act on MIMo, in the order of the entry ``reflexes`` of the observation."""

    @property
    def proprioception_entries(self) -> list[tuple[str, str, int, int]]:
        """Component, name, first index and end index of each entry of the observation."""

    def render(self, camera: _Camera, width: int, height: int) -> npt.NDArray[np.uint8]:
        """Draws from a camera of the scene or a free one, (height, width, 3), red, green, blue, rows from the top."""
    def depth(self, camera: _Camera, width: int, height: int) -> npt.NDArray[np.float32]:
        """Draws the distance from the camera's plane, (height, width), m; infinite where there is nothing."""
    def segmentation(self, camera: _Camera, width: int, height: int) -> npt.NDArray[np.int32]:
        """Draws the ids of geoms, (height, width); -1 in the background."""

@final
class ActionNoise:
    """Action noise for one environment."""

    def __new__(cls, noise: str, low: Sequence[float], high: Sequence[float], step: float, seed: int) -> ActionNoise:
        """Makes a noise by name, for actions between two bounds, ``step`` seconds apart."""
    def sample(self) -> npt.NDArray[np.float32]:
        """Returns the next action."""
    def reset(self, seed: int) -> None:
        """Restarts."""

@final
class View:
    """A page on this machine that shows an environment while a program steps it."""

    def __new__(cls, title: str, port: int = 0) -> View:
        """Opens it at a port, or at any free one for 0; ``OSError`` if it is taken."""
    @property
    def url(self) -> str:
        """The address of the page."""
    @property
    def moves(self) -> bool:
        """Whether the policy may move MIMo; actions are 0 otherwise."""
    @property
    def watched(self) -> bool:
        """Whether a page was open within the last two seconds."""
    def attend(self, env: Env) -> str:
        """Answers requests for pictures and returns the next action: ``step``, ``reset``, or ``wait`` after 0.05 s."""
    def stepped(self, env: Env, seconds: float) -> None:
        """Reports a step of this many simulated seconds."""
    def restarted(self, env: Env) -> None:
        """Reports the start of an episode."""
    def close(self) -> None:
        """Closes the page."""

@final
class Watch:
    """Arrays that a program may write to, and their earlier contents."""

    def __new__(cls, arrays: Sequence[_Array]) -> Watch:
        """Stores the contents of the arrays."""
    def changed(self, arrays: Sequence[_Array]) -> list[int]:
        """Returns the indices of the arrays that differ; the next call compares with these arrays."""

@final
class MjcfDocument:
    """A document as a tree of elements, the basis of :class:`babybench.mujoco.MjSpec`. Elements are numbers."""

    def __new__(cls) -> MjcfDocument: ...
    @staticmethod
    def from_text(text: str, path: str, files: Mapping[str, bytes], folder: str | os.PathLike[str]) -> MjcfDocument:
        """Reads a text, with files that replace those in and around a folder."""
    @staticmethod
    def from_file(path: str, files: Mapping[str, bytes], folder: str | os.PathLike[str]) -> MjcfDocument:
        """Reads a file of a folder."""
    def copy(self) -> MjcfDocument:
        """Returns a separate document with the same elements under the same numbers."""
    def root(self) -> int:
        """Returns the root element."""
    def world(self) -> int:
        """Returns the world."""
    def section(self, name: str) -> int:
        """Returns the section with a name, or creates it."""
    def add(self, parent: int, element: str) -> int:
        """Appends an element to another."""
    def insert(self, parent: int, element: str, index: int) -> int:
        """Adds an element before another."""
    def remove(self, number: int, alone: bool) -> None:
        """Removes an element, and also the elements that refer to it unless ``alone`` is set."""
    def contains(self, number: int) -> bool:
        """Returns whether an element is in the document."""
    def set(self, number: int, name: str, value: str) -> None:
        """Sets an attribute."""
    def unset(self, number: int, name: str) -> None:
        """Removes an attribute."""
    def get(self, number: int, name: str) -> str | None:
        """Returns the text of an attribute that the document gives."""
    def value(self, number: int, name: str) -> str:
        """Returns the text of an attribute with default classes applied."""
    def attributes(self, number: int) -> list[tuple[str, str]]:
        """Returns the attributes that the document gives."""
    def parent(self, number: int) -> int | None:
        """Returns the parent of an element."""
    def children(self, number: int) -> list[int]:
        """Returns the children of an element."""
    def element(self, number: int) -> str:
        """Returns the name of an element in MJCF."""
    def kind(self, number: int) -> str | None:
        """Returns the kind of an element."""
    def all(self, kind: str) -> list[int]:
        """Returns all elements of a kind."""
    def find(self, kind: str, name: str) -> int | None:
        """Returns the element of a kind with a name."""
    def class_of(self, number: int) -> str:
        """Returns the name of the default class of an element."""
    def attach(self, parent: int, other: MjcfDocument, body: int, prefix: str, suffix: str) -> int:
        """Copies a body, a frame or the world of another document."""
    def move_to(self, number: int, parent: int) -> None:
        """Moves an element into another."""
    def generalize(self, number: int) -> None:
        """Turns an actuator of another kind into an equivalent general one."""
    def write(self) -> str:
        """Returns the document as MJCF."""

@final
class PhysicsModel:
    """A model of any document, the basis of :class:`babybench.mujoco.MjModel`."""

    ARRAYS: ClassVar[list[str]]
    """The names of :meth:`array`."""

    @staticmethod
    def from_file(path: str | os.PathLike[str]) -> PhysicsModel:
        """Compiles a file. Includes and textures are found as MuJoCo finds them."""
    @staticmethod
    def from_text(text: str, files: Mapping[str, bytes], folder: str | os.PathLike[str]) -> PhysicsModel:
        """Compiles a text, with files that replace those in and around a folder that it names."""
    def copy(self) -> PhysicsModel:
        """Returns a separate model with the same numbers."""
    @property
    def memory(self) -> _Floats:
        """The memory of the numbers that a program may change; steps read them."""
    @property
    def layout(self) -> list[tuple[str, list[int]]]:
        """Names and shapes of the arrays in :attr:`memory`, in order."""
    @property
    def columns(self) -> dict[str, _Array]:
        """Arrays of other types that a program may change: colours, groups, materials, lights, equalities, keyframes."""
    def array(self, name: str) -> _Array:
        """Returns a compiled array."""
    def names(self) -> dict[str, list[str]]:
        """Returns the names of all elements, by kind."""
    def settings(self) -> dict[str, Any]:
        """Returns sizes, options, statistics and visual settings that are in no array."""
    def set_option(self, name: str, value: int) -> None:
        """Sets a whole number among the options."""
    def extras(self) -> dict[str, Any]:
        """Returns as MuJoCo's arrays the values that the engine stores in another form."""
    def shapes(self) -> dict[str, _Array]:
        """Returns the arrays of meshes, height fields, skins and flexes under MuJoCo's names."""

@final
class PhysicsData:
    """A state of a model and the engine that advances it, the basis of :class:`babybench.mujoco.MjData`."""

    GROUPS: ClassVar[dict[str, int]]
    """The groups of arrays, as bits."""

    def __new__(cls, model: PhysicsModel) -> PhysicsData:
        """Creates a state without computed quantities."""
    @property
    def memory(self) -> _Floats:
        """The memory of all arrays. The next computation starts from the arrays of the group ``input``."""
    @property
    def eq_active(self) -> npt.NDArray[np.uint8]:
        """The active equality constraints."""
    @property
    def layout(self) -> list[tuple[str, int, list[int]]]:
        """Names, groups and shapes of the arrays in :attr:`memory`, in order."""
    def reset(self, key: int | None = None) -> None:
        """Resets, to a keyframe if given."""
    def flexes(self) -> dict[str, _Floats]:
        """Returns the positions of the vertices of flexes, and the lengths of their edges with the rates of these."""
    def step(self, count: int) -> None:
        """Advances by some time steps."""
    def ray(
        self,
        origin: tuple[float, float, float],
        direction: tuple[float, float, float],
        without_body: int | None,
        hidden: Sequence[int],
    ) -> tuple[int, float] | None:
        """Returns the first geom that a ray meets, and the distance; ``hidden`` geoms and those of one body are left out."""
    def distance(
        self, geoms: tuple[int, int], most: float
    ) -> tuple[float, tuple[float, float, float], tuple[float, float, float]] | None:
        """Returns the distance between two geoms, if it is below ``most``, and the points between which it is measured, m."""
    def forward(self, groups: int) -> None:
        """Computes everything without advancing, and updates some groups of arrays."""
    def rne_post_constraint(self) -> None:
        """Computes and updates the group ``post``."""
    def sensordata(self) -> _Floats:
        """Returns the values of the sensors as they were last computed."""
    def copy_from(self, other: PhysicsData) -> None:
        """Copies everything from another state of the same model."""
    def contacts(self) -> dict[str, _Array]:
        """Returns the contacts as arrays, one entry for each."""
    @property
    def counts(self) -> tuple[int, int]:
        """Number of contacts and of constraint rows."""
    def rows(self) -> dict[str, _Array]:
        """Returns the constraint rows as arrays, one entry for each."""
    def jacobian(self) -> _Floats:
        """Returns the Jacobian of the constraints as a full matrix, (nefc, nv)."""
    def inertia(self) -> _Floats:
        """Returns the joint-space inertia as a full matrix, (nv, nv)."""
    def tendon_jacobian(self) -> _Floats:
        """Returns the Jacobian of tendon lengths as a full matrix, (ntendon, nv)."""

@final
class PhysicsRenderer:
    """Draws states of a model."""

    def __new__(cls, model: PhysicsModel, shown: tuple[tuple[bool, ...], ...] | None = None) -> PhysicsRenderer:
        """Decodes the textures of a model. ``shown``: the geoms, sites, groups of tendons and groups of skins to draw."""
    def draw(
        self,
        data: PhysicsData,
        camera: tuple[int | None, tuple[tuple[float, ...], float, float, float]],
        size: tuple[int, int],
        what: str,
        markers: Sequence[tuple[int, Sequence[float], Sequence[float], Sequence[float], Sequence[float]]],
    ) -> _Array:
        """Draws ``rgb``, ``depth`` or ``segmentation`` of a state, as its arrays show it.

        ``camera`` is a camera of the model, or ``None`` to use the free camera after it: the point that it looks at, distance,
        azimuth and elevation. ``size`` is width and height. The ids of ``markers`` follow those of the model's geoms; each has
        shape, size, position, orientation and colour.
        """

@final
class VectorEnv:
    """Many environments at once, on threads, with arrays that have one row each.

    Resets, steps and :meth:`recv` always return the same read-only arrays, which the next call overwrites; with ``copy`` they
    return new arrays.
    """

    def __new__(
        cls,
        blueprints: Sequence[Blueprint],
        autoreset: str = "next_step",
        threads: int = 0,
        max_memory: int | None = None,
        lazy: bool = False,
        copies: int = 1,
    ) -> VectorEnv:
        """Makes an environment of each blueprint; ``autoreset`` is ``next_step``, ``same_step`` or ``disabled``.

        With ``lazy``, observations and their spaces have no images: :meth:`eyes` returns them. ``copies`` is the number of copies
        of all observations that Python keeps; they count as memory.
        """
    @staticmethod
    def check_memory(
        blueprint: Blueprint, count: int, autoreset: str, threads: int, max_memory: int | None, copies: int
    ) -> None:
        """Refuses more environments than fit into memory, before any list of that length is made.

        Raises:
            MemoryError: The text says how many would fit.
        """

    def reset(
        self,
        seeds: int | Sequence[int | None] | None = None,
        mask: Sequence[bool] | npt.NDArray[np.bool_] | None = None,
        copy: bool = False,
    ) -> dict[str, _Array]:
        """Starts an episode in all environments, or in those of the mask; with one seed, environment i gets the seed plus i."""
    def step(self, actions: npt.ArrayLike, copy: bool = False) -> dict[str, _Array]:
        """Applies an action in each environment, (N, action size), and waits for all."""
    def run(self, actions: npt.ArrayLike) -> None:
        """Applies actions, (K, N, action size), one after the other, and returns nothing."""
    def send(self, actions: npt.ArrayLike, ids: Sequence[int] | npt.NDArray[np.integer[Any]]) -> None:
        """Sends actions, (K, action size), to K environments and returns at once."""
    def recv(
        self, n: int, copy: bool = False
    ) -> tuple[dict[str, _Array], _Floats, _Flags, _Flags, npt.NDArray[np.int64]]:
        """Waits for ``n`` environments; returns observations, rewards, terminated, truncated and their indices."""
    def eyes(self, copy: bool = False) -> dict[str, _Array]:
        """Returns the images of the last rows, and draws them if they are not drawn yet."""
    def close(self) -> None:
        """Ends the threads and frees the environments."""
    @property
    def closed(self) -> bool:
        """Whether :meth:`close` was called."""
    @property
    def flags(self) -> list[_Array]:
        """Rewards, terminated, truncated of the last step (N)."""
    def infos(self) -> dict[str, _Array]:
        """Returns the last rows in new arrays.

        ``steps`` (N); ``touches`` (N, 2, geoms), which geoms the right and the left palm have touched, 1 or 0;
        ``regards`` (N, 4), how often hands were in view, with ``page_regards`` and ``kit_regards``, counted by either rule;
        for tasks ``is_success`` and ``is_failure`` (N) and ``reward_terms`` (N, terms).
        """
    def failures(self) -> list[tuple[int, str]]:
        """Returns the environments that could not continue in the last step, with the reasons."""
    def final_observations(self) -> list[tuple[int, dict[str, _Array]]]:
        """Returns the last observations of the episodes that ended in the last step, with ``same_step``."""
    def info(self, env: int, details: bool = True) -> dict[str, Any]:
        """Returns the information of one environment."""
    def final_info(self, env: int, details: bool = True) -> dict[str, Any] | None:
        """Returns the information of the end of the episode that ended in the last step, with ``same_step``."""
    def compute_reward(
        self, env: int, achieved: npt.ArrayLike, desired: npt.ArrayLike, terms: npt.ArrayLike
    ) -> _Floats:
        """Returns the rewards of one environment's task: see :meth:`Env.compute_reward`."""
    @property
    def reward_terms(self) -> int:
        """Number of values besides goals that rewards depend on."""
    @property
    def num_envs(self) -> int:
        """Number of environments."""
    @property
    def threads(self) -> int:
        """Number of threads that step environments."""
    @property
    def clipped_threads(self) -> str | None:
        """The reason why there are fewer threads than requested, if so."""
    @property
    def in_flight(self) -> int:
        """Number of environments that were sent an action and have not been received."""
    @property
    def action_bounds(self) -> list[npt.NDArray[np.float32]]:
        """Lower and upper bounds of the actions of one environment."""
    @property
    def observation_spaces(self) -> list[_Space]:
        """Key, shape, number type, lower and upper bound of each observation of one environment."""
    def seed_action_spaces(self, seed: int) -> None:
        """Seeds the generators of :meth:`sample_actions` and of start actions: environment i gets the seed plus i."""
    def sample_actions(self) -> npt.NDArray[np.float32]:
        """Returns a random action of each environment, (N, action size), from their own generators."""
    def config(self, env: int) -> dict[str, Any]:
        """Returns the configuration of one environment."""
    def snapshot(self, env: int) -> bytes:
        """Takes a snapshot of one environment."""
    def restore(self, env: int, snapshot: bytes) -> None:
        """Takes one environment back to a snapshot."""
    def model_array(self, env: int, name: str) -> _Array:
        """Returns an array of the model by MuJoCo's name, with all changes, or an option: ``opt.gravity``."""
    def change_model(self, env: int, changes: dict[str, _Array]) -> None:
        """Changes numbers of the model from the next step; takes whole arrays."""
    def set_age(self, env: int, age: float | None) -> dict[str, Any]:
        """Sets the age of one environment's MIMo, months; returns its configuration."""
    def model_changes(self, env: int) -> dict[str, _Array]:
        """Returns the arrays of one environment that differ from those of its scene."""
    def lock(self, env: int, target: str | int, angle: float = 0.0) -> LockReport:
        """Locks a joint, or all joints of a part, of one environment at an angle in rad."""
    def unlock(self, env: int, target: str | int) -> LockReport:
        """Unlocks a joint, or all joints of a part, of one environment."""
    def state_array(self, env: int, name: str) -> _Array:
        """Returns an array of the state of one environment."""
    def render(self, env: int, camera: str, width: int, height: int) -> npt.NDArray[np.uint8]:
        """Draws one environment from a camera of its scene, (height, width, 3)."""

# --- for environments that go through a reset and a step as the Python kit does ---

@final
class Parts:
    """The parts of an environment's reset and step, one by one."""

    FILLED: ClassVar[list[str]]
    """The arrays that ``fill`` writes."""

    def __new__(cls, env: Env) -> Parts: ...
    def reset_data(self) -> None:
        """Resets to ``qpos0`` at rest, without computing anything from it."""
    def forward(self, qpos: npt.ArrayLike, qvel: npt.ArrayLike) -> None:
        """Computes everything at positions (nq,) and velocities (nv,), without sensing it."""
    def set_position(self, qpos: npt.ArrayLike, qvel: npt.ArrayLike) -> None:
        """Sets positions (nq,) and velocities (nv,) for the next physics step."""
    def set_action(self, action: npt.ArrayLike) -> None:
        """Passes an action, (n,), to the actuators."""
    def substep(self) -> None:
        """Updates the actuators, as before each physics step of a step except the first."""
    def physics_step(self) -> None:
        """Advances by one physics step, without sensing."""
    def observe(self) -> None:
        """Senses the current state."""
    def track(self) -> None:
        """Updates the counters of the behavior."""
    def clear_info(self) -> None:
        """Resets the counters of the behavior."""
    def touches(self, right: int, left: int) -> tuple[list[int], list[int]] | None:
        """Returns the geoms that each palm has touched, after the first ``right`` and ``left`` ones."""
    @property
    def regards(self) -> tuple[int, int, int, int] | None:
        """Returns for how many steps each eye has had each hand in view."""
    @property
    def cost(self) -> float:
        """Returns the cost of the current controls, 0 to 1."""
    @property
    def gear(self) -> _Floats:
        """Returns the gears of the actuators, (nu,); with muscles their torques, N m."""
    @property
    def efc_force(self) -> _Floats:
        """Returns the force of each constraint row, N or N m."""
    @property
    def eq_active0(self) -> npt.NDArray[np.uint8]:
        """Returns which equality constraints are active after a reset, (neq,)."""
    @property
    def proprioception(self) -> _Floats:
        """Returns the proprioception of the last observation, (n,)."""
    @property
    def touch(self) -> npt.NDArray[np.float32] | None:
        """Returns the touch of the last observation, (n,), N."""
    def fill(self, arrays: Sequence[_Floats]) -> None:
        """Copies the state into arrays of the same lengths, in the order of ``FILLED``."""
    def fill_start(self, eq_active: npt.NDArray[np.uint8], position: Sequence[_Floats]) -> None:
        """Writes which equality constraints are active, and positions and velocities at the start of the last physics step."""
    def fill_position(self, position: Sequence[_Floats]) -> None:
        """Writes the current positions and velocities."""
    def differences(self, arrays: Sequence[_Floats]) -> int:
        """Returns which arrays differ from the state, as bits 0 to 7.

        They are ``qpos``, ``qvel``, ``ctrl``, ``act``, ``qfrc_applied``, ``xfrc_applied``, ``mocap_pos`` and ``mocap_quat``.
        """

@final
class Blocks:
    """The last values of a sense, as arrays by key: touch (sensors, 1 or 3), N, or parts of the proprioception."""

    def __new__(cls, env: Env, touch: bool, blocks: Sequence[tuple[Any, int, int]]) -> Blocks:
        """Takes keys, each with a range of sensors or numbers (first, end)."""
    def felt(self, moment: int) -> dict[Any, _Array]:
        """Returns the latest values. The arrays stay the same until ``moment`` changes."""

def scene_file(
    config: Mapping[str, Any] | str | os.PathLike[str], assets: str | os.PathLike[str] | None = None
) -> tuple[str, dict[str, bytes]]:
    """Returns the complete document of a configuration's scene, and its images by name."""

def embedded_files() -> dict[str, bytes]:
    """Returns the files that are embedded in the library, by path."""

def model_extras(blueprint: Blueprint) -> dict[str, Any]:
    """Returns names of textures and materials, the number of lights, and MuJoCo's arrays of equality constraints."""

def model_columns(env: Env) -> dict[str, _Array]:
    """Returns new arrays of the look of an environment's model, and of its equalities and keyframes."""

def paint(env: Env, looks: Mapping[str, npt.ArrayLike]) -> None:
    """Changes the look of an environment's model at any time: whole arrays by name, in the form of :func:`model_columns`."""

def set_equalities(env: Env, active: Sequence[bool]) -> None:
    """Sets which equality constraints are active, now and in later episodes."""

def spread_linear(
    sides: Sequence[tuple[int, int, _Array]],
    contacts: tuple[_Floats, _Floats, _Floats, Sequence[int]],
    poses: tuple[_Floats, _Floats],
    skin: tuple[dict[int, _Floats], dict[int, npt.NDArray[np.float32]], dict[int, float]],
) -> None:
    """Adds the force of each contact on each body to the sensors near it, as MIMo's ``spread_linear`` does.

    Args:
        sides: Contact, body and force of each.
        contacts: Frames (n, 9), whose normals are inverted for bodies of first geoms, points (n, 3), distances, and bodies of
            first geoms.
        poses: Positions (nbody, 3) and orientations (nbody, 9) of bodies.
        skin: Positions (n, 3), outputs (n, numbers) and distances between sensors of each body.
    """

def write_video(
    path: str | os.PathLike[str], frames: Sequence[npt.NDArray[np.uint8]], frame_rate: float, width: int, height: int
) -> None:
    """Writes frames (height, width, 3), red, green and blue, as motion JPEG."""
