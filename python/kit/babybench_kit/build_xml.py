"""Builds the document of a scene: ``babybench.build_xml``."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from .tables import GROUND, PARTS, VERSIONS

_ORDER = ("body", "head", "eyes", "arms", "hands", "fingers", "legs", "feet")
_BY_VERSION = ("fingers", "feet")
_FAMILIES = {"spring_damper": "motor", "muscle": "motor", "positional": "position"}


def _checked(config: Mapping[str, Any] | None) -> Mapping[str, Any]:
    """Returns the configuration, if it has the keys that a scene needs."""
    if not isinstance(config, Mapping):
        raise TypeError(f"build needs a configuration, a dict, not {type(config).__name__}")
    needed = ("behavior", "scene", "actuation_model", *(f"act_{part}" for part in PARTS))
    missing = [key for key in needed if key not in config]
    if missing:
        raise KeyError(f"configuration: missing {', '.join(missing)}, without which no scene can be built")
    for key, choices in (("behavior", VERSIONS), ("scene", GROUND), ("actuation_model", _FAMILIES)):
        if config[key] not in choices:
            raise ValueError(f"configuration: {key} is {config[key]!r}, expected one of {', '.join(choices)}")
    return config


def build(config: Mapping[str, Any] | None = None, path_to_assets: str = "./MIMo/mimoEnv/assets/") -> str:
    """Returns the MJCF document of a configuration, which includes the files of a folder of assets.

    Args:
        config: The configuration; ``behavior``, ``scene``, ``actuation_model`` and every ``act_*`` are read.
        path_to_assets: The folder that holds ``babybench/*.xml`` and ``tex/*.png``.

    Raises:
        KeyError: One of these keys is missing.
        ValueError: One of them has an unknown value.
    """
    config = _checked(config)
    version = VERSIONS[config["behavior"]]

    def include(name: str) -> str:
        return f'<include file="{path_to_assets}/babybench/{name}.xml"></include>'

    family = _FAMILIES[config["actuation_model"]]
    active = [part for part in _ORDER if config[f"act_{part}"] is True]
    # two hyphens would end the comment
    comment = json.dumps(dict(config), indent=4, default=str).replace("--", "-\\u002d")
    lines = [
        f"<!--\n{comment}\n-->",
        '<mujoco model="MIMo">',
        "<worldbody>",
        f'<body name="mimo_location" {GROUND[config["scene"]]}>',
        '<freejoint name="mimo_location"/>',
        include(f"mimo_{version}"),
        "</body>",
        "</worldbody>",
        include("base"),
        include(f"meta_{version}"),
        *(include(f"{family}_{part}" + (f"_{version}" if part in _BY_VERSION else "")) for part in active),
    ]
    if config["scene"] != "base":
        lines.append(include(config["scene"]))
    return "\n".join([*lines, "</mujoco>"])
