"""Drives an environment of the kit as a script would, and records everything that scripts can see.

Run as ``record.py CONFIG STEPS OUT`` from the root of a checkout of the kit, with MIMo or its stand-in on the path. With
``cold`` as a further word MuJoCo's solver starts each step afresh instead of from its last solution: it finds the same up to its
tolerance, and what is recorded shows how far that alone takes it.
"""

from __future__ import annotations

import pickle
import sys
import tempfile
from typing import Any

import numpy as np
import yaml

sys.path.insert(0, ".")
import mimoEnv  # noqa: F401
from babybench import utils as bb_utils

SENSES = ("touch", "proprioception", "vestibular", "vision", "actuation_model", "mujoco_renderer")
ELEMENTS = ("body", "joint", "geom", "site", "camera", "actuator", "sensor", "equality")
SEED = 7


def public(thing: Any) -> list[str]:
    """Returns the names of the public attributes of an object that are no methods."""
    found = []
    for name in dir(thing):
        if not name.startswith("_"):
            try:
                value = getattr(thing, name)
            except Exception:  # MuJoCo's own: some arrays need plugins
                continue
            if not callable(value):
                found.append(name)
    return found


def plain(value: Any, depth: int = 0) -> Any:
    """Returns a value as numbers, text, arrays and containers of them; other things as the name of their type."""
    if value is None or isinstance(value, (bool, int, float, str, bytes)):
        return value
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        return np.array(value)
    if isinstance(value, range):
        return list(value)
    if isinstance(value, dict) and depth < 4:
        return {key: plain(item, depth + 1) for key, item in value.items()}
    if isinstance(value, (list, tuple)) and depth < 4:
        return [plain(item, depth + 1) for item in value]
    return f"<{type(value).__name__}>"


def attributes(thing: Any) -> dict[str, tuple[str, Any]]:
    """Returns type and value of each public attribute of an object."""
    return {name: (kind(getattr(thing, name)), plain(getattr(thing, name))) for name in public(thing)}


def kind(value: Any) -> str:
    """Returns the name of a type; every array is one, also those that explain why they cannot be changed."""
    return "ndarray" if isinstance(value, np.ndarray) else type(value).__name__


def space(of: Any) -> Any:
    """Describes a space."""
    if hasattr(of, "spaces"):
        return {key: space(item) for key, item in of.spaces.items()}
    return (type(of).__name__, of.low, of.high, of.shape, str(of.dtype))


def elements(model: Any, data: Any) -> dict[str, Any]:
    """Returns name and some numbers of every element, by id and by name."""
    counts = {"body": model.nbody, "joint": model.njnt, "geom": model.ngeom, "site": model.nsite, "camera": model.ncam}
    counts.update(actuator=model.nu, sensor=model.nsensor, equality=model.neq)
    found = {kind: [getattr(model, kind)(i).name for i in range(counts[kind])] for kind in ELEMENTS}
    found["mass"] = [plain(model.body(i).mass) for i in range(model.nbody)]
    found["range"] = [plain(model.joint(i).range) for i in range(model.njnt)]
    found["geom_body"] = [plain(model.geom(i).bodyid) for i in range(model.ngeom)]
    found["equalities"] = [
        [plain(getattr(model.equality(i), n)) for n in ("type", "obj1id", "active0", "data")] for i in range(model.neq)
    ]
    found["hand"] = [plain(getattr(data.body("right_hand"), name)) for name in ("xpos", "xmat", "xquat", "id", "name")]
    found["elbow"] = [plain(getattr(data.joint("robot:right_elbow"), name)) for name in ("qpos", "qvel", "id", "name")]
    found["ctrl"] = [plain(data.actuator(i).ctrl) for i in range(model.nu)]
    return found


def contacts(data: Any) -> dict[str, Any]:
    """Returns the contacts, as columns and one by one."""
    found: dict[str, Any] = {"ncon": data.ncon}
    for name in (
        "geom1",
        "geom2",
        "geom",
        "dist",
        "pos",
        "frame",
        "friction",
        "dim",
        "includemargin",
        "solref",
        "solimp",
    ):
        found[name] = plain(getattr(data.contact, name)) if data.ncon else []
    found["single"] = [
        [plain(getattr(data.contact[i], n)) for n in ("geom1", "geom2", "pos", "frame", "dist")]
        for i in range(data.ncon)
    ]
    return found


