"""Plain structs of MuJoCo's that programs fill or read: statistics, perturbations, rectangles, figures."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, ClassVar, NoReturn

import numpy as np
from numpy.typing import NDArray

__all__ = [
    *("MjLROpt", "MjSolverStat", "MjTimerStat", "MjWarningStat", "MjrContext", "MjrRect", "MjvFigure", "MjvPerturb"),
    *("mj_defaultLROpt", "mjv_defaultFigure", "mjv_defaultPerturb"),
]


class Struct:
    """Fields with default values: arrays, numbers and texts. Other names cannot be set."""

    FIELDS: ClassVar[dict[str, Any]] = {}
    """Default values by name."""

    def __init__(self) -> None:
        """Takes the default values."""
        self.__dict__.update({name: np.array(v) if isinstance(v, np.ndarray) else v for name, v in self.FIELDS.items()})

    def __setattr__(self, name: str, value: Any) -> None:
        old = self.__dict__.get(name)
        if name not in self.FIELDS:
            if isinstance(getattr(type(self), name, None), property):
                object.__setattr__(self, name, value)
                return
            raise AttributeError(f"{type(self).__name__} has no {name}; it has {', '.join(self.FIELDS)}")
        if isinstance(old, np.ndarray):
            old[...] = value
        else:
            self.__dict__[name] = str(value) if isinstance(old, str) else type(self.FIELDS[name])(value)

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any: ...

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {', '.join(f'{name}={self.__dict__[name]!r}' for name in self.FIELDS)}>"

    def __copy__(self) -> Any:
        other = type(self).__new__(type(self))
        Struct.__init__(other)
        for name in self.FIELDS:
            setattr(other, name, self.__dict__[name])
        return other

    def __deepcopy__(self, memo: Any) -> Any:
        return self.__copy__()


def _singles(*values: float) -> NDArray[np.float32]:
    return np.array(values, np.float32)


class MjWarningStat(Struct):
    """Number of warnings, which is 0: what MuJoCo warns of is an error here."""

    FIELDS: ClassVar = {"lastinfo": 0, "number": 0}


class MjTimerStat(Struct):
    """Time spent on a part of steps, which is not measured here."""

    FIELDS: ClassVar = {"duration": 0.0, "number": 0}


class MjSolverStat(Struct):
    """Statistics of an iteration of the solver, which are not recorded here."""

    FIELDS: ClassVar = {"improvement": 0.0, "gradient": 0.0, "lineslope": 0.0} | dict.fromkeys(
        ("nactive", "nchange", "neval", "nupdate"), 0
    )


class StatList:
    """The warnings of a state, by ``mjtWarning``."""

    def __init__(self, count: int) -> None:
        """Makes statistics without any warning."""
        self._stats = [MjWarningStat() for _ in range(count)]
        self.number = np.zeros(count, np.int32)
        self.lastinfo = np.zeros(count, np.int32)

    def __len__(self) -> int:
        return len(self._stats)

    def __getitem__(self, index: int) -> MjWarningStat:
        return self._stats[index]

    def __iter__(self) -> Iterator[MjWarningStat]:
        return iter(self._stats)


class MjLROpt(Struct):
    """Options for finding the length ranges of muscles; a document has them in ``<lengthrange>``."""

    FIELDS: ClassVar = {
        "mode": 1,
        "useexisting": 1,
        "uselimit": 0,
        "accel": 20.0,
        "maxforce": 0.0,
        "timeconst": 1.0,
    } | {
        "timestep": 0.01,
        "inttotal": 10.0,
        "interval": 2.0,
        "tolrange": 0.05,
    }


def mj_defaultLROpt(opt: MjLROpt) -> None:
    """Sets options to the defaults."""
    MjLROpt.__init__(opt)


class MjvPerturb(Struct):
    """A body that a user has selected in a window and pulls."""

    FIELDS: ClassVar = {
        **{"select": 0, "flexselect": -1, "skinselect": -1, "active": 0, "active2": 0},
        **{
            "refpos": np.zeros(3),
            "refquat": np.array([1.0, 0, 0, 0]),
            "refselpos": np.zeros(3),
            "localpos": np.zeros(3),
        },
        **{"localmass": 0.0, "scale": 1.0},
    }


def mjv_defaultPerturb(pert: MjvPerturb) -> None:
    """Clears a perturbation."""
    MjvPerturb.__init__(pert)


class MjrRect(Struct):
    """A rectangle of pixels."""

    FIELDS: ClassVar = {"left": 0, "bottom": 0, "width": 0, "height": 0}

    def __init__(self, left: int, bottom: int, width: int, height: int) -> None:
        """Takes the place and the size, pixels."""
        super().__init__()
        for name, value in zip(self.FIELDS, (left, bottom, width, height)):
            setattr(self, name, value)


class MjvFigure(Struct):
    """A plot of curves. It can be filled but not drawn: ``mjr_figure`` is missing."""

    FIELDS: ClassVar = {
        **{
            "flg_legend": 1,
            "flg_ticklabel": np.ones(2, np.int32),
            "flg_extend": 1,
            "flg_barplot": 0,
            "flg_selection": 0,
        },
        **{"flg_symmetric": 0, "linewidth": 3.0, "gridwidth": 1.0, "gridsize": np.full(2, 2, np.int32)},
        **{"gridrgb": _singles(0.4, 0.4, 0.4), "figurergba": _singles(0, 0, 0, 1), "panergba": _singles(0, 0, 0, 1)},
        **{
            "legendrgba": _singles(0, 0, 0, 0.3),
            "textrgb": _singles(1, 1, 1),
            "range": _singles(0, 1, 0, 1).reshape(2, 2),
        },
        **{"xformat": "%.0f", "yformat": "%.2g", "minwidth": "XXX", "title": "", "xlabel": "", "ylabel": ""},
        **{"legendoffset": 0, "subplot": 0, "highlight": np.zeros(2, np.int32), "highlightid": -1, "selection": 0.0},
        **{"linergb": np.zeros((100, 3), np.float32), "linepnt": np.zeros(100, np.int32)},
        **{"linedata": np.zeros((100, 2000), np.float32), "linename": np.zeros(100, "S100")},
        **{"xaxispixel": np.zeros(2, np.int32), "yaxispixel": np.zeros(2, np.int32)},
        **{"xaxisdata": np.zeros(2, np.float32), "yaxisdata": np.zeros(2, np.float32)},
    }


def mjv_defaultFigure(fig: MjvFigure) -> None:
    """Clears a plot."""
    MjvFigure.__init__(fig)


class MjrContext:
    """MuJoCo's context of OpenGL, which does not exist here."""

    def __init__(self, *_: Any, **__: Any) -> None:
        """Raises an error."""
        self._refuse()

    @staticmethod
    def _refuse() -> NoReturn:
        raise NotImplementedError(
            "there is no OpenGL here, and no MjrContext: draw with mujoco.Renderer(model, height, width), or install mujoco "
            "(pip install mujoco)"
        )
