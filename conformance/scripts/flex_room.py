"""Writes conformance/data/flexes.xml: a room of flexes, whose pictures render_goldens.py takes.

    python flex_room.py [--out DIR]

Ropes, sheets and solids, some of them bent: smooth and flat, with an image, by a material, transparent, and one of a group that is not drawn.
Vertices of bent sheets follow formulas. Numbers are rounded to four places.
"""

import argparse
from math import cos, pi, sin
from pathlib import Path

from mesh_room import OPENING, numbers

HEAD = OPENING.format(name="flexes") + """    <material name="floor" texture="tiles" texrepeat="4 4" specular="0"/>
    <material name="image" texture="tiles"/>
    <material name="shiny" rgba="0.3 0.5 0.9 1" specular="1" shininess="0.9" emission="0.1"/>
  </asset>
  <deformable>
"""
BODY = """  </deformable>
  <worldbody>
    <light directional="true" dir="0.3 0.2 -1" diffuse="0.6 0.6 0.6" specular="0.2 0.2 0.2"/>
    <geom name="floor" type="plane" size="1 1 0.1" material="floor"/>
    <flexcomp name="rope" dim="1" count="9 1 1" spacing=".07 .07 .07" pos="-.5 -.5 .15" euler="0 20 10" radius=".02" rgba="0.8 0.6 0.3 1"/>
    <flexcomp name="loop" dim="1" type="circle" count="14 1 1" spacing=".08 .08 .08" pos=".6 -.2 .3" euler="60 0 0" radius=".012" material="shiny"/>
    <flexcomp name="ball" dim="3" type="ellipsoid" count="6 6 6" spacing=".05 .06 .04" pos="0 -.3 .2" radius=".01" rgba="0.9 0.4 0.5 1"/>
    <flexcomp name="block" dim="3" count="4 3 3" spacing=".08 .06 .05" pos=".35 .35 .2" euler="20 10 40" radius=".005" flatskin="true" rgba="0.6 0.5 0.9 1"/>
    <flexcomp name="tower" dim="3" type="box" count="4 3 5" spacing=".06 .06 .06" pos="-.6 .5 .25" euler="0 0 30" radius=".01" material="image"/>
    <flexcomp name="hidden" dim="2" count="3 3 1" spacing=".2 .2 .2" pos="0 0 .8" group="3"/>
    <camera name="front" pos="0 -1.6 0.7" euler="75 0 0" fovy="45"/>
    <camera name="above" pos="0.3 0.9 1.6" euler="-30 0 180" fovy="50"/>
    <camera name="near" pos="0.1 -0.7 0.4" euler="80 0 10" fovy="60"/>
    <camera name="below" pos="0.9 -0.6 0.2" xyaxes="0.3 1 0 -0.35 0.1 1" fovy="60"/>
  </worldbody>
</mujoco>
"""
# Name, place, height of the waves, attributes, whether it has texture coordinates.
SHEETS = [
    ("cloth", (-0.3, 0.0, 0.45), 0.04, 'radius="0.01" rgba="0.5 0.8 0.5 1"', False),
    ("rug", (0.3, 0.0, 0.5), 0.05, 'radius="0.02" material="image"', True),
    ("plate", (0.0, 0.55, 0.4), 0.06, 'radius="0.015" flatskin="true" rgba="0.9 0.8 0.3 1"', False),
    ("sail", (-0.1, -0.55, 0.45), 0.03, 'radius="0.005" rgba="0.3 0.6 0.9 0.5"', False),
]
SIDE, COUNT = 0.4, 8


def sheet(name, place, height, attributes, textured):
    places, elements, coordinates = [], [], []
    for k in range(COUNT):
        for l in range(COUNT):
            u, v = k / (COUNT - 1), l / (COUNT - 1)
            wave = height * sin(2 * pi * u) * cos(3 * v)
            places.append((place[0] + SIDE * (u - 0.5), place[1] + SIDE * (v - 0.5), place[2] + wave))
            coordinates.append((2 * u, v))
            if k and l:
                here, left, under, corner = k * COUNT + l, k * COUNT + l - 1, (k - 1) * COUNT + l, (k - 1) * COUNT + l - 1
                elements += [corner, under, here, corner, here, left]
    text = f'    <flex name="{name}" body="world" {attributes} vertex="{numbers(places)}" element="{" ".join(map(str, elements))}"'
    return text + (f' texcoord="{numbers(coordinates)}"/>\n' if textured else "/>\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path(__file__).resolve().parents[1] / "data")
    sheets = "".join(sheet(*row) for row in SHEETS)
    (parser.parse_args().out / "flexes.xml").write_text(HEAD + sheets + BODY)


if __name__ == "__main__":
    main()