def observation(obs: dict[str, Any]) -> dict[str, Any]:
    """Copies an observation."""
    return {key: np.array(value) for key, value in obs.items()}


def start_cold() -> None:
    """Lets MuJoCo's solver start each step afresh, in all models from now on."""
    import mujoco

    read = mujoco.MjModel.from_xml_path

    def cold(*args: Any) -> Any:
        model = read(*args)
        model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_WARMSTART
        return model

    mujoco.MjModel.from_xml_path = cold


def drive(config: dict[str, Any], steps: int) -> dict[str, Any]:
    """Runs an environment and records it."""
    # trimesh casts random rays where it is unsure whether a point of skin lies inside a mesh, and may take it for one outside
    np.random.seed(SEED)
    env = bb_utils.make_env(config)
    u = env.unwrapped
    env.action_space.seed(SEED)
    obs, empty = env.reset()
    recorded: dict[str, Any] = {
        "reset": observation(obs),
        "reset_info": empty,
        "observations": [],
        "infos": [],
        "rest": [],
    }
    for _ in range(steps):
        obs, reward, terminated, truncated, info = env.step(env.action_space.sample())
        recorded["observations"].append(observation(obs))
        recorded["infos"].append(
            {key: list(value) if isinstance(value, list) else value for key, value in info.items()}
        )
        recorded["rest"].append((type(reward).__name__, reward, terminated, truncated))
    # what is felt once more at the same instant, with normals that the kit has inverted in place
    frames = np.array([contact.frame for contact in u.data.contact])
    recorded["again"] = {**observation(u._get_obs()), "frames": frames}
    if u.touch:
        recorded["again"]["contacts"] = np.array([[c, b, *force] for c, b, force in u.touch.get_contacts()])
    # the same state on both sides, with everything computed there
    joints = u.proprioception.joint_qpos.ravel()
    moved, speed = np.round(u.init_qpos, 4), np.round(u.init_qvel / 2, 4)
    moved[joints] *= 0.9
    for joint in range(u.model.njnt):
        if u.model.joint(joint).type[0] == 0:
            quaternion = u.model.jnt_qposadr[joint] + np.arange(3, 7)
            moved[quaternion] /= np.linalg.norm(moved[quaternion])
    u.set_state(moved, speed)
    recorded["contacts"] = contacts(u.data)
    obs = u._get_obs()
    recorded["state"] = observation(obs)
    recorded["pictures"] = {camera: bb_utils.render(env, camera) for camera in ("corner", "top", "closeup", "eye_left")}
    recorded["env"] = attributes(u)
    recorded["wrapped"] = str(env)
    recorded["spaces"] = {"action": space(env.action_space), "observation": space(env.observation_space)}
    recorded["order"] = {"observation": list(obs), "info": list(info), "layout": list(u.proprioception.sensor_outputs)}
    for sense in SENSES:
        value = getattr(u, sense)
        recorded[sense] = None if value is None else attributes(value)
    if u.touch:
        recorded["order"]["touch"] = list(u.touch.sensor_positions)
        recorded["counts"] = [u.touch.get_sensor_count(body) for body in u.touch.sensing_bodies()]
        recorded["empty"] = plain(u.touch.get_empty_sensor_dict(3))
    recorded["elements"] = elements(u.model, u.data)
    recorded["model"] = attributes(u.model)
    recorded["data"] = attributes(u.data)
    recorded["model"].pop("tex_data", None)  # gigabytes
    # what a script writes is where the next step starts
    u.data.qpos[joints] = 0.5 * moved[joints]
    u.data.qvel[:] = 0
    import mujoco

    mujoco.mj_forward(u.model, u.data)
    recorded["written"] = observation(u._get_obs())
    recorded["name"] = mujoco.mj_id2name(u.model, mujoco.mjtObj.mjOBJ_GEOM, 5)
    env.reset()
    recorded["history"] = plain(u._info_hist)
    return recorded


def main() -> None:
    """Records one configuration."""
    file, steps, out, *how = sys.argv[1:]
    with open(file) as f:
        config = yaml.safe_load(f)
    with tempfile.TemporaryDirectory() as save_dir:
        config["save_dir"] = save_dir
        if how == ["cold"]:
            start_cold()
        recorded = drive(config, int(steps))
    with open(out, "wb") as f:
        pickle.dump(recorded, f)


if __name__ == "__main__":
    main()
