"""Bodies of an editable document."""

from __future__ import annotations

from typing import Any

import numpy as np

from .enums import mjtObj
from .spec_elements import (
    IDENTITY,
    NOT_GIVEN,
    MjsCamera,
    MjsFrame,
    MjsGeom,
    MjsJoint,
    MjsLight,
    MjsSite,
)
from .spec_fields import Element, Field, Flag, Many, Numbers, Orientation, Posed, Quat, Real, Text, text_of

__all__ = ["MjsBody"]


class _Inertial(Field):
    """A field of the inertia of a body, which has an effect once ``ipos`` is given, as in MuJoCo."""

    def __init__(self, xml: str, initial: Any) -> None:
        super().__init__(xml)
        self.initial = initial

    def read(self, element: Element) -> Any:
        """Returns the value."""
        assert isinstance(element, MjsBody)
        return element._inertia()[self.name]

    def write(self, element: Element, value: Any) -> None:
        """Sets the value."""
        assert isinstance(element, MjsBody)
        own = element._inertia()
        if isinstance(self.initial, tuple):
            own[self.name][...] = value
        else:
            own[self.name] = type(self.initial)(value)


class MjsBody(Posed):
    """A body."""

    name = Text("name")
    childclass = Text("childclass")
    pos = Numbers("pos", (0, 0, 0))
    quat = Quat("quat", IDENTITY)
    mocap = Flag("mocap")
    gravcomp = Real("gravcomp")
    userdata = Many("user")
    mass = _Inertial("mass", 0.0)
    ipos = _Inertial("pos", (float("nan"), 0.0, 0.0))
    iquat = _Inertial("quat", IDENTITY)
    inertia = _Inertial("diaginertia", (0.0, 0.0, 0.0))
    fullinertia = _Inertial("fullinertia", NOT_GIVEN)
    explicitinertial = _Inertial("", 0)

    def _is_world(self) -> bool:
        return self._spec._own.element(self._at) == "worldbody"

    def _value(self, xml: str) -> str:
        if self._is_world():
            return "world" if xml == "name" else ""
        return super()._value(xml)

    def _given(self, xml: str) -> str | None:
        return None if self._is_world() else super()._given(xml)

    def _write(self, xml: str, text: str | None) -> None:
        if self._is_world():
            raise ValueError(f"the world has no {xml} that can be changed")
        super()._write(xml, text)

    def _inertial(self) -> Element | None:
        own = self._spec._own
        found = [at for at in own.children(self._at) if own.element(at) == "inertial"]
        return Element(self._spec, found[0]) if found else None

    def _inertia(self) -> dict[str, Any]:
        """Returns the numbers of the inertia, read once."""
        if "_mass" not in self.__dict__:
            element = self._inertial()
            values: dict[str, Any] = {}
            for name in ("mass", "ipos", "iquat", "inertia", "fullinertia", "explicitinertial"):
                field = getattr(type(self), name)
                given = element._given(field.xml) if element is not None and field.xml else None
                if isinstance(field.initial, tuple):
                    values[name] = np.array([float(word) for word in given.split()] if given else field.initial)
                else:
                    values[name] = float(given) if given else field.initial
            values["explicitinertial"] = int(element is not None)
            self.__dict__["_mass"] = values
            self.__dict__["_mass_seen"] = repr(values)
            self.__dict__["_ialt"] = Orientation(element, self._needed_inertial) if element is not None else None
        found: dict[str, Any] = self.__dict__["_mass"]
        return found

    @property
    def ialt(self) -> Orientation:
        """Another form of the orientation of the inertia."""
        self._inertia()
        if self.__dict__["_ialt"] is None:
            self.__dict__["_ialt"] = Orientation(Element(self._spec, self._spec._own.root()), self._needed_inertial)
        found: Orientation = self.__dict__["_ialt"]
        return found

    def _needed_inertial(self) -> Element:
        element = self._inertial()
        return Element(self._spec, self._spec._own.add(self._at, "inertial")) if element is None else element

    def _flush(self) -> None:
        super()._flush()
        if "_mass" not in self.__dict__:
            return
        values = self._inertia()
        if repr(values) != self.__dict__["_mass_seen"] and not np.isnan(values["ipos"][0]):
            self.__dict__["_mass_seen"] = repr(values)
            element = self._needed_inertial()
            element._write("pos", text_of(values["ipos"]))
            element._write("mass", text_of(values["mass"]))
            full = not np.isnan(values["fullinertia"][0])
            element._write("diaginertia" if full else "fullinertia", None)
            name = "fullinertia" if full else "inertia"
            element._write("fullinertia" if full else "diaginertia", text_of(values[name]))
            if not full and (self.__dict__["_ialt"] is None or self.ialt._type == 0):
                element._write("quat", text_of(values["iquat"]))
        if self.__dict__["_ialt"] is not None and (self._inertial() is not None or self.ialt._type):
            self.ialt._flush()

    @property
    def parent(self) -> MjsBody | None:
        """The parent body; ``None`` for the world."""
        return None if self._is_world() else self._spec._body_around(self._at)

    @property
    def frame(self) -> MjsFrame | None:
        """The frame that it is in, or ``None``."""
        return None if self._is_world() else self._spec._frame_around(self._at)

    def set_frame(self, frame: MjsFrame) -> None:
        """Moves the body into a frame of its document."""
        self._spec._flush()
        self._spec._own.move_to(self._at, frame._at)

    @property
    def classname(self) -> Any:
        """The default class of elements in the body that name none."""
        return self._spec.find_default(self.childclass or "main")

    def _new(self, element: str, default: Any, values: dict[str, Any]) -> Any:
        return self._spec._add(self._at, element, default, values)

    def add_body(self, default: Any = None, **values: Any) -> MjsBody:
        """Adds a body; values set its fields."""
        new: MjsBody = self._new("body", None, values)
        if default is not None:
            new.childclass = default.name
        return new

    def add_frame(self, default: Any = None, **values: Any) -> MjsFrame:
        """Adds a frame; values set its fields."""
        new: MjsFrame = self._new("frame", None, values)
        return new

    def add_joint(self, default: Any = None, **values: Any) -> MjsJoint:
        """Adds a joint; values set its fields."""
        new: MjsJoint = self._new("joint", default, values)
        return new

    def add_freejoint(self, **values: Any) -> MjsJoint:
        """Adds a free joint, which has no defaults; values set its fields."""
        new: MjsJoint = self._new("freejoint", None, values)
        return new

    def add_geom(self, default: Any = None, **values: Any) -> MjsGeom:
        """Adds a geom; values set its fields."""
        new: MjsGeom = self._new("geom", default, values)
        return new

    def add_site(self, default: Any = None, **values: Any) -> MjsSite:
        """Adds a site; values set its fields."""
        new: MjsSite = self._new("site", default, values)
        return new

    def add_camera(self, default: Any = None, **values: Any) -> MjsCamera:
        """Adds a camera; values set its fields."""
        new: MjsCamera = self._new("camera", default, values)
        return new

    def add_light(self, default: Any = None, **values: Any) -> MjsLight:
        """Adds a light; values set its fields."""
        new: MjsLight = self._new("light", default, values)
        return new

    def attach_frame(self, frame: MjsFrame, prefix: str = "", suffix: str = "") -> MjsFrame:
        """Copies a frame of another document into the body, as :meth:`MjsFrame.attach_body` does a body."""
        attached: MjsFrame = self._spec._attach(self._at, frame, prefix, suffix)
        return attached

    def find_child(self, name: str) -> MjsBody | None:
        """Returns the body with a name below this one."""
        return next((body for body in self.find_all("body") if body.name == name), None)

    def find_all(self, kind: Any) -> list[Any]:
        """Returns all elements of a kind in the body and in those below it; a kind is a name or one of ``mjtObj``."""
        name = kind if isinstance(kind, str) else _KINDS.get(int(kind), "")
        if name not in _KINDS.values():
            raise ValueError(f"{kind!r} is not a kind of element of bodies: {', '.join(_KINDS.values())}")
        inside = set(self._spec._bodies_below(self._at))
        found = [one for one in self._spec._all(name) if self._spec._owner(one._at) in inside]
        return found

    def delete(self) -> None:
        """Removes the body from its document, with its contents and whatever refers to them."""
        self._delete(alone=False)


