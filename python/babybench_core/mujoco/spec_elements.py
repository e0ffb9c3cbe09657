"""Elements of bodies in an editable document, and bodies themselves."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .enums import mjtCamLight, mjtGeom, mjtJoint
from .more_enums import mjtGeomInertia
from .spec_fields import (
    Array,
    Element,
    Flag,
    Many,
    Numbers,
    Posed,
    Quat,
    Real,
    Text,
    Tri,
    Whole,
    Word,
)

if TYPE_CHECKING:
    from .spec_bodies import MjsBody

SHAPES = ("plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh")
_AIMS = ("fixed", "track", "trackcom", "targetbody", "targetbodycom")
SOLREF, SOLIMP = (0.02, 1.0), (0.9, 0.95, 0.001, 0.5, 2.0)
IDENTITY, NOT_GIVEN = (1.0, 0.0, 0.0, 0.0), (float("nan"), 0.0, 0.0, 0.0, 0.0, 0.0)
_F32 = np.float32


class Classed(Element):
    """An element with a default class."""

    @property
    def classname(self) -> Any:
        """The default class that the element was made with."""
        return self._spec.find_default(self._spec._own.class_of(self._at))

    @classname.setter
    def classname(self, value: Any) -> None:
        self._write("class", value if isinstance(value, str) else value.name)


class Placed(Element):
    """An element in a body."""

    @property
    def parent(self) -> Any:
        """The body that it is in; ``None`` for the world."""
        return self._spec._body_around(self._at)

    @property
    def frame(self) -> Any:
        """The frame that it is in, or ``None``."""
        return self._spec._frame_around(self._at)

    def set_frame(self, frame: Any) -> None:
        """Moves the element into a frame of its document."""
        self._spec._flush()
        self._spec._own.move_to(self._at, frame._at)


class MjsJoint(Classed, Placed):
    """A joint."""

    name = Text("name")
    type = Word("type", ("free", "ball", "slide", "hinge"), mjtJoint)
    group = Whole("group")
    pos = Numbers("pos", (0, 0, 0))
    axis = Numbers("axis", (0, 0, 1))
    ref = Real("ref")
    stiffness = Real("stiffness")
    springref = Real("springref")
    springdamper = Numbers("springdamper", (0, 0))
    limited = Tri("limited")
    range = Numbers("range", (0, 0))
    margin = Real("margin")
    solref_limit = Numbers("solreflimit", SOLREF)
    solimp_limit = Numbers("solimplimit", SOLIMP)
    actfrclimited = Tri("actuatorfrclimited")
    actfrcrange = Numbers("actuatorfrcrange", (0, 0))
    actgravcomp = Flag("actuatorgravcomp")
    armature = Real("armature")
    damping = Real("damping")
    frictionloss = Real("frictionloss")
    solref_friction = Numbers("solreffriction", SOLREF)
    solimp_friction = Numbers("solimpfriction", SOLIMP)
    align = Tri("align")
    userdata = Many("user")

    def _write(self, xml: str, text: str | None) -> None:
        own = self._spec._own
        free = own.element(self._at) == "freejoint" and xml not in ("name", "group", "align")
        if free and text == (self._spec._default_of(("worldbody", "body", "joint"), xml) if xml != "type" else "free"):
            return
        if free:
            raise ValueError(
                f"a free joint that add_freejoint makes has no {xml}: use add_joint(type=mjtJoint.mjJNT_FREE)"
            )
        super()._write(xml, text)


class MjsGeom(Classed, Placed, Posed):
    """A geom."""

    name = Text("name")
    type = Word("type", SHAPES, mjtGeom)
    pos = Numbers("pos", (0, 0, 0))
    quat = Quat("quat", IDENTITY)
    fromto = Numbers("fromto", NOT_GIVEN, unset=True)
    size = Numbers("size", (0, 0, 0))
    contype = Whole("contype")
    conaffinity = Whole("conaffinity")
    condim = Whole("condim")
    priority = Whole("priority")
    friction = Numbers("friction", (1, 0.005, 0.0001))
    solmix = Real("solmix")
    solref = Numbers("solref", SOLREF)
    solimp = Numbers("solimp", SOLIMP)
    margin = Real("margin")
    gap = Real("gap")
    mass = Real("mass", float("nan"))
    density = Real("density")
    typeinertia = Word("shellinertia", ("false", "true"), mjtGeomInertia)
    fluid_ellipsoid = Word("fluidshape", ("none", "ellipsoid"), float)
    fluid_coefs = Numbers("fluidcoef", (0.5, 0.25, 1.5, 1, 1))
    material = Text("material")
    rgba = Numbers("rgba", (0.5, 0.5, 0.5, 1), _F32)
    group = Whole("group")
    hfieldname = Text("hfield")
    meshname = Text("mesh")
    fitscale = Real("fitscale")
    userdata = Many("user")


class MjsSite(Classed, Placed, Posed):
    """A site."""

    name = Text("name")
    type = Word("type", SHAPES, mjtGeom)
    pos = Numbers("pos", (0, 0, 0))
    quat = Quat("quat", IDENTITY)
    fromto = Numbers("fromto", NOT_GIVEN, unset=True)
    size = Numbers("size", (0.005, 0.005, 0.005))
    material = Text("material")
    group = Whole("group")
    rgba = Numbers("rgba", (0.5, 0.5, 0.5, 1), _F32)
    userdata = Many("user")

    def attach_body(self, body: MjsBody, prefix: str = "", suffix: str = "") -> MjsBody:
        """Copies a body of another document to the site; see :meth:`MjsFrame.attach_body`."""
        frame = self._spec._frame_at_site(self)
        return frame.attach_body(body, prefix, suffix)


class MjsCamera(Classed, Placed, Posed):
    """A camera."""

    name = Text("name")
    pos = Numbers("pos", (0, 0, 0))
    quat = Quat("quat", IDENTITY)
    mode = Word("mode", _AIMS, mjtCamLight)
    targetbody = Text("target")
    orthographic = Flag("orthographic")
    fovy = Real("fovy")
    ipd = Real("ipd", 0.068)
    resolution = Numbers("resolution", (1, 1), _F32)
    sensor_size = Numbers("sensorsize", (0, 0), _F32)
    focal_length = Numbers("focal", (0, 0), _F32)
    focal_pixel = Numbers("focalpixel", (0, 0), _F32)
    principal_length = Numbers("principal", (0, 0), _F32)
    principal_pixel = Numbers("principalpixel", (0, 0), _F32)
    userdata = Many("user")


class MjsLight(Classed, Placed):
    """A light."""

    name = Text("name")
    pos = Numbers("pos", (0, 0, 0))
    dir = Numbers("dir", (0, 0, -1))
    mode = Word("mode", _AIMS, mjtCamLight)
    targetbody = Text("target")
    active = Flag("active")
    directional = Flag("directional")
    castshadow = Flag("castshadow")
    bulbradius = Real("bulbradius", 0.02)
    attenuation = Numbers("attenuation", (1, 0, 0), _F32)
    cutoff = Real("cutoff")
    exponent = Real("exponent")
    ambient = Numbers("ambient", (0, 0, 0), _F32)
    diffuse = Numbers("diffuse", (0.7, 0.7, 0.7), _F32)
    specular = Numbers("specular", (0.3, 0.3, 0.3), _F32)


class MjsFrame(Placed, Posed):
    """A frame: the pose of all elements in it."""

    name = Text("name")
    childclass = Text("childclass")
    pos = Numbers("pos", (0, 0, 0))
    quat = Quat("quat", IDENTITY)

    def attach_body(self, body: MjsBody, prefix: str = "", suffix: str = "") -> MjsBody:
        """Copies a body, of another document or of this one, into the frame, with its contents and what refers only to them.

        Args:
            body: The body.
            prefix: What all names begin with.
            suffix: What all names end with.

        Returns:
            The copy.

        Raises:
            ValueError: Names that exist already, or something that cannot be attached; the document does not change.
        """
        attached: MjsBody = self._spec._attach(self._at, body, prefix, suffix)
        return attached


__all__ = [
    "Array",
    "MjsCamera",
    "MjsFrame",
    "MjsGeom",
    "MjsJoint",
    "MjsLight",
    "MjsSite",
]
