"""The model: :class:`MjModel`."""

from __future__ import annotations

import os
from abc import ABCMeta
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _native
from ..named import KINDS, PREFIX, Named, accessor, numbers, span
from .derived import DERIVED
from .model_fields import EMPTY, FLEX_SIZES, NAME_ADDRESSES, NO_PLUGINS, NOT_OF_MODELS, Absent, empty, name_block
from .options import FIXED, MISSING, MjOption, Settings, visual, with_rows

_SINGLES = frozenset(
    f"{kind}_{name}"
    for kind, names in {
        "geom": ("rgba",),
        "site": ("rgba",),
        "cam": ("intrinsic", "sensorsize"),
        "light": ("ambient", "diffuse", "specular", "attenuation", "cutoff", "exponent"),
        "mat": ("rgba", "specular", "shininess", "reflectance", "emission", "texrepeat"),
    }.items()
    for name in names
)
"""Arrays that MuJoCo stores in single precision."""

_USERS = ("body", "jnt", "geom", "site", "cam", "tendon", "actuator", "sensor")
_OWN = frozenset({"actuator_refid", "exclude", "pair_geom", "dof_m0", "texture", "material", "text_data"})
"""Arrays that the engine keeps in a form that MuJoCo does not have."""
_ADDRESSES = {"body_jntadr": "body_jntnum", "body_dofadr": "body_dofnum", "body_geomadr": "body_geomnum"}
_SIZES = (
    *(
        "nq",
        "nv",
        "nu",
        "na",
        "nmocap",
        "nbody",
        "njnt",
        "ngeom",
        "nsite",
        "ncam",
        "neq",
        "ntendon",
        "nsensor",
        "nsensordata",
        "npair",
    ),
    *("nkey", "nlight", "nexclude", "nmesh", "nhfield", "nskin", "nflex"),
)


class FixedArray(np.ndarray[Any, np.dtype[Any]]):
    """An array of a model that cannot be changed. Writing to it raises an error that explains this."""

    _name: str

    def __array_finalize__(self, obj: Any) -> None:
        """Keeps the name."""
        self._name = getattr(obj, "_name", "")

    def __setitem__(self, key: Any, value: Any) -> None:
        """Refuses, unless it is a copy."""
        self._check()
        super().__setitem__(key, value)

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, out: Any = None, **options: Any) -> Any:
        """Computes with plain arrays, and never writes into a fixed one."""
        if out is not None:
            for array in out:
                if isinstance(array, FixedArray):
                    array._check()
            options["out"] = tuple(_plain(array) for array in out)
        return getattr(ufunc, method)(*(_plain(array) for array in inputs), **options)

    def _check(self) -> None:
        if not self.flags.writeable:
            raise ValueError(FIXED.format(name=self._name))


def _plain(array: Any) -> Any:
    return array.view(np.ndarray) if isinstance(array, FixedArray) else array


def _fixed(array: NDArray[Any], name: str) -> FixedArray:
    fixed = np.array(array).view(FixedArray)
    fixed._name = name
    fixed.flags.writeable = False
    return fixed


def views(memory: NDArray[np.float64], layout: list[tuple[str, list[int]]]) -> dict[str, NDArray[np.float64]]:
    """Returns the arrays that lie one after another in a block of memory."""
    found, at = {}, 0
    for name, shape in layout:
        size = int(np.prod(shape))
        found[name] = memory[at : at + size].reshape(shape)
        at += size
    return found


def _contents(assets: Mapping[str, bytes | str]) -> dict[str, bytes]:
    return {name: content.encode() if isinstance(content, str) else bytes(content) for name, content in assets.items()}


class Fields(ABCMeta):
    """The type of :class:`MjModel` and ``MjData``, whose ``dir`` lists MuJoCo's fields for programs that wrap them."""

    def __dir__(cls) -> list[str]:
        of_instances = cls.__dict__.get("_of_instances")
        return sorted({*super().__dir__(), *(of_instances() if of_instances is not None else ())})


