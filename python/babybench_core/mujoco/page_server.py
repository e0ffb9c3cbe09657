"""A server on this machine for a page that shows pictures: it asks a program for pictures and brings it what users do."""

from __future__ import annotations

import hmac
import json
import secrets
import threading
import time
import zlib
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from typing import Any, Optional
from urllib.parse import parse_qs, urlsplit

import numpy as np
from numpy.typing import NDArray

__all__ = ["PageServer"]

PATIENCE = 1.0
"""Seconds that a request waits for a picture before the page asks again."""
GRACE = 3.0
"""Seconds after which a page that was left counts as closed: a reload comes back sooner."""
LARGEST_BODY = 1 << 16
"""Bytes of events that a page may send at once."""
LARGEST_SIDE = 4096
"""Pixels of a side of a picture."""


class PageServer:
    """Serves ``viewer.html`` to browsers of this machine. Its methods are for the thread of the program.

    Attributes:
        url: The address of the page, with a secret token.
    """

    def __init__(self, title: str, controls: bool, cameras: list[str], port: int = 0) -> None:
        """Starts to listen.

        Args:
            title: The title of the page.
            controls: Whether the page can pause, step and restart what it shows.
            cameras: Names of the model's cameras, for a list.
            port: The port; 0 is any free one.

        Raises:
            OSError: The port is taken.
        """
        self._start = json.dumps({"title": title, "controls": controls, "cameras": cameras}).encode()
        self._token = secrets.token_urlsafe(16)
        self._changed = threading.Condition()
        self._wanted: Optional[tuple[int, int]] = None
        self._asked = -np.inf
        self._picture: tuple[int, NDArray[np.uint8], dict[str, Any]] = (0, np.zeros((0, 0, 3), np.uint8), {})
        self._events: list[dict[str, Any]] = []
        self._left = np.inf
        self._server = ThreadingHTTPServer(("127.0.0.1", port), _handler(self))
        self._server.daemon_threads = True
        self.url = f"http://127.0.0.1:{self._server.server_address[1]}/{self._token}/"
        threading.Thread(target=self._server.serve_forever, args=(0.1,), name="mujoco.viewer", daemon=True).start()

    @property
    def left(self) -> bool:
        """Whether the last browser that showed the page has left it."""
        return time.monotonic() - self._left > GRACE

    @property
    def watched(self) -> bool:
        """Whether a browser has asked for a picture within the last seconds."""
        return time.monotonic() - self._asked < GRACE

    def wanted(self) -> Optional[tuple[int, int]]:
        """Returns width and height of the picture that a page waits for, pixels, or ``None``."""
        with self._changed:
            return self._wanted if time.monotonic() - self._asked < PATIENCE else None

    def deliver(self, picture: NDArray[np.uint8], status: dict[str, Any]) -> None:
        """Hands over a picture, (height, width, 3), and what the page says beside it."""
        with self._changed:
            self._picture = (self._picture[0] + 1, picture, status)
            self._wanted = None
            self._changed.notify_all()

    def events(self) -> list[dict[str, Any]]:
        """Returns what users have done since the last call, in order."""
        with self._changed:
            found, self._events = self._events, []
        return found

    def close(self) -> None:
        """Stops listening."""
        self._server.shutdown()
        self._server.server_close()

    def _next_picture(self, width: int, height: int) -> Optional[tuple[int, NDArray[np.uint8], dict[str, Any]]]:
        """Waits for a picture, in a thread of the server."""
        with self._changed:
            self._left = np.inf
            before = self._picture[0]
            self._wanted, self._asked = (width, height), time.monotonic()
            self._changed.wait_for(lambda: self._picture[0] > before, PATIENCE)
            return self._picture if self._picture[0] > before else None

    def _take(self, events: list[dict[str, Any]]) -> None:
        """Keeps what users have done, in a thread of the server."""
        with self._changed:
            for event in events:
                if event.get("kind") == "left":
                    self._left = time.monotonic()
                else:
                    self._events.append(event)


def _handler(page: PageServer) -> type[BaseHTTPRequestHandler]:
    """Returns the class that answers requests to a page."""

    class Handler(BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def log_message(self, *_: Any) -> None:
            """Prints nothing."""

        def _answer(
            self, status: int, body: bytes = b"", kind: str = "text/plain; charset=utf-8", **headers: str
        ) -> None:
            self.send_response(status)
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(len(body)))
            self.send_header("Cache-Control", "no-store")
            for name, value in headers.items():
                self.send_header(name.replace("_", "-"), value)
            self.end_headers()
            self.wfile.write(body)

        def _place(self) -> Optional[str]:
            """Returns the part of the address after the token, or answers and returns ``None``."""
            # a name that resolves to this machine is another site's (DNS rebinding); ports may differ, because of tunnels
            if (self.headers.get("Host") or "").partition(":")[0] not in ("127.0.0.1", "localhost"):
                self._answer(403, b"this page is for browsers of this machine alone")
                return None
            token, _, place = urlsplit(self.path).path.lstrip("/").partition("/")
            if not hmac.compare_digest(token.encode(), page._token.encode()):
                self._answer(404, b"there is no such page: use the address that the program has printed")
                return None
            return place

        def do_GET(self) -> None:
            """Answers with the page, what it starts with, or a picture."""
            place = self._place()
            if place is None:
                return
            if place == "":
                html = files(__package__).joinpath("viewer.html").read_bytes()
                self._answer(200, html, "text/html; charset=utf-8")
            elif place == "start":
                self._answer(200, page._start, "application/json")
            elif place == "picture":
                self._picture()
            else:
                self._answer(404, b"there is no such file")

        def _picture(self) -> None:
            asked = parse_qs(urlsplit(self.path).query)
            try:
                width, height = int(asked["width"][0]), int(asked["height"][0])
            except (KeyError, ValueError):
                width = height = 0
            if not (1 <= width <= LARGEST_SIDE and 1 <= height <= LARGEST_SIDE):
                self._answer(400, f"width and height must be 1 to {LARGEST_SIDE}".encode())
                return
            found = page._next_picture(width, height)
            if found is None:
                self._answer(204)
                return
            _, picture, status = found
            told = {"width": picture.shape[1], "height": picture.shape[0], **status}
            body = zlib.compress(np.ascontiguousarray(picture).tobytes(), 1)
            self._answer(200, body, "application/octet-stream", Content_Encoding="deflate", X_Status=json.dumps(told))

        def do_POST(self) -> None:
            """Takes what users do."""
            place = self._place()
            if place is None:
                return
            try:
                length = int(self.headers.get("Content-Length") or 0)
                if place != "events" or not 0 < length <= LARGEST_BODY:
                    raise ValueError
                events = json.loads(self.rfile.read(length))
                if not (isinstance(events, list) and all(isinstance(event, dict) for event in events)):
                    raise ValueError
            except (ValueError, RecursionError):
                self.close_connection = True
                self._answer(400, b"expected a list of events")
                return
            page._take(events)
            self._answer(204)

    return Handler
