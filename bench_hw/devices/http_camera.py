"""`HttpCamera`: a camera that streams MJPEG over HTTP; its JPEG bytes are passed on as they come.

A frame is stamped when its last byte has been read or, where the stream runs on the bench's own clock, as its part says
(`X-Timestamp`, s). Where the stream numbers its frames (`X-Frame` in a part's
header), dropped frames are known for certain; see `grabbing` for the others. Where a size is asked for, what is no JPEG
is no frame, and a frame of another size ends the stream. `MultipartParser` cuts the stream and knows no sockets.
"""

from __future__ import annotations

import re
import socket
import time
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import SplitResult, urlsplit

from bench_hw.clock import Clock, MonotonicClock, wait_until
from bench_hw.devices.grabbing import FrameCounter
from bench_hw.devices.protocols import CameraFrame, CameraHealth, Connection, DeviceInfo
from bench_hw.errors import DeviceError

_LARGEST_PART = 32 * 1024 * 1024
_LARGEST_HEAD = 16 * 1024
_CHUNK = 1 << 18
_MOST_CHUNKS = 64
_SECONDS = re.compile(r"\d{1,12}(\.\d{1,9})?")


class StreamError(ValueError):
    """The bytes are no multipart stream."""


@dataclass(frozen=True, slots=True)
class Part:
    """One part of the stream: its header (lower-case names), its body, and when that had come, s."""

    header: Mapping[str, str]
    body: bytes
    arrived: float = 0.0


class MultipartParser:
    """Cuts a stream into parts.

    Parameters
    ----------
    boundary : str
        The boundary as the stream's content type names it, with or without its two dashes.
    """

    def __init__(self, boundary: str) -> None:
        self._line = b"--" + boundary.strip('"').removeprefix("--").encode("latin-1")
        self._buffer = bytearray()
        self._chunks: deque[tuple[int, float]] = deque()  # buffered bytes up to its end, and when it came

    def feed(self, data: bytes, now: float = 0.0) -> list[Part]:
        """Take the bytes that came at `now`, s, and give the parts that are whole now.

        A part without a length is known to be whole by the next one's boundary, which many cameras send with the next
        picture; it had come all the same when its last byte did.

        Raises
        ------
        StreamError
            A head above 16 KiB, a part above 32 MiB, or a length that is no number.
        """
        self._buffer += data
        self._chunks.append((len(self._buffer), now))
        parts: list[Part] = []
        while (part := self._next()) is not None:
            parts.append(part)
        return parts

    def _next(self) -> Part | None:
        start = self._buffer.find(self._line)
        if start < 0:
            self._check(_LARGEST_HEAD, "no boundary")
            return None
        end = self._buffer.find(b"\r\n\r\n", start)
        if end < 0:
            self._check(start + _LARGEST_HEAD, "a head without an end")
            return None
        header = _header(bytes(self._buffer[start + len(self._line) : end]))
        body = end + 4
        stop = self._end_of_body(header, body)
        if stop is None:
            self._check(body + _LARGEST_PART, "a part without an end")
            return None
        arrived = next(when for end, when in self._chunks if end >= stop)
        part = Part(header, bytes(self._buffer[body:stop]), arrived)
        del self._buffer[:stop]
        self._chunks = deque((end - stop, when) for end, when in self._chunks if end >= stop)
        return part

    def _end_of_body(self, header: Mapping[str, str], body: int) -> int | None:
        length = header.get("content-length")
        if length is None:
            found = self._buffer.find(b"\r\n" + self._line, body)
            return None if found < 0 else found
        if not length.isdecimal() or int(length) > _LARGEST_PART:
            raise StreamError(f"content-length = {length[:40]!r}: allowed are 0 to {_LARGEST_PART}")
        stop = body + int(length)
        return stop if stop <= len(self._buffer) else None

    def _check(self, most: int, problem: str) -> None:
        if len(self._buffer) > most:
            raise StreamError(f"{problem} within {most} bytes")


