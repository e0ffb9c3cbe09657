#!/usr/bin/env python3
"""Checks licences, versions and sources of all dependencies against deny.toml, like cargo-deny, which takes minutes to build.

    scripts/licences.py

Reads what `cargo metadata` says of every package in the lock file: the licence is one that is allowed, no version is `*`, and the source is
the registry of crates.io. Prints what is not so; fails then. Needs Python 3.11 and cargo.
"""

import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
REGISTRY = "registry+https://github.com/rust-lang/crates.io-index"


def is_allowed(expression: str, allowed: set[str]) -> bool:
    """Evaluates an SPDX expression: either side of OR, both sides of AND; `/` is an older form of OR."""
    tokens = re.findall(r"\(|\)|[^\s()]+", expression.replace("/", " OR "))

    def either() -> bool:
        result = both()
        while tokens and tokens[0] == "OR":
            tokens.pop(0)
            other = both()
            result = result or other
        return result

    def both() -> bool:
        result = one()
        while tokens and tokens[0] == "AND":
            tokens.pop(0)
            other = one()
            result = result and other
        return result

    def one() -> bool:
        token = tokens.pop(0)
        if token == "(":
            result = either()
            tokens.pop(0)
            return result
        if tokens and tokens[0] == "WITH":
            token = f"{token} WITH {tokens[1]}"
            del tokens[:2]
        return token in allowed

    return either()


def main() -> None:
    rules = tomllib.loads((ROOT / "deny.toml").read_text())
    common = set(rules["licenses"]["allow"])
    own = {e["crate"]: set(e["allow"]) for e in rules["licenses"]["exceptions"]}
    command = ["cargo", "metadata", "--locked", "--format-version", "1", "--all-features"]
    packages = json.loads(subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE).stdout)["packages"]
    faults = []
    for package in packages:
        name, licence, source = package["name"], package["license"], package["source"]
        if not licence or not is_allowed(licence, common | own.get(name, set())):
            faults.append(f"{name}: the licence {licence or '(none)'} is not allowed")
        if source not in (None, REGISTRY):
            faults.append(f"{name}: comes from {source}")
        if source is None:
            wild = [d["name"] for d in package["dependencies"] if d["req"] == "*" and not d.get("path")]
            faults += [f"{name}: any version of {dependency} will do" for dependency in wild]
    for crate in own.keys() - {package["name"] for package in packages}:
        faults.append(f"deny.toml: {crate} has an exception and is not a dependency")
    print(*faults, f"{len(packages)} packages, {len(faults)} faults", sep="\n")
    sys.exit(bool(faults))


if __name__ == "__main__":
    main()
