"""MIMo's sense of touch: ``mimoTouch``.

It runs in the engine. These classes show where the sensors are and what they feel, and let subclasses compute it in another way.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from babybench_core import _native

from . import utils
from .course import Share
from .replaceable import replaced
from .touch_base import DiscreteTouch, SensorMesh, Touch
from .utils import EPS

if TYPE_CHECKING:
    from babybench_core.records import TouchBody

    from .sensing import SensingEnv

__all__ = ["DiscreteTouch", "Touch", "TrimeshTouch", "scale_linear"]

Array = NDArray[np.float64]

_LEAST_FORCE = 1e-9
"""Least normal force of a contact that is felt, N."""


def scale_linear(force: ArrayLike, distances: ArrayLike, scale: float, **_: Any) -> Array:
    """Returns a force (3,) at each distance (n,), m, falling to zero at ``scale``: (n, 3)."""
    weights = np.maximum(0.0, 1.0 - np.asarray(distances) / scale)
    return np.asarray(weights[:, None] * np.asarray(force))


class TrimeshTouch(Touch):
    """Sensors spread over the surface of the bodies, which feel the forces of contacts near them.

    MIMo's own class gets normals by :meth:`get_contact_normal`, which inverts them in place where the sensing body is the first
    of a contact. So these normals are inverted for later uses of a contact's frame, and if touch is felt twice at one instant.
    """

    VALID_TOUCH_TYPES: ClassVar[dict[str, int]] = {"force_vector": 3, "force_vector_global": 3, "normal_force": 3}
    VALID_RESPONSE_FUNCTIONS: ClassVar[list[str]] = ["nearest", "spread_linear"]

    _uncalled = frozenset(
        {
            "add_body",
            "visualize_contacts_subtree",
            "_convert_active_sensor_idx",
            "_get_mesh",
            "_get_mesh_adjacency_graph",
            "_get_nearest_vertex",
            "_get_sensor_count_submesh",
            "_nearest_k_search",
            "_nearest_within_distance_search",
        }
    )
    _instead = "replace get_nearest_sensor or get_sensors_within_distance, which find the sensors near a contact"

    def __init__(self, env: SensingEnv, touch_params: dict[str, Any]) -> None:
        """Takes the environment."""
        super().__init__(env, touch_params)
        layout = {skin["body"]: skin for skin in env._core.engine.touch_layout()}
        missing = [env._core.names["body"][body] for body in self.sensor_scales if body not in layout]
        if missing:
            raise ValueError(f"touch: the engine has no sensors on {', '.join(missing)}")
        self.sensor_positions = {body: np.asarray(layout[body]["positions"]) for body in self.sensor_scales}
        self._check_spacings(layout)
        self.meshes = {body: SensorMesh(_fixed(positions)) for body, positions in self.sensor_positions.items()}
        self.active_vertices = {body: np.ones(len(p), dtype=bool) for body, p in self.sensor_positions.items()}
        self.plotting_limits: dict[int, float] = {}
        self._sensor_counts = {body: len(positions) for body, positions in self.sensor_positions.items()}
        places = [(body, layout[body]["offset"], count) for body, count in self._sensor_counts.items()]
        self._skin = _native.Blocks(env._core.engine, True, [(body, at, at + count) for body, at, count in places])
        self._shape = (-1, self.touch_size)
        self._shown = self._felt = -1
        self._outputs: dict[int, NDArray[np.float32]] = {}
        self._share = Share.NOTHING
        self._contacts: list[tuple[int, int, Array]] = []
        self._inverted: dict[str, NDArray[Any]] | None = None
        env._core.frames = self._frames
        self._sensed = np.isin(env._core.body_of_geom, list(self.sensor_positions))
        if not self._feels_as_the_engine(len(layout)):
            self._share = Share.SENSES
            self._outputs = self.get_empty_sensor_dict(self.touch_size)
        self._made()

    def _check_spacings(self, layout: dict[int, TouchBody]) -> None:
        """Refuses distances between sensors that are not those of the environment's.

        Raises:
            ValueError: The text names the first body.
        """
        for body, spacing in self.sensor_scales.items():
            known = layout[body]["spacing"]
            if abs(spacing - known) > 1e-9 * known:
                raise ValueError(
                    f"touch_params: the sensors of {self._core.names['body'][body]} are {known:g} m apart in this "
                    f"environment, not {spacing:g} m: give the distances to the environment's own touch_params"
                )

    def _feels_as_the_engine(self, bodies: int) -> bool:
        """Returns whether all steps from a contact to the output are the engine's, and none a subclass's."""
        config = self._core.config
        return (
            len(self.sensor_scales) == bodies
            and self.touch_size == _SIZES.get(self.touch_type)
            and config["touch_function"] == self.touch_type
            and config["touch_response"] == self.response_type
            and not replaced(self, _ORIGINAL, _STEPS)
        )

    @property
    def _plain(self) -> bool:
        """Whether the engine computes the output."""
        return self._share is Share.NOTHING

    def _taken_over(self) -> None:
        """Computes in Python from now on, because a script has replaced a step."""
        self.__dict__["_of_script"] = {}
        if "_parts_of_mimo" not in self.__dict__ or self._share is not Share.NOTHING:
            return
        if self._felt_by_engine():
            self._frames()  # while the normals are known to be the engine's
            self._outputs = self._skin.felt(self._core.observed)
        else:
            self._outputs = self.get_empty_sensor_dict(self.touch_size)
        self._share = Share.SENSES
        super()._taken_over()

    # --- sensors ---

    def sensing_bodies(self) -> list[int]:
        """Returns the ids of the bodies with sensors."""
        return list(self.meshes)

    def has_sensors(self, body_id: int) -> bool:
        """Returns whether a body has sensors."""
        return body_id in self.sensor_positions

    def get_sensor_count(self, body_id: int) -> int:
        """Returns the number of sensors of a body."""
        return self._sensor_counts[body_id]

    def get_total_sensor_count(self) -> int:
        """Returns the number of all sensors."""
        return sum(self._sensor_counts.values())

    def _sensor_distances(self, point: ArrayLike, mesh: SensorMesh) -> Array:
        """Returns the distances, m, between a point and the sensors of a mesh."""
        return np.asarray(np.linalg.norm(mesh.vertices - np.asarray(point), axis=-1))

    def get_nearest_sensor(self, contact_pos: ArrayLike, body_id: int) -> tuple[int, float]:
        """Returns the sensor of a body that is nearest to a point in the frame of the body, and its distance, m."""
        distances = self._sensor_distances(contact_pos, self.meshes[body_id])
        nearest = int(distances.argmin())
        return nearest, float(distances[nearest])

    def get_k_nearest_sensors(
        self, contact_pos: ArrayLike, body_id: int, k: int, k_margin: float = 1.4
    ) -> tuple[NDArray[np.int_], Array]:
        """Returns the k sensors of a body that are nearest to a point in the frame of the body, and their distances, m."""
        distances = self._sensor_distances(contact_pos, self.meshes[body_id])
        nearest = np.argsort(distances, kind="stable")[:k]
        return nearest, distances[nearest]

    def get_sensors_within_distance(
        self, contact_pos: ArrayLike, body_id: int, distance_limit: float, distance_margin: float = 1.5
    ) -> tuple[NDArray[np.int_], Array]:
        """Returns the sensors of a body within a distance of a point in the frame of the body, and their distances, m."""
        distances = self._sensor_distances(contact_pos, self.meshes[body_id])
        near = np.flatnonzero(distances < distance_limit)
        return near, distances[near]

    # --- contacts ---

    def _sides(self, contact_id: int, body_id: int) -> float:
        """Returns the sign of a contact's force on a body: -1 for the body of the first geom, 1 for that of the second."""
        first = self._core.contacts()["geom1"][contact_id]
        return -1.0 if self._core.body_of_geom[first] == body_id else 1.0

    def get_contact_position_world(self, contact_id: int) -> Array:
        """Returns the point of a contact, halfway between the surfaces, in the world, m."""
        return np.array(self._core.contacts()["pos"][contact_id])

    def get_contact_position_relative(self, contact_id: int, body_id: int) -> Array:
        """Returns the point of a contact on the surface of a body, in the frame of the body, m."""
        contacts = self._core.contacts()
        point = utils.world_pos_to_body(self._core.poses, self.get_contact_position_world(contact_id), body_id)
        distance = contacts["dist"][contact_id]
        if distance >= 0:
            return point
        return np.asarray(point + self.get_contact_normal(contact_id, body_id) * distance / 2)

    def get_raw_force(self, contact_id: int, body_id: int) -> Array:
        """Returns the force of a contact on a body in the frame of the contact, N: normal, two tangents."""
        return np.asarray(self._core.contacts()["force"][contact_id][:3] * self._sides(contact_id, body_id))

    def get_contact_normal(self, contact_id: int, body_id: int) -> Array:
        """Returns the unit normal of a contact into a body, in its frame; inverts it in place for that of the first geom."""
        normal = self._frames()[contact_id][:3]
        normal *= self._sides(contact_id, body_id)
        return utils.world_rot_to_body(self._core.poses, normal, body_id)

    def _frames(self, pull: bool = True) -> Array:
        """Returns the frames of all contacts, (n, 9), as MIMo's own has left them."""
        contacts = self._core.contacts(pull)
        if self._felt_by_engine() and self._inverted is not contacts:
            self._inverted = contacts  # the engine, which felt first, does not invert them
            self._invert(contacts)
        return contacts["frame"]

    def _felt_by_engine(self) -> bool:
        return self._core.course.moment.felt and self._share is Share.NOTHING

    def _invert(self, contacts: dict[str, NDArray[Any]]) -> None:
        """Inverts the normals that one pass of feeling inverts."""
        active = (abs(contacts["force"][:, 0]) >= _LEAST_FORCE) & (contacts["dist"] < 0)
        contacts["frame"][active & self._sensed[contacts["geom1"]], :3] *= -1

    def force_vector_global(self, contact_id: int, body_id: int) -> Array:
        """Returns the force of a contact on a body, in the world, N."""
        frame = np.reshape(self._frames()[contact_id], (3, 3))
        return np.asarray(frame.T.dot(self.get_raw_force(contact_id, body_id)))

    def force_vector(self, contact_id: int, body_id: int) -> Array:
        """Returns the force of a contact on a body, in the frame of the body, N."""
        return utils.world_rot_to_body(self._core.poses, self.force_vector_global(contact_id, body_id), body_id)

    def normal_force(self, contact_id: int, body_id: int) -> Array:
        """Returns MIMo's normal force of a contact on a body: along the first column of the contact's frame; body frame, N."""
        frame = np.reshape(self._frames()[contact_id], (3, 3))
        force = self.get_raw_force(contact_id, body_id)[0] * frame[:, 0]
        return utils.world_rot_to_body(self._core.poses, force, body_id)

    def get_contacts(self) -> list[tuple[int, int, Array]]:
        """Returns contact, body and force (``touch_function``) for each sensing side of each contact that is felt."""
        contacts, sides = self._core.contacts(), []
        own_force, own_sensors = self._own("get_raw_force"), self._own("has_sensors")
        normals, pairs = contacts["force"][:, 0], [contacts["geom1"], contacts["geom2"]]
        bodies = [self._core.body_of_geom[geoms].tolist() for geoms in pairs]
        if own_force or own_sensors:
            candidates = range(len(normals))
        else:  # most contacts have no sensing body
            felt = self._sensed[pairs[0]] | self._sensed[pairs[1]]
            candidates = np.flatnonzero(felt & (abs(normals) >= _LEAST_FORCE)).tolist()
        for number in candidates:
            pair = [side[number] for side in bodies]
            sensing = [body for body in pair if self.has_sensors(body)]
            if (
                sensing
                and abs(self.get_raw_force(number, pair[0])[0] if own_force else normals[number]) >= _LEAST_FORCE
            ):
                sides += [(number, body, self.touch_function(number, body)) for body in sensing]
        self.contact_tuples = sides
        return sides

    @property
    def contact_tuples(self) -> list[tuple[int, int, Array]]:
        """Returns what :meth:`get_contacts` found when touch was last felt."""
        if self._share is Share.SENSES or self._felt == self._core.observed:
            return self._contacts
        felt = self._felt_by_engine()
        self._frames()
        contacts = self._core.contacts()
        if felt:  # as they were before
            self._invert(contacts)
        sides = self.get_contacts()
        if felt:
            self._invert(contacts)
        return sides

    @contact_tuples.setter
    def contact_tuples(self, sides: list[tuple[int, int, Array]]) -> None:
        self._contacts, self._felt = sides, self._core.observed

    # --- output ---

    @property
    def sensor_outputs(self) -> dict[int, NDArray[np.float32]]:
        """Returns what the sensors of each body felt last, (n, touch_size), N, in the order of ``sensor_positions``."""
        moment = self._core.observed
        if self._share is Share.SENSES or self._shown == moment:
            return self._outputs
        return self._skin.felt(moment)

    @sensor_outputs.setter
    def sensor_outputs(self, outputs: dict[int, NDArray[np.float32]]) -> None:
        self._outputs, self._shown = outputs, self._core.observed

    def get_empty_sensor_dict(self, size: int) -> dict[int, NDArray[np.float32]]:
        """Returns zeros for each body, (n, size)."""
        return {body: np.zeros((self.get_sensor_count(body), size), dtype=np.float32) for body in self.meshes}

    def flatten_sensor_dict(self, sensor_dict: dict[int, NDArray[Any]]) -> NDArray[Any]:
        """Returns the arrays of all bodies, by ascending id, as one: (sensors, size)."""
        return np.concatenate([sensor_dict[body] for body in sorted(self.meshes)])

    def get_touch_obs(self) -> NDArray[np.float32]:
        """Feels, and returns the output of all bodies, by ascending id: (sensors, touch_size), N."""
        core = self._core
        core.observe()
        first = not core.course.moment.felt
        core.course.change("feel")
        if first and self._share is Share.NOTHING:
            return core.touch().reshape(self._shape)
        sides = self.get_contacts()
        self.sensor_outputs = self.get_empty_sensor_dict(self.touch_size)
        if self._own("spread"):
            for contact, body, force in sides:
                self.response_function(contact, body, force)
        else:
            self._spread(sides)
        return self.flatten_sensor_dict(self.sensor_outputs)

    def _own(self, what: str) -> bool:
        """Returns whether a script has replaced a method, or ``spread``: one of those that spread a force."""
        known: dict[str, bool] = self.__dict__.setdefault("_of_script", {})
        found = known.get(what)
        if found is None:
            if what == "spread":
                found = (
                    getattr(self.response_function, "__func__", None) is not TrimeshTouch.spread_linear
                    or bool(replaced(self, _ORIGINAL, _SPREADING))
                    or not self._replaced <= _HARMLESS
                )
            else:
                found = bool(replaced(self, _ORIGINAL, (what,)))
            known[what] = found
        return found

    def _spread(self, sides: list[tuple[int, int, Array]]) -> None:
        """Calls :meth:`spread_linear` of the engine for all forces."""
        contacts, poses = self._core.contacts(), self._core.poses
        first = self._core.body_of_geom[contacts["geom1"]].tolist()
        _native.spread_linear(
            sides,
            (self._frames(), contacts["pos"], contacts["dist"], first),
            (poses.xpos, poses.xmat),
            (self.sensor_positions, self.sensor_outputs, self.sensor_scales),
        )

    def spread_linear(self, contact_id: int, body_id: int, force: ArrayLike) -> None:
        """Adds a force to the sensors within twice their distance of a contact, less to those farther away."""
        point = self.get_contact_position_relative(contact_id, body_id)
        scale = self.sensor_scales[body_id]
        sensors, distances = self.get_sensors_within_distance(point, body_id, 3 * scale)
        spread = scale_linear(force, distances, 2 * scale)
        total = abs(spread[:, 0].sum())
        factor = abs(np.asarray(force)[0] / total) if total > EPS else 0.0
        self.sensor_outputs[body_id][sensors] += spread * factor

    def nearest(self, contact_id: int, body_id: int, force: ArrayLike) -> None:
        """Adds a force to the sensor that is nearest to a contact."""
        sensor, _ = self.get_nearest_sensor(self.get_contact_position_relative(contact_id, body_id), body_id)
        self.sensor_outputs[body_id][sensor] += np.asarray(force)

    # --- plots ---

    def _bodies(self, ids: list[int], names: list[str]) -> list[int]:
        known = self._core.names["body"]
        return list(ids) + [known.index(name) for name in names]

    def _plot(self, bodies: list[int], title: str, forces: bool) -> tuple[Any, Any]:
        """Plots the sensors of bodies, about the first of them."""
        poses = self._core.poses
        bodies = [body for body in bodies if self.has_sensors(body)]
        if not bodies:
            raise ValueError("none of these bodies has touch sensors")
        origin = utils.get_body_position(poses, bodies[0])
        points = [utils.body_pos_to_world(poses, self.sensor_positions[body], body) - origin for body in bodies]
        limit = float(np.abs(np.concatenate(points)).max())
        if not forces:
            return utils.plot_points(np.concatenate(points), limit=limit, title=title, show=False)
        felt = [utils.body_rot_to_world(poses, self.sensor_outputs[body], body) for body in bodies]
        return utils.plot_forces(np.concatenate(points), np.concatenate(felt), limit=limit, title=title, show=False)

    def plot_sensors_body(
        self, body_id: int | None = None, body_name: str | None = None, title: str = ""
    ) -> tuple[Any, Any]:
        """Plots the sensors of a body with matplotlib, and returns figure and axes."""
        return self._plot([self._bodies([], [body_name or ""])[0] if body_id is None else body_id], title, forces=False)

    def plot_force_body(
        self, body_id: int | None = None, body_name: str | None = None, title: str = ""
    ) -> tuple[Any, Any]:
        """Plots what the sensors of a body feel, with matplotlib; returns figure and axes."""
        return self._plot([self._bodies([], [body_name or ""])[0] if body_id is None else body_id], title, forces=True)

    def plot_force_bodies(
        self, body_ids: list[int] | None = None, body_names: list[str] | None = None, title: str = "", **_: Any
    ) -> tuple[Any, Any]:
        """Plots what the sensors of several bodies feel, with matplotlib; returns figure and axes."""
        return self._plot(self._bodies(body_ids or [], body_names or []), title, forces=True)

    def plot_force_body_subtree(
        self,
        body_id: int | None = None,
        body_name: str | None = None,
        title: str = "",
        show_contact_points: bool = False,
    ) -> tuple[Any, Any]:
        """Plots with matplotlib what the sensors of a body and those below it feel; returns figure and axes."""
        root = self._bodies([], [body_name or ""])[0] if body_id is None else body_id
        return self._plot(utils.get_child_bodies(self._core.tree, root), title, forces=True)


