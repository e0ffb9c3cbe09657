"""Equality constraints, tendons and sensors of an editable document, whose names in MJCF follow from what they relate."""

from __future__ import annotations

from typing import Any

import numpy as np

from .enums import mjtDataType, mjtEq, mjtObj, mjtSensor, mjtStage
from .spec_elements import SOLIMP, SOLREF, Classed
from .spec_fields import Element, Flag, Many, Numbers, Real, Text, Tri, Whole, text_of
from .spec_parts import Kept, Remade, floats, given_numbers

_EQUALITIES = {
    mjtEq.mjEQ_CONNECT: "connect",
    mjtEq.mjEQ_WELD: "weld",
    mjtEq.mjEQ_JOINT: "joint",
    mjtEq.mjEQ_TENDON: "tendon",
}
_OBJECTS = {
    mjtObj.mjOBJ_BODY: "body",
    mjtObj.mjOBJ_XBODY: "xbody",
    mjtObj.mjOBJ_JOINT: "joint",
    mjtObj.mjOBJ_GEOM: "geom",
    mjtObj.mjOBJ_SITE: "site",
    mjtObj.mjOBJ_CAMERA: "camera",
    mjtObj.mjOBJ_TENDON: "tendon",
    mjtObj.mjOBJ_ACTUATOR: "actuator",
}


def _object(name: str) -> mjtObj:
    return next((kind for kind, other in _OBJECTS.items() if other == name), mjtObj.mjOBJ_UNKNOWN)


class MjsEquality(Remade, Classed):
    """An equality constraint. A new one has MuJoCo's default ``data``: ``0 1 0 0 0 0 0 0 0 0 1``, whatever its type."""

    name = Text("name")
    active = Flag("active")
    solref = Numbers("solref", SOLREF)
    solimp = Numbers("solimp", SOLIMP)
    type = Kept(lambda value: mjtEq(int(value)))
    name1 = Kept(str)
    name2 = Kept(str)
    objtype = Kept(lambda value: mjtObj(int(value)))
    data = Kept(floats)

    def _load(self) -> dict[str, Any]:
        element, given = self._spec._own.element(self._at), self._given
        data = np.zeros(11)
        data[1] = data[10] = 1.0
        kind = next(kind for kind, name in _EQUALITIES.items() if name == element)
        objtype, names = mjtObj.mjOBJ_UNKNOWN, ("", "")
        fresh = not any(given(f"{name}1") for name in ("body", "site", "joint", "tendon"))
        if element in ("joint", "tendon"):
            names = (given(f"{element}1") or "", given(f"{element}2") or "")
            objtype = mjtObj.mjOBJ_JOINT if element == "joint" else mjtObj.mjOBJ_TENDON
            data[:5] = given_numbers(given("polycoef"), 5, (0, 1, 0, 0, 0))
        elif not fresh:
            site = given("site1") is not None
            objtype = mjtObj.mjOBJ_SITE if site else mjtObj.mjOBJ_BODY
            ends = "site" if site else "body"
            names = (given(f"{ends}1") or "", given(f"{ends}2") or "")
            data[:3] = given_numbers(given("anchor"), 3)
            if element == "weld":
                data[3:10] = given_numbers(given("relpose"), 7)
                data[10] = float(given("torquescale") or 1.0)
        return {"type": kind, "name1": names[0], "name2": names[1], "objtype": objtype, "data": data}

    def _attributes(self, fields: dict[str, Any]) -> tuple[str, dict[str, str]]:
        if fields["type"] not in _EQUALITIES:
            raise ValueError(
                f"equality type is {fields['type']!r}: {', '.join(kind.name for kind in _EQUALITIES)} are supported"
            )
        element, data = _EQUALITIES[fields["type"]], fields["data"]
        kept = {name: text for name in ("active", "solref", "solimp") if (text := self._given(name)) is not None}
        if element in ("joint", "tendon"):
            names, numbers = element, {"polycoef": data[:5]}
        else:
            site = fields["objtype"] == mjtObj.mjOBJ_SITE
            names, numbers = ("site", {}) if site else ("body", {"anchor": data[:3]})
            if element == "weld":
                numbers = {**numbers, "torquescale": data[10:]}
                if not site:
                    numbers["relpose"] = data[3:10]
        for number in (1, 2):
            if fields[f"name{number}"]:
                kept[f"{names}{number}"] = fields[f"name{number}"]
        return element, {**kept, **{name: text_of(value) for name, value in numbers.items()}}


