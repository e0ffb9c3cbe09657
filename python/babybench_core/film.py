"""Films of environments that play wherever a notebook is read, without a connection to its kernel."""

from __future__ import annotations

import base64
import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

import gymnasium
import numpy as np
import numpy.typing as npt

from babybench_core.env import Env, make
from babybench_core.view import Policy, chooser

if TYPE_CHECKING:
    from PIL.Image import Image

__all__ = ["Film", "film"]

Camera = Union[str, tuple[Sequence[float], float, float, float]]
FORMATS = {".webp": "WEBP", ".gif": "GIF", ".png": "PNG"}


class Film:
    """Pictures of an environment over time, which a notebook shows as a moving image.

    The image is part of the notebook: it plays in JupyterLab, JupyterHub, VS Code and Colab, wherever the kernel runs, and in a
    notebook that is read later. :func:`babybench.view` instead shows the live environment, but only to a browser that reaches the
    machine of the kernel.

    Example:
        >>> import babybench
        >>> env = babybench.make("self_touch", touch_active=False)
        >>> observation, info = env.reset(seed=0)
        >>> film = babybench.Film(env, width=160, height=120)
        >>> for _ in range(20):
        ...     observation, *rest = env.step(env.action_space.sample())
        ...     film.add()
        >>> film
        <babybench.Film: 2 pictures, 0.1 s>
    """

    def __init__(
        self,
        env: gymnasium.Env[Any, Any],
        *,
        camera: Camera = "closeup",
        width: int = 480,
        height: int = 360,
        fps: float = 20,
    ) -> None:
        """Starts an empty film.

        Args:
            env: An environment of this package, or wrappers around one.
            camera: As for :meth:`babybench.Env.picture`.
            width: Pixels.
            height: Pixels.
            fps: Pictures for each second of simulated time, at most 50. It plays in real time.

        Raises:
            TypeError: ``env`` is not an environment of this package.
            ValueError: ``fps`` is not in its range.
        """
        inside = env.unwrapped
        if not isinstance(inside, Env):
            raise TypeError(f"expected an environment of babybench, got {type(inside).__name__}")
        if not 0 < fps <= 50:
            raise ValueError(f"fps is {fps}, but must be above 0 and at most 50: image formats do not play faster")
        self._inside = inside
        self._camera, self._size, self._fps = camera, (width, height), fps
        self._pictures: list[npt.NDArray[np.uint8]] = []
        self._passed = 0.0
        self._next = 0.0

    def __len__(self) -> int:
        return len(self._pictures)

    def add(self) -> None:
        """Counts a step, and draws a picture if it is time for the next one."""
        if self._passed >= self._next - 1e-9:
            self._pictures.append(self._inside.picture(self._camera, *self._size))
            self._next += 1 / self._fps
        self._passed += self._inside.dt

    def save(self, path: Union[str, Path]) -> None:
        """Writes the film: ``.webp``, ``.gif``, or ``.png`` (animated).

        Raises:
            ValueError: The film is empty, or the format is unknown.
            ModuleNotFoundError: Pillow is not installed.
        """
        kind = FORMATS.get(Path(path).suffix.lower())
        if kind is None:
            raise ValueError(f"{path}: the name of a film ends in {', '.join(FORMATS)}")
        data = self._encoded(kind)
        Path(path).write_bytes(data)

    def _encoded(self, kind: str) -> bytes:
        if not self._pictures:
            raise ValueError("the film has no pictures: call add() after each step")
        first, *others = self._images()
        out = io.BytesIO()
        first.save(out, kind, save_all=True, append_images=others, duration=round(1000 / self._fps), loop=0)
        return out.getvalue()

    def _images(self) -> list[Image]:
        try:
            from PIL import Image
        except ModuleNotFoundError:
            raise ModuleNotFoundError("films need Pillow: pip install pillow") from None
        return [Image.fromarray(picture) for picture in self._pictures]

    def _repr_html_(self) -> str:
        """Returns the film as an image whose data is part of the text, for notebooks."""
        data = base64.b64encode(self._encoded("WEBP")).decode()
        width, height = self._size
        return f'<img src="data:image/webp;base64,{data}" width="{width}" height="{height}" alt="MIMo moves">'

    def __repr__(self) -> str:
        return f"<babybench.Film: {len(self)} pictures, {self._passed:.1f} s>"


def film(
    env: Union[gymnasium.Env[Any, Any], str, Mapping[str, Any]] = "self_touch",
    policy: Policy = None,
    *,
    seconds: float = 5,
    seed: Optional[int] = 0,
    camera: Camera = "closeup",
    width: int = 480,
    height: int = 360,
    fps: float = 20,
) -> Film:
    """Runs an environment and films it. At the end of a notebook's cell the film plays.

    Args:
        env: An environment, which is reset; or the arguments of :func:`babybench.make`.
        policy: The policy that moves MIMo: a function of the observation, a noise (``"held"``, ``"pink"``, ...), or nothing.
        seconds: Simulated time. If an episode ends earlier, another begins.
        seed: The seed of the first episode.
        camera: See :class:`Film`.
        width: See :class:`Film`.
        height: See :class:`Film`.
        fps: See :class:`Film`.

    Raises:
        TypeError: ``env`` is not an environment of this package.
        ValueError: ``fps`` is not in its range.
    """
    acting: gymnasium.Env[Any, Any] = make(env) if isinstance(env, (str, Mapping)) else env
    made_film = Film(acting, camera=camera, width=width, height=height, fps=fps)
    inside = made_film._inside
    choose = chooser(inside, policy)
    observation, _ = acting.reset(seed=seed)
    for _ in range(round(seconds / inside.dt)):
        observation, _, terminated, truncated, _ = acting.step(np.asarray(choose(observation), np.float32))
        made_film.add()
        if terminated or truncated:
            observation, _ = acting.reset()
    if acting is not env:
        acting.close()
    return made_film
