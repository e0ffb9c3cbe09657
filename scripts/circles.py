#!/usr/bin/env python3
"""Prints the files of one room in src that import each other in a circle: a line with their number and names for each circle.

With --imports it also prints the imports among them. An import is a `use`, or a path in code that begins with `crate` or
`super`, and leads to the file that defines the item. A file that uses its parent module is not counted, nor is a `pub use`,
which only passes a name on, nor are unit tests. Methods need no import, so calls of them do not count.
"""

import collections
import re
import subprocess
import sys
from collections.abc import Iterator

CRATES = ("src/physics/rapier", "src/physics", "src/mjcf_loader", "src/render", "src/model", "src")

Path = tuple[str, ...]
"""Path of a module or an item in its crate."""


def module_of(file: str) -> tuple[str, Path]:
    """Returns the crate of a file and the path of its module."""
    crate = next(crate for crate in CRATES if file.startswith(f"{crate}/"))
    path = file[len(crate) + 1 : -len(".rs")].split("/")
    return crate, tuple(path[:-1] if path[-1] in ("mod", "lib") else path)


def code_of(file: str) -> str:
    """Returns the code of a file without comments and without the unit tests at its end."""
    with open(file, encoding="utf-8") as opened:
        text = re.sub(r"//[^\n]*", "", opened.read())
    tests = re.search(r"^#\[cfg\(test\)\]\nmod \w+ \{", text, re.MULTILINE)
    return text[: tests.start()] if tests else text


def leaves(tree: str, before: Path = ()) -> Iterator[Path]:
    """Lists the paths of a `use` such as `a::{b, c::{d, e as f}}`."""
    tree = tree.strip()
    group = re.fullmatch(r"([\w:]*?)(?:::)?\{(.*)\}", tree, re.DOTALL)
    if not group:
        if tree:
            yield before + tuple(part.strip() for part in re.sub(r"\s+as\s+\w+", "", tree).split("::"))
        return
    inner = before + tuple(part for part in group[1].split("::") if part)
    depth, start = 0, 0
    for at, char in enumerate(group[2] + ","):
        depth += {"{": 1, "}": -1}.get(char, 0)
        if char == "," and depth == 0:
            yield from leaves(group[2][start:at], inner)
            start = at + 1


class House:
    """The files of src, what they import, and what their modules pass on."""

    def __init__(self, files: list[str]) -> None:
        """Reads the files."""
        self.files = files
        self.modules = {module_of(file): file for file in files}
        self.imports: dict[str, list[Path]] = {}
        self.passed_on: dict[tuple[str, Path], dict[str, Path]] = {}
        for file in files:
            self._read(file)

    def _read(self, file: str) -> None:
        crate, module = module_of(file)
        imports: list[Path] = []
        passed_on: dict[str, Path] = {}
        code = code_of(file)
        for public, tree in re.findall(r"^\s*(pub(?:\([^)]*\))? )?use ([^;]+);", code, re.MULTILINE):
            for path in leaves(tree):
                item = self._absolute(crate, module, path)
                if item and public:
                    passed_on[item[-1]] = item
                elif item:
                    imports.append(item)
        for start, rest in re.findall(r"\b(crate|super)((?:::\w+)+)", code):
            if item := self._absolute(crate, module, (start, *rest[2:].split("::"))):
                imports.append(item)
        self.imports[file], self.passed_on[crate, module] = imports, passed_on

    def _absolute(self, crate: str, module: Path, path: Path) -> Path | None:
        if path[0] == "crate":
            return path[1:]
        here, relative = module, path[0] in ("self", "super")
        while path and path[0] in ("self", "super"):
            here, path = here[: len(here) - (path[0] == "super")], path[1:]
        # a path that begins with a name is another crate's, unless it is a child's
        return here + path if relative or (crate, here + path[:1]) in self.modules else None

    def defined_in(self, crate: str, item: Path, depth: int = 0) -> str | None:
        """Returns the file that defines an item."""
        for length in range(len(item), -1, -1):
            if (crate, item[:length]) not in self.modules:
                continue
            if length < len(item) and depth < len(CRATES) + 4:
                target = self.passed_on[crate, item[:length]].get(item[length])
                if target and target != item:
                    return self.defined_in(crate, target + item[length + 1 :], depth + 1)
            return self.modules[crate, item[:length]]
        return None

    def graph(self) -> dict[str, set[str]]:
        """Returns which files of its room each file imports."""
        edges: dict[str, set[str]] = collections.defaultdict(set)
        for file, imports in self.imports.items():
            crate, module = module_of(file)
            for item in imports:
                target = self.defined_in(crate, item)
                if target is None or target == file or target.split("/")[1] != file.split("/")[1]:
                    continue
                parent = module_of(target)[1]
                if module[: len(parent)] != parent:
                    edges[file].add(target)
        return edges


def circles(files: list[str], edges: dict[str, set[str]]) -> list[list[str]]:
    """Returns the groups of files that reach each other, the largest first."""
    reached: dict[str, set[str]] = {}
    for file in files:
        seen: set[str] = set()
        waiting = list(edges.get(file, ()))
        while waiting:
            if (next_one := waiting.pop()) not in seen:
                seen.add(next_one)
                waiting.extend(edges.get(next_one, ()))
        reached[file] = seen
    groups = {tuple(sorted(b for b in reached[a] if a in reached[b])) for a in files if a in reached[a]}
    return sorted((list(group) for group in groups), key=lambda group: (-len(group), group))


def main() -> None:
    """Prints the circles."""
    listed = subprocess.run(["git", "ls-files", "src"], check=True, capture_output=True, text=True).stdout.split()
    files = [file for file in listed if file.endswith(".rs") and "/tests" not in file]
    edges = House(files).graph()
    for group in circles(files, edges):
        print(len(group), " ".join(file.removeprefix("src/") for file in group))
        if "--imports" in sys.argv[1:]:
            for file in group:
                for target in sorted(edges[file].intersection(group)):
                    print(f"  {file.removeprefix('src/')} -> {target.removeprefix('src/')}")


if __name__ == "__main__":
    main()
