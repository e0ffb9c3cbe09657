"""Names, subtrees and frames of models and states: the helpers of ``mimoEnv.utils``.

Every function takes MuJoCo's ``MjModel`` and ``MjData`` or their stand-ins. Positions are in m, frames are (3, 3)
matrices whose columns are the axes in the world; vectors have the shape (3,) or (n, 3).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .volumes import Solid, union

Array = NDArray[np.float64]

EPS = 1e-10
"""Below this a sum of forces counts as zero."""

MUJOCO_JOINT_SIZES = {0: 7, 1: 4, 2: 1, 3: 1}
"""Number of entries in ``qpos`` of each type of joint: free, ball, slide, hinge."""

MUJOCO_DOF_SIZES = {0: 6, 1: 3, 2: 1, 3: 1}
"""Number of entries in ``qvel`` of each type of joint: free, ball, slide, hinge."""

JOINT_EQUALITY = 2
"""MuJoCo's number for equality constraints between joints."""


# --- vectors ---


def rotate_vector(vector: ArrayLike, rot_matrix: ArrayLike) -> Array:
    """Returns ``rot_matrix @ vector``; several vectors are columns."""
    return np.asarray(np.asarray(rot_matrix).dot(vector))


def rotate_vector_transpose(vector: ArrayLike, rot_matrix: ArrayLike) -> Array:
    """Returns ``rot_matrix.T @ vector``; several vectors are columns."""
    return np.asarray(np.transpose(np.asarray(rot_matrix)).dot(vector))


def weighted_sum_vectors(vector1: ArrayLike, vector2: ArrayLike, weight1: float, weight2: float) -> Array:
    """Returns the weighted mean of two vectors."""
    weighted = np.asarray(vector1) * weight1 + np.asarray(vector2) * weight2
    return np.asarray(weighted / (weight1 + weight2))


def normalize_vectors(vectors: ArrayLike) -> Array:
    """Normalizes vectors along the last axis."""
    return np.asarray(np.asarray(vectors) / np.linalg.norm(vectors, axis=-1, keepdims=True))


# --- names and trees ---


def _id(kind: str, model: Any, number: int | None, name: str | None) -> int:
    if number is None:
        if name is None:
            raise TypeError(f"give the number of a {kind} ({kind}_id) or its name ({kind}_name)")
        number = getattr(model, kind)(name).id
    return number


def get_geom_id(mujoco_model: Any, geom_id: int | None = None, geom_name: str | None = None) -> int:
    """Returns the id of a geom by id or by name; the id wins."""
    return _id("geom", mujoco_model, geom_id, geom_name)


def get_body_id(mujoco_model: Any, body_id: int | None = None, body_name: str | None = None) -> int:
    """Returns the id of a body by id or by name; the id wins."""
    return _id("body", mujoco_model, body_id, body_name)


def get_geoms_for_body(sim_model: Any, body_id: int) -> range:
    """Returns the ids of the geoms of a body."""
    first = sim_model.body_geomadr[body_id]
    return range(first, first + sim_model.body_geomnum[body_id])


def get_child_bodies(sim_model: Any, body_id: int) -> list[int]:
    """Returns the ids of a body and of all below it: each body before its children, siblings in reverse order."""
    children: dict[int, list[int]] = {}
    for body, parent in enumerate(np.asarray(sim_model.body_parentid).tolist()):
        children.setdefault(parent, []).append(body)
    found = []
    waiting = [body_id]
    while waiting:
        body = waiting.pop()
        found.append(body)
        # the world is its own parent
        waiting.extend(child for child in children.get(body, ()) if child != body)
    return found


def get_sensor_addr(mujoco_model: Any, sensor_id: int) -> range:
    """Returns the slice of a sensor's values in ``sensordata``."""
    first = mujoco_model.sensor_adr[sensor_id]
    return range(first, first + mujoco_model.sensor_dim[sensor_id])


def get_data_for_sensor(mujoco_model: Any, mujoco_data: Any, sensor_name: str) -> Array:
    """Returns the values of a sensor."""
    where = get_sensor_addr(mujoco_model, mujoco_model.sensor(sensor_name).id)
    return np.asarray(mujoco_data.sensordata[where.start : where.stop])


