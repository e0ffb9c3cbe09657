"""The appearance of a model: values that affect pictures but not steps."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from babybench_core import _native

LOOKS = frozenset(
    {
        *("geom_rgba", "geom_group", "geom_matid", "site_rgba", "site_group", "site_matid"),
        *("tendon_rgba", "tendon_group", "tendon_matid", "cam_fovy"),
        *(f"mat_{name}" for name in ("rgba", "specular", "shininess", "reflectance", "emission")),
        *("mat_texrepeat", "mat_texuniform", "mat_texid"),
        *(f"light_{name}" for name in ("ambient", "diffuse", "specular", "attenuation", "cutoff", "exponent")),
        *("light_pos", "light_dir", "light_active"),
    }
)
"""The arrays that affect pictures."""


def is_look(name: str) -> bool:
    """Returns whether an array, or a setting of ``model.vis``, affects pictures."""
    return name in LOOKS or name.startswith("vis_")


def of(engine: _native.Env) -> dict[str, NDArray[Any]]:
    """Returns the look of an environment's model."""
    return {name: array for name, array in _native.model_columns(engine).items() if is_look(name)}


def take(engine: _native.Env, given: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """Applies the look of an environment to a copy of it, and returns what has changed."""
    own = of(engine)
    others = {name: array for name, array in given.items() if not np.array_equal(array, own[name])}
    if others:
        _native.paint(engine, others)
    return others
