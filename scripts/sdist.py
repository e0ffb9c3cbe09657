#!/usr/bin/env python3
"""Checks that a source distribution of babybench has all that Cargo needs to build the wheel, without building it again.

    scripts/sdist.py ARCHIVE WHEEL DEP_INFO

DEP_INFO is the file that Cargo writes beside the library of the wheel (target/PROFILE/lib_native.d). It names the sources of the
packages of this repository, with what they embed. Each must be in ARCHIVE, with the same bytes; so must be what WHEEL has beside
the library; and the manifests there must resolve to packages of Cargo.lock. Needs Python 3.11 and cargo.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import tomllib
import zipfile
from pathlib import Path


def sources(dep_info: Path, repository: Path) -> list[Path]:
    """Returns the files of the repository that Cargo read, relative to its root."""
    library, _, files = dep_info.read_text().splitlines()[0].partition(": ")
    if "_native." not in Path(library).name:  # .so, .dylib or .dll
        sys.exit(f"{dep_info} begins with {library}: expected the library of the wheel")
    paths = [Path(file.replace("\0", " ")) for file in files.replace("\\ ", "\0").split()]
    return [path.relative_to(repository) for path in paths if path.is_relative_to(repository)]


def main() -> None:
    """Prints how many files were compared; ends with a message if one is missing or differs."""
    archive, wheel, dep_info = map(Path, sys.argv[1:])
    repository = Path(__file__).resolve().parent.parent
    needed = {path: path for path in sources(dep_info, repository) if not path.is_relative_to("target")}
    if len(needed) < 100:
        sys.exit(f"{dep_info} names only {len(needed)} sources: was it built from this checkout?")
    with zipfile.ZipFile(wheel) as files:
        names = [name for name in files.namelist() if ".dist-info/" not in name and not name.endswith((".so", ".pyd"))]
    needed |= {Path("python", name): Path(name) for name in names}
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["tar", "-xzf", archive, "-C", folder], check=True)
        (unpacked,) = Path(folder).iterdir()
        faults = [path for path, packed in needed.items() if not is_same(repository / path, unpacked / packed)]
        if faults:
            sys.exit("\n".join([f"{archive.name} lacks, or has other bytes of:", *map(str, faults)]))
        command = ["cargo", "metadata", "--format-version", "1", "--manifest-path", unpacked / "python/Cargo.toml"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        new = packages(unpacked / "Cargo.lock") - packages(repository / "Cargo.lock")
        if new:
            sys.exit(f"{archive.name} resolves to packages that Cargo.lock does not have: {sorted(new)}")
    print(f"{archive.name}: {len(needed)} files that the wheel needs are there, and the manifests resolve")


def packages(lock: Path) -> set[tuple[str, str]]:
    """Returns names and versions of what a lock file has."""
    return {(package["name"], package["version"]) for package in tomllib.loads(lock.read_text())["package"]}


def is_same(file: Path, other: Path) -> bool:
    """Whether both files exist and have the same bytes."""
    return other.is_file() and file.read_bytes() == other.read_bytes()


main()
