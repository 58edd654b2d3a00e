"""`CameraServer`: a simulated webcam as an HTTP MJPEG stream on loopback, or as picture files.

A picture is taken for each instant of the frame timing and sent to every client; a client that does not read
fast enough loses its connection. Each part says its number in `X-Frame` and when
it was taken, by the server's clock, in `X-Timestamp` (s).
"""

from __future__ import annotations

import contextlib
import socket
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from bench_hw.clock import Cancel, Clock

BOUNDARY = "frame"
_TICK = 2e-3
_SEND_TIMEOUT = 1.0
_HEADER = (
    "HTTP/1.0 200 OK\r\nCache-Control: no-store\r\n"
    f"Content-Type: multipart/x-mixed-replace; boundary={BOUNDARY}\r\n\r\n"
).encode("ascii")


@dataclass(frozen=True, slots=True)
class CameraSettings:
    """Timing and faults of the camera.

    Parameters
    ----------
    rate : float
        Frames per second, Hz.
    jitter : float
        Standard deviation of the instant a frame is taken, s.
    quality : int
        JPEG quality.
    loss : float
        Chance that a frame is dropped, 0 to 1.
    drop, freeze : frozenset of int
        Frames (counted from 1) that are dropped, or that repeat the one before.
    """

    rate: float = 30.0
    jitter: float = 0.0
    quality: int = 92
    loss: float = 0.0
    drop: frozenset[int] = field(default_factory=frozenset)
    freeze: frozenset[int] = field(default_factory=frozenset)


class CameraServer:
    """A camera that is switched on when made and off by `close`.

    Parameters
    ----------
    picture : callable
        Reading of the clock (s) to a grey picture (height, width) of uint8.
    clock : Clock
        Its clock.
    settings : CameraSettings
        Timing and faults.
    rng : numpy.random.Generator
        Source of jitter and chance.
    port : int
        Port on 127.0.0.1; 0 lets the system choose.
    """

    def __init__(
        self,
        picture: Callable[[float], NDArray[np.uint8]],
        clock: Clock,
        settings: CameraSettings,
        rng: np.random.Generator,
        *,
        port: int = 0,
    ) -> None:
        self._picture, self._clock, self._settings, self._rng = picture, clock, settings, rng
        self._clients: list[socket.socket] = []
        self._lock = threading.Lock()
        self._number = 0
        self._began = clock.now()
        self._next = self._instant(1)
        self._last: bytes = b""
        self.sent = 0
        self.dropped = 0
        self._frozen = False
        self._listener = socket.create_server(("127.0.0.1", port))
        self._closed = threading.Event()
        self._thread = threading.Thread(target=self._accept, name="camera", daemon=True)
        self._thread.start()
        self._cancel: Cancel = clock.every(_TICK, self.tick)

    @property
    def port(self) -> int:
        """The port it listens on."""
        return int(self._listener.getsockname()[1])

    @property
    def url(self) -> str:
        """Address of the stream."""
        return f"http://127.0.0.1:{self.port}/stream.mjpg"

    def tick(self, now: float) -> None:
        """Take and send the frames that are due at the reading `now`."""
        while self._next <= now and not self._closed.is_set():
            taken_at = self._next
            self._number += 1
            self._next = max(self._instant(self._number + 1), taken_at + 1e-4)
            if self._number in self._settings.drop or self._rng.random() < self._settings.loss:
                self.dropped += 1
            elif self._clients:
                self._send(self._frame(taken_at), taken_at)

    def freeze(self, frozen: bool = True) -> None:
        """Repeat the last picture byte for byte, or take new ones again."""
        self._frozen = frozen

    def unplug(self) -> None:
        """End every client's stream."""
        with self._lock:
            for client in self._clients:
                client.close()
            self._clients.clear()

    def close(self) -> None:
        """Switch the camera off; may be repeated."""
        self._closed.set()
        self._cancel()
        self.unplug()
        with contextlib.suppress(OSError):
            self._listener.shutdown(socket.SHUT_RDWR)
        self._listener.close()
        self._thread.join(timeout=5.0)

    def __enter__(self) -> CameraServer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _instant(self, number: int) -> float:
        return self._began + number / self._settings.rate + self._settings.jitter * self._rng.standard_normal()

    def _frame(self, now: float) -> bytes:
        if not ((self._frozen or self._number in self._settings.freeze) and self._last):
            self._last = encode(self._picture(now), self._settings.quality)
        return self._last

    def _send(self, data: bytes, taken_at: float) -> None:
        about = f"Content-Length: {len(data)}\r\nX-Frame: {self._number}\r\nX-Timestamp: {taken_at:.9f}"
        part = f"--{BOUNDARY}\r\nContent-Type: image/jpeg\r\n{about}\r\n\r\n".encode("ascii") + data + b"\r\n"
        with self._lock:
            for client in tuple(self._clients):
                try:
                    client.sendall(part)
                except OSError:
                    self._clients.remove(client)
                    client.close()
        self.sent += 1

    def _accept(self) -> None:
        while not self._closed.is_set():
            try:
                client, _ = self._listener.accept()
            except OSError:
                return
            client.settimeout(_SEND_TIMEOUT)
            with contextlib.suppress(OSError):
                client.recv(4096)
                with self._lock:  # a client that has the header has a place in the list: no frame is missed
                    self._clients.append(client)
                    client.sendall(_HEADER)


def encode(picture: NDArray[np.uint8], quality: int = 92) -> bytes:
    """Encode a picture as JPEG."""
    import cv2

    return bytes(cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, quality])[1])


def write_pictures(folder: Path, picture: Callable[[float], NDArray[np.uint8]], times: list[float]) -> list[Path]:
    """Write the pictures of given instants as files `frame_00001.png`, lossless; give their paths.

    Raises
    ------
    OSError
        The folder cannot be made or written.
    """
    import cv2

    folder.mkdir(parents=True, exist_ok=True)
    paths = [folder / f"frame_{number:05d}.png" for number in range(1, len(times) + 1)]
    for path, time in zip(paths, times, strict=True):
        path.write_bytes(bytes(cv2.imencode(path.suffix, picture(time))[1]))
    return paths