_KINDS = {
    int(mjtObj.mjOBJ_BODY): "body",
    int(mjtObj.mjOBJ_JOINT): "joint",
    int(mjtObj.mjOBJ_GEOM): "geom",
    int(mjtObj.mjOBJ_SITE): "site",
    int(mjtObj.mjOBJ_CAMERA): "camera",
    int(mjtObj.mjOBJ_LIGHT): "light",
    int(mjtObj.mjOBJ_FRAME): "frame",
}


def _lists() -> None:
    """Gives bodies their lists, ``first_geom`` and ``next_geom``."""
    plural = {"body": "bodies"}
    for kind in _KINDS.values():

        def every(self: MjsBody, kind: str = kind) -> list[Any]:
            own = self._spec
            return [one for one in own._all(kind) if own._owner(one._at) == self._at]

        def first(self: MjsBody, kind: str = kind) -> Any:
            return next(iter(every(self, kind)), None)

        def after(self: MjsBody, element: Any, kind: str = kind) -> Any:
            found = every(self, kind)
            place = found.index(element) + 1
            return found[place] if place < len(found) else None

        name = plural.get(kind, f"{kind}s")
        setattr(MjsBody, name, property(every, doc=f"The {name} in this body, not those of bodies below it."))
        setattr(MjsBody, f"first_{kind}", first)
        setattr(MjsBody, f"next_{kind}", after)


_lists()
