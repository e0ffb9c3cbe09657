"""Documents that a program edits before they are compiled: :class:`MjSpec`."""

from __future__ import annotations

import io
import os
import zipfile
from collections.abc import Callable, Mapping
from typing import Any, NoReturn

from .. import _native
from .data import MjData
from .model import MjModel, Source
from .spec_bodies import MjsBody
from .spec_elements import MjsCamera, MjsFrame, MjsGeom, MjsJoint, MjsLight, MjsSite
from .spec_fields import Orientation
from .spec_kinds import SECTIONS, TYPES, MjsDefault
from .spec_parts import (
    MjsActuator,
    MjsExclude,
    MjsHField,
    MjsKey,
    MjsMaterial,
    MjsMesh,
    MjsNumeric,
    MjsPair,
    MjsSkin,
    MjsText,
    MjsTexture,
    MjsTuple,
)
from .spec_relations import MjsEquality, MjsSensor, MjsTendon, MjsWrap
from .spec_settings import MjsCompiler, Section, SpecOption, SpecStatistic, SpecVisual
from .spec_tree import SpecTree

__all__ = [
    "MjSpec",
    "MjsActuator",
    "MjsBody",
    "MjsCamera",
    "MjsCompiler",
    "MjsDefault",
    "MjsEquality",
    "MjsExclude",
    "MjsFrame",
    "MjsGeom",
    "MjsHField",
    "MjsJoint",
    "MjsKey",
    "MjsLight",
    "MjsMaterial",
    "MjsMesh",
    "MjsNumeric",
    "MjsOrientation",
    "MjsPair",
    "MjsSensor",
    "MjsSite",
    "MjsSkin",
    "MjsTendon",
    "MjsText",
    "MjsTexture",
    "MjsTuple",
    "MjsWrap",
]

MjsOrientation = Orientation
_Compiled = tuple[MjModel, MjData]  # in the class, `tuple` is the method that finds one by name

_LISTS = {"body": "bodies", "mesh": "meshes", "equality": "equalities"}
_SIZES = ("njmax", "nconmax", "nstack", "nuserdata", "nkey")
_USERS = tuple(f"nuser_{kind}" for kind in ("body", "jnt", "geom", "site", "cam", "tendon", "actuator", "sensor"))


