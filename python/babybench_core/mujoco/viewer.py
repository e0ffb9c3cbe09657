"""``mujoco.viewer`` for environments: a page on this machine that shows ``env.data`` while a program steps it."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import Any

from .. import _native

__all__ = ["Handle", "launch", "launch_passive"]


def _core(model: Any, data: Any) -> Any:
    """Returns the environment beneath a state."""
    sync = getattr(data, "__dict__", {}).get("_sync")
    if sync is None or data.model is not model:
        raise NotImplementedError(
            "mujoco.viewer shows environments here: give it env.model and env.data of one environment. For other models "
            "draw pictures with mujoco.Renderer, or install mujoco (pip install mujoco)"
        )
    return sync.core


class Handle:
    """A page that shows a state.

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
) -> Handle:
    """Opens a page for a state that the program steps, and prints its address.

    Args:
        model: ``env.model`` of an environment.
        data: Its ``env.data``.
        key_callback: Must be ``None``: the page has keys of its own.
        show_left_ui: Not used: the page has its own.
        show_right_ui: Not used.

    Raises:
        NotImplementedError: Another model, or a callback.
    """
    _refuse({"key_callback": key_callback})
    return Handle(model, data)


def launch(model: Any = None, data: Any = None, *, show_left_ui: bool = True, show_right_ui: bool = True) -> None:
    """Opens a page and steps the state until the program is interrupted (Ctrl-C).

    Raises:
        NotImplementedError: The model does not belong to an environment.
    """
    with contextlib.suppress(KeyboardInterrupt), Handle(model, data) as handle:
        while handle.is_running():
            handle._env.physics_step()
            handle.sync()