_SIZED = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}
_BARE = frozenset(range(0xD0, 0xD9)) | {0x01}


def jpeg_size(data: bytes) -> tuple[int, int] | None:
    """Width and height of a JPEG picture by its frame header (ITU-T T.81, annex B); None where it is none."""
    at = 2
    if data[:2] != b"\xff\xd8":
        return None
    while at + 4 <= len(data) and data[at] == 0xFF:
        marker = data[at + 1]
        if marker in _SIZED and at + 9 <= len(data):
            return int.from_bytes(data[at + 7 : at + 9], "big"), int.from_bytes(data[at + 5 : at + 7], "big")
        fill = marker == 0xFF
        at += 1 if fill else 2 if marker in _BARE else 2 + int.from_bytes(data[at + 2 : at + 4], "big")
    return None


def _header(head: bytes) -> dict[str, str]:
    lines = head.decode("latin-1").split("\r\n")
    pairs = (line.partition(":") for line in lines if ":" in line)
    return {name.strip().lower(): value.strip() for name, _, value in pairs}


class HttpCamera(Connection):
    """Driver of an MJPEG stream.

    Parameters
    ----------
    url : str
        `http://host:port/path` of the stream.
    rate : float
        Nominal frames per second, Hz.
    clock : Clock, optional
        The bench's clock.
    timeout : float
        Longest wait for the connection and its header, s.
    same_clock : bool
        Whether the stream's `X-Timestamp` is on this clock, as a simulated camera's is; another machine's is not.
    size : tuple of 2 ints, optional
        Width and height that its pictures must have, pixels; without it any will do.
    """

    def __init__(
        self,
        url: str,
        *,
        rate: float = 30.0,
        clock: Clock | None = None,
        timeout: float = 2.0,
        same_clock: bool = False,
        size: tuple[int, int] | None = None,
    ) -> None:
        self._size = size
        self._url, self._rate, self._timeout, self._same_clock = url, rate, timeout, same_clock
        self._clock = clock or MonotonicClock()
        self._socket: socket.socket | None = None
        self._parser = MultipartParser("")
        self._counter = FrameCounter(1.0 / rate)
        self._streaming = False

    @property
    def info(self) -> DeviceInfo:
        """The stream's address and nominal rate."""
        return DeviceInfo("HTTP camera", settings={"url": self._url, "rate": f"{self._rate:g} Hz"})

    @property
    def rate(self) -> float:
        """Nominal frames per second, Hz."""
        return self._rate

    @property
    def health(self) -> CameraHealth:
        """Counts of the stream since `start`."""
        return self._counter.health

    def connect(self) -> None:
        """Ask for the stream and read its header.

        Raises
        ------
        DeviceError
            No such address, no answer in time, another status than 200, or no multipart stream.
        """
        self.close()
        host, port, parts = self._address()
        try:
            opened = socket.create_connection((host, port), self._timeout)
        except OSError as error:
            raise self._lost(error) from error
        try:
            path = (parts.path or "/") + (f"?{parts.query}" if parts.query else "")
            opened.sendall(f"GET {path} HTTP/1.0\r\nHost: {parts.netloc}\r\n\r\n".encode("latin-1"))
            self._begin(opened)
        except BaseException:
            opened.close()
            raise
        self._socket = opened

    def start(self) -> None:
        """Throw away what has come so far and number frames from 0; wait for a picture where a size is asked for.

        Raises
        ------
        DeviceError
            Not connected, the stream ended, no picture in time, or one of another size.
        """
        self._streaming = True
        patience = self._timeout + 1.0 / self._rate
        if (
            not self.read()
            and self._size is not None
            and not wait_until(self._clock, lambda: bool(self.read()), patience)
        ):
            raise DeviceError(f"camera at {self._url}: no JPEG picture within {patience:g} s")
        self._counter = FrameCounter(1.0 / self._rate)

    def read(self) -> list[CameraFrame]:
        """Give the frames that are whole since the last call; never waits.

        Raises
        ------
        DeviceError
            Not connected, the stream ended, or its bytes make no sense.
        """
        frames: list[CameraFrame] = []
        for _ in range(_MOST_CHUNKS):
            data = self._receive()
            if data is None:
                break
            frames += self._frames(data)
        return frames if self._streaming else []

    def stop(self) -> None:
        """Stop passing frames on; the connection stays."""
        self._streaming = False

    def close(self) -> None:
        """Close the connection; may be repeated."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    def _address(self) -> tuple[str, int, SplitResult]:
        """Host, port and parts of the stream's address."""
        try:
            parts = urlsplit(self._url)
            host, port = parts.hostname, parts.port or 80
        except ValueError:
            host, port = None, 80
        if host is None or parts.scheme != "http" or not self._url.isprintable() or " " in self._url:
            raise DeviceError(f"camera at {self._url!r}: allowed is an address like http://host:port/path")
        return host, port, parts

    def _begin(self, opened: socket.socket) -> None:
        head, end = b"", time.monotonic() + self._timeout
        try:
            while b"\r\n\r\n" not in head and len(head) < _LARGEST_HEAD:
                opened.settimeout(max(end - time.monotonic(), 1e-3))  # for all of it, however slowly it comes
                data = opened.recv(4096)
                if not data:
                    break
                head += data
        except OSError as error:
            raise self._lost(error) from error
        header, _, rest = head.partition(b"\r\n\r\n")
        self._parser = MultipartParser(self._boundary(header.decode("latin-1")))
        opened.setblocking(False)
        self._frames(rest)

    def _boundary(self, header: str) -> str:
        status = header.partition("\r\n")[0]
        if " 200" not in status:
            raise DeviceError(f"camera at {self._url}: answered {status[:80]!r}; allowed is status 200")
        found = re.search(r"multipart/x-mixed-replace[^\r\n]*boundary=\"?([^\"\r\n;]+)", header, re.IGNORECASE)
        if found is None:
            raise DeviceError(f"camera at {self._url}: no MJPEG stream (multipart/x-mixed-replace)")
        return found.group(1)

    def _receive(self) -> bytes | None:
        if self._socket is None:
            raise DeviceError(f"camera at {self._url}: not connected")
        try:
            data = self._socket.recv(_CHUNK)
        except BlockingIOError:
            return None
        except OSError as error:
            raise self._lost(error) from error
        if not data:
            raise DeviceError(f"camera at {self._url}: the stream ended")
        return data

    def _frames(self, data: bytes) -> list[CameraFrame]:
        now = self._clock.now()
        try:
            parts = self._parser.feed(data, now)
        except StreamError as error:
            raise DeviceError(f"camera at {self._url}: {error}") from error
        return [
            self._counter.frame(self._taken(part), part.body, "jpeg", _sequence(part.header.get("x-frame")))
            for part in parts
            if self._is_picture(part.body)
        ]

    def _is_picture(self, body: bytes) -> bool:
        """Whether a part is a JPEG picture; refuse one of another size. Where none is asked for, anything will do."""
        if self._size is None:
            return True
        found = jpeg_size(body)
        if found is not None and found != tuple(self._size):
            wanted, shown = (f"{width} x {height}" for width, height in (self._size, found))
            raise DeviceError(f"camera at {self._url}: gives {shown} pixels; the rig asks for {wanted} (camera.size)")
        return found is not None

    def _taken(self, part: Part) -> float:
        """When a frame was taken, as far as can be told, s."""
        text = part.header.get("x-timestamp", "") if self._same_clock else ""
        return min(float(text), part.arrived) if _SECONDS.fullmatch(text) else part.arrived

    def _lost(self, error: OSError) -> DeviceError:
        return DeviceError(f"camera at {self._url}: {error.strerror or error}; check address, cable and power")


def _sequence(text: str | None) -> int | None:
    return int(text) if text is not None and text.isdecimal() else None
