"""Touches over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional

import numpy as np
import numpy.typing as npt

from babybench_core.figures.style import HANDS, figure, library, look

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from babybench_core.data import Episode

_GAP = 0.1
"""Shorter gaps do not end a touch, s, as the guide defines it."""
_ROWS = ("head", "trunk", "arm", "hand", "leg", "foot")
"""Regions, from the top."""


def hand_touches(episode: Episode, side: str) -> dict[str, npt.NDArray[np.bool_]]:
    """Returns the steps in which a hand, the palm with its fingers, touches a region, by region and side (``own arm``).

    Touches of a hand by itself do not count.
    """
    geoms, steps = episode.manifest["geoms"], episode.steps
    number = np.repeat(np.arange(steps), np.diff(episode["contact_ptr"]))
    near = episode["contact_dist"] <= 0
    number, pairs = number[near], episode["contact_geom"][near].astype(int)
    hand = np.array([g["region"] == "hand" and g["side"] == side for g in geoms])
    found: dict[str, npt.NDArray[np.bool_]] = {}
    for one, other in ((0, 1), (1, 0)):
        mine = hand[pairs[:, one]] & ~hand[pairs[:, other]]
        for step, geom in zip(number[mine], pairs[mine, other]):
            region = geoms[geom]["region"]
            if region is None:
                continue
            whose = "" if geoms[geom]["side"] is None else "own " if geoms[geom]["side"] == side else "other "
            found.setdefault(region if region in ("head", "trunk") else whose + region, np.zeros(steps, bool))[step] = (
                True
            )
    return found


def touch_raster(episode: Episode, *, start: float = 0.0, end: Optional[float] = None) -> Figure:
    """Draws when each hand touches which region of the body: a line for each region and hand, a bar for each touch.

    A touch continues across gaps of less than 0.1 s. The share of the steps with contact is beside it.

    Args:
        episode: An episode of a record.
        start: Start of the time axis, s.
        end: End of the time axis, s; by default the end of the episode.

    Raises:
        ModuleNotFoundError: matplotlib is not installed.
        ValueError: There is nothing between start and end.
    """
    library()
    time = episode["time"]
    dt = float(episode.manifest["dt"])
    end = float(time[-1]) if end is None else end
    if not start < end:
        raise ValueError(f"there is no time between {start} s and {end} s")
    found = {side: hand_touches(episode, side) for side in HANDS}
    rows = [f"{whose}{region}" for region in _ROWS for whose in _whose(region)]
    with library().rc_context(look()):
        made = figure(7.0, 0.9 + 0.2 * len(rows))
        axes, share = made.subplots(1, 2, sharey=True, gridspec_kw={"width_ratios": [6, 1]})
        for k, row in enumerate(rows):
            for side, colour in HANDS.items():
                at = k + (-0.2 if side == "right" else 0.2)
                felt = found[side].get(row, np.zeros(episode.steps, bool))
                axes.broken_barh(_runs(felt, time, dt), (at - 0.17, 0.34), color=colour, linewidth=0)
                inside = (time >= start) & (time <= end)
                share.barh(at, 100 * felt[inside].mean() if inside.any() else 0.0, 0.34, color=colour, linewidth=0)
        for panel in (axes, share):
            for k in range(1, len(rows)):
                panel.axhline(k - 0.5, color="#e4e4e4", linewidth=0.4, zorder=0)
            panel.tick_params(left=False)
        axes.set_yticks(range(len(rows)), rows)
        axes.set_ylim(len(rows) - 0.5, -0.5)
        axes.set_xlim(start, end)
        axes.set_xlabel("time, s")
        share.set_xlabel("time touched, %")
        share.set_xlim(left=0)
        from matplotlib.patches import Patch

        handles = [Patch(color=colour, label=f"{side} hand") for side, colour in HANDS.items()]
        made.legend(handles=handles, loc="outside upper center", ncols=2, handlelength=1.0)
        return made


def _whose(region: str) -> tuple[str, ...]:
    if region in ("head", "trunk"):
        return ("",)
    # a hand does not touch itself
    return ("other ",) if region == "hand" else ("own ", "other ")


def _runs(felt: npt.NDArray[np.bool_], time: npt.NDArray[Any], dt: float) -> list[tuple[float, float]]:
    """Returns start and length of each touch, s."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], felt, [False]]).astype(np.int8)))
    begins, ends = edges[::2], edges[1::2]
    apart = (begins[1:] - ends[:-1]) * dt >= _GAP
    begins, ends = (
        begins[np.concatenate([[True], apart])[: len(begins)]],
        ends[np.concatenate([apart, [True]])[: len(ends)]],
    )
    return [(float(time[begin]) - dt, (stop - begin) * dt) for begin, stop in zip(begins, ends)]
