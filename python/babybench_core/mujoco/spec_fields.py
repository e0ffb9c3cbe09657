"""Fields of elements of an editable document: each has MuJoCo's name and form, and writes attributes of MJCF."""

from __future__ import annotations

import difflib
import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from .spec_tree import SpecTree

Array = NDArray[Any]


def number_text(value: float) -> str:
    """Returns the shortest text that is read as the same number."""
    value = float(value)
    if math.isinf(value):
        return "inf" if value > 0 else "-inf"
    return repr(int(value)) if value.is_integer() and abs(value) < 1e15 and str(value) != "-0.0" else repr(value)


def text_of(values: Any) -> str:
    """Returns numbers as MJCF writes them."""
    return " ".join(number_text(value) for value in np.asarray(values).ravel().tolist())


def numbers_of(text: str) -> list[float]:
    """Returns the numbers of a text."""
    return [float(word) for word in text.split()]


class Element:
    """An element of a document. Its fields are MuJoCo's, and so is their form; arrays can be written into."""

    _spec: SpecTree
    _at: int
    _arrays: dict[str, tuple[Array, Array]]

    def __init__(self, spec: SpecTree, at: int) -> None:
        """Takes an element; documents make them."""
        self.__dict__.update(_spec=spec, _at=at, _arrays={})

    def __setattr__(self, name: str, value: Any) -> None:
        if name.startswith("_"):
            self.__dict__[name] = value
        elif isinstance(getattr(type(self), name, None), (Field, property)):
            object.__setattr__(self, name, value)
        else:
            self._unknown(name)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        self._unknown(name)

    def _unknown(self, name: str) -> NoReturn:
        kind = type(self).__name__
        if name in _REFUSED:
            raise AttributeError(f"{kind}.{name}: {_REFUSED[name]}")
        near = difflib.get_close_matches(name, [known for known in dir(type(self)) if known[0] != "_"], 1)
        raise AttributeError(f"{kind} has no {name}" + (f"; did you mean {near[0]}?" if near else ""))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Element) and other._spec is self._spec and other._at == self._at

    def __hash__(self) -> int:
        return hash((id(self._spec), self._at))

    def _value(self, xml: str) -> str:
        """Returns an attribute with default classes applied; nothing for one that the element does not have."""
        try:
            return self._spec._own.value(self._at, xml)
        except ValueError:
            if not self._spec._own.contains(self._at):
                raise ValueError("this element was deleted") from None
            return ""

    def _given(self, xml: str) -> str | None:
        try:
            return self._spec._own.get(self._at, xml)
        except ValueError:
            return None

    def _write(self, xml: str, text: str | None) -> None:
        """Sets or removes an attribute."""
        if text is None:
            if self._given(xml) is not None:
                self._spec._own.unset(self._at, xml)
        else:
            self._spec._own.set(self._at, xml, text)

    def _flush(self) -> None:
        """Writes arrays that a program has changed."""
        for name, (array, seen) in list(self._arrays.items()):
            if not np.array_equal(array, seen, equal_nan=array.dtype.kind == "f"):
                field = getattr(type(self), name)
                field.store(self, array)
                self._arrays[name] = (array, array.copy())

    def _set_all(self, values: dict[str, Any]) -> None:
        for name, value in values.items():
            setattr(self, name, value)

    def _delete(self, alone: bool) -> None:
        self._spec._flush()
        self._spec._own.remove(self._at, alone)

    def delete(self) -> None:
        """Removes the element from its document. References to it by name stay, and are errors when the document is compiled."""
        self._delete(alone=True)


_REFUSED = {
    "plugin": "plugins are programs of MuJoCo's own, which are not run here",
    "data": "pixels of a texture cannot be given here: write them to a PNG file, and give its name as `file`",
    "intrinsic": "give sensor_size, resolution and focal_length or focal_pixel",
    "userfacetexcoord": "texture coordinates are those of vertices here: give usertexcoord",
}


class Field:
    """An attribute of MJCF under MuJoCo's name."""

    def __init__(self, xml: str) -> None:
        """Takes the name in MJCF."""
        self.xml = xml
        self.name = xml

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, element: Element | None, owner: type) -> Any:
        return self if element is None else self.read(element)

    def __set__(self, element: Element, value: Any) -> None:
        element._spec._change(element, self.xml, lambda: self.write(element, value))

    def read(self, element: Element) -> Any:
        """Returns the value."""
        return element._value(self.xml)

    def write(self, element: Element, value: Any) -> None:
        """Sets the value."""
        element._write(self.xml, str(value) or None)


