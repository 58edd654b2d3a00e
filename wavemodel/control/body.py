"""What a tool can press interactively: depth and elastic force, each from the other, and the patch that they move."""

from typing import Protocol

from wavemodel.arrays import FloatArray


class Body(Protocol):
    """One tool on one tissue; L layers. Depths in m and positive, elastic forces in N."""

    @property
    def layers(self) -> int:
        """L."""
        ...

    @property
    def tool_radius(self) -> float:
        """In m; nought where the tool is a point."""
        ...

    @property
    def reach(self) -> float:
        """Half of the patch's side: vertices further from the contact do not move, m."""
        ...

    @property
    def deepest(self) -> float:
        """Largest depth that the model answers, m."""
        ...

    def elastic(self, depth: float) -> float:
        """Elastic force at a depth."""
        ...

    def depth(self, elastic: float) -> float:
        """Depth under an elastic force."""
        ...

    def reaction(self, elastic: float) -> float:
        """Force on the tool where nothing fades, N; NaN where the model has none."""
        ...

    def between(self, distance: float) -> float:
        """Depth that one newton on one tool adds under another so far away, m/N; nought where they do not add up."""
        ...

    def returning(self, elastic: float, share: float) -> float:
        """Elastic force after a share of the way back to rest, 0 to 1."""
        ...

    def return_time(self, elastic: float) -> float | None:
        """Time that the body takes to return by itself, s; None where its fading memory decides."""
        ...

    def add(self, elastic: float, dx: FloatArray, dy: FloatArray, out: FloatArray) -> None:
        """Add the patch to `out` (L, p, q), vertices at dx (p,) and dy (q,) from the contact, m; allocates nothing."""
        ...
