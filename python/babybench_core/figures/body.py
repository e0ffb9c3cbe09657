"""Touch on MIMo's body, from the front and from the back."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from babybench_core.figures.felt import shares
from babybench_core.figures.style import figure, library, look

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from babybench_core.data import Record

_UNTOUCHED = "#dcdcdc"
_POSE = {"shoulder_ad_ab": 0.1, "right_hip2": -0.12, "left_hip2": -0.12}
"""Angles that spread the limbs, so that arms do not hide the trunk, by parts of the joints' names, rad."""


def touch_on_body(records: Mapping[str, Record], *, what: str = "own", to_scale: bool = True) -> Figure:
    """Draws the duration of touch on the skin, a pair of views for each record: over training, or by age.

    Sensors that felt nothing are grey; the colour of the others is the share of the time in which they did, on one
    logarithmic scale.

    Args:
        records: Records by their labels: stages of a training, ages.
        what: ``own`` for touches of the body by itself, ``all`` for any touch, including that of the ground.
        to_scale: Whether bodies of several ages are drawn on one scale, instead of with one height.

    Raises:
        ModuleNotFoundError: matplotlib is not installed.
        ValueError: There are no records, or one without touch.
    """
    library()
    if not records:
        raise ValueError("there are no records to draw: give at least one with its name")
    felt = {label: shares(record, what) for label, record in records.items()}
    bodies = {label: _Body(record) for label, record in records.items()}
    seen = np.concatenate([share[share > 0] for share in felt.values()])
    low, high = (float(10 ** np.floor(np.log10(seen.min()))), float(seen.max())) if len(seen) else (1e-3, 1.0)
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LogNorm

    norm = LogNorm(100 * low, 100 * max(high, 2 * low))
    tallest, widest = max(body.height for body in bodies.values()), max(body.width for body in bodies.values())
    # each view is as wide as the widest body, with a margin
    room = 1.12 * widest
    across = min(1.15, 6.2 / (2 * len(records)))
    frame = [(room, tallest) if to_scale else (1.12 * body.width, body.height) for body in bodies.values()]
    high_in = across * max(height / width for width, height in frame)
    with library().rc_context(look()):
        made = figure(0.8 + 2 * len(records) * across, high_in + 0.75)
        engine: Any = made.get_layout_engine()
        engine.set(w_pad=0.01, wspace=0.0)
        panels = made.subplots(1, 2 * len(records), squeeze=False)[0]
        for (label, body), pair, size in zip(bodies.items(), panels.reshape(-1, 2), frame):
            for axes, view in zip(pair, ("front", "back")):
                body.draw(axes, felt[label], view, norm, size)
                axes.set_xlabel(view)
            pair[0].annotate(
                label,
                (1.0, 1.02),
                xycoords="axes fraction",
                ha="center",
                va="bottom",
                fontsize=8,
                fontweight="bold",
                annotation_clip=False,
            )
        _bar(panels[0], frame[0][1])
        name = "touched by his own body,\n% of the time" if what == "own" else "touched, % of the time"
        made.colorbar(ScalarMappable(norm, _colours()), ax=list(panels), shrink=0.85, pad=0.02, label=name)
        from matplotlib.lines import Line2D

        never = Line2D([], [], marker="o", linestyle="", color=_UNTOUCHED, markersize=4, label="never touched")
        made.legend(handles=[never], loc="outside lower center", handletextpad=0.2)
        return made


def _colours() -> Any:
    import matplotlib

    return matplotlib.colormaps["plasma_r"]


def _bar(axes: Any, height: float) -> None:
    """Draws a scale bar of 10 cm."""
    x, y = axes.get_xlim()[0] + 0.02 * height, axes.get_ylim()[1] - 0.08 * height
    axes.plot([x, x + 0.1], [y, y], color="black", linewidth=1.2, solid_capstyle="butt")
    axes.annotate("10 cm", (x + 0.05, y + 0.01 * height), ha="center", va="bottom", fontsize=6)


class _Body:
    """MIMo's skin in a pose that shows all of it."""

    def __init__(self, record: Record) -> None:
        from babybench_core import _native

        env = record.environment(vision_active=False)
        env.reset()
        names, own = env._core.blueprint.model_names, env.array("qpos0")
        for joint in record.manifest["joints"]:
            own[joint["qpos"]] = 0.0
            for part, angle in _POSE.items():
                if part in joint["name"]:
                    own[joint["qpos"]] = angle
        _native.Parts(env._core).forward(own, np.zeros(len(env.array("qvel"))))
        frames = env.array("xmat").reshape(-1, 3, 3)
        hip = names["body"].index("hip")
        # his own axes: x to the front, y to the left, z to the head
        points = (env.touch.world_positions() - env.array("xpos").reshape(-1, 3)[hip]) @ frames[hip]
        geoms = (env.array("geom_xpos").reshape(-1, 3) - env.array("xpos").reshape(-1, 3)[hip]) @ frames[hip]
        middle = np.zeros_like(points)
        spacing = np.zeros(len(points))
        for body in env._core.touch_layout():
            at = body["offset"]
            for geom, first, last, _ in body["geoms"]:
                middle[at + first : at + last] = geoms[geom]
            spacing[at : at + len(body["positions"])] = body["spacing"]
        self._points, self._front, self._spacing = points, points[:, 0] - middle[:, 0], spacing
        self.height, self.width = float(np.ptp(points[:, 2])), float(np.ptp(points[:, 1]))

    def draw(self, axes: Any, felt: npt.NDArray[np.float64], view: str, norm: Any, size: tuple[float, float]) -> None:
        """Draws one side into a frame of a width and a height, m."""
        width, height = size
        sign = 1.0 if view == "front" else -1.0
        shown = sign * self._front > -0.25 * self._spacing
        order = np.flatnonzero(shown)
        # touched sensors are drawn on top
        order = order[np.lexsort((sign * self._points[order, 0], felt[order] > 0))]
        across, along = -sign * self._points[order, 1], self._points[order, 2]
        bottom = self._points[:, 2].min()
        axes.set_aspect("equal")
        axes.set_xlim(-0.5 * width, 0.5 * width)
        axes.set_ylim(bottom - 0.03 * height, bottom + 1.03 * height)
        for side in axes.spines.values():
            side.set_visible(False)
        axes.set_xticks([])
        axes.set_yticks([])
        share, touched = felt[order], felt[order] > 0
        colours = np.empty((len(order), 4))
        from matplotlib.colors import to_rgba

        colours[:] = to_rgba(_UNTOUCHED)
        if touched.any():
            colours[touched] = _colours()(norm(100 * share[touched]))
        _discs(axes, across, along, 0.5 * self._spacing[order], colours)


def _discs(axes: Any, x: Any, y: Any, radius: Any, colours: Any) -> None:
    """Draws discs of radii in the units of the axes; in vector formats they are an image, because there are thousands."""
    from matplotlib.collections import EllipseCollection

    size = 2 * radius
    discs = EllipseCollection(
        size,
        size,
        np.zeros_like(size),
        units="xy",
        offsets=np.column_stack([x, y]),
        transOffset=axes.transData,
        facecolors=colours,
        linewidths=0,
        rasterized=True,
    )
    axes.add_collection(discs)
