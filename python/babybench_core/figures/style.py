"""The style of figures: small type, few lines, colours that everyone can distinguish."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FORMATS = ("svg", "pdf", "png")
"""Formats of figures."""
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
"""Colours of series, by Okabe and Ito."""
HANDS = {"right": "#d55e00", "left": "#0072b2"}
"""Colours of the hands."""
COLUMN = 3.5
"""Width of a column of a paper, inches."""


def library() -> Any:
    """Imports matplotlib.

    Raises:
        ModuleNotFoundError: It is not installed; the error says how to install it.
    """
    try:
        import matplotlib
    except ModuleNotFoundError as error:
        if error.name != "matplotlib":
            raise
        text = "figures need the module matplotlib, which is not installed: pip install 'babybench[figures]'"
        raise ModuleNotFoundError(text, name="matplotlib") from None
    return matplotlib


def look() -> dict[str, Any]:
    """Returns the settings of matplotlib."""
    return {
        "font.size": 8,
        "axes.titlesize": 8,
        "axes.labelsize": 8,
        "xtick.labelsize": 7,
        "ytick.labelsize": 7,
        "legend.fontsize": 7,
        "legend.frameon": False,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.linewidth": 0.6,
        "xtick.major.width": 0.6,
        "ytick.major.width": 0.6,
        "lines.linewidth": 1.4,
        "figure.dpi": 150,
        # text stays text, in fonts that publishers take
        "svg.fonttype": "none",
        "svg.hashsalt": "babybench",
        "pdf.fonttype": 42,
    }


def figure(width: float, height: float) -> Figure:
    """Creates an empty figure of a size in inches, which pyplot does not manage.

    Raises:
        ModuleNotFoundError: matplotlib is not installed.
    """
    library()
    from matplotlib import figure as figures

    return figures.Figure(figsize=(width, height), layout="constrained")
