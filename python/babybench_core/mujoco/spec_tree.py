"""The elements of an editable document: one object for each, and their operations on the document."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from .. import _native
from .spec_bodies import MjsBody
from .spec_elements import MjsFrame, MjsSite
from .spec_fields import Element
from .spec_kinds import TYPES, MjsDefault
from .spec_settings import MjsCompiler, Section


class SpecTree:
    """The elements of a document."""

    assets: dict[str, bytes]
    """Contents of files by name, which replace those of the file system."""
    comment: str
    """A text for programs; it is not written."""
    _own: _native.MjcfDocument
    _folder: str
    _wrapped: dict[int, Any]
    _parts: dict[Any, Any]

    def _take(self, own: _native.MjcfDocument, files: dict[str, bytes], folder: str) -> None:
        parts: dict[Any, Any] = {}
        self.__dict__.update(_own=own, assets=files, _folder=folder, _wrapped={}, _parts=parts, comment="")

    def _compiler(self) -> MjsCompiler:
        found: MjsCompiler = self._section(MjsCompiler, "compiler")
        return found

    def _wrap(self, at: int, kind: type[Element]) -> Any:
        if at not in self._wrapped:
            self._wrapped[at] = kind(self, at)
        return self._wrapped[at]

    def _section(self, kind: type[Section], *path: str) -> Any:
        if path not in self._parts:
            self._parts[path] = kind(self, *path)
        return self._parts[path]

    def _default_of(self, path: tuple[str, ...], xml: str) -> str:
        """Returns the default of a setting, which an empty document has."""
        empty = _native.MjcfDocument()
        at = empty.root()
        for name in path:
            at = empty.add(at, name)
        return empty.value(at, xml)

    def _moved(self, element: Element, at: int) -> None:
        self._wrapped.pop(element._at, None)
        element._at = at
        self._wrapped[at] = element

    def _flush(self) -> None:
        """Writes what programs have changed in arrays."""
        for element in [*self._wrapped.values(), *self._parts.values()]:
            if element._at < 0 or self._own.contains(element._at):
                element._flush()

    def _change(self, element: Element, xml: str, act: Callable[[], None]) -> None:
        """Changes an element. A change of a default class does not affect existing elements, as in MuJoCo."""
        own, at = self._own, element._at
        parent = own.parent(at) if at >= 0 else None
        in_class = parent is not None and own.element(parent) == "default" and bool(xml)
        if not in_class:
            act()
            if hasattr(element, "_fields") or not xml:
                element._flush()
            return
        kind = own.element(at)
        kind = "actuator" if kind == "general" else kind
        known = [one._at for one in self._all(kind)]
        # actuators are written as general ones, because a class has only their attributes
        before = {one: _value(own, one, xml) for one in known}
        before = {one: text for one, text in before.items() if text is not None and not _given(own, one, xml)}
        act()
        for one, text in before.items():
            if _value(own, one, xml) != text:
                if not text:
                    raise ValueError(
                        f"{xml} of a default class has no value to start from: set it before elements are added"
                    )
                own.set(one, xml, text)

    def _all(self, kind: str) -> list[Any]:
        return [self._wrap(at, TYPES[kind]) for at in self._own.all(kind)]

    def _owner(self, at: int) -> int:
        """Returns the body that an element is in."""
        up = self._own.parent(at)
        while up is not None and self._own.element(up) not in ("body", "worldbody"):
            up = self._own.parent(up)
        return self._own.world() if up is None else up

    def _body_around(self, at: int) -> Any:
        up = self._owner(at)
        return self._wrap(self._own.world() if self._own.element(up) == "worldbody" else up, MjsBody)

    def _frame_around(self, at: int) -> Any:
        up = self._own.parent(at)
        return self._wrap(up, MjsFrame) if up is not None and self._own.element(up) == "frame" else None

    def _bodies_below(self, at: int) -> list[int]:
        found = [at]
        for body in self._own.all("body"):
            if self._owner(body) in found:
                found.append(body)
        return found

    def _frame_at_site(self, site: MjsSite) -> MjsFrame:
        self._flush()
        parent = self._own.parent(site._at)
        assert parent is not None
        frame: MjsFrame = self._wrap(self._own.add(parent, "frame"), MjsFrame)
        for name in ("pos", "quat", "axisangle", "xyaxes", "zaxis", "euler"):
            text = site._given(name)
            if text is not None:
                self._own.set(frame._at, name, text)
        return frame

    def _add(self, parent: int, element: str, default: Any, values: dict[str, Any]) -> Any:
        self._flush()
        own = self._own
        at = own.add(parent, element)
        kind = own.kind(at)
        assert kind is not None
        new = self._wrap(at, TYPES[kind])
        try:
            if default is not None:
                own.set(at, "class", default if isinstance(default, str) else default.name)
            new._set_all(dict(values))
        except Exception:
            own.remove(at, True)
            raise
        return new

    def _attach(self, parent: int, element: Element, prefix: str, suffix: str) -> Any:
        self._flush()
        other: SpecTree = element._spec
        other._flush()
        if other._compiler().degree != self._compiler().degree:
            raise ValueError(
                "cannot attach: angles are in degrees in one document and in radians in the other, and MuJoCo 3.3.0 would "
                "read all of them as those of the first: give both documents the same compiler angle"
            )
        own = other._own.copy() if other is self else other._own
        at = self._own.attach(parent, own, element._at, prefix, suffix)
        for name, content in other.assets.items():
            if self.assets.setdefault(name, content) != content:
                raise ValueError(f"assets: both documents have a file {name!r}, with different contents")
        return self._wrap(
            at, type(element) if not isinstance(element, MjsBody) or at == element._at else _kind_of(self, at)
        )

    @property
    def default(self) -> MjsDefault:
        """The main default class."""
        return self._class(self._own.section("default"))

    def _class(self, at: int) -> MjsDefault:
        found: MjsDefault = self._parts.setdefault(("class", at), MjsDefault(self, at))
        return found

    def find_default(self, name: str) -> MjsDefault | None:
        """Returns the default class with a name, or ``None``."""
        if name == "main":
            return self.default
        at = self._own.find("default", name)
        return None if at is None else self._class(at)


def _kind_of(spec: SpecTree, at: int) -> type[Element]:
    kind = spec._own.kind(at)
    assert kind is not None
    return TYPES[kind]


def _given(own: _native.MjcfDocument, at: int, xml: str) -> bool:
    try:
        return own.get(at, xml) is not None
    except ValueError:
        return True


def _value(own: _native.MjcfDocument, at: int, xml: str) -> str | None:
    try:
        return own.value(at, xml)
    except ValueError:
        return None