@dataclass(frozen=True)
class Source:
    """The source that a model was compiled from."""

    text: str
    """The document."""
    folder: str
    """The folder of the files that it names."""
    files: Mapping[str, bytes] = field(default_factory=dict)
    """Contents of files by name, which replace those of the file system."""

    def compile(self) -> _native.PhysicsModel:
        """Compiles the document."""
        return _native.PhysicsModel.from_text(self.text, dict(self.files), self.folder)


class MjModel(Named, metaclass=Fields):
    """A compiled model, under the names and in the shapes of MuJoCo's ``MjModel``.

    Arrays that steps and pictures read can be written to, and the next step or picture uses the new values: masses, sizes,
    poses, friction, solver parameters, gains, equalities, colours, groups, lights (:attr:`writable` lists them). As in MuJoCo,
    quantities derived from them do not change, and a renderer keeps the textures that materials had when it was made. Writing
    into the other arrays raises an error.
    """

    writable: tuple[str, ...]
    """The names of the arrays that can be written to."""

    def __init__(self) -> None:
        """Raises an error, because models are made from documents."""
        raise TypeError("make models with MjModel.from_xml_path(path) or MjModel.from_xml_string(text)")

    @classmethod
    def from_xml_path(
        cls, filename: str | os.PathLike[str], assets: Mapping[str, bytes | str] | None = None
    ) -> MjModel:
        """Compiles an MJCF document. Files that it names are found as in MuJoCo: beside it, above it, or by absolute path.

        Args:
            filename: Path of the document.
            assets: Contents of files by name, which replace those of the file system.

        Raises:
            ValueError: The document cannot be read, or has something that the engine does not know; the text names the place.
        """
        path = os.fspath(filename)
        folder = os.path.dirname(path)
        try:
            with open(path, encoding="utf-8") as file:
                text = file.read()
        except UnicodeDecodeError as error:
            if assets:
                raise ValueError(f"{path}: {error}: with assets it must be UTF-8") from error
            return cls._made(_native.PhysicsModel.from_file(path), None)
        except OSError as error:
            if not assets:
                return cls._made(_native.PhysicsModel.from_file(path), None)  # raises an error with the cause
            raise ValueError(f"{path}: {error.strerror}") from error
        files = _contents(assets or {})
        native = _native.PhysicsModel.from_text(text, files, folder) if assets else _native.PhysicsModel.from_file(path)
        return cls._made(native, Source(text, os.path.abspath(folder), files))

    @classmethod
    def from_xml_string(cls, xml: str | bytes, assets: Mapping[str, bytes | str] | None = None) -> MjModel:
        """Compiles the text of an MJCF document.

        Files that it names are found as in MuJoCo: from the working directory, or by absolute path.

        Args:
            xml: The text.
            assets: Contents of files by name, which replace those of the file system. Folders and case of names are ignored.

        Raises:
            ValueError: As :meth:`from_xml_path`; or two assets have one name.
        """
        files = _contents(assets or {})
        if isinstance(xml, bytes):
            xml = xml.decode()
        return cls._made(_native.PhysicsModel.from_text(xml, files, ""), Source(xml, os.getcwd(), files))

    @classmethod
    def from_binary_path(cls, filename: str, assets: Any = None) -> MjModel:
        """Refuses: MuJoCo's compiled models (MJB) are not read."""
        raise ValueError(
            f"{filename}: compiled models (MJB) are not read here; use the document, with MjModel.from_xml_path"
        )

    @classmethod
    def _made(cls, native: _native.PhysicsModel, source: Source | None) -> MjModel:
        self = cls.__new__(cls)
        settings, extras = native.settings(), native.extras()
        names = {kind: list(found) for kind, found in native.names().items()}
        changeable = views(native.memory, native.layout)
        floats = {name[4:]: array for name, array in changeable.items() if name.startswith("opt_")}
        arrays = {name: array for name, array in changeable.items() if not name.startswith("opt_")}
        columns = with_rows(native.columns, settings)
        arrays.update({name: array for name, array in columns.items() if not name.startswith("vis_")})
        own = self.__dict__
        own.update({name: int(settings[name]) for name in _SIZES})
        own.update(dict.fromkeys((*NO_PLUGINS, *FLEX_SIZES), 0))
        own.update(
            _own=native, _source=source, _model_name=str(settings["name"]), _names=names, _numbers=numbers(names)
        )
        own.update(_arrays=arrays, _extras=extras, _chains={})
        own.update(arrays)
        own["writable"] = tuple(arrays)
        own.update(ntex=len(names["texture"]), nmat=len(names["material"]), nnumeric=len(names["numeric"]))
        own.update(
            ntext=len(names["text"]), nuserdata=int(settings["nuserdata"]), nplugin=0, nwrap=len(extras["wrap_objid"])
        )
        if settings["nflex"]:
            own.update({size: len(self._shapes[array]) for size, array in FLEX_SIZES.items()})
        own["opt"] = MjOption(native, floats, settings)
        stat = {name: settings[name] for name in ("extent", "meaninertia", "meanmass", "meansize")}
        own["stat"] = Settings("stat", {**stat, "center": _fixed(settings["center"], "stat.center")})
        own["vis"] = visual(columns, settings["offwidth"], settings["offheight"])
        return self

    def __getattr__(self, name: str) -> Any:
        """Returns an array by MuJoCo's name; it is read once."""
        if name.startswith("_") or "_own" not in self.__dict__:
            raise AttributeError(name)
        value = self._derived(name)
        if value is None:
            raise AttributeError(MISSING.format(name=f"model.{name}"))
        if isinstance(value, np.ndarray):
            value = _fixed(value, name)
        self.__dict__[name] = value
        return value

    def __setattr__(self, name: str, value: Any) -> None:
        """Writes into an array that can be changed."""
        if name not in self._arrays:
            if name not in self.__dict__ and self._derived(name) is None:
                raise AttributeError(MISSING.format(name=f"model.{name}"))
            raise AttributeError(FIXED.format(name=name))
        self._arrays[name][...] = value

    def __copy__(self) -> MjModel:
        return MjModel._made(self._own.copy(), self._source)

    def __deepcopy__(self, memo: Any) -> MjModel:
        return self.__copy__()

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickles the document and what was written into the model.

        Raises:
            TypeError: The document is not UTF-8 text.
        """
        if self._source is None:
            raise TypeError(
                "cannot pickle this model, whose document is not UTF-8: make it with MjModel.from_xml_path where it is needed"
            )
        written = {name: np.array(array) for name, array in self._arrays.items()}
        shown = {name: np.array(self.__dict__[name]) for name in _CONSTANTS if name in self.__dict__}
        return _restored, (self._source, written, shown, self.opt._numbers(), self.vis._written())

    def __dir__(self) -> list[str]:
        names = [*self.__dict__, *DERIVED, *self._extras, *_native.PhysicsModel.ARRAYS, *super().__dir__()]
        names += ["names", *self._shapes, *NAME_ADDRESSES, *NOT_OF_MODELS]
        names += [name for name in EMPTY if name.startswith(("flex_", "plugin", "name_")) or name in _OF_EDGES]
        names = [name for name in names if name not in ("plugin_data", "plugin_state")]
        return sorted(
            {name for name in names if not name.startswith("_") and (name not in _OWN or name in NOT_OF_MODELS)}
            | {"texture", "material"}
        )

    @staticmethod
    def _of_instances() -> list[str]:
        return dir(MjModel.from_xml_string("<mujoco/>"))

    @property
    def _shapes(self) -> dict[str, NDArray[Any]]:
        """Arrays of meshes, height fields, skins and flexes, which are read once."""
        if "_meshes" not in self.__dict__:
            self.__dict__["_meshes"] = self._own.shapes()
        found: dict[str, NDArray[Any]] = self.__dict__["_meshes"]
        return found

    def _named(self, name: str) -> Any:
        """Returns the block of all names, or where in it those of a kind start."""
        block, starts = name_block(self._model_name, self._names, {"pair": self.npair, "exclude": self.nexclude})
        return block if name == "names" else starts[name]

    def _compiled(self, name: str) -> NDArray[Any]:
        array = np.asarray(self._own.array(name))
        if array.dtype == np.bool_:
            return array.astype(np.uint8)
        return array.astype(np.float32) if name in _SINGLES else array

    def _derived(self, name: str) -> Any:
        """Returns a MuJoCo field that the engine stores in a different form, or nothing."""
        if name in DERIVED:
            return DERIVED[name](self)
        if name in NOT_OF_MODELS:
            return Absent(f"model.{name}")
        if name in _OWN:
            return None
        if name in self._shapes:
            return self._shapes[name]
        if name in EMPTY:
            return empty(name, self.nflex, "model")
        if name == "names" or name in NAME_ADDRESSES:
            return self._named(name)
        if name.endswith("_user") and name[:-5] in _USERS:
            count = len(self._names[_KIND_OF.get(name[:-5], name[:-5])])
            array = self._compiled(name)
            return array if array.size else np.zeros((count, 0))
        if name.startswith("nuser_") and name[6:] in _USERS:
            return getattr(self, f"{name[6:]}_user").shape[1]
        if name in _ADDRESSES:
            return np.where(self._compiled(_ADDRESSES[name]) == 0, np.int32(-1), self._compiled(name))
        if name in self._extras:
            if name == "ntexdata":
                return int(self._extras[name])
            value = np.asarray(self._extras[name])
            if value.dtype == np.bool_:
                return value.astype(np.uint8)
            return value.astype(np.float32) if name in _SINGLES else value
        if name in _native.PhysicsModel.ARRAYS:
            return self._compiled(name)
        return None

    def _part(self, kind: str, number: int, name: str) -> Any:
        """Returns the part of an array that belongs to an element."""
        if kind == "joint" and name in ("qpos0", "qpos_spring"):
            return span(getattr(self, name), self.jnt_qposadr, number)
        if kind == "joint" and name in _OF_DOFS:
            return span(getattr(self, f"dof_{name}"), self.jnt_dofadr, number)
        if kind == "numeric" and name == "data":
            first = self.numeric_adr[number]
            return self.numeric_data[first : first + self.numeric_size[number]]
        if kind == "hfield" and name == "data":
            first, rows, columns = (int(getattr(self, f"hfield_{size}")[number]) for size in ("adr", "nrow", "ncol"))
            return self.hfield_data[first : first + rows * columns].reshape(rows, columns)
        array: NDArray[Any] = getattr(self, f"{PREFIX.get(kind, kind)}_{name}")
        return array[number] if array.ndim > 1 else array[number : number + 1]


_OF_DOFS = frozenset({"armature", "damping", "frictionloss", "invweight0", "M0", "Madr", "jntid", "parentid"})
_CONSTANTS = ("dof_M0", "body_subtreemass")
"""Arrays that ``mj_setConst`` recomputes."""
_OF_EDGES = ("flexedge_invweight0", "flexedge_length0", "flexedge_rigid")


def _restored(
    source: Source,
    written: dict[str, NDArray[Any]],
    shown: dict[str, NDArray[Any]],
    options: dict[str, Any],
    visual: dict[str, dict[str, Any]],
) -> MjModel:
    """Restores a pickled model."""
    model = MjModel._made(source.compile(), source)
    for name, values in written.items():
        if values.size:
            model._arrays[name][...] = values
    for name, values in shown.items():
        model.__dict__[name] = _fixed(values, name)
    for name, value in options.items():
        setattr(model.opt, name, value)
    for part, settings in visual.items():
        for name, value in settings.items():
            setattr(getattr(model.vis, part), name, value)
    return model


def is_compiled(model: Any) -> bool:
    """Returns whether an object is a model of this module; the model of an environment is not."""
    return isinstance(model, MjModel) and "_own" in model.__dict__


_KIND_OF = {"jnt": "joint", "cam": "camera"}


for _name, _kind in {
    **KINDS,
    **{kind: kind for kind in ("light", "key", "numeric", "hfield", "mesh", "skin")},
    "keyframe": "key",
}.items():
    setattr(MjModel, _name, accessor(_kind))