class MjsWrap(Element):
    """A part of a tendon's path."""


class MjsTendon(Classed):
    """A tendon: a spatial one through sites and around geoms, or a fixed one along joints."""

    name = Text("name")
    group = Whole("group")
    damping = Real("damping")
    stiffness = Real("stiffness")
    springlength = Numbers("springlength", (-1, -1), spread=True)
    solref_friction = Numbers("solreffriction", SOLREF)
    solimp_friction = Numbers("solimpfriction", SOLIMP)
    frictionloss = Real("frictionloss")
    range = Numbers("range", (0, 0))
    limited = Tri("limited")
    margin = Real("margin")
    solref_limit = Numbers("solreflimit", SOLREF)
    solimp_limit = Numbers("solimplimit", SOLIMP)
    material = Text("material")
    width = Real("width", 0.003)
    rgba = Numbers("rgba", (0.5, 0.5, 0.5, 1), np.float32)
    userdata = Many("user")

    def default(self) -> Any:
        """Returns the default class of the tendon."""
        return self.classname

    def _wrap(self, fixed: bool, element: str, **attributes: str) -> MjsWrap:
        own = self._spec._own
        kind = "fixed" if fixed else "spatial"
        if own.element(self._at) != kind:
            if own.children(self._at):
                raise ValueError("a tendon runs along joints, or through sites and around geoms: not both")
            self._flush()
            parent = own.parent(self._at)
            assert parent is not None
            new = own.insert(parent, kind, own.children(parent).index(self._at))
            for name, text in own.attributes(self._at):
                own.set(new, name, text)
            own.remove(self._at, True)
            self._spec._moved(self, new)
        at = own.add(self._at, element)
        for name, text in attributes.items():
            if text:
                own.set(at, name, text)
        return MjsWrap(self._spec, at)

    def wrap_site(self, name: str) -> MjsWrap:
        """Lets the tendon pass through a site."""
        return self._wrap(False, "site", site=name)

    def wrap_geom(self, name: str, sidesite: str = "") -> MjsWrap:
        """Lets the tendon wrap around a geom, on the side of a site."""
        return self._wrap(False, "geom", geom=name, sidesite=sidesite)

    def wrap_joint(self, name: str, coef: float) -> MjsWrap:
        """Lets the tendon follow a joint."""
        return self._wrap(True, "joint", joint=name, coef=text_of(coef))

    def wrap_pulley(self, divisor: float) -> MjsWrap:
        """Divides the length of the rest of the path."""
        return self._wrap(False, "pulley", divisor=text_of(divisor))


_SENSORS = {
    **dict.fromkeys(("touch", "accelerometer", "velocimeter", "gyro", "force", "torque"), ("site", "")),
    **dict.fromkeys(("magnetometer", "rangefinder"), ("site", "")),
    **dict.fromkeys(("jointpos", "jointvel", "jointactuatorfrc", "ballquat", "ballangvel"), ("joint", "")),
    **dict.fromkeys(("jointlimitpos", "jointlimitvel", "jointlimitfrc"), ("joint", "")),
    **dict.fromkeys(("tendonpos", "tendonvel", "tendonlimitpos", "tendonlimitvel", "tendonlimitfrc"), ("tendon", "")),
    **dict.fromkeys(("actuatorpos", "actuatorvel", "actuatorfrc"), ("actuator", "")),
    **dict.fromkeys(("framepos", "framequat", "framexaxis", "frameyaxis", "framezaxis"), ("frame", "frame")),
    **dict.fromkeys(("framelinvel", "frameangvel"), ("frame", "frame")),
    **dict.fromkeys(("framelinacc", "frameangacc"), ("frame", "")),
    **dict.fromkeys(("subtreecom", "subtreelinvel", "subtreeangmom"), ("subtree", "")),
    **dict.fromkeys(("distance", "normal", "fromto"), ("between", "between")),
    **dict.fromkeys(("e_potential", "e_kinetic", "clock"), ("", "")),
    "camprojection": ("site", "camera"),
    "user": ("user", ""),
}
_SENSOR_NAMES = {
    "mjSENS_CAMPROJECTION": "camprojection",
    "mjSENS_JOINTACTFRC": "jointactuatorfrc",
    "mjSENS_GEOMDIST": "distance",
    "mjSENS_GEOMNORMAL": "normal",
    "mjSENS_GEOMFROMTO": "fromto",
    "mjSENS_E_POTENTIAL": "e_potential",
    "mjSENS_E_KINETIC": "e_kinetic",
}


