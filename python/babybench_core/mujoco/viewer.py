"""``mujoco.viewer``: a page on this machine that shows a state while a program steps it, of an environment or of any model."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import Any

from .. import _native
from .data import MjData
from .functions import mj_forward, mj_resetData, mj_step
from .jacobians import check
from .model import MjModel, is_compiled
from .window import Window, run

__all__ = ["Handle", "Window", "launch", "launch_from_path", "launch_passive"]


def _core(model: Any, data: Any) -> Any:
    """Returns the environment beneath a state, or ``None`` for one of a model without an environment.

    Raises:
        TypeError: It is neither, or the state of another model.
    """
    if is_compiled(model) and isinstance(data, MjData):
        check(model, data)
        return None
    sync = getattr(data, "__dict__", {}).get("_sync")
    if sync is None or data.model is not model:
        raise TypeError(
            "mujoco.viewer shows an MjModel with its MjData, or env.model and env.data of one environment, not "
            f"{type(model).__name__} and {type(data).__name__}"
        )
    return sync.core


class Handle:
    """A page that shows an environment.

    Attributes:
        url: The address of the page, on this machine alone.
    """

    def __init__(self, model: Any, data: Any, port: int = 0) -> None:
        """Opens the page."""
        self._env = _core(model, data)
        self._data = data
        self._page: _native.View | None = _native.View("mujoco.viewer", port)
        self._shown = float(data.time)
        self.url = self._page.url
        print(f"mujoco.viewer: {self.url}")

    def is_running(self) -> bool:
        """Returns whether the page is open, which it is until :meth:`close`."""
        return self._page is not None

    def sync(self) -> None:
        """Shows what the program has written and stepped since, at real time while a browser shows the page."""
        if self._page is None or not self._page.watched:
            return
        self._env.pull()
        now = float(self._data.time)
        if now > self._shown:
            self._page.stepped(self._env.engine, now - self._shown)
        self._shown = now
        while self._page.attend(self._env.engine) == "wait":
            pass

    def close(self) -> None:
        """Closes the page."""
        self._page = None

    @contextlib.contextmanager
    def lock(self) -> Iterator[None]:
        """Does nothing: the page reads the state in :meth:`sync` alone."""
        yield

    def __enter__(self) -> Handle:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(
            f"{name}: the page of this viewer has its own camera and no such setting; install mujoco (pip install mujoco) for "
            "MuJoCo's own viewer"
        )


def _refuse(given: dict[str, Any]) -> None:
    found = [name for name, value in given.items() if value is not None]
    if found:
        raise NotImplementedError(
            f"mujoco.viewer: {', '.join(found)} is not served by the page that stands in for MuJoCo's window"
        )


def launch_passive(
    model: Any,
    data: Any,
    *,
    key_callback: Callable[[int], None] | None = None,
    show_left_ui: bool = True,
    show_right_ui: bool = True,
) -> Handle | Window:
    """Opens a page for a state that the program steps, and prints its address.

    The picture is drawn in ``sync()``, in the thread of the program, when a browser waits for one. Otherwise nothing is drawn.

    Args:
        model: The model, or ``env.model`` of an environment.
        data: Its state, or ``env.data``.
        key_callback: Called in ``sync()`` with GLFW's code of a key pressed on the page. Pages of environments have their
            own keys, so it must be ``None`` for them.
        show_left_ui: Has no effect: the page has its own controls.
        show_right_ui: Has no effect.

    Raises:
        TypeError: ``data`` is no state of ``model``.
        NotImplementedError: A callback for an environment.
    """
    if _core(model, data) is None:
        return Window(model, data, key_callback)
    _refuse({"key_callback": key_callback})
    return Handle(model, data)


def launch(
    model: Any = None,
    data: Any = None,
    *,
    loader: Callable[[], tuple[Any, ...]] | None = None,
    show_left_ui: bool = True,
    show_right_ui: bool = True,
) -> None:
    """Opens a page and steps the state in real time until the page is closed or the program is interrupted (Ctrl-C).

    Args:
        model: The model, or ``env.model`` of an environment.
        data: Its state; a new one by default.
        loader: A function that returns the model and the state, instead of them.
        show_left_ui: Has no effect: the page has its own controls.
        show_right_ui: Has no effect.

    Raises:
        TypeError: There is no model, or ``data`` is no state of it.
    """
    if loader is not None:
        if model is not None or data is not None:
            raise TypeError("mujoco.viewer.launch takes a model and a state, or a loader, not both")
        model, data = loader()[:2]
    if data is None and is_compiled(model):
        data = MjData(model)
    with contextlib.suppress(KeyboardInterrupt):
        if _core(model, data) is None:
            mj_forward(model, data)
            with Window(model, data, controls=True) as window:
                run(window, lambda: mj_step(model, data), lambda: _restart(model, data))
            return
        with Handle(model, data) as handle:
            while handle.is_running():
                handle._env.physics_step()
                handle.sync()


def launch_from_path(path: str, *, show_left_ui: bool = True, show_right_ui: bool = True) -> None:
    """Opens a page for the model of a file: see :func:`launch`."""
    launch(MjModel.from_xml_path(path), show_left_ui=show_left_ui, show_right_ui=show_right_ui)


def _restart(model: MjModel, data: MjData) -> None:
    mj_resetData(model, data)
    mj_forward(model, data)
