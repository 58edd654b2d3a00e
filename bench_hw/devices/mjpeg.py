"""Pictures out of a `multipart/x-mixed-replace` stream, fed in pieces of any size. No sockets here."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

_LARGEST_PART = 32 * 1024 * 1024
_LARGEST_HEAD = 16 * 1024


class StreamError(ValueError):
    """The bytes are no multipart stream."""


@dataclass(frozen=True, slots=True)
class Part:
    """One part of the stream: its header (lower-case names) and its body."""

    header: Mapping[str, str]
    body: bytes


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

    def feed(self, data: bytes) -> list[Part]:
        """Take the next bytes and give the parts that are whole now.

        Raises
        ------
        StreamError
            A head above 16 KiB, a part above 32 MiB, or a length that is no number.
        """
        self._buffer += data
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
        part = Part(header, bytes(self._buffer[body:stop]))
        del self._buffer[:stop]
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


def _header(head: bytes) -> dict[str, str]:
    lines = head.decode("latin-1").split("\r\n")
    pairs = (line.partition(":") for line in lines if ":" in line)
    return {name.strip().lower(): value.strip() for name, _, value in pairs}
