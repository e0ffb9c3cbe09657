"""Writes conformance/data/skins.xml: a room of skins, from formulas, whose pictures render_goldens.py takes.

    python skin_room.py [--out DIR]

Bodies are elsewhere than where the skins were bound to them, so that each skin is bent: a limb that three bodies pull, which is blown up or
textured by a cube, flags with and without texture coordinates, and glass. Numbers are rounded to four places.
"""

import argparse
from math import cos, pi, sin
from pathlib import Path

from mesh_room import OPENING, numbers

HEAD = OPENING.format(name="skins") + """    <material name="floor" texture="tiles" texrepeat="4 4" specular="0"/>
    <material name="image" texture="tiles"/>
    <material name="repeated" texture="tiles" texrepeat="3 2"/>
    <material name="even" texture="tiles" texuniform="true"/>
    <material name="cube" texture="dice" shininess="0.3"/>
    <material name="glass" rgba="0.3 0.6 0.9 0.4"/>
  </asset>
  <deformable>
"""
BODY = """  </deformable>
  <worldbody>
    <light directional="true" dir="0.3 0.2 -1" diffuse="0.6 0.6 0.6" specular="0.2 0.2 0.2"/>
    <geom name="floor" type="plane" size="1 1 0.1" material="floor"/>
    <geom type="box" size="0.05 0.3 0.1" pos="0.55 0.55 0.1" rgba="0.8 0.8 0.7 1"/>
LIMBS    <camera name="front" pos="0 -1.6 0.7" euler="75 0 0" fovy="45"/>
    <camera name="above" pos="0.3 0.9 1.6" euler="-30 0 180" fovy="50"/>
    <camera name="near" pos="0.1 -0.7 0.4" euler="80 0 10" fovy="60"/>
    <camera name="side" pos="1.3 -0.5 0.8" xyaxes="0.3 1 0 -0.35 0.1 1" fovy="50"/>
  </worldbody>
</mujoco>
"""
# Name, place, how far each joint is bent (degrees), attributes of the skin, whether it is a flag and has texture coordinates.
SKINS = [
    ("limb", (-0.5, -0.3, 0.1), (20, 50), 'rgba="0.9 0.6 0.5 1"', False, False),
    ("fat", (-0.1, -0.3, 0.1), (-30, 40), 'inflate="0.03" rgba="0.4 0.8 0.5 1"', False, False),
    ("cube", (0.3, -0.3, 0.1), (40, -70), 'material="cube"', False, False),
    ("wound", (0.7, -0.3, 0.1), (10, 20), 'material="image"', False, True),
    ("flag", (-0.6, 0.3, 0.4), (30, 30), 'material="repeated"', True, True),
    ("bare", (-0.2, 0.3, 0.5), (-30, 60), 'material="image" inflate="-0.02"', True, False),
    ("even", (0.2, 0.3, 0.5), (20, 10), 'material="even"', True, False),
    ("glass", (0, 0, 0.2), (60, 20), 'material="glass"', False, False),
    ("clear", (0.3, 0.1, 0.7), (-20, -20), 'rgba="0.9 0.9 0.3 0.5"', True, False),
]
LENGTH, AROUND, ALONG = 0.2, 10, 9


def surface(flag):
    """Vertices, faces and texture coordinates of a tube, or of a sheet that is visible from one side."""
    places, faces, coordinates = [], [], []
    for k in range(ALONG + 1):
        for l in range(AROUND + 1):
            z, a = 3 * LENGTH * k / ALONG, 2 * pi * l / AROUND
            places.append((0.3 * l / AROUND - 0.15, 0.02 * sin(a), z) if flag else (0.07 * cos(a), 0.07 * sin(a), z))
            coordinates.append((l / AROUND, k / ALONG))
            if k < ALONG and l < AROUND:
                here, above = k * (AROUND + 1) + l, (k + 1) * (AROUND + 1) + l
                faces += [(here, here + 1, above + 1), (here, above + 1, above)]
    return places, faces, coordinates


def skin(name, attributes, flag, textured):
    places, faces, coordinates = surface(flag)
    text = f'    <skin name="{name}" {attributes} vertex="{numbers(places)}" face="{numbers(faces)}"'
    text += f' texcoord="{numbers(coordinates)}">\n' if textured else ">\n"
    for bone in range(3):
        # a body pulls with what is left at a distance from its middle
        weights = [max(0.0, 1.2 - abs(z / LENGTH - bone - 0.5)) for _, _, z in places]
        ids = [i for i, w in enumerate(weights) if w > 0]
        text += f'      <bone body="{name}{bone}" bindpos="0 0 {LENGTH * bone:g}" bindquat="1 0 0 0" vertid="{" ".join(map(str, ids))}"'
        text += f' vertweight="{numbers([[weights[i] for i in ids]])}"/>\n'
    return text + "    </skin>\n"


def limb(name, place, bent):
    text, indent = "", "    "
    poses = [f'pos="{numbers([place])}"'] + [f'pos="0 0 {LENGTH:g}" euler="{b} 0 {b / 2:g}"' for b in bent]
    for k, pose in enumerate(poses):
        text += f'{indent}<body name="{name}{k}" {pose}>\n{indent}  <geom size="0.01" rgba="1 0 0 0"/>\n'
        indent += "  "
    for _ in poses:
        indent = indent[2:]
        text += f"{indent}</body>\n"
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path(__file__).resolve().parents[1] / "data")
    skins = "".join(skin(name, attributes, flag, textured) for name, _, _, attributes, flag, textured in SKINS)
    limbs = "".join(limb(name, place, bent) for name, place, bent, *_ in SKINS)
    (parser.parse_args().out / "skins.xml").write_text(HEAD + skins + BODY.replace("LIMBS", limbs))


if __name__ == "__main__":
    main()
