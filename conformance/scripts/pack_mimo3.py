"""Packs what MIMo 3 (mimo_infant 3.0.0) compiled and recorded on MuJoCo 3.3.0 into conformance/data/mimo3.

The folder SOURCE has `compiled_by_age.npz` (arrays `id|age|array`), `body_v1.json`, `body_v2.json` (names) and `rec_*.npz` (episodes).

    python conformance/scripts/pack_mimo3.py SOURCE conformance/data/mimo3
"""

import json
import sys
from pathlib import Path

import numpy as np

STEPS = 60
"""Steps that are kept of each episode."""
TOUCH_STEPS = 20
"""Steps of which touch is kept."""
AGES = ["None", "0", "1", "3", "6", "9", "12", "18", "24"]
MODELS = {
    "MIMoBench-v0": ("bench_v1", AGES),
    "MIMoBenchV2-v0": ("bench_v2", AGES),
    "MIMoReach-v0": ("reach", ["None", "6"]),
    "MIMoStandup-v0": ("standup", ["None"]),
    "MIMoSelfBody-v0": ("selfbody", ["None", "24"]),
    "MIMoCatch-v0": ("catch", ["None", "0"]),
    "MIMoRollOver-v0": ("roll_over", ["None", "0", "1", "6", "24"]),
}
EPISODES = {
    "bench": "bench_v1",
    "bench_age6": "bench_v1_6",
    "benchv2": "bench_v2",
    "muscle": "muscle_v2",
    "reach": "reach",
    "standup": "standup",
    "selfbody": "selfbody",
    "catch": "catch",
    "rollover": "roll_over",
    "rollover_age1": "roll_over_1",
}


def activity(episode: dict, steps: int) -> np.ndarray:
    """Returns the activities of muscles after each step.

    They follow from the actions: each of three updates a step halves the distance to the action. Recorded observations, in single
    precision, confirm it.
    """
    muscles = episode["action"].shape[1]
    now = episode["obs_observation_first"][:muscles].astype(float)
    rows = [now]
    for t in range(steps):
        for _ in range(3):
            now = now + 0.5 * (episode["action"][t].astype(float) - now)
        assert np.abs(now - episode["obs_observation"][t + 1][:muscles]).max() < 1e-6
        rows.append(now)
    return np.array(rows)


def pack_episode(source: Path, out: Path) -> None:
    """Packs the first steps of an episode."""
    episode = dict(np.load(source))
    steps = min(STEPS, len(episode["action"]))
    kept = {
        "actions": episode["action"][:steps].astype(np.float32),
        "reward": episode["reward"][:steps],
        "terminated": episode["terminated"][:steps],
        "achieved_goal": episode["achieved"][:steps],
        "ncon": episode["ncon"][:steps].astype(np.int32),
        "qpos0": episode["qpos0"],
        "qvel0": episode["qvel0"],
        "qpos": episode["qpos"][:steps],
        "qvel": episode["qvel"][:steps],
        "reset_row": np.zeros(1, np.int64),
        "reset_qpos": episode["qpos0"][None],
        "reset_qvel": episode["qvel0"][None],
        "reset_desired_goal": episode["goal0"][None],
    }
    if "muscle" in source.name or "catch" in source.name:
        rows = activity(episode, steps)
        kept |= {"activity0": rows[0], "activity": rows[1:], "reset_activity": rows[:1]}
    if "ball" in episode:
        radius, mass = episode["ball"]
        moment = 0.4 * mass * radius**2
        kept["reset_ball"] = np.array([[radius, mass, moment, moment, moment, 1 / mass, 1 / moment]])
    if "obs_observation" in episode:
        kept["observation"] = episode["obs_observation"][1 : steps + 1].astype(np.float32)[:TOUCH_STEPS]
    if "touch_step" in episode:
        within = (episode["touch_step"] >= 1) & (episode["touch_step"] <= TOUCH_STEPS)
        kept |= {
            "touch_step": (episode["touch_step"][within] - 1).astype(np.int32),
            "touch_index": episode["touch_index"][within].astype(np.int32),
            "touch_value": episode["touch_value"][within].astype(np.float32),
            "touch_size": episode["touch_size"].astype(np.int64),
        }
    np.savez_compressed(out, **kept)


def main(source: Path, out: Path) -> None:
    """Packs everything."""
    out.mkdir(parents=True, exist_ok=True)
    compiled = np.load(source / "compiled_by_age.npz")
    models = {
        f"{ours}|{age}|{key.split('|')[2]}": compiled[key]
        for theirs, (ours, ages) in MODELS.items()
        for age in ages
        for key in compiled.files
        if key.startswith(f"{theirs}|{age}|")
    }
    for version in ["v1", "v2"]:
        body = json.loads((source / f"body_{version}.json").read_text())
        for kind in ["bodies", "joints", "geoms", "sites", "actuators", "sensors"]:
            names = "\n".join(element["name"] for element in body[kind])
            models[f"{version}|{kind}"] = np.frombuffer(names.encode(), np.uint8)
    np.savez_compressed(out / "compiled.npz", **models)
    for theirs, ours in EPISODES.items():
        pack_episode(source / f"rec_{theirs}.npz", out / f"{ours}.npz")


main(Path(sys.argv[1]), Path(sys.argv[2]))
