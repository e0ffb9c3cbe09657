"""Writes the meshes of the play room's toys, assets/toys/*.obj, from formulas.

    python scripts/toys.py [--out DIR] [--check]

With --check nothing is written: it fails if a file is another one. Lengths are in millimetres and rounded, so that files are small and
the same everywhere. A mesh collides as its convex hull, so what is hollow is made of convex parts: a ring of eight bows, a cup of eight
staves and a bottom, a lid of the pieces around its holes. Parts of one round thing have the normals of the whole, so that seams do
not show.
"""

import argparse
import sys
from math import cos, hypot, pi, sin, sqrt
from pathlib import Path


class Mesh:
    """Vertices, faces that run counterclockwise from outside, and, if `smooth`, normals of each face's corners."""

    def __init__(self):
        self.places, self.normals, self.faces = [], [], []

    def place(self, *at):
        self.places.append(at)
        return len(self.places) - 1

    def face(self, corners, normals=None):
        """Adds a polygon as a fan of triangles."""
        for k in range(1, len(corners) - 1):
            order = (0, k, k + 1)
            self.faces.append(([corners[i] for i in order], normals and [normals[i] for i in order]))

    def text(self, title):
        index, lines = {}, [f"# {title}, mm; written by scripts/toys.py"]
        lines += ["v " + " ".join(number(x, 2) for x in at) for at in self.places]
        faces = []
        for corners, normals in self.faces:
            words = [str(corner + 1) for corner in corners]
            if normals:
                keys = [" ".join(number(x, 2) for x in normal) for normal in normals]
                words = [f"{word}//{index.setdefault(key, len(index) + 1)}" for word, key in zip(words, keys)]
            faces.append("f " + " ".join(words))
        return "\n".join(lines + ["vn " + key for key in index] + faces) + "\n"


def number(x, digits):
    return f"{0.0 + round(x, digits):g}"


def icosphere(times):
    """Points and faces of a unit sphere: an icosahedron whose faces are repeatedly divided into four, this many times."""
    golden = (1 + sqrt(5)) / 2
    corners = [(s, t * golden, 0.0) for s in (-1, 1) for t in (-1, 1)]
    corners = [at[k:] + at[:k] for k in range(3) for at in corners]
    faces, count = [], range(len(corners))

    def near(p, q):
        return abs(sum((x - y) ** 2 for x, y in zip(p, q)) - 4) < 1e-9

    def volume(p, q, r):
        turns = ((0, 1, 2), (1, 2, 0), (2, 0, 1))
        return sum(p[a] * (q[b] * r[c] - q[c] * r[b]) for a, b, c in turns)

    for i in count:
        for j in count[i + 1 :]:
            for k in count[i + 1 :]:
                p, q, r = corners[i], corners[j], corners[k]
                if near(p, q) and near(q, r) and near(r, p) and volume(p, q, r) > 0:
                    faces.append((i, j, k))
    for _ in range(times):
        middles, divided = {}, []
        for face in faces:
            between = []
            for i, j in zip(face, face[1:] + face[:1]):
                key = (min(i, j), max(i, j))
                if key not in middles:
                    middles[key] = len(corners)
                    corners.append(tuple(x + y for x, y in zip(corners[i], corners[j])))
                between.append(middles[key])
            a, b, c = between
            divided += [(face[0], a, c), (face[1], b, a), (face[2], c, b), (a, b, c)]
        faces = divided
    return [tuple(x / sqrt(sum(y * y for y in at)) for x in at) for at in corners], faces


def bent(times, shape):
    """A sphere whose points are moved by `shape`."""
    mesh = Mesh()
    places, faces = icosphere(times)
    for at in places:
        mesh.place(*shape(*at))
    for face in faces:
        mesh.face(list(face))
    return mesh


def duck_body(x, y, z):
    """An egg that stands on a flat bottom, with a tail that points up."""
    x, y, z = 32 * x, 21 * y * (1 - 0.15 * x), max(17 * z, -14)
    tail = max(0.0, -x - 12) / 20
    return x - 4 * tail, y * (1 - 0.35 * tail), z + 13 * tail * tail


def duck_beak(x, y, z):
    """Flattens the beak and widens its tip."""
    return 8 * x, (6 + 1.5 * x) * y, (3 - 0.8 * x) * z


def lathe(profile, around, lobes=0, depth=0.0):
    """Turns a line of (radius, height) from the bottom up about z; its radius may have lobes."""
    mesh, rings = Mesh(), []
    for radius, height in profile:
        if radius == 0:
            rings.append([mesh.place(0, 0, height)] * around)
            continue
        ring = []
        for k in range(around):
            a = 2 * pi * k / around
            r = radius * (1 - depth * (0.5 - 0.5 * cos(lobes * a)))
            ring.append(mesh.place(r * cos(a), r * sin(a), height))
        rings.append(ring)
    for low, high in zip(rings, rings[1:]):
        for k in range(around):
            ahead = (k + 1) % around
            corners = [low[k], low[ahead], high[ahead], high[k]]
            mesh.face([c for i, c in enumerate(corners) if c not in corners[:i]])
    return mesh


def rattle_handle():
    rings = 8
    line = [(6.5 + 2.5 * (2 * k / rings - 1) ** 2, -40 + 80 * k / rings) for k in range(rings + 1)]
    return lathe([(0, -40), *line, (0, 40)], 12)


def rattle_head():
    rings = 8
    line = [(22 * sin(pi * k / rings), -22 * cos(pi * k / rings)) for k in range(1, rings)]
    return lathe([(0, -22), *line, (0, 22)], 18, lobes=6, depth=0.12)