# --- joints ---


def get_joint_qpos_addr(mujoco_model: Any, joint_id: int) -> range:
    """Returns the indices of a joint in ``qpos``."""
    first = mujoco_model.jnt_qposadr[joint_id]
    return range(first, first + MUJOCO_JOINT_SIZES[int(mujoco_model.jnt_type[joint_id])])


def get_joint_qvel_addr(mujoco_model: Any, joint_id: int) -> range:
    """Returns the indices of a joint in ``qvel``."""
    first = mujoco_model.jnt_dofadr[joint_id]
    return range(first, first + MUJOCO_DOF_SIZES[int(mujoco_model.jnt_type[joint_id])])


def set_joint_qpos(mujoco_model: Any, mujoco_data: Any, joint_name: str, qpos: ArrayLike) -> None:
    """Sets the position of a joint, rad or m; for a free joint, position and quaternion (7)."""
    where = get_joint_qpos_addr(mujoco_model, mujoco_model.joint(joint_name).id)
    mujoco_data.qpos[where.start : where.stop] = qpos


def set_joint_locking_angle(mujoco_model: Any, joint_name: str, angle: float, constraint_id: int | None = None) -> None:
    """Sets the angle, rad from the reference pose, at which :func:`lock_joint` holds a joint after the next reset."""
    constraint = mujoco_model.equality(joint_name if constraint_id is None else int(np.ravel(constraint_id)[0]))
    constraint.data[0] = np.ravel(angle)[0]
    constraint.data[1:] = 0


def _scalar(value: Any) -> int:
    return int(np.ravel(value)[0])


def lock_joint(mujoco_model: Any, joint_name: str, joint_angle: float | None = None) -> None:
    """Locks a joint at the next reset: at an angle, rad, or at the angle set for it, unless something else holds it."""
    own = mujoco_model.equality(joint_name)
    if joint_angle is not None:
        set_joint_locking_angle(mujoco_model, joint_name, joint_angle, own.id)
    else:
        joint = _scalar(own.obj1id)
        for number in range(mujoco_model.neq):
            other = mujoco_model.equality(number)
            if number == own.id or _scalar(other.type) != JOINT_EQUALITY or not mujoco_model.eq_active0[number]:
                continue
            if joint in (_scalar(other.obj1id), _scalar(other.obj2id)):
                return
    mujoco_model.eq_active0[own.id] = 1  # `own.active0` is a copy in MuJoCo 3.9


def unlock_joint(mujoco_model: Any, joint_name: str) -> None:
    """Unlocks a joint at the next reset."""
    mujoco_model.eq_active0[mujoco_model.equality(joint_name).id] = 0


def determine_geom_masses(
    mujoco_model: Any, mujoco_data: Any, body_ids: list[int], target_mass: float, print_out: bool = False
) -> dict[str, list[float]]:
    """Returns the mass of each geom of some bodies, kg, with which the bodies have a total mass and all the same density.

    Where geoms of one body overlap, space counts once; overlaps between bodies do not matter. MIMo's own measures meshes
    with edges of 1 mm, by trimesh; here the volumes are those of the geoms.

    Args:
        mujoco_model: The model.
        mujoco_data: Its state, which does not matter.
        body_ids: The bodies. Each needs a geom.
        target_mass: Their total mass, kg.
        print_out: Whether to print masses, volume and density.

    Raises:
        ValueError: A body has no geom, or one without a volume, such as a plane.
    """
    solids: dict[str, list[Solid]] = {}
    for body in body_ids:
        name = mujoco_model.body(body).name
        solids[name] = [Solid.of_geom(mujoco_model, geom) for geom in get_geoms_for_body(mujoco_model, body)]
        if not solids[name]:
            raise ValueError(f"body {name!r} has no geoms, so no volume: leave it out")
    volumes = {name: union(parts) for name, parts in solids.items()}
    density = target_mass / sum(volumes.values())
    masses = {}
    for name, parts in solids.items():
        share = density * volumes[name] / sum(part.volume for part in parts)
        masses[name] = [part.volume * share for part in parts]
    if print_out:
        mass = sum(float(mujoco_model.body_mass[body]) for body in body_ids)
        total = sum(volumes.values())
        print(
            f"mass now: {mass:.6g} kg; target: {target_mass:.6g} kg; volume: {total:.6g} m^3; density: {density:.6g} kg/m^3"
        )
        for name, parts_of_mass in masses.items():
            print(f"{name}: {', '.join(f'{part:.4e}' for part in parts_of_mass)} kg")
    return masses


