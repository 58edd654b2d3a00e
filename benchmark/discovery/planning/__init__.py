"""The next experiment: from rivals to a protocol that the bench can run."""

from benchmark.discovery.planning.proposing import propose

__all__ = ["propose"]
