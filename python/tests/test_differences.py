"""Infants who differ: z-scores, preterm infants and populations, as keys of Python's environments."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from conftest import SMALL

import babybench
import babybench.data

INFANT = {**SMALL, "touch_active": False}


def mass(env):
    """MIMo's mass, kg; the scene's other bodies are the same in all of them."""
    return float(env.array("body_mass").sum())


def test_keys_of_an_infant_are_those_of_any_configuration():
    light, heavy = (babybench.make(INFANT, age=6, sex="girl", length_z=1, weight_z=z) for z in (-1, 1))
    # 7.297 kg, L -0.0756, S 0.12204: the medians of the WHO at six months
    scale = [(1 - 0.0756 * 0.12204 * z) ** (1 / -0.0756) * 7.297 for z in (-1, 1)]
    assert mass(heavy.unwrapped) - mass(light.unwrapped) == pytest.approx(scale[1] - scale[0], abs=1e-6)
    assert light.unwrapped.config["sex"] == "girl"
    early = babybench.make(INFANT, age=1, sex="boy", gestation=30).unwrapped
    assert mass(early) < mass(babybench.make(INFANT, age=1, sex="boy").unwrapped)
    # his z-scores stay while he grows
    before = mass(heavy.unwrapped)
    heavy.reset(seed=0, options={"age": 9})
    assert mass(heavy.unwrapped) > before
    assert heavy.unwrapped.config["weight_z"] == 1.0


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"age": 6, "length_z": 1}, "set `sex: boy`"),
        ({"sex": "boy"}, "`age` is none"),
        ({"age": 6, "sex": "boy", "weight_z": 4}, "from -3 to 3"),
        ({"age": 0.25, "sex": "boy", "gestation": 24}, "must be 0, or at least 0.69"),
        ({"age": 6, "body_number": 3}, "set `body_random`"),
    ],
)
def test_keys_that_do_not_fit_say_why(keys, message):
    with pytest.raises(ValueError, match=message):
        babybench.make(INFANT, **keys)


def test_environments_of_a_vector_are_infants_of_a_population():
    envs = babybench.VectorEnv(INFANT, 5, age=3, body_random=1)
    assert [config["body_number"] for config in envs.configs] == list(range(5))
    masses = [float(envs.array(env, "body_mass").sum()) for env in range(5)]
    assert len(set(masses)) == 5
    observations, _ = envs.reset(seed=0)
    alone = babybench.make(INFANT, age=3, body_random=1, body_number=3)
    observation, _ = alone.reset(seed=3)
    np.testing.assert_array_equal(observations["observation"][3], observation["observation"])
    other = pickle.loads(pickle.dumps(envs))
    assert [float(other.array(env, "body_mass").sum()) for env in range(5)] == masses


def test_records_have_the_infant_as_their_subject(tmp_path):
    env = babybench.make(INFANT, age=6, sex="boy", weight_z=-1, max_episode_steps=4)
    with babybench.data.Recorder(env, tmp_path / "record") as recorder:
        recorder.reset(seed=0)
        for _ in range(4):
            recorder.step(np.zeros(env.action_space.shape, np.float32))
    record = babybench.data.open(tmp_path / "record")
    infant = record.manifest["infant"]
    assert (infant["sex"], infant["weight_z"], infant["length_z"]) == ("boy", -1.0, 0.0)
    # the median length of boys
    assert infant["length"] == pytest.approx(0.676236, abs=1e-9)
    pynwb = pytest.importorskip("pynwb")
    record.to_nwb(tmp_path / "r.nwb")
    with pynwb.NWBHDF5IO(tmp_path / "r.nwb", "r") as io:
        subject = io.read().subject
        assert (subject.sex, subject.weight) == ("M", f"{infant['weight']:.3f} kg")
