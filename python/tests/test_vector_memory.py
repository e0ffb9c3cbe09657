"""How much memory a vector says that it takes, against what the process takes."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from typing import Any

import gymnasium
import pytest
from conftest import SMALL

import babybench

CHILD = """
import gc, json, re, resource, sys
import babybench
count, keys = int(sys.argv[1]), json.loads(sys.argv[2])
try:
    babybench.VectorEnv(num_envs=count, max_memory=1, **keys)
except MemoryError as error:
    number, unit = re.search(r"take ([0-9.]+) (.iB)", str(error)).groups()
gc.collect()
before = int(open("/proc/self/statm").read().split()[1]) * resource.getpagesize()
envs = babybench.VectorEnv(num_envs=count, **keys)
observations = envs.reset(seed=0)
for _ in range(3):
    observations = envs.step(envs.action_space.sample())
    pictures = envs.eyes() if keys.get("vision_lazy") else None
peak = int(re.search("VmHWM:[^0-9]*([0-9]+) kB", open("/proc/self/status").read())[1]) * 1024
print(json.dumps([float(number) * 1024 ** ["KiB", "MiB", "GiB"].index(unit) * 1024, peak - before]))
"""

ALL = ["rgb", "depth", "segmentation"]
EYES: dict[str, Any] = {"config": "hand_regard", "threads": 2}


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="the system does not tell what a process takes")
@pytest.mark.parametrize(
    ("count", "keys"),
    [
        (8, {**EYES, "vision_resolution": 512}),
        (8, {**EYES, "vision_resolution": 1024}),
        (8, {**EYES, "vision_resolution": 1024, "threads": 1}),
        (8, {**EYES, "vision_resolution": 1024, "copy": False}),
        (8, {**EYES, "vision_resolution": 1024, "vision_outputs": ALL}),
        (8, {**EYES, "vision_resolution": 1024, "vision_outputs": ["depth"]}),
        (8, {**EYES, "vision_resolution": 1024, "vision_outputs": ["gray"]}),
        (8, {**EYES, "vision_resolution": 1024, "autoreset_mode": "SameStep", "max_episode_steps": 1}),
        (8, {**EYES, "vision_resolution": 1024, "vision_lazy": True}),
        (600, {"config": "self_touch", "threads": 2}),
        (300, {"config": "self_touch", "threads": 2, "touch_scale": 0.5}),
        (300, {"config": "reach", "threads": 2}),
    ],
)
def test_what_a_vector_says_is_what_it_takes(count: int, keys: dict[str, Any]) -> None:
    command = [sys.executable, "-c", CHILD, str(count), json.dumps(keys)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=600)
    assert done.returncode == 0, done.stderr
    said, took = json.loads(done.stdout)
    print(f"{count} {keys}: said {said / 1e6:.0f} MB, took {took / 1e6:.0f} MB")
    # what Python and the allocator keep beside it
    slack = 0.2 * said + 8e6
    assert took - said < slack
    # the spaces of Gymnasium before 1.0 keep fewer copies of pictures than are foreseen
    if int(gymnasium.__version__.split(".")[0]) >= 1:
        assert said - took < slack


def test_far_too_many_are_refused_at_once() -> None:
    begin = time.perf_counter()
    for config in ("hand_regard", SMALL):
        with pytest.raises(MemoryError, match="1000000000 environments would take"):
            babybench.VectorEnv(config, 10**9)
    assert time.perf_counter() - begin < 10
