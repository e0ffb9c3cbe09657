"""Kinds of elements of an editable document, and default classes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .spec_bodies import MjsBody
from .spec_elements import MjsCamera, MjsFrame, MjsGeom, MjsJoint, MjsLight, MjsSite
from .spec_fields import Element
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
from .spec_relations import MjsEquality, MjsSensor, MjsTendon

if TYPE_CHECKING:
    from .spec_tree import SpecTree

TYPES: dict[str, type[Element]] = {
    "body": MjsBody,
    "frame": MjsFrame,
    "joint": MjsJoint,
    "geom": MjsGeom,
    "site": MjsSite,
    "camera": MjsCamera,
    "light": MjsLight,
    "texture": MjsTexture,
    "material": MjsMaterial,
    "mesh": MjsMesh,
    "hfield": MjsHField,
    "skin": MjsSkin,
    "pair": MjsPair,
    "exclude": MjsExclude,
    "equality": MjsEquality,
    "tendon": MjsTendon,
    "actuator": MjsActuator,
    "sensor": MjsSensor,
    "numeric": MjsNumeric,
    "text": MjsText,
    "tuple": MjsTuple,
    "key": MjsKey,
}
SECTIONS = {
    **{kind: ("asset", kind) for kind in ("texture", "material", "mesh", "hfield", "skin")},
    "pair": ("contact", "pair"),
    "exclude": ("contact", "exclude"),
    "equality": ("equality", "connect"),
    "tendon": ("tendon", "spatial"),
    "actuator": ("actuator", "general"),
    "sensor": ("sensor", "touch"),
    "numeric": ("custom", "numeric"),
    "text": ("custom", "text"),
    "tuple": ("custom", "tuple"),
    "key": ("keyframe", "key"),
}


class MjsDefault:
    """A default class: its fields are elements whose values are the defaults of others."""

    def __init__(self, spec: SpecTree, at: int) -> None:
        """Takes a class; documents make them."""
        self.__dict__.update(_spec=spec, _at=at)

    @property
    def name(self) -> str:
        """The name of the class."""
        return self._spec._own.get(self._at, "class") or "main"

    @name.setter
    def name(self, value: str) -> None:
        self._spec._own.set(self._at, "class", value)

    def __getattr__(self, name: str) -> Any:
        if name not in (
            "geom",
            "joint",
            "site",
            "camera",
            "light",
            "pair",
            "equality",
            "tendon",
            "material",
            "mesh",
            "actuator",
        ):
            raise AttributeError(f"MjsDefault has no {name}")
        own = self._spec._own
        found = [at for at in own.children(self._at) if own.element(at) == name]
        if name == "actuator":
            kinds = [
                at for at in own.children(self._at) if own.element(at) not in TYPES and own.element(at) != "default"
            ]
            if any(own.element(at) != "general" for at in kinds):
                raise ValueError(
                    f'the default class "{self.name}" has actuators of other kinds than general: use a class of its own'
                )
            found, name = kinds, "general"
        at = found[-1] if found else own.add(self._at, name)
        return self._spec._wrap(at, TYPES["actuator" if name == "general" else name])

    def __eq__(self, other: object) -> bool:
        return isinstance(other, MjsDefault) and other._spec is self._spec and other._at == self._at

    def __hash__(self) -> int:
        return hash((id(self._spec), self._at))

    def _flush(self) -> None:
        """Does nothing: the elements of the class are parts of the document themselves."""
