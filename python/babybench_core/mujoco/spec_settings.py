"""Settings of an editable document: compiler, options, statistics, visual settings."""

from __future__ import annotations

from typing import Any

import numpy as np

from .enums import mjtDisableBit, mjtEnableBit
from .spec_fields import Element, Field, Flag, Numbers, Real, Text, Tri, Whole, Word

_F32, _I32 = np.float32, np.int32


class Section(Element):
    """A section of a document, which exists once something in it is set."""

    _path: tuple[str, ...]

    def __init__(self, spec: Any, *path: str) -> None:
        """Takes the names of the section and of those above it."""
        super().__init__(spec, -1)
        self._path = path

    def _find(self, make: bool) -> int | None:
        own, at = self._spec._own, self._spec._own.root()
        for name in self._path:
            found = [child for child in own.children(at) if own.element(child) == name]
            if not found and not make:
                return None
            at = found[-1] if found else own.add(at, name)
        return at

    def _value(self, xml: str) -> str:
        return self._given(xml) or self._spec._default_of(self._path, xml)

    def _given(self, xml: str) -> str | None:
        own, at = self._spec._own, self._spec._own.root()
        places = [at]
        for name in self._path:
            places = [child for place in places for child in own.children(place) if own.element(child) == name]
        given = [text for place in places if (text := own.get(place, xml)) is not None]
        return given[-1] if given else None

    def _write(self, xml: str, text: str | None) -> None:
        at = self._find(text is not None)
        if at is None:
            return
        if text is None:
            self._spec._own.unset(at, xml)
        else:
            self._spec._own.set(at, xml, text)


class _Switches(Field):
    """Flags of the options as bits."""

    def __init__(self, names: dict[int, str], on: str, off: str) -> None:
        super().__init__("")
        self.names, self.on, self.off = names, on, off

    def read(self, element: Element) -> int:
        """Returns the bits."""
        flags = Section(element._spec, "option", "flag")
        return sum(bit for bit, name in self.names.items() if flags._value(name) == self.on)

    def write(self, element: Element, value: Any) -> None:
        """Sets the bits."""
        flags, bits = Section(element._spec, "option", "flag"), int(value)
        unknown = bits & ~sum(self.names)
        if unknown:
            raise ValueError(f"{self.name}: bit {unknown} is not supported")
        for bit, name in self.names.items():
            wanted = self.on if bits & bit else self.off
            if flags._value(name) != wanted:
                flags._write(name, wanted)


class _Groups(Field):
    """Groups of actuators as bits."""

    def read(self, element: Element) -> int:
        """Returns the bits."""
        return sum(1 << int(word) for word in set((element._given(self.xml) or "").split()))

    def write(self, element: Element, value: Any) -> None:
        """Sets the bits."""
        groups = [str(bit) for bit in range(31) if int(value) & 1 << bit]
        element._write(self.xml, " ".join(groups) or None)


def _bits(kind: Any, prefix: str) -> dict[int, str]:
    names = {int(bit): bit.name[len(prefix) :].lower() for bit in kind if bit.name.startswith(prefix)}
    return {bit: name for bit, name in names.items() if name not in ("string", "override")}


class MjsCompiler(Section):
    """How the document is compiled."""

    autolimits = Flag("autolimits")
    boundmass = Real("boundmass")
    boundinertia = Real("boundinertia")
    settotalmass = Real("settotalmass")
    balanceinertia = Flag("balanceinertia")
    fitaabb = Flag("fitaabb")
    degree = Word("angle", ("radian", "degree"))
    eulerseq = Text("eulerseq")
    discardvisual = Flag("discardvisual")
    usethread = Flag("usethread", 1)
    fusestatic = Flag("fusestatic")
    inertiafromgeom = Tri("inertiafromgeom")
    inertiagrouprange = Numbers("inertiagrouprange", (0, 5), _I32)
    alignfree = Flag("alignfree")

    @property
    def LRopt(self) -> MjsLengthRange:
        """How lengths of actuators are found."""
        found: MjsLengthRange = self._spec._section(MjsLengthRange, "compiler", "lengthrange")
        return found


class MjsLengthRange(Section):
    """How the lengths of actuators are found."""

    mode = Word("mode", ("none", "muscle", "muscleuser", "all"))
    useexisting = Flag("useexisting")
    uselimit = Flag("uselimit")
    accel = Real("accel")
    maxforce = Real("maxforce")
    timeconst = Real("timeconst")
    timestep = Real("timestep")
    inttotal = Real("inttotal")
    interval = Real("interval")
    tolrange = Real("tolrange")


