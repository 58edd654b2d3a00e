"""Tools on a tissue's vertices, frame after frame: touch, press, move, let go, several at once, and force out."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.control.contact_relaxation import ContactRelaxation
from wavemodel.control.pressed_body import Body
from wavemodel.errors import WaveError, require_positive
from wavemodel.integrators.viscoelastic import ELASTIC, Prony

SWEEPS, CLOSE = 200, 1e-12
"""For tools that feel each other."""
GONE = 1e-9
"""Of the elastic force at release: what is less is at rest."""
ROUNDING = 1e-9
"""Of two tool radii: what two tools may seem closer than that by the rounding of their places."""


@dataclass(frozen=True)
class Grid:
    """Vertices every `spacing` along x from 0 to the width and along y from 0 to the height.

    Attributes
    ----------
    width, height, spacing
        In m.

    Raises
    ------
    WaveError
        If a length is not positive, or the spacing is wider than the tissue.
    """

    width: float
    height: float
    spacing: float

    def __post_init__(self) -> None:
        for name in ("width", "height", "spacing"):
            require_positive(f"tissue: {name}", getattr(self, name), "m")
        if self.spacing > min(self.width, self.height):
            raise WaveError(
                f"tissue: spacing = {self.spacing * 1e3:g} mm is not allowed: at most its sides, "
                f"{self.width * 1e3:g} x {self.height * 1e3:g} mm"
            )

    @cached_property
    def x(self) -> FloatArray:
        """(P,) in m."""
        return self._line(self.width)

    @cached_property
    def y(self) -> FloatArray:
        """(Q,) in m."""
        return self._line(self.height)

    def _line(self, side: float) -> FloatArray:
        return np.asarray(np.arange(int(side / self.spacing + 1e-9) + 1) * self.spacing)

    def holds(self, x: float, y: float) -> bool:
        """Whether a point, m, is on the tissue."""
        return 0.0 <= x <= self.width and 0.0 <= y <= self.height

    def window(self, x: float, y: float, reach: float) -> tuple[int, int, int, int]:
        """Vertices within `reach` (m) of x and of y, clipped at the edges: first and end of each."""
        return *self._span(x, reach, self.x.size), *self._span(y, reach, self.y.size)

    def most_vertices(self, reach: float) -> int:
        """Most vertices that a window can hold."""
        span = int(2.0 * reach / self.spacing + 1e-6) + 2
        return min(span, self.x.size) * min(span, self.y.size)

    def _span(self, at: float, reach: float, count: int) -> tuple[int, int]:
        first, last = np.ceil((at - reach) / self.spacing - 1e-9), np.floor((at + reach) / self.spacing + 1e-9)
        return max(int(first), 0), min(int(last) + 1, count)


@dataclass
class _Contact:
    """One tool: idle, pressed to a depth, or let go and returning."""

    x: float = 0.0
    y: float = 0.0
    depth: float = 0.0
    phase: str = "idle"
    elastic: float = 0.0
    before: float = 0.0
    start: float = 0.0
    share: float = 0.0
    steps: int | None = None
    window: tuple[int, int, int, int] = (0, 0, 0, 0)


class InteractiveTissue:
    """A tissue under up to `contacts` tools; a frame works in memory that was made beforehand.

    NumPy itself may take buffers of 64 KB for a moment. Only vertices within the body's reach of a contact move,
    clipped at the tissue's edges; the others are untouched. Bad input raises before anything changes.

    A tool pushes and never pulls: one that goes up faster than the tissue creeps loses it, feels nothing, and meets it
    again where it then stands. The same goes for a tool that touches, within its radius, where it let go; touching
    elsewhere begins anew, and what was left of the old dent is gone.

    Parameters
    ----------
    body
        What is pressed and with what tool.
    grid
        The tissue's vertices.
    contacts
        Most tools at once.
    series
        ContactRelaxation memory of the tissue.
    retardation
        Kelvin-Voigt time, s.

    Attributes
    ----------
    force
        (contacts,) on each tool after the last frame, N; nought where none presses.

    Raises
    ------
    WaveError
        If the number of contacts or the damping is not usable.
    """

    def __init__(
        self, body: Body, grid: Grid, contacts: int = 4, *, series: Prony = ELASTIC, retardation: float = 0.0
    ) -> None:
        if contacts < 1:
            raise WaveError(f"contacts = {contacts} is not allowed: at least 1")
        self.body, self.grid = body, grid
        self.force: FloatArray = np.zeros(contacts)
        self._contacts = [_Contact() for _ in range(contacts)]
        self._relaxation = ContactRelaxation(contacts, series, retardation)
        self._out = np.zeros((body.layers, grid.x.size, grid.y.size))
        self._dx, self._dy = np.empty(grid.x.size), np.empty(grid.y.size)

    def touch(self, contact: int, x: float, y: float, depth: float) -> None:
        """Put a tool somewhere and press it to a depth, or move one that presses.

        Parameters
        ----------
        contact
            Which tool, 0..contacts-1.
        x, y
            On the tissue, m.
        depth
            Below the untouched surface, m; not negative.

        Raises
        ------
        WaveError
            For a tool that does not exist, a contact outside the tissue, a depth beyond the model's range, or a place
            that another tool holds.
        """
        tool = self._tool(contact)
        self._check(contact, x, y, depth)
        if tool.phase == "returning" and float(np.hypot(x - tool.x, y - tool.y)) > self.body.tool_radius:
            self._forget(contact, tool)
        tool.x, tool.y, tool.depth, tool.phase = x, y, depth, "pressed"

    def release(self, contact: int, steps: int | None = None) -> None:
        """Let go: the surface returns to its shape in so many frames, or in physical time where `steps` is None.

        In physical time a body returns as it creeps back (at once where nothing relaxes), the published membrane in
        what is left of a quarter of its period.

        Raises
        ------
        WaveError
            If the tool does not press, or there is no step.
        """
        tool = self._tool(contact)
        if tool.phase != "pressed":
            raise WaveError(f"contact = {contact} is not allowed: this tool does not press")
        if steps is not None and steps < 1:
            raise WaveError(f"steps = {steps} is not allowed: at least 1, or None for physical time")
        tool.phase, tool.start, tool.share, tool.steps = "returning", tool.elastic, 0.0, steps

    def frame(self, dt: float) -> FloatArray:
        """Go on by a frame.

        Parameters
        ----------
        dt
            Its duration, s.

        Returns
        -------
        ndarray (L, P, Q)
            Deflection of each layer's top face at the grid's vertices, m, downwards. The same memory at every call.

        Raises
        ------
        WaveError
            If the duration is not positive.
        """
        self.advance(dt)
        self._draw()
        return self._out

    def advance(self, dt: float) -> None:
        """Go on by a frame of dt (s) with the forces alone, for a loop that draws less often than it feels.

        Raises
        ------
        WaveError
            If the duration is not positive.
        """
        require_positive("dt", dt, "s")
        for index, tool in enumerate(self._contacts):
            if tool.phase == "returning":
                self._return(index, tool, dt)
        self._press(dt)
        for index, tool in enumerate(self._contacts):
            pressed = tool.phase == "pressed"
            held = max(self._relaxation.held(index, tool.elastic, dt), 0.0) if pressed else 0.0
            self.force[index] = self.body.reaction(held) if pressed else 0.0

    def presses(self, contact: int) -> bool:
        """Whether a tool is on the tissue.

        Raises
        ------
        WaveError
            For a tool that does not exist.
        """
        return self._tool(contact).phase == "pressed"

    def _tool(self, contact: int) -> _Contact:
        if not 0 <= contact < len(self._contacts):
            raise WaveError(f"contact = {contact} is not allowed: 0 to {len(self._contacts) - 1}")
        return self._contacts[contact]

    def _check(self, contact: int, x: float, y: float, depth: float) -> None:
        if not self.grid.holds(x, y):
            raise WaveError(
                f"contact at ({x * 1e3:g}, {y * 1e3:g}) mm is outside the tissue: 0 to {self.grid.width * 1e3:g} mm "
                f"along x and 0 to {self.grid.height * 1e3:g} mm along y"
            )
        if not 0.0 <= depth <= self.body.deepest:
            raise WaveError(f"depth = {depth * 1e3:g} mm is not allowed: 0 to {self.body.deepest * 1e3:.4g} mm")
        touching = 2.0 * self.body.tool_radius * (1.0 - ROUNDING)
        for index, other in enumerate(self._contacts):
            apart = float(np.hypot(x - other.x, y - other.y))
            if index != contact and other.phase == "pressed" and apart < touching:
                raise WaveError(
                    f"contact = {contact} is not allowed {apart * 1e3:g} mm from tool {index}: at least two tool "
                    f"radii, {2e3 * self.body.tool_radius:g} mm, apart"
                )

    def _return(self, index: int, tool: _Contact, dt: float) -> None:
        alone = self.body.return_time(tool.start)
        if tool.steps is None and alone is None:
            tool.elastic = self._relaxation.free(index, dt)
            done = abs(tool.elastic) <= GONE * abs(tool.start)
        else:
            tool.share += 1.0 / tool.steps if tool.steps is not None else dt / max(alone or 0.0, 1e-300)
            done = tool.share >= 1.0 - 1e-9
            before, tool.elastic = tool.elastic, 0.0 if done else self.body.returning(tool.start, tool.share)
            self._relaxation.fade(index, tool.elastic / before if before else 0.0)
        if done:
            self._forget(index, tool)

    def _forget(self, index: int, tool: _Contact) -> None:
        """The surface is at rest."""
        tool.elastic, tool.phase = 0.0, "idle"
        self._relaxation.forget(index)

    def _press(self, dt: float) -> None:
        """Elastic forces that bring each pressed tool to its depth under the forces of all; no tool pulls."""
        scale, busy = 0.0, sum(tool.phase != "idle" for tool in self._contacts)
        for tool in self._contacts:
            tool.before = tool.elastic
        for _ in range(SWEEPS if busy > 1 else 1):
            change = 0.0
            for index, tool in enumerate(self._contacts):
                if tool.phase == "pressed":
                    found = self.body.elastic(max(tool.depth - self._sunk(tool), 0.0))
                    if found < tool.before:
                        found = max(found, self._relaxation.let_go(index, dt))
                    change, tool.elastic = max(change, abs(found - tool.elastic)), found
                    scale = max(scale, abs(found))
            if change <= CLOSE * scale:
                break

    def _sunk(self, tool: _Contact) -> float:
        """How deep the others press the surface under a tool, m."""
        return sum(
            other.elastic * self.body.between(float(np.hypot(tool.x - other.x, tool.y - other.y)))
            for other in self._contacts
            if other is not tool and other.elastic
        )

    def _draw(self) -> None:
        for tool in self._contacts:
            a, b, c, d = tool.window
            self._out[:, a:b, c:d] = 0.0
        for tool in self._contacts:
            tool.window = (0, 0, 0, 0)
            if not tool.elastic:
                continue
            a, b, c, d = tool.window = self.grid.window(tool.x, tool.y, self.body.reach)
            dx, dy = self._dx[: b - a], self._dy[: d - c]
            np.subtract(self.grid.x[a:b], tool.x, out=dx)
            np.subtract(self.grid.y[c:d], tool.y, out=dy)
            self.body.add(tool.elastic, dx, dy, self._out[:, a:b, c:d])