class MjSpec(SpecTree):
    """A document that can be edited, under the names of MuJoCo 3.3.0.

    Example:
        >>> from babybench import mujoco
        >>> spec = mujoco.MjSpec()
        >>> toy = spec.worldbody.add_body(name="toy", pos=[0, 0, 0.5])
        >>> joint = toy.add_freejoint()
        >>> cube = toy.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.03, 0.03, 0.03])
        >>> model = spec.compile()
        >>> model.nbody, model.nq
        (2, 7)
    """

    def __init__(self) -> None:
        """Makes an empty document."""
        folder = os.getcwd()
        path = os.path.join(folder, "model.xml")
        self._take(_native.MjcfDocument.from_text("<mujoco/>", path, {}, ""), {}, folder)

    @classmethod
    def _made(cls, own: _native.MjcfDocument, files: Mapping[str, bytes], folder: str) -> MjSpec:
        spec = cls.__new__(cls)
        spec._take(own, dict(files), folder)
        return spec

    @staticmethod
    def from_file(filename: str | os.PathLike[str], include: Any = None, assets: Any = None) -> MjSpec:
        """Reads a file and the files that it includes.

        Args:
            filename: The path.
            include: Texts of files that it includes, by name.
            assets: Contents of other files, by name.

        Raises:
            ValueError: It cannot be read; the text names the place.
        """
        path = os.path.abspath(os.fspath(filename))
        files = _files(include, assets)
        # paths are absolute, because documents of different folders can be attached to each other
        return MjSpec._made(_native.MjcfDocument.from_file(path, files, ""), files, os.path.dirname(path))

    @staticmethod
    def from_string(xml: str, include: Any = None, assets: Any = None) -> MjSpec:
        """Reads a text; arguments and errors are those of :meth:`from_file`."""
        files = _files(include, assets)
        folder = os.getcwd()
        path = os.path.join(folder, "model.xml")
        return MjSpec._made(_native.MjcfDocument.from_text(xml, path, files, ""), files, folder)

    def __setattr__(self, name: str, value: Any) -> None:
        if name == "assets":
            self.__dict__["assets"] = dict(value)
        elif name == "comment":
            self.__dict__["comment"] = str(value)
        elif isinstance(getattr(type(self), name, None), property):
            object.__setattr__(self, name, value)
        else:
            self.__getattr__(name)
            raise AttributeError(f"MjSpec.{name} cannot be set")

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        if name in ("add_flex", "flex", "flexes", "add_plugin", "plugin", "plugins", "hasImplicitPluginElem"):
            raise AttributeError(f"MjSpec.{name}: deformable bodies and plugins are not simulated here: leave them out")
        if name == "delete":
            raise AttributeError("MjSpec has no delete, as in MuJoCo 3.3.0: use element.delete(), or detach_body(body)")
        raise AttributeError(f"MjSpec has no {name}")

    @property
    def strippath(self) -> int:
        """Whether folders in the names of files are dropped."""
        return int(Section(self, "compiler")._given("strippath") == "true")

    @strippath.setter
    def strippath(self, value: Any) -> None:
        Section(self, "compiler")._write("strippath", "true" if value else "false")

    @property
    def modelfiledir(self) -> str:
        """The folder of the document."""
        return self._folder

    @property
    def parent(self) -> None:
        """None: a document has no parent."""
        return None

    @property
    def modelname(self) -> str:
        """The name of the model."""
        return self._own.value(self._own.root(), "model")

    @modelname.setter
    def modelname(self, value: str) -> None:
        self._own.set(self._own.root(), "model", value)

    @property
    def worldbody(self) -> MjsBody:
        """The world."""
        world: MjsBody = self._wrap(self._own.world(), MjsBody)
        return world

    @property
    def compiler(self) -> MjsCompiler:
        """How the document is compiled."""
        return self._compiler()

    @property
    def option(self) -> SpecOption:
        """The options of the simulation."""
        found: SpecOption = self._section(SpecOption, "option")
        return found

    @property
    def stat(self) -> SpecStatistic:
        """Statistics that the document sets."""
        found: SpecStatistic = self._section(SpecStatistic, "statistic")
        return found

    @property
    def visual(self) -> SpecVisual:
        """The visual settings."""
        found: SpecVisual = self._section(SpecVisual, "visual")
        return found

    def add_default(self, name: str, parent: MjsDefault | None = None) -> MjsDefault:
        """Adds a default class, which starts with the values of its parent, else of the main one."""
        self._flush()
        if self._own.find("default", name) is not None:
            raise ValueError(f'default class "{name}" exists already')
        at = self._own.add((parent or self.default)._at, "default")
        self._own.set(at, "class", name)
        return self._class(at)

    @property
    def bodies(self) -> list[MjsBody]:
        """All bodies, the world first."""
        return [self.worldbody, *self._all("body")]

    def body(self, name: str) -> MjsBody | None:
        """Returns the body with a name, or ``None``."""
        return self.worldbody if name == "world" else self._find("body", name)

    def _find(self, kind: str, name: str) -> Any:
        self._flush()
        at = self._own.find(kind, name)
        return None if at is None else self._wrap(at, TYPES[kind])

    def detach_body(self, body: MjsBody) -> None:
        """Removes a body from the document, with its contents and whatever refers to them."""
        body.delete()

    def attach(
        self,
        child: MjSpec,
        prefix: str | None = None,
        suffix: str | None = None,
        site: MjsSite | str | None = None,
        frame: MjsFrame | str | None = None,
    ) -> MjsFrame:
        """Copies the whole world of another document into a frame, or to a site. Returns the new frame in it.

        Args:
            child: The other document.
            prefix: What all names begin with.
            suffix: What all names end with.
            site: A site, or its name.
            frame: A frame, or its name.
        """
        if (site is None) == (frame is None):
            raise ValueError("attach needs either a frame or a site")
        place = site if frame is None else frame
        if isinstance(place, str):
            name, place = place, self._find("site" if frame is None else "frame", place)
            if place is None:
                raise ValueError(f"{'site' if frame is None else 'frame'} {name!r} not found")
        at = self._frame_at_site(place)._at if isinstance(place, MjsSite) else place._at  # type: ignore[union-attr]
        attached: MjsFrame = self._attach(at, child.worldbody, prefix or "", suffix or "")
        return attached

    def copy(self) -> MjSpec:
        """Returns a separate document with the same elements."""
        self._flush()
        return MjSpec._made(self._own.copy(), self.assets, self._folder)

    __copy__ = copy

    def __deepcopy__(self, memo: Any) -> MjSpec:
        return self.copy()

    def __reduce__(self) -> NoReturn:
        raise TypeError("cannot pickle an MjSpec: use its text, with to_xml and MjSpec.from_string")

    def compile(self) -> MjModel:
        """Compiles the document, which stays as it is and can be edited further.

        Raises:
            ValueError: The document is invalid; the line is that of :meth:`to_xml`.
        """
        self._flush()
        source = Source(self._own.write(), self._folder, dict(self.assets))
        return MjModel._made(source.compile(), source)

    def recompile(self, m: MjModel, d: MjData) -> _Compiled:
        """Compiles the document, and keeps the state of an earlier model for elements that both have, by name.

        Returns:
            The model, and a state with the time and the values of joints, actuators and mocap bodies whose names both models
            have. Unnamed elements are matched by order if both models have equally many.
        """
        from .spec_state import carried

        model = self.compile()
        return model, carried(m, d, model)

    def to_xml(self) -> str:
        """Returns the document as MJCF."""
        self._flush()
        return self._own.write()

    def to_file(self, filename: str | os.PathLike[str]) -> None:
        """Writes the document to a file."""
        with open(filename, "w", encoding="utf-8") as file:
            file.write(self.to_xml())

    def to_zip(self, file: Any) -> None:
        """Writes the document and the files given as ``assets`` into a ZIP archive: a path or an open file."""
        target: Any = file if isinstance(file, io.IOBase) else os.fspath(file)
        with zipfile.ZipFile(target, "w") as archive:
            archive.writestr(f"{self.modelname}.xml", self.to_xml())
            for name, content in self.assets.items():
                archive.writestr(name, content)


