"""The `with` statement of a driver: connect on the way in, close on the way out."""

from __future__ import annotations

from abc import ABC, abstractmethod
from types import TracebackType
from typing import Self


class Connection(ABC):
    """Something that is connected explicitly and always let go."""

    @abstractmethod
    def connect(self) -> None:
        """Open the device."""

    @abstractmethod
    def close(self) -> None:
        """Let go of the device."""

    def __enter__(self) -> Self:
        self.connect()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