class SpecOption(Section):
    """The options of the simulation."""

    timestep = Real("timestep")
    impratio = Real("impratio")
    tolerance = Real("tolerance")
    ls_tolerance = Real("ls_tolerance")
    noslip_tolerance = Real("noslip_tolerance")
    ccd_tolerance = Real("ccd_tolerance")
    gravity = Numbers("gravity", (0, 0, -9.81))
    wind = Numbers("wind", (0, 0, 0))
    magnetic = Numbers("magnetic", (0, -0.5, 0))
    density = Real("density")
    viscosity = Real("viscosity")
    integrator = Word("integrator", ("Euler", "RK4", "implicit", "implicitfast"))
    cone = Word("cone", ("pyramidal", "elliptic"))
    jacobian = Word("jacobian", ("dense", "sparse", "auto"))
    solver = Word("solver", ("PGS", "CG", "Newton"))
    iterations = Whole("iterations")
    ls_iterations = Whole("ls_iterations")
    noslip_iterations = Whole("noslip_iterations")
    ccd_iterations = Whole("ccd_iterations")
    apirate = Real("apirate", 100.0)
    o_margin = Real("o_margin")
    o_solref = Numbers("o_solref", (0.02, 1))
    o_solimp = Numbers("o_solimp", (0.9, 0.95, 0.001, 0.5, 2))
    o_friction = Numbers("o_friction", (1, 1, 0.005, 0.0001, 0.0001))
    sdf_iterations = Whole("sdf_iterations", 10)
    sdf_initpoints = Whole("sdf_initpoints", 40)
    disableactuator = _Groups("actuatorgroupdisable")
    disableflags = _Switches(_bits(mjtDisableBit, "mjDSBL_"), "disable", "enable")
    enableflags = _Switches(_bits(mjtEnableBit, "mjENBL_"), "enable", "disable")


class SpecStatistic(Section):
    """Statistics of the model that the document sets instead of computed ones; NaN where it does not."""

    meaninertia = Real("meaninertia", float("nan"))
    meanmass = Real("meanmass", float("nan"))
    meansize = Real("meansize", float("nan"))
    extent = Real("extent", float("nan"))
    center = Numbers("center", (float("nan"), 0, 0), unset=True)

    def _value(self, xml: str) -> str:
        return self._given(xml) or ""


class VisualSection(Section):
    """A part of the visual settings, whose fields have the names of MJCF."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        key = f"_own_{name}"
        if key not in self.__dict__:
            try:
                text = self._value(name)
            except ValueError:
                self._unknown(name)
            if text in ("true", "false"):
                return int(text == "true")
            numbers = [float(word) for word in text.split()]
            if len(numbers) == 1:
                return numbers[0]
            self.__dict__[key] = np.array(numbers, _F32)
            self.__dict__[f"_seen_{name}"] = np.array(numbers, _F32)
        return self.__dict__[key]

    def __setattr__(self, name: str, value: Any) -> None:
        if name.startswith("_"):
            self.__dict__[name] = value
            return
        from .spec_fields import text_of

        text = self._value(name)
        if text in ("true", "false"):
            self._write(name, "true" if value else "false")
        elif len(text.split()) > 1:
            getattr(self, name)[...] = value
            self._flush()
        else:
            self._write(name, text_of(value))

    def _flush(self) -> None:
        from .spec_fields import text_of

        for key in [key for key in self.__dict__ if key.startswith("_own_")]:
            name, array = key[5:], self.__dict__[key]
            if not np.array_equal(array, self.__dict__[f"_seen_{name}"]):
                self._write(name, text_of(array))
                self.__dict__[f"_seen_{name}"] = array.copy()


class SpecVisual(Section):
    """The visual settings: ``global_``, ``map``, ``quality``, ``headlight``, ``scale`` and ``rgba``."""

    def __getattr__(self, name: str) -> Any:
        parts = ("global", "map", "quality", "headlight", "scale", "rgba")
        if name.rstrip("_") in parts:
            return self._spec._section(VisualSection, "visual", name.rstrip("_"))
        if name.startswith("_"):
            raise AttributeError(name)
        self._unknown(name)


__all__ = ["MjsCompiler", "Section", "SpecOption", "SpecStatistic", "SpecVisual"]