# --- frames ---


def get_geom_position(mujoco_data: Any, geom_id: int) -> Array:
    """Returns the position of a geom in the world, m."""
    return np.asarray(mujoco_data.geom(geom_id).xpos)


def get_body_position(mujoco_data: Any, body_id: int) -> Array:
    """Returns the position of a body in the world, m."""
    return np.asarray(mujoco_data.body(body_id).xpos)


def get_geom_rotation(mujoco_data: Any, geom_id: int) -> Array:
    """Returns the orientation of a geom in the world."""
    return np.reshape(mujoco_data.geom(geom_id).xmat, (3, 3))


def get_body_rotation(mujoco_data: Any, body_id: int) -> Array:
    """Returns the orientation of a body in the world."""
    return np.reshape(mujoco_data.body(body_id).xmat, (3, 3))


def _to_world(rotation: Array, vector: ArrayLike) -> Array:
    return np.transpose(rotation.dot(np.transpose(vector)))


def _from_world(rotation: Array, vector: ArrayLike) -> Array:
    return np.transpose(rotation.T.dot(np.transpose(vector)))


def geom_rot_to_world(mujoco_data: Any, vector: ArrayLike, geom_id: int) -> Array:
    """Turns vectors from a geom's frame into the world's."""
    return _to_world(get_geom_rotation(mujoco_data, geom_id), vector)


def body_rot_to_world(mujoco_data: Any, vector: ArrayLike, body_id: int) -> Array:
    """Turns vectors from a body's frame into the world's."""
    return _to_world(get_body_rotation(mujoco_data, body_id), vector)


def world_rot_to_geom(mujoco_data: Any, vector: ArrayLike, geom_id: int) -> Array:
    """Turns vectors from the world's frame into a geom's."""
    return _from_world(get_geom_rotation(mujoco_data, geom_id), vector)


def world_rot_to_body(mujoco_data: Any, vector: ArrayLike, body_id: int) -> Array:
    """Turns vectors from the world's frame into a body's."""
    return _from_world(get_body_rotation(mujoco_data, body_id), vector)


def geom_pos_to_world(mujoco_data: Any, position: ArrayLike, geom_id: int) -> Array:
    """Moves positions from a geom's frame into the world's."""
    return geom_rot_to_world(mujoco_data, position, geom_id) + get_geom_position(mujoco_data, geom_id)


def body_pos_to_world(mujoco_data: Any, position: ArrayLike, body_id: int) -> Array:
    """Moves positions from a body's frame into the world's."""
    return body_rot_to_world(mujoco_data, position, body_id) + get_body_position(mujoco_data, body_id)


def world_pos_to_geom(mujoco_data: Any, position: ArrayLike, geom_id: int) -> Array:
    """Moves positions from the world's frame into a geom's."""
    return world_rot_to_geom(mujoco_data, np.asarray(position) - get_geom_position(mujoco_data, geom_id), geom_id)


def world_pos_to_body(mujoco_data: Any, position: ArrayLike, body_id: int) -> Array:
    """Moves positions from the world's frame into a body's."""
    return world_rot_to_body(mujoco_data, np.asarray(position) - get_body_position(mujoco_data, body_id), body_id)


def geom_pos_to_body(mujoco_data: Any, position: ArrayLike, geom_id: int, body_id: int) -> Array:
    """Moves positions from a geom's frame to a body's."""
    return world_pos_to_body(mujoco_data, geom_pos_to_world(mujoco_data, position, geom_id), body_id)


def body_pos_to_geom(mujoco_data: Any, position: ArrayLike, body_id: int, geom_id: int) -> Array:
    """Moves positions from a body's frame to a geom's."""
    return world_pos_to_geom(mujoco_data, body_pos_to_world(mujoco_data, position, body_id), geom_id)


