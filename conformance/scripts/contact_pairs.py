"""Poses two geoms against each other in MuJoCo 3.3.0 and writes the contacts it finds.

usage: python contact_pairs.py [--poses N] [--seed S] [--out FILE]      (needs mujoco==3.3.0 and numpy)

N poses for each of the 20 pairs of shapes (default 500, the committed file); a larger FILE is read by the test in place
of the committed one when BB_CONTACT_PAIRS names it.

Kinds of poses, in turn: random orientation at a depth between 1e-6 and 1e-2 m, deep in each other, the same with a
margin, axis-aligned on a grid (flush faces, kissing surfaces, shared edges), that pose turned as a whole, that pose with
a slight tilt, stacked with a gap or overlap of some rounding errors, and the same centre.

Arrays of the file, for P poses and C contacts: type (P,2) MuJoCo's geom types; size (P,2,3), rbound (P,2), pos (P,2,3)
and mat (P,2,9) as MuJoCo holds them after its kinematics; margin (P); kind (P) index of the kind of pose; ncon (P);
dist (C), contact_pos (C,3) and frame (C,9), pose after pose.
"""

import argparse
import pathlib

import mujoco
import numpy as np

TYPES = {
    "plane": mujoco.mjtGeom.mjGEOM_PLANE,
    "sphere": mujoco.mjtGeom.mjGEOM_SPHERE,
    "capsule": mujoco.mjtGeom.mjGEOM_CAPSULE,
    "ellipsoid": mujoco.mjtGeom.mjGEOM_ELLIPSOID,
    "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER,
    "box": mujoco.mjtGeom.mjGEOM_BOX,
}
KINDS = ["shallow", "deep", "margin", "aligned", "turned", "tilted", "kissing", "shallow", "aligned", "centred"]
KIND_NAMES = list(dict.fromkeys(KINDS))
IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])


def quat_mul(a, b):
    out = np.zeros(4)
    mujoco.mju_mulQuat(out, a, b)
    return out


def rotate(quat, vec):
    out = np.zeros(3)
    mujoco.mju_rotVecQuat(out, vec, quat)
    return out


