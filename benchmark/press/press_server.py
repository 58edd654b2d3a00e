"""The page served to this machine alone: one random address on the loopback interface, a line to the finite elements.

Only requests that name this host and this address get an answer, and only the page's own script may ask: another
origin, a missing token, a message too long or malformed is refused, and the server goes on.
"""

from __future__ import annotations

import asyncio
import hmac
import secrets
import signal
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any

from tornado.httpserver import HTTPServer
from tornado.netutil import bind_sockets
from tornado.web import Application, HTTPError, RequestHandler
from tornado.websocket import WebSocketClosedError, WebSocketHandler

from benchmark.errors import InputError

LOOPBACK = "127.0.0.1"
LONGEST_MESSAGE = 16_384
LONGEST_REQUEST = 8_192
MOST_PAGES = 4
"""Pages that may be connected at once."""
REFUSED, GONE = 403, 404


@dataclass
class Served:
    """What the handlers share.

    Attributes
    ----------
    token
        The secret part of the address.
    page
        The HTML.
    answer
        Message of a page to what is sent back; it runs in `worker`, one at a time.
    hosts
        Names under which a browser may call this server.
    """

    token: str
    page: bytes
    answer: Callable[[str], dict[str, Any]]
    worker: ThreadPoolExecutor
    hosts: frozenset[str] = frozenset()
    pages: set[WebSocketHandler] = field(default_factory=set)

    def check(self, handler: RequestHandler, token: str) -> None:
        """Refuse a request for another host (a rebound name) or without the token."""
        if handler.request.host not in self.hosts:
            raise HTTPError(REFUSED)
        if not hmac.compare_digest(token.encode(), self.token.encode()):
            raise HTTPError(GONE)


class _Page(RequestHandler):
    def initialize(self, served: Served) -> None:
        self._served = served

    def set_default_headers(self) -> None:
        self.clear_header("Server")
        self.set_header("X-Content-Type-Options", "nosniff")
        self.set_header("Referrer-Policy", "no-referrer")
        self.set_header("Cross-Origin-Resource-Policy", "same-origin")
        self.set_header("X-Frame-Options", "DENY")
        self.set_header("Cache-Control", "no-store")

    def get(self, token: str) -> None:
        self._served.check(self, token)
        self.set_header("Content-Type", "text/html; charset=utf-8")
        self.finish(self._served.page)


class _Line(WebSocketHandler):
    def initialize(self, served: Served) -> None:
        self._served, self._busy = served, False

    def check_origin(self, origin: str) -> bool:
        return origin.removeprefix("http://") in self._served.hosts and origin.startswith("http://")

    async def get(self, token: str) -> None:
        self._served.check(self, token)
        if "Origin" not in self.request.headers:
            raise HTTPError(REFUSED)
        if len(self._served.pages) >= MOST_PAGES:
            raise HTTPError(503)
        await super().get(token)

    def open(self, token: str) -> None:  # noqa: ARG002
        self._served.pages.add(self)

    def on_close(self) -> None:
        self._served.pages.discard(self)

    async def on_message(self, message: str | bytes) -> None:
        if self._busy:
            answer: dict[str, Any] = {"error": "the finite elements are still at the press before"}
        elif isinstance(message, bytes):
            answer = {"error": "the message is not text"}
        else:
            self._busy = True
            loop = asyncio.get_running_loop()
            try:
                answer = await loop.run_in_executor(self._served.worker, self._served.answer, message)
            finally:
                self._busy = False
        try:
            await self.write_message(answer)
        except WebSocketClosedError:
            return


def make_server(served: Served, port: int) -> tuple[HTTPServer, int]:
    """Listen on the loopback interface; port 0 takes a free one, which is returned.

    Raises
    ------
    InputError
        The port is taken or not allowed.
    """
    application = Application(
        [(r"/([\w-]+)/", _Page, {"served": served}), (r"/([\w-]+)/fem", _Line, {"served": served})],
        websocket_max_message_size=LONGEST_MESSAGE,
        log_function=lambda _: None,
    )
    server = HTTPServer(application, max_header_size=LONGEST_REQUEST, max_body_size=LONGEST_REQUEST)
    try:
        sockets = bind_sockets(port, address=LOOPBACK)
    except OSError as error:
        raise InputError(f"--port {port} cannot be listened on: {error.strerror}; 0 takes a free one") from error
    server.add_sockets(sockets)
    number = int(sockets[0].getsockname()[1])
    served.hosts = frozenset({f"{LOOPBACK}:{number}", f"localhost:{number}"})
    return server, number


def serve(page: str, answer: Callable[[str], dict[str, Any]], port: int, say: Callable[[str], None]) -> None:
    """Serve until Ctrl-C or SIGTERM; `say` is told the address.

    Raises
    ------
    InputError
        See `make_server`.
    """
    with ThreadPoolExecutor(max_workers=1, thread_name_prefix="fem") as worker:
        served = Served(secrets.token_urlsafe(24), page.encode(), answer, worker)
        asyncio.run(_until_stopped(served, port, say))
        worker.shutdown(wait=True, cancel_futures=True)


async def _until_stopped(served: Served, port: int, say: Callable[[str], None]) -> None:
    stopped, loop = asyncio.Event(), asyncio.get_running_loop()
    for name in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(name, stopped.set)
    server, number = make_server(served, port)
    say(f"http://{LOOPBACK}:{number}/{served.token}/")
    await stopped.wait()
    server.stop()
    for page in tuple(served.pages):
        page.close(1001, "the server ends")
    await server.close_all_connections()
