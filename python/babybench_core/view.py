"""Environments in a browser: a page on this machine, or in a notebook, with the live environment behind it."""

from __future__ import annotations

import html
import threading
from collections.abc import Mapping
from types import TracebackType
from typing import Any, Callable, Optional, Union

import gymnasium
import numpy as np
import numpy.typing as npt

from babybench_core import _native
from babybench_core.env import Env, make
from babybench_core.noise import ActionNoise
from babybench_core.notebook import NotebookOutput

__all__ = ["View", "view"]

Action = npt.NDArray[np.float32]
Policy = Union[None, str, ActionNoise, Callable[[Mapping[str, Any]], npt.ArrayLike]]
"""A source of actions: nothing, a noise or its name, or a function of the observation."""


def chooser(env: Env, policy: Policy) -> Callable[[Mapping[str, Any]], npt.ArrayLike]:
    """Returns a policy as a function of the observation.

    Raises:
        TypeError: ``policy`` is not a policy.
    """
    if isinstance(policy, str):
        policy = ActionNoise(policy, env)
    if isinstance(policy, ActionNoise):
        noise = policy
        return lambda _: noise()
    if policy is None:
        still = np.zeros(env.action_space.shape, np.float32)
        return lambda _: still
    if not callable(policy):
        raise TypeError(f"expected a function of the observation, a noise or its name, got {type(policy).__name__}")
    return policy


