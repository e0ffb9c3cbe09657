"""Measures how long other renderers take for the eyes of many environments on a GPU.

    MUJOCO_GL=egl python gpu_eyes.py --renderer egl --pictures FILE [--environments 1,64,1024]
    python gpu_eyes.py --renderer mjwarp --pictures FILE [--environments 1,64,1024]

`egl` is MuJoCo's own renderer, which draws one picture after the other; `mjwarp` is MuJoCo Warp's, which casts rays for all
worlds at once (pip install mujoco-warp), with one ray a pixel and with four, as MuJoCo has four samples. Environment k has
state k modulo 24 of data/render_{base,crib,cubes}.npz; both eyes are 64 x 64. Poses are there before the clock starts.
Prints a JSON object a line:

    scene, renderer, device, environments
    host         ms a round until all pictures are in the host's memory, median of 7 rounds
    device_only  ms a round without that copy; absent for egl

FILE becomes an npz with an array (24, 2, 64, 64, 3) of the states' pictures for each `SCENE: RENDERER`. `conformance gpu`
lays ours beside it.
"""

import argparse
import json
import shutil
import statistics
import tempfile
import time
from pathlib import Path

import mujoco
import numpy as np

from check_assets import GROUPS, POSES, compile_model

HERE = Path(__file__).resolve().parents[1]
VERSION = {"base": 1, "crib": 1, "cubes": 2}
EYES = ("eye_left", "eye_right")
ROUNDS = 7


def milliseconds(work):
    work()
    spent = []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        work()
        spent.append(1e3 * (time.perf_counter() - start))
    return statistics.median(spent)


def placed(model, qpos):
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_forward(model, data)
    return data


def egl(model, states, environments):
    """Yields a row of the table and the states' pictures, for each number of environments."""
    import OpenGL.GL

    renderer = mujoco.Renderer(model, 64, 64)
    device = OpenGL.GL.glGetString(OpenGL.GL.GL_RENDERER).decode()
    states = [placed(model, qpos) for qpos in states]

    def draw(count, out):
        for k in range(count):
            for eye, name in enumerate(EYES):
                renderer.update_scene(states[k % len(states)], name)
                renderer.render(out=out[k, eye])

    pictures = np.empty((len(states), 2, 64, 64, 3), np.uint8)
    draw(len(states), pictures)
    for n in environments:
        out = np.empty((n, 2, 64, 64, 3), np.uint8)
        yield {"renderer": "MuJoCo, EGL", "device": device, "environments": n, "host": milliseconds(lambda: draw(n, out))}, pictures
    renderer.close()


def mjwarp(model, states, environments):
    """Yields the same for MuJoCo Warp."""
    import mujoco_warp as mjw
    import warp as wp

    # nothing is solved here, but a dense matrix of the cubes' 193 degrees of freedom is refused
    model.opt.jacobian = mujoco.mjtJacobian.mjJAC_SPARSE
    device = wp.get_device()
    for side, rays in ((1, "one ray"), (2, "four rays")):
        for n in environments:
            worlds = mjw.put_model(model)
            data = mjw.put_data(model, placed(model, states[0]), nworld=n, nconmax=256, njmax=768)
            context = mjw.create_render_context(
                model, n, cam_res=(64, 64), render_rgb=True, cam_active=list(EYES), samples_per_pixel=side, render_skybox=True
            )

            def place(first):
                qpos = [states[(first + k) % len(states)] for k in range(n)]
                data.qpos.assign(np.array(qpos, dtype=np.float32))
                mjw.kinematics(worlds, data)
                mjw.com_pos(worlds, data)
                mjw.camlight(worlds, data)

            def draw():
                mjw.refit_bvh(worlds, data, context)
                mjw.render(worlds, data, context)

            def host(go):
                go()
                return context.rgb_data.numpy()

            def device_only(go):
                go()
                wp.synchronize()

            pictures = []
            for first in range(0, len(states), n):
                place(first)
                # blue comes first
                pictures.extend(host(draw).view(np.uint8).reshape(n, 2, 64, 64, 4)[..., 2::-1].copy())
            place(0)
            draw()
            go = draw
            if device.is_cuda:
                with wp.ScopedCapture() as capture:
                    draw()
                go = lambda: wp.capture_launch(capture.graph)
            row = {"renderer": f"MuJoCo Warp, {rays} a pixel", "device": device.name, "environments": n}
            spent = {"host": milliseconds(lambda: host(go)), "device_only": milliseconds(lambda: device_only(go))}
            yield row | spent, np.array(pictures[: len(states)])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--renderer", choices=["egl", "mjwarp"], required=True)
    parser.add_argument("--pictures", type=Path, required=True)
    parser.add_argument("--environments", default="1,64,1024")
    args = parser.parse_args()
    environments = [int(n) for n in args.environments.split(",")]
    pictures = {}
    with tempfile.TemporaryDirectory() as temporary:
        directory = Path(temporary) / "assets"
        shutil.copytree(HERE.parent / "assets", directory)
        for scene in POSES:
            model = compile_model(directory / "babybench", VERSION[scene], scene, "motor", GROUPS)
            states = np.load(HERE / "data" / f"render_{scene}.npz")["qpos"]
            measure = {"egl": egl, "mjwarp": mjwarp}[args.renderer]
            for row, seen in measure(model, states, environments):
                pictures[f"{scene}: {row['renderer']}"] = seen
                print(json.dumps({"scene": scene, **row}), flush=True)
    np.savez_compressed(args.pictures, **pictures)


if __name__ == "__main__":
    main()