def geom_pos_to_geom(mujoco_data: Any, position: ArrayLike, geom_id_source: int, geom_id_target: int) -> Array:
    """Moves positions from a geom's frame to another's."""
    return world_pos_to_geom(mujoco_data, geom_pos_to_world(mujoco_data, position, geom_id_source), geom_id_target)


def body_pos_to_body(mujoco_data: Any, position: ArrayLike, body_id_source: int, body_id_target: int) -> Array:
    """Moves positions from a body's frame to another's."""
    return world_pos_to_body(mujoco_data, body_pos_to_world(mujoco_data, position, body_id_source), body_id_target)


def geom_rot_to_body(mujoco_data: Any, vector: ArrayLike, geom_id: int, body_id: int) -> Array:
    """Turns vectors from a geom's frame to a body's."""
    return world_rot_to_body(mujoco_data, geom_rot_to_world(mujoco_data, vector, geom_id), body_id)


def body_rot_to_geom(mujoco_data: Any, vector: ArrayLike, body_id: int, geom_id: int) -> Array:
    """Turns vectors from a body's frame to a geom's."""
    return world_rot_to_geom(mujoco_data, body_rot_to_world(mujoco_data, vector, body_id), geom_id)


def geom_rot_to_geom(mujoco_data: Any, vector: ArrayLike, geom_id_source: int, geom_id_target: int) -> Array:
    """Turns vectors from a geom's frame to another's."""
    return world_rot_to_geom(mujoco_data, geom_rot_to_world(mujoco_data, vector, geom_id_source), geom_id_target)


def body_rot_to_body(mujoco_data: Any, vector: ArrayLike, body_id_source: int, body_id_target: int) -> Array:
    """Turns vectors from a body's frame to another's."""
    return world_rot_to_body(mujoco_data, body_rot_to_world(mujoco_data, vector, body_id_source), body_id_target)


# --- angles ---


def angle_between_vectors(v1: ArrayLike, v2: ArrayLike) -> float:
    """Returns the angle between two vectors, degrees; infinite where one is zero."""
    a, b = np.asarray(v1), np.asarray(v2)
    lengths = np.linalg.norm(a), np.linalg.norm(b)
    if 0 in lengths:
        return float("inf")
    return float(np.degrees(np.arccos(np.clip(np.dot(a / lengths[0], b / lengths[1]), -1.0, 1.0))))


def angle_between_vector_and_rotation(vector: ArrayLike, rotation_matrix: ArrayLike) -> float:
    """Returns the angle between a vector and the third column of a rotation, degrees; infinite where the vector is zero."""
    return angle_between_vectors(vector, np.asarray(rotation_matrix)[:, 2])


# --- plots ---


def _axes(limit: float, title: str) -> Any:
    from matplotlib import pyplot

    axes = pyplot.figure().add_subplot(111, projection="3d")
    axes.set_xlim([-limit, limit])
    axes.set_ylim([-limit, limit])
    axes.set_zlim([-limit, limit])
    axes.set_title(title)
    return axes


def _shown(axes: Any, show: bool) -> tuple[Any, Any]:
    if show:
        axes.figure.show()
    return axes.figure, axes


def plot_points(points: ArrayLike, limit: float = 1.0, title: str = "", show: bool = True) -> tuple[Any, Any]:
    """Plots points (n, 3) in a cube of half width ``limit`` with matplotlib, and returns figure and axes."""
    axes = _axes(limit, title)
    axes.scatter(*np.transpose(points), color="k")
    return _shown(axes, show)


def plot_forces(
    points: ArrayLike, vectors: ArrayLike, limit: float = 1.0, title: str = "", show: bool = True
) -> tuple[Any, Any]:
    """Plots points (n, 3) with arrows (n, 3) for the forces there, the largest a third of ``limit`` long."""
    axes = _axes(limit, title)
    forces = np.asarray(vectors, dtype=float)
    largest = np.linalg.norm(forces, axis=-1).max(initial=0.0)
    axes.scatter(*np.transpose(points), color="k", s=5, alpha=0.3)
    if largest > 0:
        axes.quiver(*np.transpose(points), *np.transpose(forces * (limit / 3 / largest)), color="r")
    return _shown(axes, show)
