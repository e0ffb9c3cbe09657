"""Transfer of states by name when a document is recompiled."""

from __future__ import annotations

from typing import Any

from .data import MjData
from .model import MjModel

_SIZES = {0: (7, 6), 1: (4, 3), 2: (1, 1), 3: (1, 1)}


def _same(before: list[str], after: list[str]) -> list[tuple[int, int]]:
    """Returns the numbers of elements that two models share: by name, and those without one by their order among themselves."""
    named = {name: number for number, name in enumerate(before) if name}
    pairs = [(named[name], number) for number, name in enumerate(after) if name in named]
    nameless = [[number for number, name in enumerate(names) if not name] for names in (before, after)]
    if len(nameless[0]) == len(nameless[1]):
        pairs += list(zip(*nameless))
    return pairs


def carried(m: MjModel, d: MjData, model: MjModel) -> MjData:
    """Returns a state of a model with the values that it shares with another model's state."""
    data = MjData(model)
    data.time = d.time
    for old, new in _same(m._names["joint"], model._names["joint"]):
        if m.jnt_type[old] != model.jnt_type[new]:
            continue
        nq, nv = _SIZES[int(m.jnt_type[old])]
        for name, addresses, count in (
            ("qpos", "jnt_qposadr", nq),
            ("qvel", "jnt_dofadr", nv),
            ("qacc_warmstart", "jnt_dofadr", nv),
        ):
            source, first = getattr(d, name), int(getattr(m, addresses)[old])
            target, place = getattr(data, name), int(getattr(model, addresses)[new])
            target[place : place + count] = source[first : first + count]
    for old, new in _same(m._names["actuator"], model._names["actuator"]):
        data.ctrl[new] = d.ctrl[old]
        place, first = int(model.actuator_actadr[new]), int(m.actuator_actadr[old])
        if place >= 0 and first >= 0:
            data.act[place] = d.act[first]
    for old, new in _same(m._names["body"], model._names["body"]):
        place, first = _mocap(model, new), _mocap(m, old)
        if place >= 0 and first >= 0:
            data.mocap_pos[place], data.mocap_quat[place] = d.mocap_pos[first], d.mocap_quat[first]
    return data


def _mocap(m: Any, body: int) -> int:
    return int(m.body_mocapid[body])
