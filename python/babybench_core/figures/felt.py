"""How long touch sensors felt something, from any contact or only from his own body."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from babybench_core.export.signals import sensor_forces

if TYPE_CHECKING:
    from babybench_core.data import Episode, Record

_NEAR = 0.03
"""Largest distance at which a sensor feels a contact, m."""


def shares(record: Record, what: str) -> npt.NDArray[np.float64]:
    """Returns the share of the time in which each sensor felt something, (sensors,), 0 to 1.

    Args:
        record: The record.
        what: ``own`` for touches of the body by itself, ``all`` for any touch.

    Raises:
        ValueError: The record has no touch or no episodes, or ``what`` is another word.
    """
    if what not in ("own", "all"):
        raise ValueError(f"what is {what!r}, expected 'own' or 'all'")
    episodes = list(record.values())
    if not record.has_skin or not episodes or "touch_ptr" not in episodes[0]:
        raise ValueError(f"{record.folder}: the record has no touch: touch_active is false, or there are no episodes")
    count, steps = np.zeros(len(record.skin()["body"])), 0
    poses = _Poses(record) if what == "own" else None
    for episode in episodes:
        step, sensor, _ = sensor_forces(episode)
        if poses is not None:
            kept = _own(episode, poses, step, sensor)
            sensor = sensor[kept]
        count += np.bincount(sensor, minlength=len(count))
        steps += episode.steps
    share: npt.NDArray[np.float64] = count / max(1, steps)
    return share


class _Poses:
    """Poses of bodies at positions of a scene."""

    def __init__(self, record: Record) -> None:
        from babybench_core import _native

        env = record.environment(vision_active=False, touch_active=False)
        env.reset()
        self._env, self._parts = env, _native.Parts(env._core)
        self.body_of_geom = env.array("geom_bodyid").astype(int)

    def at(self, qpos: npt.NDArray[Any]) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Returns positions (bodies, 3) and frames (bodies, 3, 3)."""
        self._parts.forward(qpos.astype(np.float64), np.zeros(len(self._env.array("qvel"))))
        core = self._env._core
        return core.state_array("xpos").reshape(-1, 3), core.state_array("xmat").reshape(-1, 3, 3)


def _own(
    episode: Episode, poses: _Poses, step: npt.NDArray[np.intp], sensor: npt.NDArray[np.intp]
) -> npt.NDArray[np.bool_]:
    """Returns, for each touch of a sensor, whether it comes from his own body."""
    skin, geoms = episode.record.skin(), episode.manifest["geoms"]
    own = np.array([geom["region"] is not None for geom in geoms])
    pairs = episode["contact_geom"].astype(int)
    number = np.repeat(np.arange(episode.steps), np.diff(episode["contact_ptr"]))
    both = own[pairs].all(1)
    bodies = poses.body_of_geom[pairs]
    touched = skin["body"][sensor].astype(int)
    kept = np.zeros(len(step), bool)
    starts = np.searchsorted(step, np.arange(episode.steps + 1))
    for t in np.unique(number[both]):
        here = slice(starts[t], starts[t + 1])
        span = slice(int(episode["contact_ptr"][t]), int(episode["contact_ptr"][t + 1]))
        mine = both[span]
        by_self, by_other = set(bodies[span][mine].ravel()), set(bodies[span][~mine].ravel())
        # a body that nothing else touches needs no closer look
        alone = np.isin(touched[here], list(by_self - by_other))
        kept[here] = alone
        unsure = np.flatnonzero(np.isin(touched[here], list(by_self & by_other))) + starts[t]
        if len(unsure) == 0:
            continue
        places, frames = poses.at(episode["qpos"][t])
        at = places[touched[unsure]] + np.einsum(
            "nij,nj->ni", frames[touched[unsure]], skin["position"][sensor[unsure]]
        )
        points = episode["contact_pos"][span][mine]
        far = np.linalg.norm(at[:, None] - points[None], axis=2)
        # both bodies of a contact feel it
        sides = (touched[unsure][:, None, None] == bodies[span][mine][None]).any(2)
        kept[unsure] = (sides & (far <= _NEAR)).any(1)
    return kept
