"""Writes conformance/data/render_{base,crib,cubes}.npz: what MuJoCo 3.3.0 draws of the models in assets/ with OSMesa.

    MUJOCO_GL=osmesa python render_goldens.py [--assets DIR] [--out DIR] [--poses DIR] [--time] [--only small]

Body version 1 in base and crib, 2 in cubes. States are positions only; pictures are of mj_forward at them. Kinds of
states, in turn: random torques; a hand before the eyes; toys before the eyes, or the own body and the floor; MIMo
turned and moved to look into the room (crib: at the rails). Arrays:

    qpos        (K, nq)             states, K = 24
    eyes        (K, 2, 64, 64, 3)   u8, left and right eye
    view_state  (V)                 states of the next
    view_camera (V)                 cameras of the next, ids
    views       (V, 480, 480, 3)    u8

Pictures have row 0 at the top. So that they compress, each stores the difference to the pixel on the left, modulo 256.
With --time nothing is written: of the first states in DIR, the CPU time of drawing is printed, a line for each: scene, number
of the state, `eyes` (both) or `corner`, ms. `conformance speed --pictures yes` lays ours beside it.
Of data/flexes.xml (flexes, by flex_room.py), data/glass.xml (transparent things), data/lamps.xml (lit planes), data/meshes.xml (meshes, by mesh_room.py), data/skins.xml (skins, by skin_room.py) and data/strings.xml
(tendons), render_glass.npz and so
on have the views of all cameras; with --only small nothing else is written:

    views       (V, 120, 160, 3)    u8

With --poses the poses of all geoms, sites and cameras of each state are written there too, as float64 without a header,
in this order, each element's position (3) followed by its matrix (9).
"""

import argparse
import shutil
import tempfile
import time
from pathlib import Path

import mujoco
import numpy as np

from check_assets import GROUPS, POSES, compile_model

STATES = 24
TIMED = 8
VERSION = {"base": 1, "crib": 1, "cubes": 2}
SMALL = ["flexes", "glass", "lamps", "meshes", "skins", "strings"]
VIEWS = [("corner", 0), ("top", 3), ("side1", 1), ("side2", 2), ("closeup", 0), ("eye_left", 1)]


class Maker:
    def __init__(self, model, seed):
        self.model, self.rng = model, np.random.default_rng(seed)
        self.data = mujoco.MjData(model)
        for _ in range(100):
            mujoco.mj_step(model, self.data)
        self.settled = self.data.qpos.copy()
        names = [model.joint(j).name for j in range(model.njnt)]
        part = lambda *words: [j for j, n in enumerate(names) if n.startswith("robot:") and any(w in n for w in words)]
        self.arms = part("shoulder", "elbow", "hand", "_ff_", "_mf_", "_rf_", "_lf_", "_th_", "fingers", "wrist", "forearm")
        self.gaze = part("head", "eye")
        self.place = model.joint("mimo_location").qposadr[0]
        self.toys = [
            model.jnt_qposadr[j] for j in range(model.njnt)
            if model.jnt_type[j] == mujoco.mjtJoint.mjJNT_FREE and names[j] != "mimo_location"
        ]

    def randomize(self, qpos, joints, share=1.0):
        for j in joints:
            low, high = self.model.jnt_range[j]
            middle = np.clip(0, low, high)
            qpos[self.model.jnt_qposadr[j]] = middle + share * (self.rng.uniform(low, high) - middle)

    def torques(self):
        for _ in range(6):
            self.data.ctrl[:] = self.rng.uniform(*self.model.actuator_ctrlrange.T)
            for _ in range(10):
                mujoco.mj_step(self.model, self.data)
        return self.data.qpos.copy()

    def kinematics(self, qpos):
        data = mujoco.MjData(self.model)
        data.qpos[:] = qpos
        mujoco.mj_kinematics(self.model, data)
        mujoco.mj_camlight(self.model, data)
        return data

    def hands(self):
        """The best of many arm postures: a hand near the middle of the picture of one of the eyes."""
        best = None
        for _ in range(1500):
            qpos = self.settled.copy()
            self.randomize(qpos, self.arms)
            self.randomize(qpos, self.gaze, 0.5)
            data, score = self.kinematics(qpos), 0.0
            for eye in ("eye_left", "eye_right"):
                camera = data.camera(eye)
                for hand in ("left_hand", "right_hand"):
                    offset = camera.xmat.reshape(3, 3).T @ (data.body(hand).xpos - camera.xpos)
                    distance = np.linalg.norm(offset)
                    score += max(0.0, -offset[2] / distance - 0.8) * (0.05 < distance < 0.3)
            if best is None or score > best[0]:
                best = score, qpos
        return best[1]

    def near(self):
        qpos = self.torques()
        if not self.toys:  # sits up and looks down at itself
            qpos = self.settled.copy()
            qpos[self.place + 2] += 0.1
            qpos[self.place + 3 : self.place + 7] = [1, 0, 0, 0]
            self.randomize(qpos, self.gaze)
            self.randomize(qpos, self.arms, 0.6)
            return qpos
        data = self.kinematics(qpos)
        for toy in self.rng.choice(self.toys, 5, replace=False):
            camera = data.camera(self.rng.choice(["eye_left", "eye_right"]))
            depth = self.rng.uniform(0.06, 0.4)
            offset = np.array([*self.rng.uniform(-0.5, 0.5, 2) * depth, -depth])
            qpos[toy : toy + 3] = camera.xpos + camera.xmat.reshape(3, 3) @ offset
            quat = self.rng.normal(size=4)
            qpos[toy + 3 : toy + 7] = quat / np.linalg.norm(quat)
        return qpos

    def room(self):
        qpos = self.torques()
        yaw, pitch = self.rng.uniform(-np.pi, np.pi), self.rng.uniform(0.0, 0.9)
        turn, bow, quat = np.zeros(4), np.zeros(4), np.zeros(4)
        mujoco.mju_axisAngle2Quat(turn, np.array([0.0, 0.0, 1.0]), yaw)
        mujoco.mju_axisAngle2Quat(bow, np.array([0.0, 1.0, 0.0]), pitch)
        mujoco.mju_mulQuat(quat, turn, bow)
        qpos[self.place : self.place + 3] = *self.rng.uniform(-0.2, 0.2, 2), self.rng.uniform(0.25, 0.6)
        qpos[self.place + 3 : self.place + 7] = quat
        self.randomize(qpos, self.gaze, 0.7)
        return qpos

    def states(self):
        kinds = [self.torques, self.hands, self.near, self.room]
        return np.array([kinds[k % 4]() for k in range(STATES)])


