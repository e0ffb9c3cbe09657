"""Decides whether this package or an installed MIMo provides ``mimoEnv``. It is small because every Python process may import it.

``BABYBENCH_MIMO=babybench`` selects this package, ``BABYBENCH_MIMO=original`` selects MIMo. Without the variable, this package
serves if it was imported before ``mimoEnv`` or MIMo is not installed. Otherwise MIMo serves, with a warning.
"""

from __future__ import annotations

import os
import sys

TYPE_CHECKING = False  # typing itself takes fifty times longer to import than this module
if TYPE_CHECKING:
    from importlib.machinery import ModuleSpec
    from typing import Any

CHOICE = "BABYBENCH_MIMO"
"""The variable that decides: ``babybench`` or ``original``."""
MIMO = (
    *("mimoActuation", "mimoEnv", "mimoGrowth", "mimoProprioception", "mimoTouch", "mimoVestibular", "mimoVision"),
    "mimo_infant",
)
"""Packages of MIMo 2, and that of MIMo 3."""

_SERVED_BY_MIMO = (
    "{name} is MIMo's own ({folder}): MuJoCo runs these environments, not the engine of babybench. To run them on it, import "
    "babybench before mimoEnv, or start with `python -m babybench_core run SCRIPT`, or set {choice}=babybench; "
    "{choice}=original keeps MIMo and this message away"
)
_TREES = os.path.join(os.path.dirname(__file__), "standins", "")
_told = False


def is_own(module: Any) -> bool:
    """Returns whether a module of MIMo's name is this package's."""
    return (getattr(module, "__file__", None) or "").startswith(_TREES)


def chosen(claimed: bool) -> bool:
    """Returns whether this package serves: by the variable, or else by ``claimed``.

    Raises:
        ImportError: The variable has an unknown value.
    """
    choice = os.environ.get(CHOICE, "")
    if choice not in ("", "babybench", "original"):
        raise ImportError(f"{CHOICE} is {choice!r}, expected babybench or original")
    return choice == "babybench" or (claimed and not choice)


def tell(name: str, folder: str | None) -> None:
    """Warns once that an installed MIMo is used, unless the user requested it."""
    global _told
    if _told or os.environ.get(CHOICE) == "original":
        return
    _told = True
    import warnings

    warnings.warn(_SERVED_BY_MIMO.format(name=name, folder=folder, choice=CHOICE), stacklevel=4)


class Swap:
    """Finds the modules of MIMo's names before any other finder does.

    Attributes:
        claimed: Whether this package was imported before any of them.
    """

    claimed = False

    def find_spec(self, name: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        """Returns the module of the chosen package; ``None`` leaves the search to other finders."""
        return find(name) if name in MIMO else None


_swap = Swap()


def find(name: str) -> ModuleSpec | None:
    """Returns one of MIMo's modules, this package's or MIMo's own; ``None`` if MIMo is selected but not installed."""
    from babybench_kit import standin

    present = [sys.modules[other] for other in MIMO if other in sys.modules]
    # the package that came first serves all: modules of both would not know each other's classes
    if is_own(present[0]) if present else chosen(_swap.claimed):
        return standin.own(name)
    real = standin.real(name)
    if real is not None:
        tell(name, os.path.dirname(real.origin or ""))
    return real


def watch() -> None:
    """Watches for imports of MIMo's modules from now on."""
    if _swap not in sys.meta_path:
        sys.meta_path.insert(0, _swap)


def claim() -> None:
    """Records that this package was imported; it serves from now on, unless MIMo already does."""
    _swap.claimed = True
    watch()
    for name in MIMO:
        module = sys.modules.get(name)
        if module is not None and not is_own(module):
            tell(name, os.path.dirname(getattr(module, "__file__", None) or ""))
            return