def _sensor_name(kind: mjtSensor) -> str:
    return _SENSOR_NAMES.get(kind.name, kind.name[7:].lower())


_SENSOR_KINDS = {_sensor_name(kind): kind for kind in mjtSensor}
_STAGES, _DATA = ("none", "pos", "vel", "acc"), ("real", "positive", "axis", "quaternion")


class MjsSensor(Remade):
    """A sensor."""

    name = Text("name")
    cutoff = Real("cutoff")
    noise = Real("noise")
    userdata = Many("user")
    type = Kept(lambda value: mjtSensor(int(value)))
    objtype = Kept(lambda value: mjtObj(int(value)))
    objname = Kept(str)
    reftype = Kept(lambda value: mjtObj(int(value)))
    refname = Kept(str)
    datatype = Kept(lambda value: mjtDataType(int(value)))
    needstage = Kept(lambda value: mjtStage(int(value)))
    dim = Kept(int)

    def _load(self) -> dict[str, Any]:
        element, given = self._spec._own.element(self._at), self._given
        form, reference = _SENSORS[element]
        objtype = reftype = mjtObj.mjOBJ_UNKNOWN
        objname = refname = ""
        if form in ("frame", "user"):
            objtype, objname = _object(given("objtype") or ""), given("objname") or ""
        elif form == "between":
            side = "geom" if given("geom1") else "body"
            objtype, objname = _object(side), given(f"{side}1") or ""
            side = "geom" if given("geom2") else "body"
            reftype, refname = _object(side), given(f"{side}2") or ""
        elif form:
            name = "body" if form == "subtree" else form
            objtype, objname = _object(name), given(name) or ""
        if reference == "frame" and given("refname"):
            reftype, refname = _object(given("reftype") or ""), given("refname") or ""
        elif reference == "camera":
            reftype, refname = mjtObj.mjOBJ_CAMERA, given("camera") or ""
        if not objname:
            objtype = mjtObj.mjOBJ_UNKNOWN
        return {
            "type": _SENSOR_KINDS[element],
            "objtype": objtype,
            "objname": objname,
            "reftype": reftype,
            "refname": refname,
            "datatype": mjtDataType(_DATA.index(given("datatype") or "real")),
            "needstage": mjtStage(_STAGES.index(given("needstage") or "acc")),
            "dim": int(given("dim") or 0),
        }

    def _attributes(self, fields: dict[str, Any]) -> tuple[str, dict[str, str]]:
        element = _sensor_name(fields["type"])
        if element not in _SENSORS:
            raise ValueError(
                f"sensor type is {fields['type']!r}: plugins are programs of MuJoCo's own, which are not run here"
            )
        form, reference = _SENSORS[element]
        kept = {name: text for name in ("cutoff", "noise", "user") if (text := self._given(name)) is not None}
        objname, refname = fields["objname"], fields["refname"]
        objtype = _OBJECTS.get(fields["objtype"], "")
        reftype = _OBJECTS.get(fields["reftype"], "")
        if form in ("frame", "user"):
            kept.update({"objtype": objtype, "objname": objname} if objtype and objname else {})
        elif form == "between":
            kept.update({f"{objtype}1": objname} if objtype and objname else {})
            kept.update({f"{reftype}2": refname} if reftype and refname else {})
        elif form and objname:
            kept["body" if form == "subtree" else form] = objname
        if reference == "frame" and refname:
            kept.update({"reftype": reftype or "body", "refname": refname})
        elif reference == "camera" and refname:
            kept["camera"] = refname
        if form == "user":
            kept["dim"] = str(fields["dim"])
            kept["needstage"] = _STAGES[int(fields["needstage"])]
            kept["datatype"] = _DATA[int(fields["datatype"])]
        return element, kept


__all__ = ["MjsEquality", "MjsSensor", "MjsTendon", "MjsWrap"]
