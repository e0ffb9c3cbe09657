"""Documents with everything that they include."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

_FILES = ("file", "fileright", "fileleft", "fileup", "filedown", "filefront", "fileback")
_FOLDERS = {"texture": "texturedir", "mesh": "meshdir", "hfield": "meshdir", "skin": "meshdir"}
MAX_DEPTH = 50
"""Largest depth of nested includes."""


def _found(file: str, folder: Path, beside: Path) -> Path:
    """Returns the path of a file: relative to the folder of the document, or else next to the file that names it."""
    path = folder / file
    return path if path.is_file() else beside / file


def _spliced(
    path: Path, folder: Path, depth: int, visit: Callable[[ElementTree.Element, Path], None]
) -> list[ElementTree.Element]:
    """Returns the elements of a file, with those of the files that it includes."""
    if depth > MAX_DEPTH:
        raise ValueError(f"{path}: includes are nested more than {MAX_DEPTH} deep")
    root = ElementTree.parse(path).getroot()

    def splice(parent: ElementTree.Element) -> None:
        children = list(parent)
        for child in children:
            parent.remove(child)
        for child in children:
            if child.tag == "include":
                parent.extend(_spliced(_found(child.get("file", ""), folder, path.parent), folder, depth + 1, visit))
            else:
                visit(child, path.parent)
                splice(child)
                parent.append(child)

    splice(root)
    return list(root) if depth else [root]


def flat(path: Path, name_file: Callable[[Path], str] = str) -> ElementTree.Element:
    """Returns a document with its includes, and names each of its files by ``name_file`` of the file's path.

    Raises:
        FileNotFoundError: An included file does not exist.
        ElementTree.ParseError: A file is not XML.
    """
    named: list[tuple[ElementTree.Element, Path]] = []
    (root,) = _spliced(path, path.parent, 0, lambda element, beside: named.append((element, beside)))
    folders = {key: value for compiler in root.iter("compiler") for key, value in compiler.attrib.items()}
    for element, beside in named:
        prefix = folders.get(_FOLDERS.get(element.tag, ""), folders.get("assetdir", ""))
        for key in _FILES:
            if element.tag in (*_FOLDERS, "model") and key in element.attrib:
                file = element.attrib[key]
                element.set(key, name_file(_found(f"{prefix}/{file}" if prefix else file, path.parent, beside)))
    for compiler in root.iter("compiler"):
        for key in ("assetdir", "texturedir", "meshdir"):
            compiler.attrib.pop(key, None)
    return root
