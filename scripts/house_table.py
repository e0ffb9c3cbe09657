#!/usr/bin/env python3
"""Prints how the counts of scripts/house.sh have changed since a commit, as a Markdown table: scripts/house_table.py [COMMIT].

Without COMMIT it compares with b62d939, the last commit in which engine and infant were one crate. What the working tree
has and git does not track is not counted.
"""

import collections
import pathlib
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable

import tomllib

OLD = "b62d939"
PASSED_BY_AN_ACTION = {
    OLD: """env/mod env/physics env/held env/stage env/eyes env/senses env/clock env/pipeline env/episode env/engines shelf
        env/task/mod env/task/scene env/action_delay sensors/transform/delay actuation/spring_damper spaces/mod env/paths"""
}
"""Files with functions that run in `Env::step` before `Engine::step`: of older commits a list made by hand."""
CIRCLES = pathlib.Path(__file__).with_name("circles.py")


def run(*command: str, folder: pathlib.Path) -> str:
    """Runs a command in a folder and returns what it prints."""
    return subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True).stdout


class Tree:
    """The files of a commit, or those that git tracks in the working tree."""

    def __init__(self, folder: pathlib.Path) -> None:
        """Lists the files."""
        self.folder = folder
        self.files = [file for file in run("git", "ls-files", folder=folder).split("\n") if (folder / file).is_file()]

    def text(self, file: str) -> str:
        """Returns the text of a file."""
        return (self.folder / file).read_text(encoding="utf-8")

    def rust(self, *folders: str) -> list[str]:
        """Lists the Rust files in folders."""
        return [file for file in self.files if file.endswith(".rs") and file.startswith(folders)]

    def count(self, pattern: str) -> int:
        """Counts the lines of the library and the engine that match."""
        lines = (line for file in self.rust("src/", "engine/") for line in self.text(file).split("\n"))
        return sum(1 for line in lines if re.search(pattern, line))

    def crates(self) -> dict[str, int]:
        """Returns the lines of Rust of each crate that is published, without those of crates and tests within it."""
        manifests = {}
        for file in self.files:
            if file.endswith("Cargo.toml"):
                package = tomllib.loads(self.text(file)).get("package", {})
                if package.get("publish", True) is not False and "name" in package:
                    manifests[file.removesuffix("Cargo.toml")] = package["name"]
        lines: dict[str, int] = dict.fromkeys(manifests.values(), 0)
        for file in self.rust(""):
            home = max((folder for folder in manifests if file.startswith(folder)), key=len)
            inside = file.removeprefix(home)
            if home.startswith("src/") or inside.startswith("src/"):
                lines[manifests[home]] += self.text(file).count("\n")
        return lines

    def features(self) -> int:
        """Counts the features of babybench, without the default."""
        return len(set(tomllib.loads(self.text("Cargo.toml"))["features"]) - {"default"})

    def methods(self, name: str) -> tuple[int, int]:
        """Counts the public methods of a type, and the files that define them."""
        found: dict[str, set[str]] = collections.defaultdict(set)
        for file in self.rust("src/"):
            for block in re.findall(
                rf"^impl(?:<[^>]*>)? {name}(?:<[^>]*>)? \{{\n(.*?)^\}}", self.text(file), re.M | re.S
            ):
                for method in re.findall(r"^    pub (?:const )?fn (\w+)", block, re.M):
                    found[method].add(file)
        return len(found), len(set().union(*found.values()))

    def sense(self) -> int:
        """Counts the files that name one sense."""
        places = ("src/", "python/src/", "python/babybench_core/", "web/")
        texts = (
            file
            for file in self.files
            if file.startswith(places) and file.endswith((".rs", ".py", ".pyi", ".js", ".ts", ".html"))
        )
        return sum(1 for file in texts if "touch_pooled" in self.text(file))

    def circles(self) -> tuple[int, int]:
        """Counts the circles of files, and the files in them."""
        sizes = [int(line.split()[0]) for line in run(str(CIRCLES), folder=self.folder).split("\n") if line]
        return len(sizes), sum(sizes)

    def repeated(self) -> int:
        """Counts the names that more than one type has."""
        declared = r"^(?:pub(?:\([a-z: ]*\))? )?(?:struct|enum|trait|type) ([A-Z]\w*)"
        names = collections.Counter(
            name for file in self.rust("src/", "engine/") for name in re.findall(declared, self.text(file), re.M)
        )
        return sum(1 for uses in names.values() if uses > 1)


def passed(commit: str | None) -> int | str:
    """Counts the files that an action passes."""
    if commit is None:
        script = CIRCLES.with_name("house.sh").read_text(encoding="utf-8")
        listed = re.search(r"^action_path\(\).*?<<'END'\n(.*?)^END", script, re.M | re.S)
        return len(listed[1].split("\n")) - 1 if listed else "?"
    known = next((files for start, files in PASSED_BY_AN_ACTION.items() if commit.startswith(start)), None)
    return len(known.split()) if known else "?"


def main() -> None:
    """Prints the table."""
    here = pathlib.Path(run("git", "rev-parse", "--show-toplevel", folder=CIRCLES.parent).strip())
    old = sys.argv[1] if len(sys.argv) > 1 else OLD
    with tempfile.TemporaryDirectory() as made:
        folder = pathlib.Path(made)
        archive = subprocess.run(["git", "archive", old], cwd=here, check=True, capture_output=True).stdout
        subprocess.run(["tar", "-x"], cwd=folder, input=archive, check=True)
        run("git", "init", "-q", folder=folder)
        run("git", "add", "-A", "-f", folder=folder)
        before, after = Tree(folder), Tree(here)
        rows: list[tuple[str, Callable[[Tree], object]]] = [
            ("crates that are published", lambda tree: len(tree.crates())),
            ("features of babybench", Tree.features),
            ("items hidden from the documentation", lambda tree: tree.count(r"doc\(hidden\)")),
            ("conditions on features", lambda tree: tree.count("cfg.*feature")),
            ("public methods of Env, in files", lambda tree: "{}, {}".format(*tree.methods("Env"))),
            ("public methods of Blueprint, in files", lambda tree: "{}, {}".format(*tree.methods("Blueprint"))),
            ("public methods of TaskScene", lambda tree: tree.methods("TaskScene")[0]),
            ("files that name the sense touch_pooled", Tree.sense),
            ("circles of files in a room, files in them", lambda tree: "{}, {}".format(*tree.circles())),
            ("type names that several types have", Tree.repeated),
        ]
        print(f"| | {old} | now |\n|---|--:|--:|")
        for name, measure in rows:
            print(f"| {name} | {measure(before)} | {measure(after)} |")
        print(f"| files that an action passes before the engine | {passed(old)} | {passed(None)} |")
        lines = [tree.crates() for tree in (before, after)]
        for crate in sorted(lines[0] | lines[1]):
            print(f"| lines of {crate} | {lines[0].get(crate, '')} | {lines[1].get(crate, '')} |")


if __name__ == "__main__":
    main()
