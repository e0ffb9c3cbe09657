"""Elements of an editable document that are in no body: assets, contact pairs, actuators, keyframes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, MutableSequence
from typing import Any, Union, overload

import numpy as np

from .enums import mjtBias, mjtDyn, mjtGain, mjtTexture, mjtTrn
from .more_enums import mjtMeshInertia
from .spec_elements import SOLIMP, SOLREF, Classed
from .spec_fields import Element, Field, Flag, Many, Numbers, Real, Text, Tri, Whole, Word, text_of

_F32, _I32 = np.float32, np.int32


class MjsPair(Classed):
    """A contact pair."""

    name = Text("name")
    geomname1 = Text("geom1")
    geomname2 = Text("geom2")
    condim = Whole("condim")
    friction = Numbers("friction", (1, 1, 0.005, 0.0001, 0.0001))
    solref = Numbers("solref", SOLREF)
    solreffriction = Numbers("solreffriction", (0, 0))
    solimp = Numbers("solimp", SOLIMP)
    margin = Real("margin")
    gap = Real("gap")


class MjsExclude(Element):
    """A pair of bodies without contacts."""

    name = Text("name")
    bodyname1 = Text("body1")
    bodyname2 = Text("body2")


class TextList(MutableSequence[str]):
    """A fixed number of texts that a program may change."""

    def __init__(self, values: Iterable[str], changed: Callable[[list[str]], None]) -> None:
        """Takes the texts and a function that is called on changes."""
        self._values, self._changed = list(values), changed

    @overload
    def __getitem__(self, index: int) -> str: ...
    @overload
    def __getitem__(self, index: slice) -> list[str]: ...
    def __getitem__(self, index: Union[int, slice]) -> Any:
        return self._values[index]

    def __setitem__(self, index: Any, value: Any) -> None:
        self._values[index] = value
        self._changed(self._values)

    def __delitem__(self, index: Any) -> None:
        raise TypeError("the number of these texts is fixed: set one to the empty text")

    def __len__(self) -> int:
        return len(self._values)

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def insert(self, index: int, value: str) -> None:
        """Refuses: the number of texts is fixed."""
        raise TypeError("the number of these texts is fixed: set one of them")

    def __repr__(self) -> str:
        return repr(self._values)


class Texts(Field):
    """Texts, each with an attribute of its own."""

    def __init__(self, *names: str) -> None:
        """Takes the attributes in MJCF."""
        super().__init__(names[0])
        self.names = names

    def read(self, element: Element) -> TextList:
        """Returns the texts."""
        return TextList((element._value(name) for name in self.names), lambda values: self.write(element, values))

    def write(self, element: Element, value: Any) -> None:
        """Sets the texts."""
        given = [*value, *([""] * (len(self.names) - len(value)))]
        for name, text in zip(self.names, given):
            element._write(name, text or None)


class MjsTexture(Element):
    """A texture."""

    name = Text("name")
    type = Word("type", ("2d", "cube", "skybox"), mjtTexture)
    builtin = Word("builtin", ("none", "gradient", "checker", "flat"))
    mark = Word("mark", ("none", "edge", "cross", "random"))
    rgb1 = Numbers("rgb1", (0.8, 0.8, 0.8))
    rgb2 = Numbers("rgb2", (0.5, 0.5, 0.5))
    markrgb = Numbers("markrgb", (0, 0, 0))
    random = Real("random")
    width = Whole("width")
    height = Whole("height")
    nchannel = Whole("nchannel")
    file = Text("file")
    content_type = Text("content_type")
    gridsize = Numbers("gridsize", (1, 1), _I32)
    gridlayout = Text("gridlayout")
    hflip = Flag("hflip")
    vflip = Flag("vflip")
    cubefiles = Texts("fileright", "fileleft", "fileup", "filedown", "filefront", "fileback")


_ROLES = ("", "rgb", "occlusion", "roughness", "metallic", "normal", "opacity", "emissive", "rgba", "orm")


class _Layers(Field):
    """Textures of a material by ``mjtTextureRole``."""

    def read(self, element: Element) -> TextList:
        """Returns the names."""
        own, found = element._spec._own, [""] * len(_ROLES)
        found[1] = element._value("texture")
        for at in own.children(element._at):
            found[_ROLES.index(own.get(at, "role") or "rgb")] = own.get(at, "texture") or ""
        return TextList(found, lambda values: self.write(element, values))

    def write(self, element: Element, value: Any) -> None:
        """Sets the names."""
        own, given = element._spec._own, list(value)
        if given[0]:
            raise ValueError("textures[0], for the role user, is never drawn: leave it empty")
        for at in own.children(element._at):
            own.remove(at, True)
        layered = any(given[2:])
        element._write("texture", None if layered or not given[1] else given[1])
        for role, name in zip(_ROLES, given):
            if layered and name:
                at = own.add(element._at, "layer")
                own.set(at, "role", role)
                own.set(at, "texture", name)


class MjsMaterial(Classed):
    """A material."""

    name = Text("name")
    textures = _Layers("texture")
    texuniform = Flag("texuniform")
    texrepeat = Numbers("texrepeat", (1, 1), _F32)
    emission = Real("emission")
    specular = Real("specular")
    shininess = Real("shininess")
    reflectance = Real("reflectance")
    metallic = Real("metallic", 1.0)
    roughness = Real("roughness", 1.0)
    rgba = Numbers("rgba", (1, 1, 1, 1), _F32)


class MjsMesh(Classed):
    """A mesh."""

    name = Text("name")
    file = Text("file")
    content_type = Text("content_type")
    refpos = Numbers("refpos", (0, 0, 0))
    refquat = Numbers("refquat", (1, 0, 0, 0))
    scale = Numbers("scale", (1, 1, 1))
    inertia = Word("inertia", ("convex", "exact", "legacy", "shell"), mjtMeshInertia)
    smoothnormal = Flag("smoothnormal")
    maxhullvert = Whole("maxhullvert", -1)
    uservert = Many("vertex", _F32)
    usernormal = Many("normal", _F32)
    usertexcoord = Many("texcoord", _F32)
    userface = Many("face", _I32)


class MjsHField(Element):
    """A height field."""

    name = Text("name")
    file = Text("file")
    content_type = Text("content_type")
    size = Numbers("size", (0, 0, 0, 0))
    nrow = Whole("nrow")
    ncol = Whole("ncol")
    userdata = Many("elevation", _F32)


class MjsSkin(Element):
    """A skin; its vertices and bones are those of the document."""

    name = Text("name")
    file = Text("file")
    material = Text("material")
    rgba = Numbers("rgba", (0.5, 0.5, 0.5, 1), _F32)
    inflate = Real("inflate")
    group = Whole("group")


class MjsNumeric(Element):
    """Numbers for programs."""

    name = Text("name")
    size = Whole("size")
    data = Many("data")


class MjsText(Element):
    """A text for programs."""

    name = Text("name")
    data = Text("data")


class MjsTuple(Element):
    """A list of elements for programs; what it lists is that of the document."""

    name = Text("name")


class MjsKey(Element):
    """A keyframe."""

    name = Text("name")
    time = Real("time")
    qpos = Many("qpos")
    qvel = Many("qvel")
    act = Many("act")
    mpos = Many("mpos")
    mquat = Many("mquat")
    ctrl = Many("ctrl")


_TARGETS = {
    mjtTrn.mjTRN_JOINT: "joint",
    mjtTrn.mjTRN_JOINTINPARENT: "jointinparent",
    mjtTrn.mjTRN_SLIDERCRANK: "cranksite",
    mjtTrn.mjTRN_TENDON: "tendon",
    mjtTrn.mjTRN_SITE: "site",
    mjtTrn.mjTRN_BODY: "body",
}


class _Transmission(Field):
    """What an actuator acts on: kind and name."""

    def read(self, element: Element) -> Any:
        """Returns the kind or the name."""
        assert isinstance(element, MjsActuator)
        return element._transmission()[self.name]

    def write(self, element: Element, value: Any) -> None:
        """Sets the kind or the name."""
        assert isinstance(element, MjsActuator)
        own = element._transmission()
        own[self.name] = mjtTrn(int(value)) if self.name == "trntype" else str(value)
        for name in _TARGETS.values():
            element._write(name, None)
        if own["trntype"] in _TARGETS and own["target"]:
            element._write(_TARGETS[own["trntype"]], own["target"])


class MjsActuator(Classed):
    """An actuator. If its kind is not ``general``, it becomes a ``general`` one when a field of that kind is requested."""

    name = Text("name")
    gaintype = Word("gaintype", ("fixed", "affine", "muscle"), mjtGain)
    gainprm = Numbers("gainprm", (1, *[0] * 9))
    biastype = Word("biastype", ("none", "affine", "muscle"), mjtBias)
    biasprm = Numbers("biasprm", (0,) * 10)
    dyntype = Word("dyntype", ("none", "integrator", "filter", "filterexact", "muscle"), mjtDyn)
    dynprm = Numbers("dynprm", (1, *[0] * 9))
    actdim = Whole("actdim", -1)
    actearly = Flag("actearly")
    trntype = _Transmission("")
    target = _Transmission("")
    gear = Numbers("gear", (1, 0, 0, 0, 0, 0))
    refsite = Text("refsite")
    slidersite = Text("slidersite")
    cranklength = Real("cranklength")
    lengthrange = Numbers("lengthrange", (0, 0))
    inheritrange = Real("inheritrange")
    ctrllimited = Tri("ctrllimited")
    ctrlrange = Numbers("ctrlrange", (0, 0))
    forcelimited = Tri("forcelimited")
    forcerange = Numbers("forcerange", (0, 0))
    actlimited = Tri("actlimited")
    actrange = Numbers("actrange", (0, 0))
    group = Whole("group")
    userdata = Many("user")

    def _known(self, xml: str) -> bool:
        common = ("name", "gear", "user", "group", "ctrlrange", "forcerange", "forcelimited", "inheritrange", "class")
        return xml in common or xml in _TARGETS.values() or self._spec._own.element(self._at) == "general"

    def _value(self, xml: str) -> str:
        if not self._known(xml):
            self._spec._own.generalize(self._at)
        return super()._value(xml)

    def _write(self, xml: str, text: str | None) -> None:
        if not self._known(xml):
            self._spec._own.generalize(self._at)
        super()._write(xml, text)

    def _transmission(self) -> dict[str, Any]:
        if "_target" not in self.__dict__:
            found: dict[str, Any] = {"trntype": mjtTrn.mjTRN_UNDEFINED, "target": ""}
            for kind, name in _TARGETS.items():
                if self._given(name):
                    found = {"trntype": kind, "target": self._given(name)}
            self.__dict__["_target"] = found
        target: dict[str, Any] = self.__dict__["_target"]
        return target


class Remade(Element):
    """An element whose name in MJCF follows from its fields: it is rewritten when they change."""

    _fields: dict[str, Any]

    def _load(self) -> dict[str, Any]:
        """Returns the fields as the document has them."""
        raise NotImplementedError

    def _attributes(self, fields: dict[str, Any]) -> tuple[str, dict[str, str]]:
        """Returns the name in MJCF and the attributes."""
        raise NotImplementedError

    def _own_fields(self) -> dict[str, Any]:
        if "_fields" not in self.__dict__:
            self.__dict__["_fields"] = self._load()
            self.__dict__["_seen"] = repr(self._fields)
        return self._fields

    def _flush(self) -> None:
        super()._flush()
        if "_fields" in self.__dict__ and repr(self._fields) != self.__dict__["_seen"]:
            name, attributes = self._attributes(self._fields)
            own = self._spec._own
            if own.element(self._at) != name:
                parent = own.parent(self._at)
                assert parent is not None
                new = own.insert(parent, name, own.children(parent).index(self._at))
                for kept in ("name", "class"):
                    text = self._given(kept)
                    if text:
                        own.set(new, kept, text)
                own.remove(self._at, True)
                self._spec._moved(self, new)
            for given, _ in own.attributes(self._at):
                if given not in ("name", "class") and given not in attributes:
                    own.unset(self._at, given)
            for attribute, text in attributes.items():
                own.set(self._at, attribute, text)
            self.__dict__["_seen"] = repr(self._fields)


class Kept(Field):
    """A field of an element that is rewritten."""

    def __init__(self, kind: Callable[[Any], Any]) -> None:
        """Takes the type of the values."""
        super().__init__("")
        self.kind = kind

    def read(self, element: Element) -> Any:
        """Returns the value."""
        assert isinstance(element, Remade)
        return element._own_fields()[self.name]

    def write(self, element: Element, value: Any) -> None:
        """Sets the value."""
        assert isinstance(element, Remade)
        own = element._own_fields()
        if isinstance(own[self.name], np.ndarray) and own[self.name].size and self.name != "userdata":
            own[self.name][...] = value
        else:
            own[self.name] = self.kind(value)


def floats(value: Any) -> Any:
    """Returns numbers as an array."""
    return np.array(value, np.float64).ravel()


def given_numbers(text: str | None, count: int, initial: Any = 0.0) -> Any:
    """Returns the numbers of an attribute, padded."""
    numbers = [float(word) for word in (text or "").split()]
    rest = np.broadcast_to(np.asarray(initial, np.float64), count)[len(numbers) :]
    return np.array([*numbers, *rest])


__all__ = [
    "Kept",
    "MjsActuator",
    "MjsExclude",
    "MjsHField",
    "MjsKey",
    "MjsMaterial",
    "MjsMesh",
    "MjsNumeric",
    "MjsPair",
    "MjsSkin",
    "MjsText",
    "MjsTexture",
    "MjsTuple",
    "Remade",
    "floats",
    "given_numbers",
    "text_of",
]