def draw(renderer, data, camera):
    renderer.update_scene(data, camera)
    return renderer.render().copy()


def timed(model, maker, qpos, scene):
    small, large = mujoco.Renderer(model, 64, 64), mujoco.Renderer(model, 480, 480)
    pictures = [("eyes", small, ("eye_left", "eye_right"), 40), ("corner", large, ("corner",), 10)]
    for k, q in enumerate(qpos[:TIMED]):
        data = maker.kinematics(q)
        for name, renderer, cameras, repeat in pictures:
            spent = []
            for _ in range(repeat):
                start = time.process_time()
                for camera in cameras:
                    draw(renderer, data, camera)
                spent.append(1e3 * (time.process_time() - start))
            print(scene, k, name, np.median(spent), flush=True)
    small.close()
    large.close()


def packed(pictures):
    pictures = np.array(pictures)
    pictures[..., 1:, :] -= pictures[..., :-1, :].copy()
    return pictures


def small_scenes(directory, out):
    for name in SMALL:
        model = mujoco.MjModel.from_xml_path(str(directory / f"{name}.xml"))
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        renderer = mujoco.Renderer(model, 120, 160)
        views = []
        for camera in range(model.ncam):
            # planes without an end move with the camera of the update before
            renderer.update_scene(data, camera)
            views.append(draw(renderer, data, camera))
        views = packed(views)
        np.savez_compressed(out / f"render_{name}.npz", views=views)
        renderer.close()


def main():
    here = Path(__file__).resolve().parents[1]
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--assets", type=Path, default=here.parent / "assets")
    parser.add_argument("--out", type=Path, default=here / "data")
    parser.add_argument("--poses", type=Path)
    parser.add_argument("--time", action="store_true")
    parser.add_argument("--only", choices=["small"])
    args = parser.parse_args()
    if args.only:
        small_scenes(here / "data", args.out)
        return
    with tempfile.TemporaryDirectory() as temporary:
        directory = Path(temporary) / "assets"
        shutil.copytree(args.assets, directory)
        for seed, scene in enumerate(POSES):
            model = compile_model(directory / "babybench", VERSION[scene], scene, "motor", GROUPS)
            maker = Maker(model, seed)
            if args.time:
                timed(model, maker, np.load(args.out / f"render_{scene}.npz")["qpos"], scene)
                continue
            qpos = maker.states()
            small, large = mujoco.Renderer(model, 64, 64), None
            eyes, poses = [], []
            for q in qpos:
                data = maker.kinematics(q)
                eyes.append([draw(small, data, eye) for eye in ("eye_left", "eye_right")])
                for pos, mat in (("geom_xpos", "geom_xmat"), ("site_xpos", "site_xmat"), ("cam_xpos", "cam_xmat")):
                    poses.append(np.hstack([getattr(data, pos), getattr(data, mat)]).ravel())
            small.close()
            large = mujoco.Renderer(model, 480, 480)
            views = [draw(large, maker.kinematics(qpos[k]), camera) for camera, k in VIEWS]
            large.close()
            path = args.out / f"render_{scene}.npz"
            np.savez_compressed(
                path,
                qpos=qpos,
                eyes=packed(eyes),
                view_state=np.array([k for _, k in VIEWS]),
                view_camera=np.array([model.camera(camera).id for camera, _ in VIEWS]),
                views=packed(views),
            )
            print(f"{path.name}: {path.stat().st_size / 1000:.0f} kB")
            if args.poses:
                np.concatenate(poses).tofile(args.poses / f"{scene}.poses")
    if not args.time:
        small_scenes(here / "data", args.out)


if __name__ == "__main__":
    main()
