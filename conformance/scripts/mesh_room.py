"""Writes conformance/data/meshes.xml: a room of meshes, from formulas, whose pictures render_goldens.py takes.

    python mesh_room.py [--out DIR]

Among them are smooth and faceted ones, with texture coordinates and without, with normals of their own, and one that is not convex;
textures are flat images and cubes. Numbers are rounded to four places, so that the file is small and the same everywhere.
"""

import argparse
from math import cos, pi, sin, sqrt
from pathlib import Path

# What rooms of pictures have in common, and its textures.
OPENING = """<mujoco model="{name}">
  <statistic extent="2" center="0 0 0"/>
  <visual>
    <headlight active="1"/>
    <quality shadowsize="0"/>
    <global offwidth="160" offheight="160"/>
  </visual>
  <asset>
    <texture name="sky" type="skybox" builtin="gradient" rgb1="0.4 0.6 0.8" rgb2="0.9 0.9 0.7" width="64" height="384"/>
    <texture name="tiles" type="2d" builtin="checker" rgb1="0.8 0.7 0.3" rgb2="0.2 0.3 0.5" width="64" height="64" mark="edge" markrgb="0.9 0.1 0.1"/>
    <texture name="dice" type="cube" builtin="gradient" rgb1="0.9 0.2 0.2" rgb2="0.1 0.1 0.9" width="32" height="192" mark="cross" markrgb="1 1 1"/>
"""
HEAD = OPENING.format(name="meshes") + """    <material name="floor" texture="tiles" texrepeat="4 4" specular="0"/>
    <material name="image" texture="tiles"/>
    <material name="repeated" texture="tiles" texrepeat="3 2" texuniform="true"/>
    <material name="cube" texture="dice" shininess="0.3"/>
    <material name="even" texture="dice" texuniform="true" rgba="0.9 1 0.8 1"/>
    <material name="glass" rgba="0.3 0.6 0.9 0.4"/>
"""
BODY = """  </asset>
  <worldbody>
    <light directional="true" dir="0.3 0.2 -1" diffuse="0.6 0.6 0.6" specular="0.2 0.2 0.2"/>
    <light directional="true" dir="-0.4 0.5 -0.2" diffuse="0.3 0.3 0.3" specular="0.3 0.3 0.3"/>
    <geom name="floor" type="plane" size="1 1 0.1" material="floor"/>
    <geom type="mesh" mesh="ring" pos="-0.4 -0.3 0.2" euler="60 0 20" rgba="0.9 0.6 0.2 1"/>
    <geom type="mesh" mesh="ring_smooth" pos="0 -0.4 0.25" euler="70 0 -30" rgba="0.3 0.8 0.4 1"/>
    <geom type="mesh" mesh="ring" pos="0.4 0.45 0.5" euler="10 40 0" material="cube"/>
    <geom type="mesh" mesh="globe" pos="0.4 -0.3 0.2" material="image"/>
    <geom type="mesh" mesh="globe" pos="0.65 0.1 0.2" euler="0 70 30" material="repeated"/>
    <geom type="mesh" mesh="ball" pos="-0.6 0.2 0.2" material="cube"/>
    <geom type="mesh" mesh="ball" pos="-0.2 0.1 0.5" material="even"/>
    <geom type="mesh" mesh="ball" pos="0.1 0 0.2" material="image"/>
    <geom type="mesh" mesh="ball_smooth" pos="-0.1 0.5 0.2" rgba="0.8 0.3 0.3 1"/>
    <geom type="mesh" mesh="gem" pos="0.35 0.15 0.2" euler="20 10 0" rgba="0.5 0.4 0.9 1"/>
    <geom type="mesh" mesh="gem" pos="-0.5 0.5 0.6" euler="0 50 0" material="glass"/>
    <geom type="mesh" mesh="star" pos="0 0.2 0.8" euler="80 0 10" rgba="0.9 0.9 0.3 1"/>
    <camera name="front" pos="0 -1.6 0.7" euler="75 0 0" fovy="45"/>
    <camera name="above" pos="0.3 0.9 1.6" euler="-30 0 180" fovy="50"/>
    <camera name="near" pos="0.1 -0.7 0.4" euler="80 0 10" fovy="60"/>
    <camera name="side" pos="1.5 0.1 0.7" xyaxes="0 1 0 -0.3 0 1" fovy="50"/>
  </worldbody>
</mujoco>
"""


def numbers(rows, digits=4):
    return " ".join(f"{0.0 + round(x, digits):g}" for row in rows for x in row)