def ring_bow(pieces=8, steps=3, about=10, radius=35, thick=7):
    """An eighth of a teething ring, which begins at x."""
    mesh, rings = Mesh(), []
    for k in range(steps + 1):
        a = 2 * pi / pieces * k / steps
        ring = []
        for l in range(about):
            b = 2 * pi * l / about
            normal = (cos(a) * cos(b), sin(a) * cos(b), sin(b))
            out = radius + thick * cos(b)
            ring.append((mesh.place(out * cos(a), out * sin(a), thick * sin(b)), normal))
        rings.append(ring)
    for here, ahead in zip(rings, rings[1:]):
        for l in range(about):
            corners = [here[l], ahead[l], ahead[(l + 1) % about], here[(l + 1) % about]]
            mesh.face([c[0] for c in corners], [c[1] for c in corners])
    a = 2 * pi / pieces
    for ring, normal in ((rings[0], (0, -1, 0)), (rings[-1][::-1], (-sin(a), cos(a), 0))):
        mesh.face([c[0] for c in ring], [normal] * about)
    return mesh


def cup_stave(pieces=8, steps=2):
    """An eighth of the wall of a cup, which begins at x."""
    profile = [(27, -30), (33, 30), (30, 30), (24, -30)]
    mesh, lines = Mesh(), []
    for k in range(steps + 1):
        a = 2 * pi / pieces * k / steps
        lines.append((a, [mesh.place(r * cos(a), r * sin(a), z) for r, z in profile]))
    for (a, here), (b, ahead) in zip(lines, lines[1:]):
        for i in range(4):
            j = (i + 1) % 4
            (r, z), (s, t) = profile[i], profile[j]
            # from the slope of the side
            length = hypot(s - r, t - z)
            out, up = (t - z) / length, (r - s) / length
            at_a, at_b = ((out * cos(c), out * sin(c), up) for c in (a, b))
            mesh.face([here[i], ahead[i], ahead[j], here[j]], [at_a, at_b, at_b, at_a])
    end = lines[-1][0]
    mesh.face(lines[0][1][::1], [(0, -1, 0)] * 4)
    mesh.face(lines[-1][1][::-1], [(-sin(end), cos(end), 0)] * 4)
    return mesh


def prism(outline, low, high):
    """Extrudes a convex outline that runs counterclockwise."""
    mesh, count = Mesh(), len(outline)
    bottom = [mesh.place(x, y, low) for x, y in outline]
    top = [mesh.place(x, y, high) for x, y in outline]
    for k in range(count):
        ahead = (k + 1) % count
        mesh.face([bottom[k], bottom[ahead], top[ahead], top[k]])
    mesh.face(top)
    mesh.face(bottom[::-1])
    return mesh


def polygon(corners, radius, turn=0.0, centre=(0.0, 0.0)):
    angles = [turn + 2 * pi * k / corners for k in range(corners)]
    return [(centre[0] + radius * cos(a), centre[1] + radius * sin(a)) for a in angles]


def cut(outline, a, b):
    """Keeps the part to the left of the line from a to b."""
    kept = []

    def side(p):
        return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])

    for p, q in zip(outline, outline[1:] + outline[:1]):
        if side(p) >= 0:
            kept.append(p)
        if side(p) * side(q) < 0:
            share = side(p) / (side(p) - side(q))
            kept.append(tuple(x + share * (y - x) for x, y in zip(p, q)))
    return kept


def around(hole, centre, half=20):
    """Cuts a square with a hole into convex pieces, one for each side of the hole."""
    square = [(-half, -half), (half, -half), (half, half), (-half, half)]
    for p, q in zip(hole, hole[1:] + hole[:1]):
        yield prism(cut(cut(cut(square, centre, p), q, centre), q, p), -2.5, 2.5)


def toys():
    """Names, what they are, and meshes."""
    yield "duck_body", "Body of a duck", bent(2, duck_body)
    yield "duck_beak", "Beak of a duck", bent(1, duck_beak)
    yield "rattle_handle", "Handle of a rattle", rattle_handle()
    yield "rattle_head", "Head of a rattle", rattle_head()
    yield "ring_bow", "An eighth of a ring", ring_bow()
    yield "cup_stave", "An eighth of the wall of a cup", cup_stave()
    yield "cup_bottom", "Bottom of a cup", prism(polygon(16, 24.3), -30, -25)
    triangle = polygon(3, 19.5, pi / 2, (0.0, -4.5))
    yield "wedge", "A block with three sides", prism(polygon(3, 17, pi / 2), -14, 14)
    names = ["side", "corner"]
    for name, piece in zip(names, around(polygon(8, 17.5, -pi / 8), (0.0, 0.0))):
        yield f"lid_round_{name}", "Piece of a lid around a round hole", piece
    for k, piece in enumerate(around(triangle, (0.0, -4.5))):
        yield f"lid_wedge_{k}", "Piece of a lid around a hole with three sides", piece


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path(__file__).resolve().parents[1] / "assets" / "toys")
    parser.add_argument("--check", action="store_true")
    args = parser.parse_args()
    for name, title, mesh in toys():
        path, text = args.out / f"{name}.obj", mesh.text(title)
        if not args.check:
            path.write_text(text)
        elif not path.is_file() or path.read_text() != text:
            sys.exit(f"{path} is not what scripts/toys.py writes")


if __name__ == "__main__":
    main()
