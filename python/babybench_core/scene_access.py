"""The names and the arrays of an environment's scene, and programs' changes to them."""

from __future__ import annotations

from functools import cached_property
from typing import Any, Optional

import numpy.typing as npt

from babybench_core import _native, changes, hints, looks


class SceneAccess:
    """Names, arrays, and changes of the model."""

    _core: _native.Env

    @cached_property
    def actuator_names(self) -> list[str]:
        """The actuators; with muscles, the action contains each of them twice, flexors first."""
        return list(self._core.blueprint.model_names["actuator"])

    @property
    def body_names(self) -> list[str]:
        """The bodies by id, as the document names them: rows of ``xpos``, ``body_mass``, ..."""
        return list(self._core.blueprint.model_names["body"])

    @property
    def joint_names(self) -> list[str]:
        """The joints by id, as the document names them: rows of ``jnt_range``, ..."""
        return list(self._core.blueprint.model_names["joint"])

    @property
    def site_names(self) -> list[str]:
        """The sites by id, as the document names them: rows of ``site_xpos``; empty where it gives none."""
        return list(self._core.blueprint.model_names["site"])

    @property
    def geom_names(self) -> list[str]:
        """The geoms by id, as the document names them: rows of ``geom_xpos``, ids of contacts, touches and :meth:`segmentation`.

        A geom without a name has that of its part: see :attr:`part_names`.
        """
        return changes.names_of("geom", self._core.blueprint)

    @cached_property
    def part_names(self) -> list[str]:
        """The part of each geom, by id: the body and the index among its geoms, ``left_hand 1/2``."""
        return changes.part_names(self._core.blueprint)

    def array(self, name: str, element: Optional[str] = None) -> npt.NDArray[Any]:
        """Returns a copy of an array of the scene or of its state by MuJoCo's name, such as ``jnt_range`` or ``xpos``.

        Args:
            name: The array.
            element: The name of a body, joint, geom, site or actuator, for its row alone; for a joint with several degrees of
                freedom, all of its rows.

        Raises:
            KeyError: There is no such array or element.
        """
        array = changes.read(name, self._core.state_array, self._core.model_array)
        return array if element is None else array[changes.rows_of(name, element, self._core.blueprint)]

    def change_model(self, model: changes.Changes) -> None:
        """Changes numbers of the model from the next step, in this and in later episodes.

        Args:
            model: Arrays by MuJoCo's names, as :meth:`array` returns them, or mappings from names of elements to rows.

        These can change: ``opt.gravity``, ``opt.timestep``, ``opt.impratio``, ``opt.density``, ``opt.viscosity``, ``opt.wind``;
        ``body_mass``, ``body_inertia``, ``geom_size``, ``geom_friction``, ``dof_damping``, ``dof_armature``,
        ``dof_frictionloss``, ``jnt_stiffness``, ``actuator_gear``; ``solref``, ``solimp``, ``margin``, ``gap`` and
        ``friction`` of geoms and pairs, and ``solref`` and ``solimp`` of joints, dofs and equalities; ``jnt_range``; ``pos`` and
        ``quat`` of bodies, geoms, sites and cameras; and the constants
        ``body_invweight0``, ``dof_invweight0`` and ``geom_rbound``, which are not updated automatically, as in
        MuJoCo without ``mj_setConst``.

        Example:
            >>> import babybench
            >>> env = babybench.make("self_touch", vision_active=False)
            >>> env.change_model({"opt.gravity": [0, 0, -1.62], "geom_friction": env.array("geom_friction") / 2})
            >>> env.change_model({"body_mass": {"head": 1.5}})
            >>> mass = env.array("body_mass")
            >>> observation, info = env.reset(seed=0, options={"model": {"body_mass": mass * 1.1}})

        Raises:
            KeyError: There is no such array or element, or it cannot change.
            ValueError: Numbers of another shape, that are not finite or too small; nothing changes then.
        """
        core = self._core
        core.change_model(changes.arrays(model, core.model_array, core.blueprint))

    def paint(self, model: changes.Changes) -> None:
        """Changes the appearance at any time; steps are unaffected.

        Args:
            model: Arrays by MuJoCo's names, or mappings from names of elements to rows: ``geom_rgba``, ``geom_group``,
                ``geom_matid`` and those of sites and tendons; ``mat_...``, ``light_...``, ``cam_fovy``.

        Records do not keep it, and :meth:`set_age` forgets it.

        Example:
            >>> import babybench
            >>> env = babybench.make("self_touch", vision_active=False)
            >>> env.paint({"geom_rgba": {"head": [1, 0, 0, 1]}, "cam_fovy": {"eye_left": 90}})

        Raises:
            KeyError: There is no such array or element.
            ValueError: Numbers of another shape, or that no model has; nothing changes then.
        """
        present = looks.of(self._core)

        def read(name: str) -> npt.NDArray[Any]:
            if name not in present:
                raise KeyError(f"{name!r} does not affect pictures{hints.nearest(name, sorted(present))}")
            return present[name]

        painted = changes.arrays(model, read, self._core.blueprint)
        for name, array in painted.items():
            shape = read(name).shape
            if array.shape != shape:
                raise ValueError(f"{name} has the shape {array.shape}, but {shape} is needed")
        _native.paint(self._core, painted)
