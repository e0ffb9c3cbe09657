"""Figures for papers: learning curves with intervals, touch on the body, touches over time.

Each function returns a matplotlib figure (``pip install 'babybench[figures]'``), which can be changed before it is
saved; :func:`save` writes it as SVG, PDF and PNG with text that stays text::

    from babybench import data, figures

    figure = figures.learning_curves({"PPO": ["runs/ppo-0", "runs/ppo-1"], "noise": ["runs/noise-0", "runs/noise-1"]})
    figures.save(figure, "curves", ["svg", "pdf"])
    figures.touch_on_body({"first hour": data.open("early"), "last hour": data.open("late")})
    figures.touch_raster(data.open("late")[0])

``python -m babybench figures RESULTS --out DIR`` draws all that a folder has.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

from babybench_core.figures.style import FORMATS, library, look

if TYPE_CHECKING:
    from matplotlib.figure import Figure

from babybench_core.figures.body import touch_on_body
from babybench_core.figures.curves import benchmark_bars, learning_curves
from babybench_core.figures.raster import touch_raster

__all__ = ["benchmark_bars", "learning_curves", "save", "touch_on_body", "touch_raster"]


def save(figure: Figure, path: Union[str, Path], formats: Sequence[str] = ("svg", "pdf")) -> list[Path]:
    """Writes a figure under a name, with the ending of each format; returns the files.

    Args:
        figure: The figure.
        path: The name, without an ending.
        formats: ``svg``, ``pdf`` or ``png``.

    Raises:
        ValueError: The format does not exist.
    """
    for name in formats:
        if name not in FORMATS:
            raise ValueError(f"there is no format {name!r}; there are {', '.join(FORMATS)}")
    written = []
    for name in formats:
        # a name may have dots of its own
        file = Path(f"{path}.{name}")
        # without dates and random ids the same data give the same file
        metadata: dict[str, Any] = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(name, {})
        with library().rc_context(look()):
            figure.savefig(file, dpi=300, metadata=metadata)
        written.append(file)
    return written
