"""Names of geoms: all geoms of MIMo 3 have one."""

from __future__ import annotations

from xml.etree import ElementTree

BODIES = ("mimo_v1", "mimo_v2", "head_v2", "right_arm_v2", "left_arm_v2", "legs_v2")
"""Documents with MIMo's body."""


def with_geom_names(document: bytes) -> bytes:
    """Names geoms without a name after their body and their number in it, from 1: ``geom:left_hand2``."""
    root = ElementTree.fromstring(document)
    for body in root.iter("body"):
        name = body.get("name")
        for number, geom in enumerate(body.findall("geom"), 1):
            if name and not geom.get("name"):
                geom.set("name", f"geom:{name}{number}")
    written: bytes = ElementTree.tostring(root)
    return written
