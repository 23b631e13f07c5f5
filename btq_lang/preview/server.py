"""The server of `btq preview`: sends the page, pictures on request, and events when they have changed or the cursor of
an editor has moved.

One invariant: it answers only pages that it served itself.  It listens on the loopback interface alone, but every page
in a browser on this machine can send requests there: a foreign one has another Origin, or, with DNS rebinding, another
Host.  Missions and files are unknown here; callbacks supply the answers.
"""

from __future__ import annotations

import json
import secrets
from collections.abc import Callable, Sequence
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from threading import Condition, Thread
from typing import Any

from btq_lang.preview import page

ADDRESS = "127.0.0.1"
_ALIVE = 15.0  # seconds between keep-alives, which detect pages that are gone
_LONGEST = 1_000_000  # bytes that a page may send


class Preview:
    """A server in its own thread.

    Args:
        port: 0 chooses a free one.
        draw: returns the page's contents, given the names of the folded nodes.
        go: handles a click on a node, given its key; the page shows the result.

    Raises:
        OSError: the port is in use.
    """

    def __init__(
        self, port: int, draw: Callable[[Sequence[str]], dict[str, object]], go: Callable[[str], dict[str, object]]
    ) -> None:
        self.draw, self.go = draw, go
        self._changed = Condition()
        self._now = (0, 0, "")  # number of changes, the cursor's line; 0: unknown; and the run that is shown
        handler = type("Handler", (_Handler,), {"preview": self})
        self._server = ThreadingHTTPServer((ADDRESS, port), handler)
        self._server.daemon_threads = True
        self.port: int = self._server.server_address[1]
        Thread(target=self._server.serve_forever, daemon=True).start()

    @property
    def url(self) -> str:
        return f"http://{ADDRESS}:{self.port}/"

    def changed(self) -> None:
        """Make every page request its picture again."""
        self._show(changes=1)

    def mark_line(self, line: int) -> None:
        """Make every page mark the node at the line, counted from 1."""
        self._show(line=line)

    def show_run(self, run: str) -> None:
        """Make every page show a run of the logs; `run`: as JSON."""
        self._show(run=run)

    def _show(self, changes: int = 0, line: int | None = None, run: str | None = None) -> None:
        with self._changed:
            before = self._now
            self._now = (before[0] + changes, before[1] if line is None else line, before[2] if run is None else run)
            self._changed.notify_all()

    def wait(self, seen: tuple[int, int, str]) -> tuple[int, int, str]:
        """Wait until the number of changes, the cursor's line or the run differs from those seen, or a timeout; returns
        all three.
        """
        with self._changed:
            self._changed.wait_for(lambda: self._now != seen, _ALIVE)
            return self._now

    def close(self) -> None:
        self._server.shutdown()
        self._server.server_close()


class _Handler(BaseHTTPRequestHandler):
    preview: Preview

    def do_GET(self) -> None:
        if not self._is_ours():
            self._refuse(HTTPStatus.FORBIDDEN)
        elif self.path == "/":
            self._answer("text/html; charset=utf-8", page(secrets.token_hex(16)).encode())
        elif self.path == "/events":
            self._send_events()
        else:
            self._refuse(HTTPStatus.NOT_FOUND)

    def do_POST(self) -> None:
        length = self.headers.get("Content-Length", "")
        if not self._is_ours():
            return self._refuse(HTTPStatus.FORBIDDEN)
        if not length.isdigit() or int(length) > _LONGEST:
            return self._refuse(HTTPStatus.BAD_REQUEST)
        try:
            request = json.loads(self.rfile.read(int(length)))
            if self.path == "/picture":
                answer = self.preview.draw([str(name) for name in request["folded"]])
            elif self.path == "/go":
                answer = self.preview.go(str(request["key"]))
            else:
                return self._refuse(HTTPStatus.NOT_FOUND)
        except (ValueError, KeyError, TypeError):
            return self._refuse(HTTPStatus.BAD_REQUEST)
        self._answer("application/json", json.dumps(answer).encode())

    def log_message(self, format: str, *args: Any) -> None:
        """Log nothing: the terminal shows the places of clicks, not requests."""

    def _is_ours(self) -> bool:
        own = {f"{name}:{self.preview.port}" for name in (ADDRESS, "localhost")}
        origin = self.headers.get("Origin")
        return self.headers.get("Host") in own and (origin is None or origin in {f"http://{name}" for name in own})

    def _answer(self, kind: str, body: bytes) -> None:
        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        self.send_header("Cache-Control", "no-store")
        self.end_headers()
        self.wfile.write(body)

    def _send_events(self) -> None:
        """Send events until the page is gone; the format:
        https://html.spec.whatwg.org/multipage/server-sent-events.html
        """
        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", "text/event-stream")
        self.send_header("Cache-Control", "no-store")
        self.end_headers()
        changes, line, run = -1, 0, ""
        try:
            while True:
                now = self.preview.wait((changes, line, run))
                events = b"data: changed\n\n" if now[0] != changes else b""
                events += b"event: here\ndata: %d\n\n" % now[1] if now[1] != line else b""
                events += b"event: run\ndata: %s\n\n" % now[2].encode() if now[2] != run else b""
                self.wfile.write(events or b": still here\n\n")
                self.wfile.flush()
                changes, line, run = now
        except OSError:
            return

    def _refuse(self, status: HTTPStatus) -> None:
        self.send_error(status)
