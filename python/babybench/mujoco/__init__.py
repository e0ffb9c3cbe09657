"""MuJoCo's interface on the engine of this package, without MuJoCo: models from MJCF documents, states, steps, pictures.

Example:
    >>> from babybench import mujoco
    >>> ball = "<mujoco><worldbody><body><freejoint/><geom size='.1'/></body></worldbody></mujoco>"
    >>> model = mujoco.MjModel.from_xml_string(ball)
    >>> data = mujoco.MjData(model)
    >>> mujoco.mj_step(model, data, nstep=100)
    >>> bool(data.qpos[2] < -0.19)
    True

Names, shapes, number types and units are those of MuJoCo 3.3.0; the numbers agree with it up to rounding. Features that the
engine lacks are never silently ignored: they raise an error that says what to do. :func:`install` makes ``import mujoco``
import this module, so that Gymnasium's own MuJoCo environments run unchanged.
"""

from __future__ import annotations

from typing import NoReturn

from babybench_core.mujoco import callbacks as _callbacks
from babybench_core.mujoco import constants as _constants
from babybench_core.mujoco import enums as _enums
from babybench_core.mujoco import finite_differences as _differences
from babybench_core.mujoco import functions as _functions
from babybench_core.mujoco import inverse as _inverse
from babybench_core.mujoco import jacobians as _jacobians
from babybench_core.mujoco import maths as _maths
from babybench_core.mujoco import more_constants as _numbers
from babybench_core.mujoco import more_enums as _more_enums
from babybench_core.mujoco import more_maths as _more_maths
from babybench_core.mujoco import rays as _rays
from babybench_core.mujoco import saving as _saving
from babybench_core.mujoco import scene as _scene
from babybench_core.mujoco import spec as _spec
from babybench_core.mujoco import structs as _structs
from babybench_core.mujoco import vectors as _vectors
from babybench_core.mujoco.callbacks import *  # noqa: F403
from babybench_core.mujoco.constants import *  # noqa: F403
from babybench_core.mujoco.data import MjData
from babybench_core.mujoco.enums import *  # noqa: F403
from babybench_core.mujoco.finite_differences import *  # noqa: F403
from babybench_core.mujoco.functions import *  # noqa: F403
from babybench_core.mujoco.installing import install, uninstall
from babybench_core.mujoco.inverse import *  # noqa: F403
from babybench_core.mujoco.jacobians import *  # noqa: F403
from babybench_core.mujoco.maths import *  # noqa: F403
from babybench_core.mujoco.missing import hint as _hint
from babybench_core.mujoco.model import MjModel
from babybench_core.mujoco.more_constants import *  # noqa: F403
from babybench_core.mujoco.more_enums import *  # noqa: F403
from babybench_core.mujoco.more_maths import *  # noqa: F403
from babybench_core.mujoco.options import MjOption
from babybench_core.mujoco.rays import *  # noqa: F403
from babybench_core.mujoco.renderer import MjvCamera, Renderer, mjv_defaultCamera, mjv_defaultFreeCamera
from babybench_core.mujoco.saving import *  # noqa: F403
from babybench_core.mujoco.scene import *  # noqa: F403
from babybench_core.mujoco.scene_option import MjvOption, mjv_defaultOption
from babybench_core.mujoco.spec import *  # noqa: F403
from babybench_core.mujoco.structs import *  # noqa: F403
from babybench_core.mujoco.vectors import *  # noqa: F403

from . import rollout, viewer

stands_in = True
"""Distinguishes this module from MuJoCo's own."""

__version__ = "3.3.0"
"""The version of MuJoCo that this module follows."""

__all__ = [
    "MjData",
    "MjModel",
    "MjOption",
    "MjvCamera",
    "MjvOption",
    "Renderer",
    "__version__",
    "install",
    "mjv_defaultCamera",
    "mjv_defaultFreeCamera",
    "mjv_defaultOption",
    "rollout",
    "stands_in",
    "uninstall",
    "viewer",
]
__all__ += (
    _constants.__all__
    + _enums.__all__
    + _more_enums.__all__
    + _functions.__all__
    + _differences.__all__
    + _inverse.__all__
    + _numbers.__all__
    + _structs.__all__
    + _callbacks.__all__
    + _more_maths.__all__
    + _scene.__all__
    + _saving.__all__
    + _jacobians.__all__
    + _maths.__all__
    + _spec.__all__
    + _rays.__all__
    + _vectors.__all__
)


def __getattr__(name: str) -> NoReturn:
    raise AttributeError(f"babybench.mujoco has no {name}: {_hint(name)}")
