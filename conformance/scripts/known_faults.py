"""Measures the faults of MuJoCo 3.3.0 that later releases have fixed, and writes the table of docs/guide/known-faults.md.

usage: python known_faults.py                        measures the mujoco that this Python imports: JSON
       python known_faults.py --babybench            measures babybench.mujoco of this Python
       python known_faults.py --table FILE ...       writes a table of such JSON files, in their order

Each measurement is 0 in a release without the fault. Requires numpy, and mujoco or babybench. For several releases:
pip install --no-deps --target DIR mujoco==3.3.5, and PYTHONPATH=DIR python known_faults.py > 3.3.5.json
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np


def loaded(mujoco, xml: str):
    """Returns a model and its state after mj_forward."""
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def height_field_sides(mujoco) -> float:
    """Share of 400 horizontal rays towards the sides of a height field that miss the side they should hit."""
    rng = np.random.default_rng(0)
    rows, columns = 4, 5
    heights = rng.random((rows, columns))
    heights[0, 0], heights[-1, -1] = 0, 1
    model, data = loaded(
        mujoco,
        f"""<mujoco><asset><hfield name="h" nrow="{rows}" ncol="{columns}" size="1 1 1 0.5"
        elevation="{" ".join(map(repr, heights.ravel().tolist()))}"/></asset>
        <worldbody><geom type="hfield" hfield="h"/></worldbody></mujoco>""",
    )
    heights = np.asarray(model.hfield_data, float).reshape(rows, columns)  # in the order of the file or reversed
    edges = [heights[:, 0], heights[:, -1], heights[0], heights[-1]]
    wrong, geom = 0, np.zeros(1, np.int32)
    for number in range(400):
        side, along, height = number % 4, rng.uniform(-0.9, 0.9), rng.uniform(-0.4, 0.9)
        start = [(-3, along, height), (3, along, height), (along, -3, height), (along, 3, height)][side]
        towards = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)][side]
        edge = edges[side]
        top = np.interp(along, np.linspace(-1, 1, len(edge)), edge)
        found = mujoco.mj_ray(model, data, np.array(start, float), np.array(towards, float), None, 1, -1, geom)
        wrong += bool(height < top - 1e-6 and abs(found - 2) > 1e-9)
    return wrong / 400


def jacobian_derivative(mujoco) -> float:
    """Largest error of mj_jacDot (translation), relative to the largest number of a difference quotient of mj_jac."""
    model, data = loaded(
        mujoco,
        """<mujoco><worldbody><body><freejoint/><geom size=".1"/>
        <body pos=".3 0 0"><joint type="ball"/><geom type="capsule" size=".05" fromto="0 0 0 .3 0 0"/>
        <body name="tip" pos=".3 0 0"><joint axis="0 1 0"/><geom type="capsule" size=".05" fromto="0 0 0 .3 .1 0"/></body>
        </body></body></worldbody></mujoco>""",
    )
    rng, body, worst = np.random.default_rng(0), model.body("tip").id, 0.0

    def jacobian(positions):
        other = mujoco.MjData(model)
        other.qpos[:] = positions
        mujoco.mj_kinematics(model, other)
        mujoco.mj_comPos(model, other)
        out = np.zeros((3, model.nv))
        point = other.xpos[body] + other.xmat[body].reshape(3, 3) @ [0.1, 0.2, 0.3]
        mujoco.mj_jac(model, other, out, np.zeros((3, model.nv)), point, body)
        return out

    for _ in range(20):
        positions = rng.normal(size=model.nq)
        mujoco.mj_normalizeQuat(model, positions)
        data.qpos[:], data.qvel[:] = positions, rng.normal(size=model.nv)
        mujoco.mj_forward(model, data)
        found = np.zeros((3, model.nv))
        point = data.xpos[body] + data.xmat[body].reshape(3, 3) @ [0.1, 0.2, 0.3]
        mujoco.mj_jacDot(model, data, found, np.zeros((3, model.nv)), point, body)
        quotient, step = np.zeros((3, model.nv)), 1e-6
        for sign in (1, -1):
            there = positions.copy()
            mujoco.mj_integratePos(model, there, np.array(data.qvel), sign * step)
            quotient += sign * jacobian(there) / (2 * step)
        worst = max(worst, np.abs(found - quotient).max() / np.abs(quotient).max())
    return worst if worst > 1e-6 else 0.0  # rounding of the quotient


def fitted_box(mujoco) -> float:
    """Distance between the middle of a box that is fitted to a mesh (fitaabb) and the middle of the mesh's bounding box, m."""
    mesh = '<asset><mesh name="m" vertex="0 0 0  2 0 0  0 1 0  0 0 1"/></asset>'
    body = '<worldbody><body><freejoint/><geom name="g" type="{}" mesh="m"/></body></worldbody>'
    _, data = loaded(mujoco, f'<mujoco><compiler fitaabb="true"/>{mesh}{body.format("box")}</mujoco>')
    model, as_mesh = loaded(mujoco, f"<mujoco>{mesh}{body.format('mesh')}</mujoco>")
    turn = as_mesh.geom_xmat[0].reshape(3, 3)
    corners = np.asarray(model.mesh_vert)  # in the frame of the mesh, along whose axes the box is fitted
    middle = as_mesh.geom_xpos[0] + turn @ ((corners.min(axis=0) + corners.max(axis=0)) / 2)
    apart = float(np.linalg.norm(np.asarray(data.geom_xpos[0]) - middle))
    return apart if apart > 1e-6 else 0.0


