"""A window for people, by pygame."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt


class Window:
    """A window that shows pictures at a steady rate."""

    def __init__(self, title: str, width: int, height: int) -> None:
        """Opens a window of a size in pixels."""
        try:
            import pygame
        except ImportError as error:
            from gymnasium.error import DependencyNotInstalled

            text = 'render_mode="human" needs pygame: pip install pygame'
            raise DependencyNotInstalled(text) from error
        self._pygame: Any = pygame
        pygame.display.init()
        pygame.display.set_caption(title)
        self._screen = pygame.display.set_mode((width, height))
        self._clock = pygame.time.Clock()

    def show(self, picture: npt.NDArray[np.uint8], fps: float) -> None:
        """Shows a picture, (height, width, 3), and waits until it is time for the next."""
        self._pygame.event.pump()
        surface = self._pygame.surfarray.make_surface(picture.swapaxes(0, 1))
        self._screen.blit(surface, (0, 0))
        self._pygame.display.flip()
        self._clock.tick(fps)

    def close(self) -> None:
        """Closes the window."""
        self._pygame.display.quit()