class View:
    """A page on which users see an environment, turn the camera, pull bodies with a spring, and pause or change the speed.

    A program either steps the environment itself and calls :meth:`show` after each step, or lets :meth:`play` or :meth:`start` do
    both. Pictures are drawn when a browser asks for one; a view without an open page draws nothing. In a notebook a view
    that ends a cell is the page. If the browser does not reach the machine of the kernel, pictures replace it after three
    seconds, up to five per second, sent through the notebook. :func:`babybench.film` makes a recording, which also plays later.

    Example:
        >>> import babybench
        >>> env = babybench.make("self_touch", vision_active=False)
        >>> observation, info = env.reset(seed=0)
        >>> with babybench.view(env) as view:
        ...     view.url.startswith("http://127.0.0.1:")
        True

    Attributes:
        url: The address of the page, on this machine alone, with a secret token. From another machine, forward
            its port: ``ssh -L PORT:127.0.0.1:PORT``.
    """

    def __init__(
        self, env: gymnasium.Env[Any, Any], *, port: int = 0, title: Optional[str] = None, height: int = 480
    ) -> None:
        """Opens a page for an environment.

        Args:
            env: An environment of this package, or wrappers around one.
            port: The port of the page; 0 is any free port.
            title: The title above the picture; by default the behavior and the scene.
            height: Pixels of the frame in a notebook.

        Raises:
            TypeError: ``env`` is not an environment of this package.
            OSError: The port is taken.
        """
        inside = env.unwrapped
        if not isinstance(inside, Env):
            raise TypeError(f"expected an environment of babybench, got {type(inside).__name__}")
        self.env = env
        self._inside = inside
        self._native = _native.View(title or f"{inside.config['behavior']} in {inside.config['scene']}", port)
        self.url = self._native.url
        self._height = height
        self._output: Optional[NotebookOutput] = None
        self._thread: Optional[threading.Thread] = None
        self._stop = threading.Event()
        self._error: Optional[BaseException] = None
        self._ready = False

    @property
    def running(self) -> bool:
        """Whether :meth:`start` keeps the environment alive."""
        return self._thread is not None and self._thread.is_alive()

    def show(self) -> bool:
        """Shows the environment after the program's step, and returns when it is time for the next.

        While no page is open it returns immediately: a closed or hidden page does not hold up the program, even if it is paused.

        Returns:
            Whether a new episode was requested (the button "Start again").
        """
        self._stepped()
        if not self._native.watched:
            return False
        core = self._inside._core
        if self._ready:
            self._native.stepped(core, self._inside.dt)
        self._ready = True
        while (what := self._native.attend(core)) == "wait":
            pass
        if what == "reset":
            self._ready = False
        return what == "reset"

    def play(self, policy: Policy = None, *, episodes: Optional[int] = None) -> None:
        """Keeps the environment alive, one episode after another, until it is interrupted (Ctrl-C, or a notebook's stop button).

        Args:
            policy: The policy that moves MIMo: a function of the observation, a noise (``"held"``, ``"pink"``, ...), or nothing.
            episodes: The number of episodes; unlimited by default.
        """
        try:
            self._play(chooser(self._inside, policy), episodes)
        except KeyboardInterrupt:
            if episodes is not None:
                raise

    def start(self, policy: Policy = None) -> View:
        """Does the same as :meth:`play` in a separate thread, until :meth:`stop`.

        Meanwhile the environment belongs to the view.
        """
        self.stop()
        self._stop.clear()
        choose = chooser(self._inside, policy)
        self._thread = threading.Thread(target=self._run, args=(choose,), name="babybench view", daemon=True)
        self._thread.start()
        return self

    def stop(self) -> None:
        """Returns control of the environment to the program; the page pauses.

        Raises:
            Exception: An exception that the policy or the environment raised meanwhile.
        """
        thread, self._thread = self._thread, None
        self._stop.set()
        if thread is not None and thread is not threading.current_thread():
            thread.join()
        error, self._error = self._error, None
        if error is not None:
            raise error

    def close(self) -> None:
        """Stops, and closes the page. The environment stays open."""
        try:
            self.stop()
        finally:
            self._native.close()

    def _run(self, choose: Callable[[Mapping[str, Any]], npt.ArrayLike]) -> None:
        try:
            self._play(choose, None)
        except Exception as error:  # raised again by stop()
            self._error = error

    def _play(self, choose: Callable[[Mapping[str, Any]], npt.ArrayLike], episodes: Optional[int]) -> None:
        core, still = self._inside._core, np.zeros(self._inside.action_space.shape, np.float32)
        observation, _ = self.env.reset()
        self._native.restarted(core)
        done = 0
        while not self._stop.is_set() and (episodes is None or done < episodes):
            what = self._native.attend(core)
            if what == "wait":
                continue
            over = what == "reset"
            if not over:
                action = choose(observation) if self._native.moves else still
                observation, _, terminated, truncated, _ = self.env.step(np.asarray(action, np.float32))
                self._native.stepped(core, self._inside.dt)
                self._stepped()
                over = terminated or truncated
            if over:
                done += 1
                observation, _ = self.env.reset()
                self._native.restarted(core)

    def _stepped(self) -> None:
        """Tells the notebook that there is something new to see."""
        if self._output is not None:
            self._output.update(self._native.watched)

    def _ipython_display_(self) -> None:
        """Shows the page in a notebook, or pictures if no browser reaches it."""
        note = (
            "<small>This browser does not reach the machine of the kernel, so pictures come through the notebook. To turn the "
            f"camera and pull MIMo, forward port {self._port()} and run the cell again.</small>"
        )
        height = min(int(self._height), 480)
        size = (4 * height // 3, height)
        page = f"<div>{self._repr_html_()}</div>"  # IPython warns of HTML that starts with a frame
        self._output = NotebookOutput(page, note, lambda: self._inside.picture("closeup", *size))

    def _repr_html_(self) -> str:
        """Returns the page in a frame, for notebooks."""
        url = html.escape(self.url, quote=True)
        style = f"width:100%;height:{int(self._height)}px;border:0;border-radius:8px"
        return f'<iframe src="{url}" title="BabyBench" style="{style}"></iframe>'

    def _port(self) -> str:
        return self.url.split("/")[2].rpartition(":")[2]

    def __repr__(self) -> str:
        return f"<babybench.View of {self._inside!r} at {self.url}>"

    def __enter__(self) -> View:
        return self

    def __exit__(
        self, kind: Optional[type[BaseException]], error: Optional[BaseException], trace: Optional[TracebackType]
    ) -> None:
        self.close()


def view(
    env: Union[gymnasium.Env[Any, Any], str, Mapping[str, Any]] = "self_touch",
    policy: Policy = None,
    *,
    port: int = 0,
    title: Optional[str] = None,
    height: int = 480,
) -> View:
    """Opens a page that shows an environment, for a browser of this machine or a notebook.

    In a notebook ``babybench.view("self_touch", "held")`` at the end of a cell shows MIMo alive, and ``view.stop()`` gives his
    environment back.

    Args:
        env: An environment that the program steps; or the arguments of :func:`babybench.make`, for an environment that
            steps itself (:meth:`View.start`).
        policy: The policy that moves MIMo. With one the environment also steps itself: see :meth:`View.play`.
        port: See :class:`View`.
        title: See :class:`View`.
        height: See :class:`View`.

    Raises:
        TypeError: ``env`` is not an environment of this package.
        OSError: The port is taken.
    """
    made = isinstance(env, (str, Mapping))
    shown = View(make(env) if made else env, port=port, title=title, height=height)  # type: ignore[arg-type]
    return shown.start(policy) if made or policy is not None else shown