def ring(around=20, about=10, radius=0.14, thick=0.05):
    """A torus: vertices, faces, and the normals of the surface."""
    places, normals, faces = [], [], []
    for k in range(around):
        a = 2 * pi * k / around
        for l in range(about):
            b = 2 * pi * l / about
            out = (cos(a) * cos(b), sin(a) * cos(b), sin(b))
            normals.append(out)
            places.append((radius * cos(a) + thick * out[0], radius * sin(a) + thick * out[1], thick * out[2]))
            here, ahead = k * about, (k + 1) % around * about
            beside = (l + 1) % about
            faces += [(here + l, ahead + l, ahead + beside), (here + l, ahead + beside, here + beside)]
    return places, faces, normals


def globe(rings=8, around=14, radius=0.17):
    """A sphere with a seam, so that it has texture coordinates."""
    places, coordinates, faces = [], [], []
    for r in range(rings + 1):
        for k in range(around + 1):
            a, b = 2 * pi * k / around, pi * r / rings
            places.append((radius * cos(a) * sin(b), radius * sin(a) * sin(b), radius * cos(b)))
            coordinates.append((k / around, r / rings))
            if r < rings and k < around:
                here, below = r * (around + 1) + k, (r + 1) * (around + 1) + k
                if r + 1 < rings:
                    faces.append((here, below, below + 1))
                if r > 0:
                    faces.append((here, below + 1, here + 1))
    return places, faces, coordinates


def ball(radius=0.17):
    """An icosahedron with each face divided into four."""
    g = (1 + sqrt(5)) / 2
    corners = [(s * a, t * b, 0) for a, b in ((1, g),) for s in (-1, 1) for t in (-1, 1)]
    corners = [p[k:] + p[:k] for k in range(3) for p in corners]
    near = lambda p, q: abs(sum((x - y) ** 2 for x, y in zip(p, q)) - 4) < 1e-9
    faces = []
    for i, p in enumerate(corners):
        for j, q in enumerate(corners):
            for k, r in enumerate(corners):
                turn = sum(p[a] * (q[b] * r[c] - q[c] * r[b]) for a, b, c in ((0, 1, 2), (1, 2, 0), (2, 0, 1)))
                if i < j and i < k and turn > 0 and near(p, q) and near(q, r) and near(r, p):
                    faces.append((i, j, k))
    middles, divided = {}, []
    for face in faces:
        between = []
        for i, j in zip(face, face[1:] + face[:1]):
            if (key := (min(i, j), max(i, j))) not in middles:
                middles[key] = len(corners)
                corners.append(tuple(x + y for x, y in zip(corners[i], corners[j])))
            between.append(middles[key])
        a, b, c = between
        divided += [(face[0], a, c), (face[1], b, a), (face[2], c, b), (a, b, c)]
    unit = [tuple(radius * x / sqrt(sum(y * y for y in p)) for x in p) for p in corners]
    return unit, divided


def gem():
    """Points without faces of their own, whose hull has large flat faces."""
    crown = [(0.1 * cos(pi * k / 3), 0.1 * sin(pi * k / 3), 0.1) for k in range(6)]
    girdle = [(0.17 * cos(pi * (k + 0.5) / 3), 0.17 * sin(pi * (k + 0.5) / 3), 0.03) for k in range(6)]
    return crown + girdle + [(0, 0, -0.15)]


def star(points=5):
    """A star of some thickness, which is not convex."""
    outline = [((0.2, 0.09)[k % 2], pi * k / points) for k in range(2 * points)]
    rim = [(r * cos(a), r * sin(a), 0) for r, a in outline]
    places, n = rim + [(0, 0, 0.06), (0, 0, -0.06)], len(rim)
    faces = [(k, (k + 1) % n, n) for k in range(n)] + [((k + 1) % n, k, n + 1) for k in range(n)]
    return places, faces


def mesh(name, vertex, face=(), normal=(), texcoord=(), smooth=False):
    text = f'    <mesh name="{name}" vertex="{numbers(vertex)}"'
    text += f' face="{numbers(face)}"' if face else ""
    text += f' normal="{numbers(normal)}"' if normal else ""
    text += f' texcoord="{numbers(texcoord)}"' if texcoord else ""
    return text + (' smoothnormal="true"/>\n' if smooth else "/>\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path(__file__).resolve().parents[1] / "data")
    places, faces, normals = ring()
    text = HEAD + mesh("ring", places, faces) + mesh("ring_smooth", places, faces, normals)
    places, faces, coordinates = globe()
    text += mesh("globe", places, faces, texcoord=coordinates)
    places, faces = ball()
    text += mesh("ball", places, faces) + mesh("ball_smooth", places, faces, smooth=True)
    places, faces = star()
    text += mesh("gem", gem()) + mesh("star", places, faces)
    (parser.parse_args().out / "meshes.xml").write_text(text + BODY)


if __name__ == "__main__":
    main()