MIRRORED = """<mujoco><asset><mesh name="m" scale="-1 1 1" {} vertex="0 0 0  2 0 0  0 1 0  0 0 1" face="0 2 1 0 1 3 0 3 2 1 2 3"/></asset>
<worldbody><body><freejoint/><geom type="mesh" mesh="m"/></body></worldbody></mujoco>"""


def mirrored_refused(mujoco) -> int:
    """Whether a mesh with a negative scale and inertia="exact" is refused."""
    try:
        loaded(mujoco, MIRRORED.format('inertia="exact"'))
    except ValueError:
        return 1
    return 0


def mirrored_inside_out(mujoco) -> int:
    """Whether the triangles of a mesh with a negative scale face inwards."""
    model, _ = loaded(mujoco, MIRRORED.format('inertia="legacy"'))
    corners, faces = np.asarray(model.mesh_vert, float), np.asarray(model.mesh_face)
    volume = sum(np.dot(corners[a], np.cross(corners[b], corners[c])) for a, b, c in faces)
    return int(volume < 0)


def board(mujoco, depth: float):
    """Returns the contacts of a box at this depth in a board of 2 cm."""
    _, data = loaded(
        mujoco,
        f"""<mujoco><worldbody><geom type="box" size="1 1 .01"/>
        <body pos="0 0 {0.11 - depth}"><freejoint/><geom type="box" size=".1 .1 .1"/></body></worldbody></mujoco>""",
    )
    return data.contact


def box_depth(mujoco) -> float:
    """Share of the depth of a box, 1 cm in a board, that is missing from its contacts."""
    found = board(mujoco, 0.01)
    return round(1 + float(found[0].dist) / 0.01, 6) if len(found) else 1.0


def box_in_board(mujoco) -> int:
    """Whether a box 6 cm deep in a thin board has no contact."""
    return int(len(board(mujoco, 0.06)) == 0)


def gap(mujoco) -> int:
    """Whether a ball 1.5 cm above a floor with margin 2 cm and gap 1 cm feels no force."""
    _, data = loaded(
        mujoco,
        """<mujoco><worldbody><geom type="plane" size="1 1 .1" margin=".02" gap=".01"/>
        <body pos="0 0 .115"><freejoint/><geom size=".1"/></body></worldbody></mujoco>""",
    )
    return int(data.nefc == 0)


MEASUREMENTS = (
    ("rays that miss a side of a height field", height_field_sides),
    ("`mj_jacDot`, relative error", jacobian_derivative),
    ("box fitted to a mesh: distance from its place, m", fitted_box),
    ('mirrored mesh with `inertia="exact"` is refused', mirrored_refused),
    ("mirrored mesh is inside out", mirrored_inside_out),
    ("box on box: share of the depth that is lacking", box_depth),
    ("box deep in a thin board has no contact", box_in_board),
    ("no force between `margin - gap` and `margin`", gap),
)


def measured(mujoco) -> dict[str, object]:
    """Returns every measurement, or the message of its error."""
    out: dict[str, object] = {"version": mujoco.__version__}
    for name, measure in MEASUREMENTS:
        try:
            out[name] = measure(mujoco)
        except Exception as error:
            out[name] = f"{type(error).__name__}: {error}".splitlines()[0]
    return out


def cell(value: object) -> str:
    """Writes a measurement."""
    if isinstance(value, int):
        return "yes" if value else "no"
    return f"{value:.2g}" if isinstance(value, float) else str(value)


def main() -> None:
    """Runs the command with its arguments."""
    if sys.argv[1:2] == ["--table"]:
        columns = [(Path(file).stem, json.loads(Path(file).read_text())) for file in sys.argv[2:]]
        print("| | " + " | ".join(name for name, _ in columns) + " |")
        print("|---|" + "--:|" * len(columns))
        for name, _ in MEASUREMENTS:
            print(f"| {name} | " + " | ".join(cell(values[name]) for _, values in columns) + " |")
        return
    if sys.argv[1:] == ["--babybench"]:
        from babybench import __version__
        from babybench import mujoco

        print(json.dumps({**measured(mujoco), "version": __version__}, indent=1))
        return
    import mujoco

    print(json.dumps(measured(mujoco), indent=1))


if __name__ == "__main__":
    main()
