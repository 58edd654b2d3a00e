"""The page served to this machine alone: one random address on the loopback interface, a line to the finite elements.

Only requests that name this host and this address get an answer, and only the page's own script may ask: another
origin, a missing token, a message too long or malformed is refused, and the server goes on. What a page sends is
checked as a stranger's: size, kind, range; one press is computed at a time.
"""

from __future__ import annotations

import asyncio
import hmac
import json
import math
import secrets
import signal
import time
from collections.abc import Callable, Coroutine, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError
from tornado.httpserver import HTTPServer
from tornado.netutil import bind_sockets
from tornado.web import Application, HTTPError, RequestHandler
from tornado.websocket import WebSocketClosedError, WebSocketHandler

import fem
from benchmark.errors import InputError, TissuebenchError
from benchmark.files import Scenario
from benchmark.models.fem_model import FemModel
from benchmark.press.pressed_specimen import PressedSpecimen

LOOPBACK = "127.0.0.1"
LONGEST_MESSAGE = 16_384
LONGEST_REQUEST = 8_192
MOST_PAGES = 4
"""Pages that may be connected at once."""
REFUSED, GONE = 403, 404

MOST_ROWS = 80
MOST_TERMS = 4
LONGEST = 600.0
"""Seconds of a history."""
RADII = 128
"""Radii at which the last instant's faces are sent."""

Row = tuple[float, float]
Share = Annotated[float, Field(gt=0.0, lt=0.95)]
Seconds = Annotated[float, Field(ge=1e-3, le=1e5)]


class Question(BaseModel):
    """What a page may ask: which press, (t in s, depth in m) rows from rest, and the memory that it chose."""

    model_config = ConfigDict(extra="forbid", strict=False, allow_inf_nan=False)

    press: Annotated[int, Field(ge=0)]
    history: Annotated[list[Row], Field(min_length=2, max_length=MOST_ROWS)]
    strength: Annotated[list[Share], Field(max_length=MOST_TERMS)] = []
    time_s: Annotated[list[Seconds], Field(max_length=MOST_TERMS)] = []


@dataclass(frozen=True, eq=False)
class FemOnDemand:
    """Answers questions about the presses of a page."""

    specimens: Sequence[PressedSpecimen]

    def answer(self, text: str) -> dict[str, Any]:
        """The answer to a message, or {"error": why}; it never raises for what a message says."""
        try:
            question = Question.model_validate(json.loads(text))
            return self._answer(question)
        except (ValueError, RecursionError) as error:
            return {"error": _brief(error)}
        except (TissuebenchError, fem.FemError) as error:
            return {"error": str(error)}

    def _answer(self, question: Question) -> dict[str, Any]:
        if question.press >= len(self.specimens):
            raise InputError(f"press {question.press} is not on this page; it has {len(self.specimens)}")
        specimen = self.specimens[question.press]
        seconds, depth = self._checked(question, specimen)
        start = time.perf_counter()
        model = FemModel(_with_memory(specimen.scenario, question)).prepared
        ready = time.perf_counter()
        solution = model.run(fem.Load("depth", seconds, depth))
        wall = time.perf_counter() - ready
        if solution.failure is not None:
            raise InputError(f"the finite elements stopped: {solution.failure}")
        radii = np.linspace(0.0, specimen.wave.reach, RADII)
        return {
            "press": question.press,
            "time_s": seconds.tolist(),
            "force_N": solution.force.tolist(),
            "radius_m": radii.tolist(),
            "faces_m": np.nan_to_num(solution.profile(-1, radii)).tolist(),
            "setup_s": ready - start,
            "wall_s": wall,
            "unknowns": model.unknowns,
        }

    def _checked(self, question: Question, specimen: PressedSpecimen) -> tuple[Any, Any]:
        """Times and depths (n,), from rest at time zero."""
        seconds, depth = np.array(question.history).T
        if seconds[0] <= 0.0 or np.any(np.diff(seconds) <= 0.0) or seconds[-1] > LONGEST:
            raise InputError(f"history: times must rise from above 0 to at most {LONGEST:g} s")
        deepest = specimen.wave.deepest * (1.0 + 1e-9)
        if depth.min() < 0.0 or depth.max() > deepest:
            raise InputError(f"history: depths must be 0 to {1e3 * specimen.wave.deepest:.4g} mm")
        if len(question.strength) != len(question.time_s) or math.fsum(question.strength) >= 0.95:
            raise InputError("memory: as many times as shares are needed, the shares together below 0.95")
        return seconds, depth


