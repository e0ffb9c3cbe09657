"""Evaluation of trained policies: ``babybench.eval``."""

from __future__ import annotations

import pickle
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .pictures import evaluation_img, evaluation_video

Record = dict[str, Any]

_MOST = 10_001
"""Number of records that count, plus the one that does not."""

_PARTS_OF_BODY = 34
"""Number of parts of MIMo v1 that a hand is scored for."""


class Eval:
    """Follows the evaluation of a policy, and writes the files to submit.

    Args:
        env: The environment.
        duration: Steps of an episode; only the caller uses it.
        render: Whether each episode becomes a video.
        save_dir: The folder of the run.
    """

    _panel = "side2"

    def __init__(self, env: Any, duration: int | None = None, render: bool = False, save_dir: str = "results") -> None:
        """Takes the environment."""
        self._env, self._duration, self._render, self._save_dir = env, duration, render, save_dir
        self._images: list[Any] = []
        self._init_track()

    def reset(self) -> None:
        """Begins an episode."""
        self._images = []
        self._init_track()

    def _init_track(self) -> None:
        self._trajectories: dict[str, list[Any]] = {"qpos": [], "info": []}

    def _eval_logs(self, logs: Sequence[Record]) -> float | None:
        """Returns the score of a training log; ``None`` without a behavior."""
        return None

    def eval_logs(self) -> None:
        """Prints the preliminary score of the training log in ``save_dir``."""
        path = Path(self._save_dir) / "logs" / "training.pkl"
        try:
            with path.open("rb") as file:
                logs = pickle.load(file)
        except FileNotFoundError:
            print(f"Training logs not found ({path}) -- make sure to use the correct save_dir in the config")
            return
        print(f"Preliminary training score: {self._eval_logs(logs)}")

    def track(self, info: Record) -> None:
        """Adds a step to the trajectory."""
        self._trajectories["qpos"].append(self._env.unwrapped.data.qpos.copy())
        self._trajectories["info"].append(info)

    def _render_image(self) -> None:
        self._images.append(evaluation_img(self._env, up=self._panel))

    def eval_step(self, info: Record) -> None:
        """Follows a step: call it after each ``env.step`` with the information that it returned."""
        self.track(info)
        if self._render:
            self._render_image()

    def end(self, episode: int = 0) -> None:
        """Writes ``logs/evaluation_<episode>.pkl``, and ``videos/evaluation_<episode>.avi`` when rendering."""
        folder = Path(self._save_dir)
        for name in ("logs", "videos"):
            (folder / name).mkdir(parents=True, exist_ok=True)
        with (folder / "logs" / f"evaluation_{episode}.pkl").open("wb") as file:
            pickle.dump(self._trajectories, file, -1)
        if self._render:
            evaluation_video(self._images, folder / "videos" / f"evaluation_{episode}.avi")


def _counted(logs: Sequence[Record]) -> Sequence[Record]:
    """Returns the records that count: the last ten thousand, without the oldest one, which belongs to no episode."""
    count = min(_MOST, len(logs)) - 1
    return logs[len(logs) - count :] if count > 0 else []


class EvalSelfTouch(Eval):
    """Evaluates self-touch: how many parts of the body each hand has touched."""

    _panel = "touches_with_hands"

    def _eval_logs(self, logs: Sequence[Record]) -> float:
        touched = [set[int](), set[int]()]
        for record in _counted(logs):
            for parts, key in zip(touched, ("right_hand_touches", "left_hand_touches")):
                parts.update(record[key])
        return sum(map(len, touched)) / (2 * _PARTS_OF_BODY)


class EvalHandRegard(Eval):
    """Evaluates hand regard: for how much of the time each eye had each hand in view."""

    _panel = "binocular"
    _PAIRS = ("right_eye_right_hand", "left_eye_right_hand", "right_eye_left_hand", "left_eye_left_hand")

    def _eval_logs(self, logs: Sequence[Record]) -> float:
        records = _counted(logs)
        steps = sum(record["steps"] for record in records)
        if steps == 0:
            raise ValueError("the training log has no steps that count: train for at least two episodes")
        regards: int = sum(record[pair] for record in records for pair in self._PAIRS)
        return regards / float(4 * steps)


EVALS: dict[str, type[Eval]] = {"none": Eval, "self_touch": EvalSelfTouch, "hand_regard": EvalHandRegard}
"""The evaluation of each behavior."""
