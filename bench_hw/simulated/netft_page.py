"""The web pages of the simulated Net F/T box: `netftapi2.xml` and `comm.cgi`."""

from __future__ import annotations

import threading
from collections.abc import Callable
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.parse import parse_qs, urlsplit
from xml.sax.saxutils import escape

Page = Callable[[str, dict[str, str]], str | None]
"""Path and query of a request to the text of the page; None for a page there is not."""


def configuration_page(values: dict[str, str]) -> str:
    """Write `netftapi2.xml` from element names and their texts."""
    lines = [f"<{name}>{escape(text)}</{name}>" for name, text in values.items()]
    return "\r\n".join(['<?xml version="1.0" encoding="UTF-8"?>', "<netft>", *lines, "</netft>", ""])


class PageServer:
    """An HTTP server on loopback in its own threads.

    Parameters
    ----------
    page : Page
        What to answer.
    port : int
        Port; 0 lets the system choose.
    """

    def __init__(self, page: Page, port: int = 0) -> None:
        self._server = ThreadingHTTPServer(("127.0.0.1", port), _handler(page))
        self._server.daemon_threads = True
        self._thread = threading.Thread(
            target=self._server.serve_forever, kwargs={"poll_interval": 0.05}, name="pages", daemon=True
        )
        self._thread.start()

    @property
    def port(self) -> int:
        """The port it listens on."""
        return int(self._server.server_address[1])

    def close(self) -> None:
        """Stop answering and free the port."""
        self._server.shutdown()
        self._server.server_close()
        self._thread.join(timeout=5.0)


def _handler(page: Page) -> type[BaseHTTPRequestHandler]:
    class Handler(BaseHTTPRequestHandler):
        timeout = 5.0

        def do_GET(self) -> None:
            parts = urlsplit(self.path)
            query = {name: values[-1] for name, values in parse_qs(parts.query).items()}
            text = page(parts.path, query)
            body = (text or "no such page").encode()
            self.send_response(200 if text is not None else 404)
            self.send_header("Content-Type", "text/xml" if parts.path.endswith(".xml") else "text/html")
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, format: str, *args: object) -> None:
            """Say nothing: this runs inside tests and other programs."""

    return Handler
