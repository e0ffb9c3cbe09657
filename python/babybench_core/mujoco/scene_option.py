"""What pictures show: :class:`MjvOption`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .enums import mjtVisFlag

if TYPE_CHECKING:
    from .model import MjModel

__all__ = ["MjvOption", "mjv_defaultOption"]

_GROUPS = ("geomgroup", "sitegroup", "jointgroup", "tendongroup", "actuatorgroup", "flexgroup", "skingroup")
_ON = (
    *("mjVIS_TEXTURE", "mjVIS_TENDON", "mjVIS_RANGEFINDER", "mjVIS_PERTOBJ", "mjVIS_ISLAND", "mjVIS_STATIC"),
    *("mjVIS_SKIN", "mjVIS_FLEXEDGE", "mjVIS_FLEXSKIN"),
)


class MjvOption:
    """What a picture shows. Groups of geoms, sites, tendons and skins have an effect; MuJoCo's other decorations are not drawn.

    Attributes:
        geomgroup: Which of the six groups of geoms are shown; 0 to 2 by default.
        sitegroup: The same for sites.
        tendongroup: The same for tendons.
        skingroup: The same for skins.
        jointgroup: The same for joints, which are not drawn.
        actuatorgroup: The same for actuators, which are not drawn.
        flexgroup: The same for deformable bodies; it has no effect.
        flags: Decorations by ``mjtVisFlag``; only the default ones are accepted.
        label: What is labelled, of ``mjtLabel``; only none is accepted.
        frame: Whose frames are drawn, of ``mjtFrame``; only none is accepted.
        bvh_depth: Depth of bounding volumes that are not drawn.
        flex_layer: Layer of deformable bodies that is not drawn.
    """

    geomgroup: NDArray[np.uint8]
    sitegroup: NDArray[np.uint8]
    tendongroup: NDArray[np.uint8]
    skingroup: NDArray[np.uint8]
    jointgroup: NDArray[np.uint8]
    actuatorgroup: NDArray[np.uint8]
    flexgroup: NDArray[np.uint8]
    flags: NDArray[np.uint8]
    label: int
    frame: int
    bvh_depth: int
    flex_layer: int

    def __init__(self) -> None:
        """Makes MuJoCo's default options."""
        own: dict[str, Any] = {name: np.array([1, 1, 1, 0, 0, 0], np.uint8) for name in _GROUPS}
        own.update(flags=default_flags(), label=0, frame=0, bvh_depth=1, flex_layer=0)
        self.__dict__.update(own)

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in self.__dict__:
            raise AttributeError(f"MjvOption has no {name}")
        if isinstance(self.__dict__[name], np.ndarray):
            self.__dict__[name][...] = value
        else:
            self.__dict__[name] = int(value)


def default_flags() -> NDArray[np.uint8]:
    """Returns the decorations that MuJoCo shows by default."""
    flags = np.zeros(len([flag for flag in mjtVisFlag if flag.name.startswith("mjVIS_")]), np.uint8)
    for name in _ON:
        flags[mjtVisFlag[name]] = 1
    return flags


def mjv_defaultOption(opt: MjvOption) -> None:
    """Sets options to MuJoCo's defaults."""
    opt.__dict__.update(MjvOption().__dict__)


def shown(m: MjModel, option: MjvOption) -> tuple[tuple[bool, ...], ...]:
    """Returns which geoms, sites, groups of tendons and groups of skins a picture shows.

    Raises:
        ValueError: The options request decorations that are not drawn.
    """
    changed = np.flatnonzero(option.flags != default_flags())
    if len(changed):
        flag = mjtVisFlag(int(changed[0]))
        raise ValueError(
            f"scene_option.flags[{flag.name}] is {option.flags[changed[0]]}: pictures have MuJoCo's default decorations "
            "only; groups of geoms, sites, tendons and skins can be shown and hidden"
        )
    if option.label or option.frame:
        raise ValueError("scene_option: labels and frames are not drawn; leave label and frame 0")
    pairs = (
        (m.geom_group, option.geomgroup),
        (m.site_group, option.sitegroup),
        (range(6), option.tendongroup),
        (range(6), option.skingroup),
    )
    return tuple(
        tuple(bool(one) for one in option_group[np.clip(np.asarray(groups, int), 0, 5)])
        for groups, option_group in pairs
    )
