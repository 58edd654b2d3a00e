"""`HttpCamera`: a camera that streams MJPEG over HTTP; its JPEG bytes are passed on as they come.

A frame is stamped when its last byte has been read. Where the stream numbers its frames (`X-Frame` in a
part's header), dropped frames are known for certain; see `frame_count` for the others.
"""

from __future__ import annotations

import re
import socket
from urllib.parse import urlsplit

from bench_hw.clock import Clock, MonotonicClock
from bench_hw.devices._context import Connection
from bench_hw.devices.frame_count import FrameCounter
from bench_hw.devices.mjpeg import MultipartParser, StreamError
from bench_hw.devices.protocols import CameraHealth, DeviceInfo, Frame
from bench_hw.errors import DeviceError

_CHUNK = 1 << 18
_MOST_CHUNKS = 64
_LARGEST_HEAD = 16 * 1024


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
    """

    def __init__(self, url: str, *, rate: float = 30.0, clock: Clock | None = None, timeout: float = 2.0) -> None:
        self._url, self._rate, self._timeout = url, rate, timeout
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
        parts = urlsplit(self._url)
        if parts.scheme != "http" or not parts.hostname:
            raise DeviceError(f"camera at {self._url}: allowed is an address like http://host:port/path")
        try:
            opened = socket.create_connection((parts.hostname, parts.port or 80), self._timeout)
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
        """Throw away what has come so far and number frames from 0.

        Raises
        ------
        DeviceError
            Not connected, or the stream ended.
        """
        self._streaming = True
        self.read()
        self._counter = FrameCounter(1.0 / self._rate)

    def read(self) -> list[Frame]:
        """Give the frames that are whole since the last call; never waits.

        Raises
        ------
        DeviceError
            Not connected, the stream ended, or its bytes make no sense.
        """
        frames: list[Frame] = []
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

    def _begin(self, opened: socket.socket) -> None:
        head = b""
        try:
            while b"\r\n\r\n" not in head and len(head) < _LARGEST_HEAD:
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

    def _frames(self, data: bytes) -> list[Frame]:
        now = self._clock.now()
        try:
            parts = self._parser.feed(data)
        except StreamError as error:
            raise DeviceError(f"camera at {self._url}: {error}") from error
        return [self._counter.frame(now, part.body, "jpeg", _sequence(part.header.get("x-frame"))) for part in parts]

    def _lost(self, error: OSError) -> DeviceError:
        return DeviceError(f"camera at {self._url}: {error.strerror or error}; check address, cable and power")


def _sequence(text: str | None) -> int | None:
    return int(text) if text is not None and text.isdecimal() else None
