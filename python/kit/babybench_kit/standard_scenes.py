"""MIMo's own scenes under the names of their files: tasks, benchmarks, showroom, tests of muscles.

They are written from the library's documents into the folder that ``SCENE_DIRECTORY`` names.
"""

from __future__ import annotations

import os
from pathlib import Path
from xml.etree import ElementTree

from .flat import flat

TASKS = ("reach", "standup", "selfbody", "catch", "roll_over")
"""The tasks whose scenes the library has."""

_SIDES = ("right", "left")
_LAMP = '<light mode="targetbodycom" target="upper_body" pos="0 0 5" diffuse=".8 .8 .8"/>'
_OBJECTS = """
    <body name="test_object1" pos="1 0.3 0.7">
      <freejoint/>
      <geom type="box" size="0.1 0.1 0.1" condim="6"/>
    </body>
    <body name="test_object2" pos="1 -0.3 0.7">
      <freejoint/>
      <geom type="sphere" size="0.1" condim="6" solimp="0.99 0.995 0.001 0.5 2" solref="-20000 -20"/>
    </body>"""
_BALL = """
    <body name="test_object2" pos="0 -0.335 1.8">
      <freejoint/>
      <geom type="sphere" size="0.015" mass="0.1" condim="6" solimp="0.99 0.995 0.001 0.5 2" solref="-7500 -300"/>
    </body>"""
_HELD = '<equality><weld body1="hip"/></equality>'
_WEIGHTLESS = '<option gravity="0 0 0"/>'

_CUBES = (
    ("red_cube", ".3 .3 .5", 0, "red", 0.03),
    ("yellow_cube", ".31 .3 .7", 10, "yellow", 0.03),
    ("blue_cube", ".31 .3 .8", 15, "blue", 0.02),
)
_BALLS = (
    ("green_sphere", ".3 -.2 .7", "green", 0.025),
    ("blue_sphere", ".2 -.1 .5", "blue", 0.02),
    ("orange_sphere", ".2 .1 .5", "orange", 0.015),
)
_CASTLE = (
    ("base1", "-.2 -.4 .05", 40, "red", ".03 .03 .05"),
    ("base2", "-.1 -.5 .05", 70, "red", ".03 .03 .05"),
    ("bridge", "-.15 -.45 .135", 45, "blue", ".045 .125 .025"),
    ("top1", "-.10 -.5 .2", 50, "green", ".03 .03 .03"),
    ("tower1", "-.175 -.425 .22", 50, "red", ".03 .03 .05"),
    ("top2", "-.197 -.403 .31", 55, "yellow", ".03 .03 .03"),
    ("top3", "-.15 -.45 .31", 45, "green", ".03 .03 .03"),
    ("top4", "-.175 -.425 .38", 30, "orange", ".03 .03 .03"),
)
_COLOURS = {"red": ".8 0 0", "green": "0 .8 0", "blue": ".15 .15 1", "yellow": ".7 .7 0", "orange": ".9 .4 0"}
_ROOM_LIGHTS = ("-1 -1 -1", "-1 0 -1", "-1 -1 .25", "-1 0 .25")
_WALLS = (("2 .1 1", "0 2 0"), ("2 .1 1", "0 -2 0"), (".1 2 1", "2 0 0"), (".1 2 1", "-2 0 0"))


def _toy(name: str, pos: str, turn: float, geom: str) -> str:
    return f'<body name="{name}" pos="{pos}" euler="0 0 {turn}"><freejoint/><geom density="200" {geom}/></body>'