def _fixed(array: Array) -> Array:
    """Returns a read-only view."""
    view: Array = array.view()
    view.flags.writeable = False
    return view


_SIZES = dict(TrimeshTouch.VALID_TOUCH_TYPES)
_ORIGINAL = dict(vars(TrimeshTouch))
_STEPS: Iterable[str] = (
    *_SIZES,
    *TrimeshTouch.VALID_RESPONSE_FUNCTIONS,
    "contact_tuples",
    "flatten_sensor_dict",
    "get_contact_normal",
    "get_contact_position_relative",
    "get_contact_position_world",
    "get_contacts",
    "get_empty_sensor_dict",
    "get_nearest_sensor",
    "get_raw_force",
    "get_sensor_count",
    "get_sensors_within_distance",
    "has_sensors",
    "sensor_outputs",
    "_sensor_distances",
)
"""Methods between a contact and the output, as this module defines them: if a script replaces one, all are called."""
_SPREADING = (
    "spread_linear",
    "get_contact_normal",
    "get_contact_position_relative",
    "get_contact_position_world",
    "get_sensors_within_distance",
    "sensor_outputs",
    "_sensor_distances",
)
"""Methods that spread a force."""
_HARMLESS = frozenset({"sensor_scales", "touch_function", "touch_size", "touch_type"})
"""Attributes that a script may replace without replacing how a force spreads."""
