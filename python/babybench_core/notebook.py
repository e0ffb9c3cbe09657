"""What a notebook shows of a live environment: its page, or pictures that come through the kernel."""

from __future__ import annotations

import base64
import importlib
import io
import time
from typing import Any, Callable

import numpy as np
import numpy.typing as npt

__all__ = ["NotebookOutput"]

PATIENCE = 3.0
"""Seconds in which a browser must have reached the page."""
FASTEST = 0.2
"""Seconds between two pictures at least."""
SHARE = 0.2
"""Largest share of the time that pictures take from the environment."""


class NotebookOutput:
    """The output of a cell that shows an environment.

    At first it is the page in a frame, which responds to the mouse. If no browser has reached the page after three seconds,
    because the kernel runs on another machine, pictures take its place. They arrive like any other output, so they work in
    JupyterLab, JupyterHub, VS Code and Colab, and behind proxies.
    """

    def __init__(self, page: str, note: str, picture: Callable[[], npt.NDArray[np.uint8]]) -> None:
        """Displays the page.

        Args:
            page: The page in a frame, HTML.
            note: What to say instead of the frame, HTML.
            picture: Draws the environment, (height, width, 3).
        """
        self._note, self._picture = note, picture
        self._frame, self._image = _display(page), _display("")
        self._started = time.monotonic()
        self._reached = self._replaced = False
        self._next = 0.0

    def update(self, watched: bool) -> None:
        """Shows the environment after a step, if the page does not.

        Args:
            watched: Whether a browser shows the page.
        """
        now = time.monotonic()
        if watched and not self._replaced:
            self._reached = True
        if self._reached or now < self._next or now - self._started < PATIENCE:
            return
        if not self._replaced:
            _update(self._frame, self._note)
            self._replaced = True
        _update(self._image, _image(self._picture()))
        after = time.monotonic()
        self._next = after + max(FASTEST, (after - now) * (1 - SHARE) / SHARE)


def _display(html: str) -> Any:
    """Adds an output to the cell and returns its handle."""
    ipython = importlib.import_module("IPython.display")
    return ipython.display(ipython.HTML(html), display_id=True)


def _update(handle: Any, html: str) -> None:
    handle.update(importlib.import_module("IPython.display").HTML(html))


def _image(picture: npt.NDArray[np.uint8]) -> str:
    """Returns a picture as HTML, with its data in the text."""
    try:
        from PIL import Image
    except ModuleNotFoundError:
        return "<small>Pictures of MIMo need Pillow: <code>pip install pillow</code></small>"
    out = io.BytesIO()
    Image.fromarray(picture).save(out, "WEBP", quality=80)
    data = base64.b64encode(out.getvalue()).decode()
    return f'<img src="data:image/webp;base64,{data}" width="{picture.shape[1]}" height="{picture.shape[0]}" alt="MIMo, live">'