def _showroom() -> tuple[str, str]:
    """Returns the toys and the room of the showroom, and their assets."""
    bodies = [_toy(n, p, a, f'class="scene" type="box" material="{c}" size="{s} {s} {s}"') for n, p, a, c, s in _CUBES]
    bodies += [_toy(n, p, 0, f'class="scene:bouncy" type="sphere" material="{c}" size="{s}"') for n, p, c, s in _BALLS]
    bodies += [
        _toy(f"castle_{n}", p, a, f'class="scene" type="box" material="{c}" size="{s}"') for n, p, a, c, s in _CASTLE
    ]
    walls = "".join(f'<geom type="box" material="wall" size="{size}" pos="{pos}"/>' for size, pos in _WALLS)
    bodies.append(f'<body name="room" pos="0 0 1">{walls}</body>')
    lights = "".join(
        f'<light diffuse="1 1 1" specular="0 0 0" pos="1.5 1.5 1.2" dir="{direction}"/>' for direction in _ROOM_LIGHTS
    )
    lights += (
        '<light directional="true" ambient=".2 .2 .2" diffuse="0 0 0" specular="0 0 0" pos="0 0 5" castshadow="false"/>'
    )
    materials = "".join(
        f'<material name="{name}" rgba="{rgb} 1" specular=".2" shininess=".8"/>' for name, rgb in _COLOURS.items()
    )
    materials += '<material name="wall" rgba=".9 .9 .7 1" specular="0" shininess="0"/>'
    settings = f"""
  <option density="1.2"/>
  <visual><headlight active="0"/></visual>
  <default>
    <default class="scene">
      <geom condim="6" friction="1 0.005 0.0002" solimp="0.9995 0.9999 0.001 0.5 1" solref="0.005 1"/>
      <default class="scene:bouncy"><geom solimp="0.99 0.995 0.001 0.5 2" solref="-20000 -20"/></default>
    </default>
  </default>
  <asset>{materials}</asset>"""
    return "\n    ".join([lights, *bodies]), settings


def _scene(
    version: str,
    height: float,
    *,
    joint: str = "mimo_orientation",
    first: str = _LAMP,
    last: str = "",
    settings: str = "",
) -> str:
    """Returns a document with MIMo upright, all his motors, and bodies before and after his in the world."""
    named = f' name="{joint}"' if joint else ""
    return f"""<mujoco model="MIMo">
  <include file="babybench/task_world.xml"/>
  <include file="babybench/task_objects.xml"/>
{settings}
  <asset><material name="matmocap" texture="texgeom" texuniform="true" rgba="0.5 0 0.5 0.5"/></asset>
  <include file="mimo/{_META[version]}"/>
  <worldbody>
    {first}
    <body name="mimo_location" pos="0 0 {height}">
      <freejoint{named}/>
      <include file="mimo/{_MODEL[version]}"/>
    </body>
  </worldbody>
  {last}
</mujoco>
"""


_META = {"v1": "MIMo_meta.xml", "v2": "MIMo_metav2.xml"}
_MODEL = {"v1": "MIMo_model.xml", "v2": "MIMo_modelv2.xml"}


def _documents() -> dict[str, str]:
    toys, settings = _showroom()
    documents = {
        "benchmark_scene.xml": _scene("v1", 0.4, first=_LAMP + _OBJECTS),
        "benchmarkv2_scene.xml": _scene("v2", 0.4, first=_LAMP + _OBJECTS),
        "showroom.xml": _scene("v2", 0.5, joint="", first=toys, settings=settings),
        "compliance_test_scene.xml": _scene("v2", 0.33, first=_LAMP + _BALL, last=_HELD),
    }
    for version, suffix in (("v1", ""), ("v2", "_v2")):
        for test, height, joint in (("static", 0.5, ""), ("velocity", 0.4, "mimo_orientation")):
            documents[f"muscle_{test}_test{suffix}.xml"] = _scene(
                version, height, joint=joint, last=_HELD, settings=_WEIGHTLESS
            )
    return documents


NAMES = (*(f"{task}_scene.xml" for task in TASKS), *_documents())
"""The names of the scenes."""

_HELD_ANGLES = {"shoulder_ad_ab": 1.4, "elbow": -1.57, "fingers": -0.785, "knee": -1.57}
"""Angles at which the static test of muscles holds the joints of both sides, rad; all others at 0."""


def _hold_joints(root: ElementTree.Element) -> None:
    """Holds every joint stiffly, as the static test of muscles does."""
    for lock in root.iter("joint"):
        name = lock.get("joint1")
        if name is None:
            continue
        stem = name.removeprefix("robot:").removeprefix("right_").removeprefix("left_")
        lock.set("active", "true")
        lock.set("polycoef", f"{_HELD_ANGLES.get(stem, 0)} 1 0 0 0")
        lock.set("solimp", f"{0.9 if '_eye_' in name else 0.95} 0.99999 0.001 0.5 2")


