"""Units at the border: newton for the force, millimetres for markers."""

from __future__ import annotations


def channel_unit(channel: str) -> tuple[str, float]:
    """Unit of a channel and the factor from SI to it."""
    return ("N", 1.0) if channel.startswith("force") else ("mm", 1e3)
