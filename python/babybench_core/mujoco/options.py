"""Parts of a model besides arrays: :class:`MjOption`, statistics and settings of pictures."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _native

FIXED = (
    "model.{name} cannot be changed here: change the document and make another model. What can be changed are the numbers that "
    "steps and pictures read, as body_mass, geom_friction, jnt_stiffness, eq_data, geom_rgba, cam_fovy and opt.gravity"
)
MISSING = "{name}: babybench.mujoco does not have it; `pip install mujoco` and `import mujoco` have everything"


class MjOption:
    """The options of a model, ``model.opt``."""

    def __init__(
        self, native: _native.PhysicsModel, floats: dict[str, NDArray[np.float64]], settings: dict[str, Any]
    ) -> None:
        """Takes the model."""
        names = (
            "iterations",
            "ls_iterations",
            "ccd_iterations",
            "integrator",
            "solver",
            "cone",
            "jacobian",
            "disableflags",
            "enableflags",
            "noslip_iterations",
            "disableactuator",
        )
        wholes = {name: int(settings[name]) for name in names}
        self.__dict__.update(_own=native, _floats=floats, _wholes=wholes)

    def __getattr__(self, name: str) -> Any:
        """Returns an option."""
        floats, wholes = self.__dict__.get("_floats", {}), self.__dict__.get("_wholes", {})
        if name in floats:
            array = floats[name]
            return array if name in ("gravity", "wind", "magnetic") else float(array[0])
        if name in wholes:
            return wholes[name]
        raise AttributeError(MISSING.format(name=f"opt.{name}"))

    def __setattr__(self, name: str, value: Any) -> None:
        """Sets an option; steps use it from now on."""
        if name in self._floats:
            self._floats[name][...] = value
        elif name in self._wholes:
            if int(value) != self._wholes[name]:
                self._own.set_option(name, int(value))
                self._wholes[name] = int(value)
        else:
            raise AttributeError(MISSING.format(name=f"opt.{name}"))

    def __dir__(self) -> list[str]:
        return sorted([*self._floats, *self._wholes])

    def _numbers(self) -> dict[str, Any]:
        """Returns all options for pickling."""
        return {**{name: np.array(array) for name, array in self._floats.items()}, **self._wholes}

    def _differs(self, other: MjOption) -> bool:
        """Returns whether an option has another value."""
        mine, its = self._numbers(), other._numbers()
        return any(not np.array_equal(mine[name], its[name]) for name in mine)


class Settings:
    """Numbers of a model that are fixed or have no effect: ``model.stat``, ``model.vis`` and its parts."""

    def __init__(self, of: str, values: dict[str, Any], free: tuple[str, ...] = ()) -> None:
        """Takes the values; those of ``free`` names can be set."""
        self.__dict__.update(values)
        self.__dict__.update(_of=of, _free=free)

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in self._free:
            raise AttributeError(FIXED.format(name=f"{self._of}.{name}"))
        self.__dict__[name] = type(self.__dict__[name])(value)

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(MISSING.format(name=f"{self.__dict__.get('_of', '')}.{name}"))

    def _written(self) -> dict[str, dict[str, Any]]:
        """Returns the values that can be set, for each part of the settings."""
        parts = {name: part for name, part in self.__dict__.items() if isinstance(part, Settings)}
        return {name: {free: part.__dict__[free] for free in part.__dict__["_free"]} for name, part in parts.items()}


class Drawn(Settings):
    """Settings that affect pictures: ``model.vis.global_``, ``map`` and ``headlight``."""

    def __init__(self, of: str, arrays: dict[str, NDArray[Any]], values: dict[str, Any], free: tuple[str, ...]) -> None:
        """Takes arrays in the model's memory, and plain values."""
        super().__init__(of, values, free)
        self.__dict__["_drawn"] = arrays

    def __getattr__(self, name: str) -> Any:
        """Returns a number, or a colour."""
        array = self.__dict__.get("_drawn", {}).get(name)
        if array is None:
            return super().__getattr__(name)
        return array[0].item() if array.ndim == 1 else array[0]

    def __setattr__(self, name: str, value: Any) -> None:
        if name in self._drawn:
            self._drawn[name][0] = value
        else:
            super().__setattr__(name, value)

    def __dir__(self) -> list[str]:
        return sorted([*self._drawn, *(name for name in self.__dict__ if name[0] != "_")])


def visual(columns: dict[str, NDArray[Any]], width: int, height: int) -> Settings:
    """Returns ``model.vis`` of the model that has these columns, and the largest size of its pictures, pixels."""
    sizes = {"offwidth": width, "offheight": height}

    def drawn(*names: str) -> dict[str, NDArray[Any]]:
        return {name: columns[f"vis_{name}"] for name in names}

    return Settings(
        "vis",
        {
            "global_": Drawn("vis.global_", drawn("fovy", "azimuth", "elevation"), sizes, tuple(sizes)),
            "map": Drawn("vis.map", drawn("znear", "zfar"), {}, ()),
            "headlight": Drawn("vis.headlight", drawn("ambient", "diffuse", "specular", "active"), {}, ()),
        },
    )


_WIDTHS = {
    **{"eq_data": 11, "mat_texid": 10, "mat_texrepeat": 2},
    **dict.fromkeys(("geom_rgba", "site_rgba", "tendon_rgba", "mat_rgba"), 4),
    **{f"light_{name}": 3 for name in ("pos", "dir", "ambient", "diffuse", "specular", "attenuation")},
}
"""Numbers in each row of arrays that may have no rows."""
_POSES = {"key_qpos": "nq", "key_qvel": "nv", "key_act": "na", "key_ctrl": "nu"}
"""The same for arrays whose rows are as long as a size of the model."""


def with_rows(columns: dict[str, NDArray[Any]], sizes: dict[str, Any]) -> dict[str, NDArray[Any]]:
    """Returns the arrays of other types than doubles, in MuJoCo's shapes where they are empty."""
    widths = {**_WIDTHS, **{name: int(sizes.get(size, 0)) for name, size in _POSES.items()}}
    return {
        name: array.reshape(0, widths[name]) if array.shape == (0,) and name in widths else array
        for name, array in columns.items()
    }