def _dull_floor(root: ElementTree.Element) -> None:
    """Removes the lamp overhead and the reflections of the floor: the showroom has lamps of its own."""
    world = next(world for world in root.iter("worldbody") if world.find("light") is not None)
    for lamp in world.findall("light")[:1]:
        world.remove(lamp)
    for material in root.iter("material"):
        if material.get("name") == "matplane":
            material.set("reflectance", "0")


_TOES = {"act:right_toes": 1.805, "act:left_toes": 1.774}
"""The largest velocities of the toes of MIMo v2 in his own scenes, where they are as strong as a big toe, rad/s."""


def _motors(folder: Path, version: str) -> list[ElementTree.Element]:
    """Returns MIMo's motors in the order of his own documents: trunk, head, eyes, then each arm and each leg."""

    def of(part: str) -> list[ElementTree.Element]:
        path = folder / f"motor_{part}.xml"
        return list(flat(path if path.is_file() else folder / f"motor_{part}_{version}.xml").iter("motor"))

    motors = [motor for part in ("body", "head", "eyes") for motor in of(part)]
    for limb in (("arms", "hands", "fingers"), ("legs", "feet")):
        found = [motor for part in limb for motor in of(part)]
        motors += [motor for side in _SIDES for motor in found if motor.get("name", "").startswith(f"act:{side}_")]
    names = [motor.get("name") for motor in motors]
    if "act:right_big_toe" in names:
        # the right foot has its big toe first, the left one last
        toes, big = names.index("act:right_toes"), names.index("act:right_big_toe")
        motors[toes], motors[big] = motors[big], motors[toes]
        for motor in motors:
            vmax = _TOES.get(motor.get("name", ""))
            if vmax is not None:
                motor.attrib.update({"class": "big_toe", "user": f"{vmax} 1.473 0.422"})
    return motors


def _parts(folder: Path, version: str) -> dict[str, ElementTree.Element]:
    """Returns MIMo as the two files that scenes of MIMo include: everything but his body, and his body."""
    own = folder / "babybench"

    def flattened(name: str) -> ElementTree.Element:
        # absolute, because MuJoCo searches beside the document that includes the file
        return flat(own / name, lambda path: str(path.resolve()))

    meta = ElementTree.Element("mujoco", model="MIMo")
    meta.extend(flattened(f"meta_{version}.xml"))
    ElementTree.SubElement(meta, "actuator").extend(_motors(own, version))
    model = flattened(f"mimo_{version}.xml")
    model.tag = "mujoco"
    return {_META[version]: meta, _MODEL[version]: model}


def _drop_chest(root: ElementTree.Element) -> None:
    """Removes motors, sense and contact rule of the chest, which the static test of muscles does not have."""
    for parent in list(root.iter()):
        for child in list(parent):
            named = child.get("name", "").startswith(("act:chest_", "proprio:chest"))
            if named or (child.tag == "exclude" and "chest" in child.attrib.values()):
                parent.remove(child)


def write_scenes(folder: Path, version: int = 2) -> None:
    """Writes all scenes with a version of MIMo into a folder that has the library's documents, unless they exist."""
    mark = folder / "scenes.complete"
    if mark.is_file():
        return
    (folder / "mimo").mkdir(exist_ok=True)
    for body in _META:
        for name, root in _parts(folder, body).items():
            _put(folder / "mimo" / name, root)
    for task in TASKS:
        part = folder / f"{task}.{os.getpid()}.part"
        part.write_text(f'<mujoco model="MIMo"><include file="babybench/{task}.xml"/></mujoco>', encoding="utf-8")
        _put(folder / f"{task}_scene.xml", flat(part, lambda path: f"tex/{path.name}"))
        part.unlink()
    for name, text in _documents().items():
        part = folder / f"{name}.{os.getpid()}.part"
        part.write_text(text, encoding="utf-8")
        root = flat(part, lambda path: f"tex/{path.name}")
        if "static" in name:
            _hold_joints(root)
            if version == 3:
                _drop_chest(root)
        elif name == "showroom.xml":
            _dull_floor(root)
        _put(folder / name, root)
        part.unlink()
    mark.write_text("written by babybench\n", encoding="utf-8")


def _put(path: Path, root: ElementTree.Element) -> None:
    """Replaces a file as a whole, because another process may be reading it."""
    part = path.with_name(f"{path.name}.{os.getpid()}")
    ElementTree.ElementTree(root).write(part, encoding="utf-8")
    part.replace(path)
