"""Every public name of MIMo's modules exists here, with its parameters and attributes, or its class is refused by name.

The names stand in ``kit/mimo_names.json``, which ``kit/mimo_names.py`` writes from a checkout of the starter kit.
"""

from __future__ import annotations

import importlib
import inspect
import json
from pathlib import Path
from typing import Any

import gymnasium as gym
import pytest
from mimoTouch.touch import DiscreteTouch

import mimoEnv

NAMES: dict[str, Any] = json.loads((Path(__file__).parent / "kit" / "mimo_names.json").read_text(encoding="utf-8"))
MODULES: dict[str, Any] = NAMES["modules"]
CLASSES = [(module, name) for module, names in MODULES.items() for name in names["classes"]]
REFUSED = {"DiscreteTouch"}
"""Classes that cannot be made."""


def cls_of(module: str, name: str) -> Any:
    return getattr(importlib.import_module(module), name)


@pytest.mark.parametrize("module", MODULES)
def test_constants_and_functions_are_there(module: str) -> None:
    found, names = importlib.import_module(module), MODULES[module]
    public = [name for name in [*names["constants"], *names["functions"], *names["classes"]] if name[0] != "_"]
    assert [name for name in public if not hasattr(found, name)] == []
    for name in public:
        path = getattr(found, name)
        if name.endswith(("_XML", "_XML_V2")) and name != "TEST_XML":  # MIMo's own has no such file either
            assert Path(path).is_file(), path


@pytest.mark.parametrize("module", [module for module in MODULES if MODULES[module]["functions"]])
def test_functions_take_the_same_arguments(module: str) -> None:
    found = importlib.import_module(module)
    for name, wanted in MODULES[module]["functions"].items():
        if name[0] != "_":
            assert same(wanted, getattr(found, name)), (
                f"{name}{inspect.signature(getattr(found, name))} is not {wanted}"
            )


def same(wanted: list[str], function: Any) -> bool:
    """Returns whether a function takes the parameters, in their order, and further ones only with a default."""
    own = list(inspect.signature(function).parameters.values())
    names = [
        parameter.name for parameter in own if parameter.kind not in (parameter.VAR_KEYWORD, parameter.VAR_POSITIONAL)
    ]
    star = {parameter.kind for parameter in own}
    expected = [parameter.split("=")[0] for parameter in wanted if not parameter.startswith("*")]
    if any(p.startswith("**") for p in wanted) and inspect.Parameter.VAR_KEYWORD not in star:
        return False
    rest = [parameter for parameter in own if parameter.name in set(names[len(expected) :])]
    takes = names[: len(expected)] == expected or inspect.Parameter.VAR_KEYWORD in star
    return takes and all(parameter.default is not parameter.empty for parameter in rest)


@pytest.mark.parametrize(("module", "name"), CLASSES)
def test_methods_are_there_or_refused(module: str, name: str) -> None:
    cls, names = cls_of(module, name), MODULES[module]["classes"][name]
    if name in REFUSED:
        with pytest.raises(NotImplementedError, match=r"TrimeshTouch"):
            DiscreteTouch(None, {})  # type: ignore[arg-type]
        return
    uncalled = getattr(cls, "_uncalled", frozenset())
    for method, wanted in names["methods"].items():
        if method in uncalled:
            with pytest.raises(TypeError, match=method):
                type("Own", (cls,), {method: lambda self: None})
            continue
        assert hasattr(cls, method), f"{name}.{method} does not exist, and subclasses that replace it are not refused"
        assert same(wanted, getattr(cls, method)), (
            f"{name}.{method}{inspect.signature(getattr(cls, method))} is not {wanted}"
        )
    for constant in [*names["constants"], *names["properties"]]:
        assert hasattr(cls, constant), f"{name}.{constant}"


def test_ids_are_registered_with_their_steps() -> None:
    assert mimoEnv
    for name, (entry, steps) in NAMES["ids"].items():
        spec = gym.spec(name)
        assert spec.max_episode_steps == steps
        module, cls = entry.split(":")
        assert getattr(importlib.import_module(module), cls)