class Text(Field):
    """A name or a path; the empty text if there is none."""


class Real(Field):
    """A number; ``unset`` stands for a missing one."""

    def __init__(self, xml: str, unset: float = 0.0) -> None:
        """Takes the name in MJCF, and the number that stands for a missing one."""
        super().__init__(xml)
        self.unset = unset

    def read(self, element: Element) -> float:
        """Returns the value."""
        text = element._value(self.xml)
        return float(text) if text else self.unset

    def write(self, element: Element, value: Any) -> None:
        """Sets the value."""
        element._write(self.xml, None if math.isnan(float(value)) else number_text(value))


class Whole(Real):
    """A whole number."""

    def read(self, element: Element) -> Any:
        """Returns the value."""
        return int(super().read(element))

    def write(self, element: Element, value: Any) -> None:
        """Sets the value."""
        element._write(self.xml, None if value == self.unset and self.unset < 0 else str(int(value)))


class Word(Field):
    """One of several words, each with a number of MuJoCo's."""

    def __init__(self, xml: str, words: Sequence[str], kind: Callable[[int], Any] = int, initial: int = 0) -> None:
        """Takes the name in MJCF, the words by number, the enumeration, and the number of a missing attribute."""
        super().__init__(xml)
        self.words, self.kind, self.initial = words, kind, initial

    def read(self, element: Element) -> Any:
        """Returns the number."""
        text = element._value(self.xml)
        return self.kind(self.words.index(text) if text in self.words else self.initial)

    def write(self, element: Element, value: Any) -> None:
        """Sets the number."""
        number = int(value)
        if not 0 <= number < len(self.words) or not self.words[number]:
            known = ", ".join(f"{k} ({word})" for k, word in enumerate(self.words) if word)
            raise ValueError(f"{self.name} is {value}: it must be one of {known}")
        element._write(self.xml, self.words[number])


class Flag(Word):
    """A flag, 0 or 1."""

    def __init__(self, xml: str, initial: int = 0) -> None:
        """Takes the name in MJCF, and the number of a missing attribute."""
        super().__init__(xml, ("false", "true"), int, initial)


class Tri(Field):
    """No, yes, or decided by other attributes: 0, 1 or 2."""

    WORDS = ("false", "true", "auto")

    def read(self, element: Element) -> int:
        """Returns the number."""
        text = element._value(self.xml)
        return self.WORDS.index(text) if text in self.WORDS else 2

    def write(self, element: Element, value: Any) -> None:
        """Sets the number."""
        if int(value) not in (0, 1, 2):
            raise ValueError(f"{self.name} is {value}: it must be one of mjtLimited: 0 (false), 1 (true), 2 (auto)")
        if int(value) != self.read(element):
            element._write(self.xml, self.WORDS[int(value)])


class Numbers(Field):
    """An array that a program may write into. ``unset``: if it is missing, its first number is NaN."""

    def __init__(
        self, xml: str, initial: Sequence[float], dtype: Any = np.float64, unset: bool = False, spread: bool = False
    ) -> None:
        """Takes the name in MJCF, the default numbers, their type, and whether a single number sets all."""
        super().__init__(xml)
        self.initial, self.dtype, self.unset, self.spread = list(initial), dtype, unset, spread

    def load(self, element: Element) -> Array:
        """Returns the numbers of the document."""
        given = numbers_of(element._value(self.xml))
        if self.spread and len(given) == 1:
            given *= len(self.initial)
        if self.initial and given:
            given = [*given, *self.initial[len(given) :]]
        return np.array(given or self.initial, self.dtype)

    def read(self, element: Element) -> Array:
        """Returns the array."""
        if self.name not in element._arrays:
            array = self.load(element)
            element._arrays[self.name] = (array, array.copy())
        return element._arrays[self.name][0]

    def write(self, element: Element, value: Any) -> None:
        """Sets the numbers."""
        array = self.read(element)
        given = np.asarray(value, self.dtype)
        if given.shape != array.shape:
            raise ValueError(f"{self.name} has {given.size} numbers: it must have {array.size}")
        array[...] = given
        element._arrays[self.name] = (array, array.copy())
        self.store(element, array)

    def store(self, element: Element, array: Array) -> None:
        """Writes the numbers into the document."""
        element._write(self.xml, None if self.unset and np.isnan(array[0]) else text_of(array))


