"""Functions of programs that MuJoCo calls: they can be read and reset, but not set."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

_CALLBACKS = (
    *("mjcb_act_bias", "mjcb_act_dyn", "mjcb_act_gain", "mjcb_contactfilter", "mjcb_control", "mjcb_passive"),
    *("mjcb_sensor", "mjcb_time", "mju_user_free", "mju_user_malloc"),
)
_warning: list[Any] = [None]

__all__ = ["get_mju_user_warning", "mj_resetCallbacks", "set_mju_user_warning"]
__all__ += [f"{verb}_{name}" for verb in ("get", "set") for name in _CALLBACKS]


def _getter(name: str) -> Callable[[], None]:
    def get() -> None:
        """Returns None: callbacks are not supported."""

    get.__name__ = get.__qualname__ = f"get_{name}"
    return get


def _setter(name: str) -> Callable[[Any], None]:
    def set(callback: Any) -> None:
        """Raises an error unless the callback is None."""
        if callback is not None:
            raise NotImplementedError(
                f"set_{name}: the engine calls no functions of programs; compute forces between steps, write "
                "them to data.ctrl or data.qfrc_applied, and call mj_step"
            )

    set.__name__ = set.__qualname__ = f"set_{name}"
    return set


for _name in _CALLBACKS:
    globals()[f"get_{_name}"], globals()[f"set_{_name}"] = _getter(_name), _setter(_name)


def get_mju_user_warning() -> Any:
    """Returns what :func:`set_mju_user_warning` was given last."""
    return _warning[0]


def set_mju_user_warning(callback: Any) -> None:
    """Keeps a function for warnings. It is never called: what MuJoCo warns of is an error here."""
    _warning[0] = callback


def mj_resetCallbacks() -> None:
    """Forgets the function for warnings."""
    _warning[0] = None