class Pair:
    """Two geoms on mocap bodies, joined by an explicit pair so that nothing filters them."""

    def __init__(self, first, second, rng):
        self.names = (first, second)
        self.rng = rng
        self.model = mujoco.MjModel.from_xml_string(
            f"""<mujoco><worldbody>
            <body mocap="true"><geom name="a" type="{first}" size="1 1 1"/></body>
            <body mocap="true"><geom name="b" type="{second}" size="1 1 1"/></body>
            </worldbody><contact><pair geom1="a" geom2="b"/></contact></mujoco>"""
        )
        self.data = mujoco.MjData(self.model)

    def random_size(self, name, grid):
        size = self.rng.integers(1, 9, 3) / 32 if grid else self.rng.integers(4, 52, 3) / 256
        if name == "sphere":
            size[1:] = 0
        elif name in ("capsule", "cylinder"):
            size[2] = 0
        elif name == "plane":
            size[:] = 1
        return size

    def set_sizes(self, grid):
        for k, name in enumerate(self.names):
            size = self.random_size(name, grid)
            self.model.geom_size[k] = size
            r, h = size[0], size[1]
            self.model.geom_rbound[k] = {
                "plane": 0.0,
                "sphere": r,
                "capsule": r + h,
                "ellipsoid": size.max(),
                "cylinder": np.sqrt(r * r + h * h),
                "box": np.sqrt(size[0] * size[0] + size[1] * size[1] + size[2] * size[2]),
            }[name]

    def place(self, pos, quat, margin=0.0):
        """Returns the contacts at a pose and their number."""
        self.data.mocap_pos[:] = pos
        self.data.mocap_quat[:] = quat
        self.model.pair_margin[0] = margin
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_collision(self.model, self.data)
        return self.data.ncon

    def touching_offset(self, pos, quat, direction):
        """Distance along a direction at which the second geom just touches the first."""
        near, far = 0.0, float(self.model.geom_rbound.sum()) + 1e-3
        for _ in range(24):
            middle = 0.5 * (near + far)
            if self.place([pos, pos + middle * direction], quat):
                near = middle
            else:
                far = middle
        return near

    def random_quat(self):
        quat = self.rng.normal(size=4)
        return quat / np.linalg.norm(quat)

    def special_quat(self):
        """A rotation that maps axes onto axes."""
        r = np.sqrt(0.5)
        choices = [[1, 0, 0, 0], [r, r, 0, 0], [r, 0, r, 0], [r, 0, 0, r], [0, 1, 0, 0], [0.5, 0.5, 0.5, 0.5]]
        return np.array(choices[self.rng.integers(len(choices))], float)

    def direction(self):
        """A random unit vector."""
        d = self.rng.normal(size=3)
        return d / np.linalg.norm(d)

    def shallow_pose(self):
        self.set_sizes(grid=False)
        quat = [self.random_quat(), self.random_quat()]
        pos = self.rng.integers(-512, 512, 3) / 512
        u = self.direction()
        if self.names[0] == "plane":
            u = rotate(quat[0], np.array([0.0, 0.0, 1.0]))
        depth = 10 ** self.rng.uniform(-6, -2)
        offset = self.touching_offset(pos, quat, u) - depth
        return [pos, pos + offset * u], quat

    def deep_pose(self):
        self.set_sizes(grid=False)
        pos = self.rng.integers(-512, 512, 3) / 512
        spread = self.model.geom_size.max(axis=1)[1] * self.rng.choice([0.1, 0.5, 1.0])
        return [pos, pos + np.round(spread * self.rng.uniform(-1, 1, 3) * 4096) / 4096], [
            self.random_quat(),
            self.random_quat(),
        ]

    def aligned_pose(self):
        """Axis-aligned, centres on a grid of the sizes' spacing, often flush along one axis."""
        self.set_sizes(grid=True)
        offset = self.rng.integers(-8, 9, 3) / 32 * self.rng.integers(0, 2, 3)
        if self.rng.random() < 0.6:
            axis = self.rng.integers(3)
            extent = [self.rng.choice(self.model.geom_size[k][self.model.geom_size[k] > 0]) for k in range(2)]
            extent[0] *= self.names[0] != "plane"
            offset[axis] = sum(extent) - self.rng.choice([0, 2.0**-10, 2.0**-20, 1 / 32])
        return [np.zeros(3), offset], [IDENTITY if self.rng.random() < 0.5 else self.special_quat(), self.special_quat()]

    def turned_pose(self):
        pos, quat = self.aligned_pose()
        turn = self.random_quat()
        return [rotate(turn, p) for p in pos], [quat_mul(turn, q) for q in quat]

    def tilted_pose(self):
        pos, quat = self.aligned_pose()
        tilt = np.append(1.0, 10 ** self.rng.uniform(-14, -2) * self.rng.normal(size=3))
        return pos, [quat[0], quat_mul(quat[1], tilt / np.linalg.norm(tilt))]

    def kissing_pose(self):
        """Poses that touch to within a few rounding errors."""
        pos, quat = self.aligned_pose()
        length = np.linalg.norm(pos[1] - pos[0])
        u = (pos[1] - pos[0]) / length if length > 0 else np.array([0.0, 0.0, 1.0])
        gap = self.rng.choice([0.0, 1e-16, 1e-15, 1e-12, 1e-9, 1e-7, 1e-6]) * self.rng.choice([-1, 1])
        return [pos[0], pos[0] + (self.touching_offset(pos[0], quat, u) + gap) * u], quat

    def centred_pose(self):
        grid = bool(self.rng.integers(2))
        self.set_sizes(grid)
        quat = self.special_quat if grid else self.random_quat
        pos = self.rng.integers(-512, 512, 3) / 512
        return [pos, pos], [quat(), quat()]

    def pose(self, kind):
        """Arranges a pose of a kind; returns its margin."""
        if kind == "margin":
            pos, quat = [self.shallow_pose, self.deep_pose, self.turned_pose][self.rng.integers(3)]()
            margin = 2.0 ** -self.rng.integers(4, 12)
            pos[1] = pos[1] + np.round(self.rng.uniform(-1, 1, 3) * 64) / 64 * margin
        else:
            pos, quat = getattr(self, kind + "_pose")()
            margin = 0.0
        self.place(pos, quat, margin)
        return margin


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--poses", type=int, default=500, help="poses per pair of shapes")
    parser.add_argument("--seed", type=int, default=1)
    default = pathlib.Path(__file__).parents[1] / "data" / "contact_pairs.npz"
    parser.add_argument("--out", type=pathlib.Path, default=default)
    args = parser.parse_args()
    assert mujoco.__version__ == "3.3.0", mujoco.__version__

    poses = {name: [] for name in ["type", "size", "rbound", "pos", "mat", "margin", "kind", "ncon"]}
    contacts = {"dist": [], "contact_pos": [], "frame": []}
    names = list(TYPES)
    for first in names:
        for second in names[max(names.index(first), 1) :]:
            rng = np.random.default_rng([args.seed, names.index(first), names.index(second)])
            pair = Pair(first, second, rng)
            found = 0
            for k in range(args.poses):
                kind = KINDS[k % len(KINDS)]
                margin = pair.pose(kind)
                model, data = pair.model, pair.data
                poses["type"].append([TYPES[first], TYPES[second]])
                poses["size"].append(model.geom_size.copy())
                poses["rbound"].append(model.geom_rbound.copy())
                poses["pos"].append(data.geom_xpos.copy())
                poses["mat"].append(data.geom_xmat.copy())
                poses["margin"].append(margin)
                poses["kind"].append(KIND_NAMES.index(kind))
                poses["ncon"].append(data.ncon)
                contacts["dist"].extend(data.contact.dist.copy())
                contacts["contact_pos"].extend(data.contact.pos.copy())
                contacts["frame"].extend(data.contact.frame.copy())
                found += data.ncon > 0
            print(f"{first}-{second}: {args.poses} poses, {found} with contacts", flush=True)
    integers = {"type", "kind", "ncon"}
    arrays = {k: np.array(v, np.int32 if k in integers else np.float64) for k, v in poses.items()}
    arrays |= {k: np.array(v, np.float64) for k, v in contacts.items()}
    np.savez_compressed(args.out, **arrays)
    print(f"{args.out.name}: {args.out.stat().st_size / 1e6:.2f} MB, {len(arrays['dist'])} contacts")


if __name__ == "__main__":
    main()