def _with_memory(scenario: Scenario, question: Question) -> Scenario:
    """The scenario whose layers all relax by a page's own series, where they have none."""
    tissue = scenario.tissue
    if not question.strength or any(layer.relaxation for layer in tissue.layers):
        return scenario
    table = tissue.to_table()
    terms = [{"g": g, "tau": f"{tau!r} s"} for g, tau in zip(question.strength, question.time_s, strict=True)]
    for layer in table["layers"]:
        layer["relaxation"] = terms
    return scenario.model_copy(update={"tissue": type(tissue).model_validate(table)})


def _brief(error: Exception) -> str:
    """What is wrong with a message, without repeating it."""
    if isinstance(error, ValidationError):
        first = error.errors(include_url=False, include_input=False)[0]
        return f"{'.'.join(map(str, first['loc'])) or 'message'}: {first['msg']}"
    return "the message is not JSON"


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


class Line(WebSocketHandler):
    """A line to a page of this server's own: its origin, the token and the number of pages are checked."""

    def initialize(self, served: Served) -> None:
        """Take what the handlers share."""
        self._served, self._busy = served, False

    def check_origin(self, origin: str) -> bool:
        """Whether the page that asks came from here."""
        return origin.removeprefix("http://") in self._served.hosts and origin.startswith("http://")

    async def get(self, token: str) -> None:
        """Open the line, or refuse."""
        self._served.check(self, token)
        if "Origin" not in self.request.headers:
            raise HTTPError(REFUSED)
        if len(self._served.pages) >= MOST_PAGES:
            raise HTTPError(503)
        await super().get(token)

    def open(self, token: str) -> None:  # noqa: ARG002
        """Count the page."""
        self._served.pages.add(self)

    def on_close(self) -> None:
        """Count it no more."""
        self._served.pages.discard(self)


class FemLine(Line):
    """The line on which a page asks the finite elements, one question at a time."""

    async def on_message(self, message: str | bytes) -> None:
        """Answer a question, or say that the one before is not answered yet."""
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


def make_server(
    served: Served, port: int, lines: Mapping[str, type[Line]] = MappingProxyType({"fem": FemLine})
) -> tuple[HTTPServer, int]:
    """Listen on the loopback interface; port 0 takes a free one, which is returned. `lines` are by their addresses.

    Raises
    ------
    InputError
        The port is taken or not allowed.
    """
    application = Application(
        [
            (r"/([\w-]+)/", _Page, {"served": served}),
            *((rf"/([\w-]+)/{name}", line, {"served": served}) for name, line in lines.items()),
        ],
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


def serve(
    page: str,
    answer: Callable[[str], dict[str, Any]],
    port: int,
    say: Callable[[str], None],
    beside: tuple[str, type[Line], Callable[[Served], Coroutine[Any, Any, None]]] | None = None,
) -> None:
    """Serve until Ctrl-C or SIGTERM; `say` is told the address.

    `beside` is a further line: its address, its handler, and what tells its pages until the end.

    Raises
    ------
    InputError
        See `make_server`.
    """
    with ThreadPoolExecutor(max_workers=1, thread_name_prefix="fem") as worker:
        served = Served(secrets.token_urlsafe(24), page.encode(), answer, worker)
        asyncio.run(_until_stopped(served, port, say, beside))
        worker.shutdown(wait=True, cancel_futures=True)


async def _until_stopped(
    served: Served,
    port: int,
    say: Callable[[str], None],
    beside: tuple[str, type[Line], Callable[[Served], Coroutine[Any, Any, None]]] | None,
) -> None:
    stopped, loop = asyncio.Event(), asyncio.get_running_loop()
    for name in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(name, stopped.set)
    lines = {"fem": FemLine} | ({} if beside is None else {beside[0]: beside[1]})
    server, number = make_server(served, port, lines)
    telling = None if beside is None else loop.create_task(beside[2](served))
    say(f"http://{LOOPBACK}:{number}/{served.token}/")
    await stopped.wait()
    if telling is not None:
        telling.cancel()
    server.stop()
    for page in tuple(served.pages):
        page.close(1001, "the server ends")
    await server.close_all_connections()
