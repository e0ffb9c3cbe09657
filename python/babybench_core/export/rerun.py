"""Rerun: MIMo in 3D, his eyes, his skin and his numbers over time."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from babybench_core import _native
from babybench_core.export import episodes, library
from babybench_core.export.signals import sensor_forces, signals

if TYPE_CHECKING:
    from babybench_core.data import Episode, Record

_PLANE, _HFIELD, _SPHERE, _CAPSULE, _ELLIPSOID, _CYLINDER, _BOX, _MESH = range(8)
"""Types of geoms, by MuJoCo's numbers."""
_SKIN, _OTHER = (228, 190, 160, 255), (150, 160, 172, 255)
"""Colours of MIMo and of what is around him."""
_WEAK, _STRONG = np.array([250, 220, 70]), np.array([200, 20, 40])
"""Colours of weak and strong touch."""
_FORCES = (0.001, 10.0)
"""Weak and strong touch, N, on a logarithmic scale."""
_HIDDEN = 3
"""The first group of geoms that MuJoCo's viewer hides."""


def write(record: Record, path: Path, every: int, eyes_every: int) -> None:
    """Writes a record; see :meth:`babybench.data.Record.to_rerun`."""
    rr = library("rerun")
    if every < 1 or eyes_every < 0:
        raise ValueError(f"every is {every} and eyes_every {eyes_every}; expected at least 1 and 0")
    numbers = episodes(record)
    # poses follow from positions alone, without any sense
    env = record.environment(vision_active=False, touch_active=False)
    env.reset()
    recording = rr.RecordingStream("babybench", recording_id=f"babybench {record.folder.resolve().name}")
    recording.save(path, default_blueprint=_layout(numbers))
    try:
        for number in numbers:
            root = f"episode_{number}"
            recording.log(root, rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
            _shapes(recording, env, root)
            _poses(recording, record, record[number], env, root, every)
            _scalars(recording, record[number], root)
            _eyes(recording, record, record[number], env, root, eyes_every)
        recording.flush()
    finally:
        recording.disconnect()


def _layout(numbers: list[int]) -> Any:
    """Returns the initial layout of the viewer: the first episode in 3D, the eyes next to it, curves below."""
    import rerun.blueprint as rrb

    root = f"/episode_{numbers[0]}"
    eyes = [rrb.Spatial2DView(origin=f"{root}/eyes/{side}", name=f"{side} eye") for side in ("left", "right")]
    curves = [rrb.TimeSeriesView(origin=f"{root}/{name}", name=name) for name in ("touch", "angle", "reward")]
    return rrb.Blueprint(
        rrb.Vertical(
            rrb.Horizontal(
                rrb.Spatial3DView(origin=root, contents=[f"{root}/world/**"], name="MIMo"),
                rrb.Vertical(*eyes),
                column_shares=[3, 1],
            ),
            rrb.Horizontal(*curves),
            row_shares=[3, 2],
        ),
        rrb.TimePanel(timeline="time"),
        collapse_panels=True,
    )


def _shapes(recording: Any, env: Any, root: str) -> None:
    """Draws the geoms once, in the frames of their bodies."""
    import rerun as rr

    kind, size = env.array("geom_type"), env.array("geom_size").reshape(-1, 3)
    body, group = env.array("geom_bodyid"), env.array("geom_group")
    pos, quat = env.array("geom_pos").reshape(-1, 3), env.array("geom_quat").reshape(-1, 4)
    names, parts, missing = env._core.blueprint.model_names["body"], env.part_names, []
    own = _descendants(env)
    for geom in range(len(kind)):
        half, place = (
            size[geom],
            {"translations": [pos[geom]], "quaternions": [rr.Quaternion(xyzw=quat[geom][[1, 2, 3, 0]])]},
        )
        colour = {"colors": [_SKIN if body[geom] in own else _OTHER]}
        solid: dict[str, Any] = {**colour, "fill_mode": "solid"}
        shape: Any
        if group[geom] >= _HIDDEN:
            continue
        if kind[geom] == _PLANE:
            # a size of 0 is an infinite plane
            extent = [x if x > 0 else 5.0 for x in half[:2]]
            shape = rr.Boxes3D(
                half_sizes=[[*extent, 0.001]], centers=[pos[geom]], quaternions=place["quaternions"], **solid
            )
        elif kind[geom] == _BOX:
            shape = rr.Boxes3D(half_sizes=[half], centers=[pos[geom]], quaternions=place["quaternions"], **solid)
        elif kind[geom] in (_SPHERE, _ELLIPSOID):
            radii = half if kind[geom] == _ELLIPSOID else np.repeat(half[0], 3)
            shape = rr.Ellipsoids3D(half_sizes=[radii], centers=[pos[geom]], quaternions=place["quaternions"], **solid)
        elif kind[geom] == _CAPSULE:
            # Rerun's capsules begin at one end
            down = pos[geom] - half[1] * _axis(quat[geom])
            shape = rr.Capsules3D(
                lengths=[2 * half[1]],
                radii=[half[0]],
                translations=[down],
                quaternions=place["quaternions"],
                **solid,
            )
        elif kind[geom] == _CYLINDER:
            shape = rr.Cylinders3D(
                lengths=[2 * half[1]], radii=[half[0]], centers=[pos[geom]], quaternions=place["quaternions"], **solid
            )
        else:
            missing.append(parts[geom])
            continue
        recording.log(rr.new_entity_path([root, "world", names[body[geom]], f"geom_{geom}"]), shape, static=True)
    if missing:
        text = f"Meshes and height fields are not shown: {', '.join(missing)}."
        recording.log(f"{root}/notes", rr.TextDocument(text), static=True)


def _descendants(env: Any) -> set[int]:
    """Returns MIMo's bodies."""
    parents, names = env.array("body_parentid"), env._core.blueprint.model_names["body"]
    own: set[int] = set()
    for body, parent in enumerate(parents):
        if names[body] in ("mimo_location", "hip") or int(parent) in own:
            own.add(body)
    return own


def _axis(quat: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Returns the z axis of a frame."""
    w, x, y, z = quat
    return np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])


def _times(episode: Episode, steps: npt.NDArray[Any]) -> list[Any]:
    import rerun as rr

    return [rr.TimeColumn("time", duration=episode["time"][steps]), rr.TimeColumn("step", sequence=steps)]


def _poses(recording: Any, record: Record, episode: Episode, env: Any, root: str, every: int) -> None:
    import rerun as rr

    parts, core = _native.Parts(env._core), env._core
    steps = np.arange(0, episode.steps, every)
    qpos, qvel = episode["qpos"].astype(np.float64), episode["qvel"].astype(np.float64)
    places, turns = [], []
    for step in steps:
        parts.forward(qpos[step], qvel[step])
        places.append(core.state_array("xpos").reshape(-1, 3))
        turns.append(core.state_array("xquat").reshape(-1, 4))
    xpos, xquat = np.array(places), np.array(turns)
    times = _times(episode, steps)
    for body, name in enumerate(core.blueprint.model_names["body"]):
        recording.send_columns(
            rr.new_entity_path([root, "world", name]),
            indexes=times,
            columns=rr.Transform3D.columns(translation=xpos[:, body], quaternion=xquat[:, body][:, [1, 2, 3, 0]]),
        )
    if "touch_ptr" in episode and record.has_skin:
        _touch(recording, record, episode, root, steps, xpos, xquat)


def _touch(recording: Any, record: Record, episode: Episode, root: str, steps: Any, xpos: Any, xquat: Any) -> None:
    """Shows the sensors that feel something, where they are."""
    import rerun as rr

    skin = record.skin()
    step, sensor, force = sensor_forces(episode)
    shown = np.isin(step, steps)
    step, sensor, force = step[shown], sensor[shown], force[shown]
    row, body = np.searchsorted(steps, step), skin["body"][sensor]
    points = xpos[row, body] + _turned(xquat[row, body], skin["position"][sensor])
    low, high = np.log(_FORCES)
    share = np.clip((np.log(np.maximum(force, 1e-9)) - low) / (high - low), 0, 1)[:, None]
    colours = (_WEAK * (1 - share) + _STRONG * share).astype(np.uint8)
    lengths = np.bincount(row, minlength=len(steps))
    path, times = f"{root}/world/touch", _times(episode, steps)
    points_of = rr.Points3D.columns(positions=points, colors=colours, radii=np.full(len(points), 0.004))
    recording.send_columns(path, indexes=times, columns=points_of.partition(lengths))
    values = rr.AnyValues.columns(force_N=force, sensor=sensor)
    recording.send_columns(path, indexes=times, columns=[column.partition(lengths) for column in values])


def _turned(quat: npt.NDArray[np.float64], vector: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
    """Turns vectors by quaternions, row by row."""
    w, axis = quat[:, :1], quat[:, 1:]
    cross = np.cross(axis, vector)
    turned: npt.NDArray[np.float64] = vector + 2 * (w * cross + np.cross(axis, cross))
    return turned


def _scalars(recording: Any, episode: Episode, root: str) -> None:
    import rerun as rr

    times = _times(episode, np.arange(episode.steps))
    for signal in signals(episode):
        for label, values in zip(signal.labels, signal.values.T):
            path = rr.new_entity_path([root, signal.name, *([label] if label else [])])
            unit = "" if signal.unit == "1" else f", {signal.unit}"
            recording.log(path, rr.SeriesLines(names=f"{label or signal.name}{unit}"), static=True)
            recording.send_columns(path, indexes=times, columns=rr.Scalars.columns(scalars=values.astype(np.float64)))


def _eyes(recording: Any, record: Record, episode: Episode, env: Any, root: str, eyes_every: int) -> None:
    import rerun as rr

    recorded = "eye_steps" in episode and "eye_left" in episode
    steps: Any = episode["eye_steps"] if recorded else np.arange(0, episode.steps, eyes_every) if eyes_every else []
    parts = _native.Parts(env._core)
    if not recorded and "eye_left" not in env._core.blueprint.model_names["camera"]:
        return
    for k, step in enumerate(steps):
        recording.set_time("time", duration=float(episode["time"][step]))
        recording.set_time("step", sequence=int(step))
        if not recorded:
            parts.forward(episode["qpos"][step].astype(np.float64), episode["qvel"][step].astype(np.float64))
        for side, size in zip(("left", "right"), env._core.blueprint.eye_sizes, strict=True):
            picture = episode[f"eye_{side}"][k] if recorded else env.picture(f"eye_{side}", *size)
            recording.log(f"{root}/eyes/{side}", rr.Image(picture))
    recording.reset_time()