class Many(Numbers):
    """An array of any length."""

    def __init__(self, xml: str, dtype: Any = np.float64) -> None:
        """Takes the name in MJCF and the type of the numbers."""
        super().__init__(xml, (), dtype)

    def write(self, element: Element, value: Any) -> None:
        """Sets the numbers."""
        array = np.array(value, self.dtype).ravel()
        element._arrays[self.name] = (array, array.copy())
        self.store(element, array)

    def store(self, element: Element, array: Array) -> None:
        """Writes the numbers into the document."""
        element._write(self.xml, text_of(array) if array.size else None)


class Orientation:
    """Another form of an orientation, MuJoCo's ``alt``; ``type`` selects the form."""

    FORMS: tuple[tuple[str, int], ...] = (("", 0), ("axisangle", 4), ("xyaxes", 6), ("zaxis", 3), ("euler", 3))

    axisangle: Array
    xyaxes: Array
    zaxis: Array
    euler: Array
    _type: int
    _seen: tuple[Any, ...]
    _target: Callable[[], Element]

    def __init__(self, element: Element, target: Callable[[], Element]) -> None:
        """Takes an element."""
        own: dict[str, Any] = {"_element": element, "_target": target, "_type": 0}
        for number, (name, size) in enumerate(self.FORMS):
            if not name:
                continue
            given = element._given(name)
            own[name] = np.array(numbers_of(given) if given else np.zeros(size))
            if given:
                own["_type"] = number
        self.__dict__.update(own)
        self.__dict__["_seen"] = self._state()

    def _state(self) -> tuple[Any, ...]:
        return (self._type, *(tuple(getattr(self, name)) for name, _ in self.FORMS if name))

    @property
    def type(self) -> Any:
        """The form in use, of ``mjtOrientation``."""
        from .more_enums import mjtOrientation

        return mjtOrientation(self._type)

    @type.setter
    def type(self, value: Any) -> None:
        self.__dict__["_type"] = int(value)

    def __setattr__(self, name: str, value: Any) -> None:
        if name == "type":
            object.__setattr__(self, name, value)
        elif name in dict(self.FORMS):
            getattr(self, name)[...] = value
        else:
            raise AttributeError(f"MjsOrientation has no {name}")

    def _flush(self) -> None:
        state = self._state()
        if state == self._seen:
            return
        self.__dict__["_seen"] = state
        element = self._target()
        for number, (name, _) in enumerate(self.FORMS):
            if name and number == self._type:
                element._write(name, text_of(getattr(self, name)))
            elif name:
                element._write(name, None)


class Quat(Numbers):
    """A quaternion, beside which there may be another form of the orientation."""

    def load(self, element: Element) -> Array:
        """Returns the numbers of the document."""
        forms = [name for name, _ in Orientation.FORMS if name]
        if any(element._given(name) is not None for name in forms):
            return np.array(self.initial)
        return super().load(element)

    def store(self, element: Element, array: Array) -> None:
        """Writes the numbers into the document."""
        alt = element.__dict__.get("_alt")
        if alt is not None:
            alt._flush()
        given = [name for name, _ in Orientation.FORMS if name and element._given(name) is not None]
        if given:
            raise ValueError(
                f"{self.name} would have no effect because alt.{given[0]} defines the orientation: first set alt.type to "
                "mjtOrientation.mjORIENTATION_QUAT"
            )
        super().store(element, array)


class Posed(Element):
    """An element with an orientation."""

    @property
    def alt(self) -> Orientation:
        """Another form of the orientation."""
        if "_alt" not in self.__dict__:
            self.__dict__["_alt"] = Orientation(self, lambda: self)
        alt: Orientation = self.__dict__["_alt"]
        return alt

    @alt.setter
    def alt(self, value: Any) -> None:
        for name, _ in Orientation.FORMS:
            if name:
                setattr(self.alt, name, getattr(value, name))
        self.alt.type = value.type

    def _flush(self) -> None:
        if "_alt" in self.__dict__:
            self.alt._flush()
        super()._flush()

    def _set_all(self, values: dict[str, Any]) -> None:
        for number, (name, _) in enumerate(Orientation.FORMS):
            if name and name in values:
                setattr(self.alt, name, values.pop(name))
                self.alt.type = number
        self._flush()
        super()._set_all(values)
