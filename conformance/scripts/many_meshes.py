"""Writes a room in which many meshes fall on a floor and on each other: OUT becomes an MJCF document.

    python many_meshes.py OUT [--meshes 200] [--vertices 2000]

Eight shapes between a ball and a box, with the same number of vertices, all of which are on the hull. `conformance worlds`
puts such a document beside MuJoCo: contacts, accelerations, and the CPU time of a step.
"""

import argparse
import math
import random
from pathlib import Path

SHAPES = 8


def vertices(shape, count):
    """Points of a golden spiral on a ball, pushed towards a box."""
    size = (0.03 + 0.004 * shape, 0.03 + 0.003 * (3 * shape % 5), 0.03)
    for i in range(count):
        z = 1 - (2 * i + 1) / count
        radius, angle = math.sqrt(1 - z * z), math.pi * (3 - math.sqrt(5)) * i
        point = (radius * math.cos(angle), radius * math.sin(angle), z)
        yield tuple(s * math.copysign(math.sqrt(abs(v)), v) for s, v in zip(size, point))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--meshes", type=int, default=200)
    parser.add_argument("--vertices", type=int, default=2000)
    args = parser.parse_args()
    rng = random.Random(1)
    assets, bodies = [], []
    for shape in range(SHAPES):
        numbers = " ".join(f"{v:.6g}" for point in vertices(shape, args.vertices) for v in point)
        assets.append(f'<mesh name="shape_{shape}" vertex="{numbers}"/>')
    for i in range(args.meshes):
        layer, place = divmod(i, 64)
        x, y = (0.13 * k - 0.45 + 0.01 * rng.random() for k in (place % 8, place // 8))
        bodies.append(
            f'<body pos="{x:.4f} {y:.4f} {0.06 + 0.1 * layer:.4f}"><freejoint/>'
            f'<geom type="mesh" mesh="shape_{i % SHAPES}"/></body>'
        )
    args.out.parent.mkdir(parents=True, exist_ok=True)
    args.out.write_text(
        '<mujoco model="many meshes">\n<option timestep="0.005"/>\n<asset>\n'
        + "\n".join(assets)
        + '\n</asset>\n<worldbody>\n<geom type="plane" size="3 3 .1"/>\n'
        + "\n".join(bodies)
        + "\n</worldbody>\n</mujoco>\n"
    )


if __name__ == "__main__":
    main()
