"""Records of runs: folders with a description and a NumPy archive for each episode.

``babybench run --record DIR``, ``babybench evaluate --record DIR`` and :class:`Recorder` make them. Two lines read one
without this module::

    import numpy
    episode = numpy.load("DIR/episode_0.npz")

With it::

    import babybench.data
    record = babybench.data.open("DIR")
    record[0]["qpos"]           # (T, nq)
    record[0].touch(17)         # what the whole skin felt in step 17
    record[0].to_pandas()       # a row for each step, if pandas is installed
    record.to_parquet("record.parquet")     # to_hdf5, to_nwb, to_rerun, to_tensorboard, to_minari: each behind an extra
"""

from __future__ import annotations

import builtins
import json
import warnings
import weakref
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np

from babybench_core.export.methods import Exports

__all__ = ["Episode", "Record", "Recorder", "open"]

_MODEL = "model."
"""Prefix of the names of changed arrays of the model."""

_RECENT = 2
"""Number of episodes that a record keeps, with the arrays that were read from them."""

FORMAT = "babybench record"
VERSION = 1


class Episode(Mapping[str, np.ndarray]):
    """An episode of a record: arrays by name, read on first use.

    Arrays of steps have a row for each step; ``record.manifest["arrays"]`` describes each array. Touch and contacts are
    sparse: :meth:`touch` and :meth:`contacts` return those of a step.
    """

    def __init__(self, record: Record, path: Path, description: Mapping[str, Any]) -> None:
        """Reads the names of the arrays. Programs get episodes from :func:`open` and ``record[number]``."""
        self.record = record
        self.path = path
        self.description = description
        self.manifest: Mapping[str, Any] = record.manifest
        with np.load(path, allow_pickle=False) as archive:
            self._names: list[str] = archive.files
        self._read: dict[str, np.ndarray] = {}

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._read:
            if name not in self._names:
                there = ", ".join(self._names)
                raise KeyError(f"{self.path}: no array {name!r}; there are {there}")
            # nothing keeps the file open: an episode has no end at which to close it
            with np.load(self.path, allow_pickle=False) as archive:
                self._read[name] = archive[name]
        return self._read[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    @property
    def number(self) -> int:
        """The number of the episode."""
        return int(self.description["episode"])

    @property
    def steps(self) -> int:
        """The number of steps."""
        return int(self.description["steps"])

    @property
    def finished(self) -> bool:
        """Whether the episode was ended. Otherwise the program dropped the recorder, or ended, during the episode."""
        return not self.description.get("unfinished", False)

    @property
    def model(self) -> dict[str, np.ndarray]:
        """A program's changes to the model before the episode, as ``env.change_model`` takes them."""
        wanted = [name for name in self._names if name.startswith(_MODEL)]
        if not wanted:
            return {}
        env = self.record.environment(**self._grown)
        found = {}
        for name in wanted:
            shape = np.shape(env.array(name[len(_MODEL) :]))
            found[name[len(_MODEL) :]] = self[name].reshape(shape)
        return found

    @property
    def _grown(self) -> dict[str, Any]:
        """The age and the number of the infant, as keys of the configuration, if they differ from the record's."""
        return {key: self.description[key] for key in ("age", "body_number") if key in self.description}

    @property
    def info(self) -> dict[str, Any]:
        """The information of the last step."""
        return dict(self.description["info"])

    def _span(self, name: str, step: int) -> slice:
        if not -self.steps <= step < self.steps:
            raise IndexError(f"step {step} of an episode of {self.steps} steps")
        ends = self[name]
        at = step % self.steps
        return slice(int(ends[at]), int(ends[at + 1]))

    def touch(self, step: int) -> np.ndarray:
        """Returns the touch observation of a step, N, shape (touch_len,)."""
        out = np.zeros(int(self["touch_len"]), np.float32)
        span = self._span("touch_ptr", step)
        out[self["touch_idx"][span]] = self["touch_val"][span]
        return out

    def contacts(self, step: int) -> dict[str, Any]:
        """Returns the contacts of a step: names of both parts, positions, distances and forces."""
        span = self._span("contact_ptr", step)
        geoms = self["contact_geom"][span]
        parts = [tuple(self.manifest["geoms"][int(geom)]["part"] for geom in pair) for pair in geoms]
        return {
            "geom": geoms,
            "part": parts,
            "pos": self["contact_pos"][span],
            "dist": self["contact_dist"][span],
            "force": self["contact_force"][span],
        }

    def __repr__(self) -> str:
        return f"<Episode {self.number} of {self.record.folder}: {self.steps} steps>"

    def _columns(self) -> dict[str, np.ndarray]:
        """Returns the numbers of each step by name: time, angles, velocities, actions, reward, touch by region."""
        from babybench_core.export.signals import signals

        columns = {"time": self["time"]}
        for signal in signals(self):
            columns.update(signal.columns())
        return columns

    def to_pandas(self) -> Any:
        """Returns a pandas ``DataFrame``: a row for each step, the time as its index.

        Raises:
            ModuleNotFoundError: pandas is not installed.
        """
        import pandas as pd

        return pd.DataFrame(self._columns()).set_index("time")

    def to_xarray(self) -> Any:
        """Returns an xarray ``Dataset``: angles and velocities by time and joint, actions by time and actuator.

        Raises:
            ModuleNotFoundError: xarray is not installed.
        """
        import xarray as xr

        joints = self.manifest["joints"]
        qpos, dofs = [j["qpos"] for j in joints], [j["dof"] for j in joints]
        return xr.Dataset(
            {
                "angle": (("time", "joint"), self["qpos"][:, qpos], {"units": "rad"}),
                "velocity": (("time", "joint"), self["qvel"][:, dofs], {"units": "rad/s"}),
                "action": (("time", "actuator"), self["actions"]),
                "reward": (("time",), self["reward"]),
            },
            coords={
                "time": ("time", self["time"], {"units": "s"}),
                "joint": [j["name"] for j in joints],
                "actuator": list(self.manifest["actions"]),
            },
            attrs={"policy": self.manifest["policy"], "babybench": self.manifest["babybench"]},
        )


class Record(Exports, Mapping[int, Episode]):
    """A record: episodes by number, and the description of everything in :attr:`manifest`."""

    def __init__(self, folder: Union[str, Path]) -> None:
        """Reads the description; see :func:`open`."""
        self.folder = Path(folder)
        path = self.folder / "manifest.json"
        if not path.is_file():
            hint = (
                " (a training's log is read by `babybench report` and figures)"
                if (self.folder / "logs").is_dir()
                else ""
            )
            raise FileNotFoundError(f"{self.folder}: there is no record, as it has no manifest.json{hint}")
        with builtins.open(path, encoding="utf-8") as file:
            try:
                manifest = json.load(file)
            except ValueError as error:
                raise ValueError(f"{path}: not a record of babybench: {error}") from None
        if not isinstance(manifest, dict) or manifest.get("format") != FORMAT:
            raise ValueError(f"{path}: no record of babybench")
        if manifest["version"] > VERSION:
            raise ValueError(f"{path}: a record of version {manifest['version']}; this babybench reads up to {VERSION}")
        self.manifest: dict[str, Any] = manifest
        self._descriptions = {int(e["episode"]): e for e in manifest["episodes"]}
        self._recent: dict[int, Episode] = {}

    def __getitem__(self, episode: int) -> Episode:
        if episode in self._recent:
            return self._recent[episode]
        if episode not in self._descriptions:
            there = ", ".join(map(str, self._descriptions)) or "none"
            raise KeyError(f"{self.folder}: no episode {episode}; there are {there}")
        description = self._descriptions[episode]
        name = description["file"]
        if Path(name).name != name:
            raise ValueError(f"{self.folder}: {name!r} is not the name of a file in this folder")
        while len(self._recent) >= _RECENT:
            del self._recent[next(iter(self._recent))]
        found = self._recent[episode] = Episode(self, self.folder / name, description)
        return found

    def __iter__(self) -> Iterator[int]:
        return iter(self._descriptions)

    def __len__(self) -> int:
        return len(self._descriptions)

    def __repr__(self) -> str:
        return f"<Record {self.folder}: {len(self)} episodes>"

    def skin(self) -> dict[str, np.ndarray]:
        """Returns the places of the touch sensors: ``body`` (N), ids, and ``position`` (N, 3) in the frames of the bodies, m."""
        with np.load(self.folder / "skin.npz", allow_pickle=False) as archive:
            return {name: archive[name] for name in archive.files}

    @property
    def has_skin(self) -> bool:
        """Whether there are touch sensors."""
        return (self.folder / "skin.npz").is_file()

    @cached_property
    def bodies(self) -> list[str]:
        """The names of the bodies of the scene, by id."""
        names = self.manifest.get("bodies")
        if names is None:
            # a record from before manifests had them
            names = self.environment(touch_active=False)._core.blueprint.model_names["body"]
        return list(names)

    def environment(self, **keys: Any) -> Any:
        """Makes an environment of the record's configuration; keywords replace its keys.

        Raises:
            ValueError: An unknown key, or a value that is not allowed.
        """
        from babybench_core.env import Env

        return Env(self.manifest["configuration"], **keys)

    def repeat(self, episode: int) -> Iterator[tuple[Any, float, bool, bool, dict[str, Any]]]:
        """Repeats an episode and yields all observations, whether they were recorded or not.

        Yields:
            First the observation at the start with reward 0, then what each step returned, with the same bits; the arrays
            are fresh. They differ if the record does not replay with the same bits (``record.replay(episode)``).
        """
        recorded = self[episode]
        env = self.environment(**recorded._grown)
        env.change_model(recorded.model)
        core = env._core
        observation = core.resume(recorded["snapshot"].tobytes())
        yield observation, 0.0, False, False, core.info()
        for drawn, action in zip(recorded["drawn"], recorded["actions"]):
            # the policy's own random draws are not repeated
            core.draw_from(int(drawn))
            yield (*core.step(action), core.info())

    def motion(self, episode: int) -> dict[str, Any]:
        """Returns the motion of an episode, which :func:`babybench.data.play_motion` plays.

        It has ``names`` of joints, ``angles`` (T, joints), rad, ``rate``, Hz, and, where MIMo is free to move, ``root_pos``
        (T, 3), m, and ``root_quat`` (T, 4).
        """
        from babybench_core import motion

        return motion.of_episode(self, episode)

    def measure(self, episode: int | None = None) -> dict[str, Any]:
        """Returns the measures of an episode, or the means of all: touches, smoothness, symmetry, as the guide defines them."""
        from babybench_core import _native

        measures: dict[str, Any] = json.loads(_native.measure_record(self.folder, episode))
        return measures

    def movement(
        self,
        episode: int | None = None,
        *,
        fps: float = 25.0,
        band: tuple[float, float] = (0.1, 5.0),
        window: int = 1024,
        jitter: float = 0.0,
        seed: int = 0,
        frame: str = "world",
    ) -> dict[str, Any]:
        """Returns measures of how limbs and joints move in an episode, or the means of all, as the guide defines them.

        Args:
            episode: One episode; all by default.
            fps: Frame rate of the camera that films the movement, Hz.
            band: The band in which exponents are fitted, Hz.
            window: Frames of a window of the spectrum, a power of two.
            jitter: Standard deviation of the camera's error in each coordinate, mm.
            seed: Seed of these errors.
            frame: ``world``, or ``hip`` for movements relative to the trunk.

        Returns:
            ``values`` by name, without those that are undefined; ``options``, ``episodes`` and ``seconds``; and ``leading``, the
            segment that turned first in each roll.
        """
        from babybench_core import _native

        text = _native.movement_of_record(self.folder, episode, fps, band, window, jitter, seed, frame)
        found: dict[str, Any] = json.loads(text)
        return found

    def replay(self, episode: int) -> int | None:
        """Repeats an episode; returns the first step whose bits differ, ``None`` if all are the same."""
        from babybench_core import _native

        return _native.replay_record(self.folder, episode)


class Recorder:
    """Records an environment, episode by episode, into a new folder: resets and steps go through it.

    Example:
        >>> env = babybench.make("self_touch")
        >>> with babybench.data.Recorder(env, "record") as recorder:
        ...     observation, info = recorder.reset(seed=0)
        ...     observation, reward, terminated, truncated, info = recorder.step(env.action_space.sample())
    """

    def __init__(
        self,
        env: Any,
        folder: Union[str, Path],
        *,
        senses: bool = False,
        eyes_every: Optional[int] = None,
        policy: str = "",
    ) -> None:
        """Makes the folder.

        Args:
            env: A ``babybench.Env``, or a wrapper around one.
            folder: A folder without a record.
            senses: Whether every other sense is recorded as observed, too.
            eyes_every: Number of steps from one recorded observation of both eyes to the next.
            policy: Description of the policy.

        Raises:
            FileExistsError: The folder has a record.
            TypeError: ``env`` is not a ``babybench.Env``.
        """
        from babybench_core import _native
        from babybench_core.env import Env

        self.env = env.unwrapped
        if not isinstance(self.env, Env):
            raise TypeError(
                f"a Recorder records a babybench.Env, not a {type(self.env).__name__}; for a vector, record each environment"
            )
        self._native = _native.Recorder(self.env._core, Path(folder).absolute(), senses, eyes_every, policy)
        self._episode = -1
        self._touch = self.env.observation_space.spaces.get("touch")
        self._rescue = weakref.finalize(self, _rescue, self._native, self.env, str(folder))
        self.env._recorders.add(self)

    def reset(self, **options: Any) -> tuple[Any, dict[str, Any]]:
        """Ends the episode, resets the environment, and starts recording the next one.

        The record includes the age, and the changes to the model by ``options`` and :meth:`babybench.Env.change_model`.

        Raises:
            ValueError: The age changes the number of touch sensors: use ``touch_grows``.
        """
        self.end()
        observation, info = self.env.reset(**options)
        if self._touch != self.env.observation_space.spaces.get("touch"):
            raise ValueError("a record has one skin, but at this age its sensors differ: set touch_grows: True")
        self._episode += 1
        self._native.begin(self.env._core, self._episode)
        return observation, info

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Steps the environment, and records the result.

        Raises:
            RuntimeError: There was no :meth:`reset`.
        """
        if self._episode < 0:
            raise RuntimeError("no episode has begun: call the recorder's reset() before its step()")
        core = self.env._core
        observation, reward, terminated, truncated = self._native.step(core, action)
        return observation, reward, terminated, truncated, core.info()

    def end(self) -> None:
        """Writes the episode, if it has steps."""
        if self._episode >= 0 and not self.env._core.closed:
            self._native.end(self.env._core)

    close = end

    def __enter__(self) -> Recorder:
        return self

    def __exit__(self, *exception: object) -> None:
        self.end()


def _rescue(native: Any, env: Any, folder: str) -> None:
    """Writes the record of an episode that was not ended."""
    if not env._core.closed and native.end(env._core, unfinished=True):
        warnings.warn(
            f"a Recorder was given up in the middle of an episode: its steps are kept in {folder}, marked as unfinished; "
            "use `with Recorder(...)`, or call its end()",
            ResourceWarning,
            stacklevel=2,
        )


def open(folder: Union[str, Path]) -> Record:
    """Opens the record in a folder.

    Raises:
        FileNotFoundError: There is no record.
        ValueError: The description is damaged, or of a later version.
    """
    return Record(folder)