def _files(include: Any, assets: Any) -> dict[str, bytes]:
    files: dict[str, bytes] = {}
    for given in (include, assets):
        for name, content in (given or {}).items():
            files[name] = content.encode() if isinstance(content, str) else bytes(content)
    return files


def _setting(section: tuple[str, ...], xml: str, kind: Callable[[str], Any], unset: Any) -> property:
    def read(self: MjSpec) -> Any:
        text = Section(self, *section)._given(xml)
        return unset if text is None else kind(text)

    def write(self: MjSpec, value: Any) -> None:
        text = ("true" if value else "false") if xml == "strippath" else str(value)
        Section(self, *section)._write(xml, text)

    return property(read, write, doc=f"``{xml}`` of ``<{section[-1]}>``.")


def _adders() -> None:
    """Gives documents ``add_...``, a list and a look-up by name for every kind of element."""
    for kind in TYPES:

        def every(self: MjSpec, kind: str = kind) -> list[Any]:
            self._flush()
            return self._all(kind)

        def find(self: MjSpec, name: str, kind: str = kind) -> Any:
            return self._find(kind, name)

        if kind != "body":
            setattr(MjSpec, _LISTS.get(kind, f"{kind}s"), property(every, doc=f"All elements of the kind {kind}."))
            setattr(MjSpec, kind, find)
        if kind not in SECTIONS:
            continue

        def add(self: MjSpec, default: Any = None, kind: str = kind, **values: Any) -> Any:
            section, element = SECTIONS[kind]
            return self._add(self._own.section(section), element, default, values)

        add.__doc__ = f"Adds an element of the kind {kind}; values set its fields."
        setattr(MjSpec, f"add_{kind}", add)
    for name in ("meshdir", "texturedir"):
        setattr(MjSpec, name, _setting(("compiler",), name, str, ""))
    for name in (*_SIZES, *_USERS):
        setattr(MjSpec, name, _setting(("size",), name, int, 0 if name in ("nuserdata", "nkey") else -1))


_adders()
