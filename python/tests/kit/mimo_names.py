"""Writes the names of MIMo's modules, as a checkout of the starter kit has them, into ``mimo_names.json`` beside this file.

    python tests/kit/mimo_names.py KIT

Names, parameters and defaults alone: nothing of what they do.
"""

from __future__ import annotations

import ast
import json
import sys
from pathlib import Path
from typing import Any

MODULES = (
    *(f"mimoEnv.envs.{name}" for name in ("catch", "dummy", "mimo_env", "muscle_test", "reach", "selfbody", "standup")),
    *(
        "mimoEnv.utils",
        "mimoTouch.touch",
        "mimoVision.vision",
        "mimoVestibular.vestibular",
        "mimoProprioception.proprio",
    ),
    *("mimoActuation.actuation", "mimoActuation.muscle"),
)


def parameters(function: ast.FunctionDef) -> list[str]:
    """Returns the parameters of a function, with defaults that are literals."""
    args = function.args
    positional = [*args.posonlyargs, *args.args]
    first = len(positional) - len(args.defaults)
    found = []
    for number, arg in enumerate(positional):
        default = args.defaults[number - first] if number >= first else None
        literal = isinstance(default, (ast.Constant, ast.UnaryOp))
        found.append(arg.arg if default is None else f"{arg.arg}={ast.unparse(default) if literal else '...'}")
    return found + ([f"*{args.vararg.arg}"] if args.vararg else []) + ([f"**{args.kwarg.arg}"] if args.kwarg else [])


def class_names(cls: ast.ClassDef) -> dict[str, Any]:
    """Returns bases, methods, properties and attributes of a class."""
    functions = [node for node in cls.body if isinstance(node, ast.FunctionDef)]
    shown = [f for f in functions if any(isinstance(d, ast.Name) and d.id == "property" for d in f.decorator_list)]
    assigned = {
        target.attr
        for function in functions
        for node in ast.walk(function)
        if isinstance(node, ast.Assign)
        for target in node.targets
        if isinstance(target, ast.Attribute) and isinstance(target.value, ast.Name) and target.value.id == "self"
    }
    constants = {
        t.id for node in cls.body if isinstance(node, ast.Assign) for t in node.targets if isinstance(t, ast.Name)
    }
    return {
        "bases": [ast.unparse(base) for base in cls.bases],
        "methods": {f.name: parameters(f) for f in functions if f not in shown},
        "properties": sorted(f.name for f in shown),
        "attributes": sorted(assigned),
        "constants": sorted(constants),
    }


def module_names(tree: ast.Module) -> dict[str, Any]:
    """Returns classes, functions and constants of a module."""
    return {
        "classes": {node.name: class_names(node) for node in tree.body if isinstance(node, ast.ClassDef)},
        "functions": {node.name: parameters(node) for node in tree.body if isinstance(node, ast.FunctionDef)},
        "constants": sorted(
            target.id
            for node in tree.body
            if isinstance(node, ast.Assign)
            for target in node.targets
            if isinstance(target, ast.Name)
        ),
    }


def main(kit: Path) -> None:
    """Writes the names of a checkout."""
    found = {
        name: module_names(ast.parse((kit / "MIMo" / f"{name.replace('.', '/')}.py").read_text(encoding="utf-8")))
        for name in MODULES
    }
    init = ast.parse((kit / "MIMo/mimoEnv/__init__.py").read_text(encoding="utf-8"))
    ids = {}
    for node in ast.walk(init):
        if isinstance(node, ast.Call) and ast.unparse(node.func) == "register":
            given = {k.arg: k.value for k in node.keywords}
            steps = given.get("max_episode_steps")
            entry = ast.literal_eval(given["entry_point"])
            ids[ast.literal_eval(given["id"])] = [entry, None if steps is None else ast.literal_eval(steps)]
    path = Path(__file__).with_name("mimo_names.json")
    path.write_text(json.dumps({"modules": found, "ids": ids}, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
