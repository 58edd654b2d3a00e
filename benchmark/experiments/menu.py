"""The menu of experiments: motions that differ from a session's own in one thing each, as the bench reads them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import floor
from typing import Any

import numpy as np

from bench_hw.configuration import validated
from bench_hw.motion.plan import MotionPlan, plan
from bench_hw.motion.protocol_file import Protocol
from benchmark.response.force_curve import Array

AIR = -2e-3
APPROACH_SPEED = 1e-3
FASTEST = 20e-3
SLOWEST = 0.05e-3
LONG = 60.0
CYCLES = 3
DEEPER = 1.5
SHARE = 0.6
"""Of the specimen's thickness, beyond which no press is proposed."""


@dataclass(frozen=True)
class Usual:
    """A session's own press: depth m, speed m/s, hold s, and the thickness of the specimen on its base, m.

    The thickness is endless over a hole, where a sheet is pressed deeper than it is thick.
    """

    depth: float
    speed: float
    hold: float
    thickness: float


@dataclass(frozen=True)
class Experiment:
    """An entry of the menu.

    Attributes
    ----------
    name : str
    words : str
        What to do, a sentence.
    segments : tuple of mapping
        Of the protocol, quantities as text.
    setup : mapping
        What a person does first; empty for nothing.
    setup_minutes : float
        How long that takes.
    tool_radius : float or None
        Of another tool than the session's, m.
    """

    name: str
    words: str
    segments: tuple[Mapping[str, Any], ...]
    setup: Mapping[str, Any] = field(default_factory=dict)
    setup_minutes: float = 0.0
    tool_radius: float | None = None

    def table(self) -> dict[str, Any]:
        """The protocol file as a table."""
        setup = {"setup": dict(self.setup)} if self.setup else {}
        return {
            "schema": 1,
            "name": f"next experiment, {self.name}",
            "description": self.words,
            **setup,
            "segments": [dict(segment) for segment in self.segments],
        }


def same_again(usual: Usual) -> Experiment:
    """The session's own press, against which the others are weighed."""
    return Experiment("same again", "Press as before.", _press(usual.depth, usual.speed, usual.hold))


def menu(usual: Usual, *, deeper: bool = True) -> tuple[Experiment, ...]:
    """What can be done with the tool in place, each with one thing changed; `deeper` is one of them."""
    depth, speed, hold = usual.depth, usual.speed, usual.hold
    deep = max(min(DEEPER * depth, SHARE * usual.thickness), depth)
    fast, slow = min(5.0 * speed, FASTEST), max(0.1 * speed, SLOWEST)
    entries = [
        Experiment("longer hold", f"Press as before and hold for {LONG:g} s.", _press(depth, speed, LONG)),
        Experiment("slower", f"Press at {1e3 * slow:.3g} mm/s.", _press(depth, slow, hold)),
        Experiment("faster", f"Press at {1e3 * fast:.3g} mm/s.", _press(depth, fast, hold)),
        Experiment("cycles", f"Press {CYCLES} times in a row.", _cycled(depth, speed)),
        Experiment(
            "rest in air",
            f"Press, rest {LONG:g} s in air, and press again.",
            (*_press(depth, speed, hold), _wait("rest", LONG), *_press(depth, speed, hold)[1:]),
        ),
    ]
    if deeper and deep > 1.05 * depth:
        entries.insert(1, Experiment("deeper", f"Press to {1e3 * deep:.3g} mm.", _press(deep, speed, hold)))
    return tuple(entries)


SECOND_TOOLS = {"wider tool": 1.6, "narrower tool": 1.0 / 1.6, "much wider tool": 2.5, "much narrower tool": 1.0 / 2.5}
"""Radii of second tools over the first one's: what drains takes 2.6 and 6.2 times as long, or as much less."""


SAME_TOOL = 0.01
"""Relative difference of radii up to which a tool is the session's own."""
DEEPEST = 2.0
"""Radii of a tool, deeper than which it is not pressed in the place of another one."""


def second_tools(usual: Usual, radius: float, there: Sequence[float] | None = None) -> tuple[Experiment, ...]:
    """The session's own press with other tools; `radius` is that of the first, m.

    A wider tool is held longer, by the radii's ratio squared: fluid needs that time to leave, and a press as short as
    before would show its beginning alone. A narrower one that would go deeper than its diameter pierces rather than
    presses, and no model follows it there: it is left out, unless the session's own tool goes as deep for its size.

    Parameters
    ----------
    usual
        The press.
    radius
        Of the session's own tool, m.
    there
        Radii of the tools that can be had, m; None: any, of which `SECOND_TOOLS` are taken.
    """
    if there is None:
        others = {name: _round(ratio * radius) for name, ratio in SECOND_TOOLS.items()}
    else:
        others = {f"tool of {_mm(each)}": each for each in there if abs(each - radius) > SAME_TOOL * radius}
    least = min(usual.depth / DEEPEST, radius)
    return tuple(_with_tool(usual, radius, name, other) for name, other in others.items() if other >= least)


def shallower(usual: Usual, radius: float, experiment: Experiment, depth: float) -> Experiment:
    """An experiment of `second_tools` less deep, where the session's own depth would be too hard; `depth` in m."""
    return _with_tool(usual, radius, experiment.name, experiment.tool_radius or radius, floor(1e5 * depth) / 1e5)


def _with_tool(usual: Usual, radius: float, name: str, other: float, depth: float | None = None) -> Experiment:
    hold = max(min(usual.hold * (other / radius) ** 2, LONG), usual.hold)
    longer = f", and hold for {hold:.3g} s" if hold > usual.hold else ""
    pressed = "as before" if depth is None else f"to {1e3 * depth:.3g} mm, since deeper would be too hard"
    words = f"Change the tool to one of {1e3 * other:g} mm radius and press {pressed}{longer}."
    segments = _press(usual.depth if depth is None else depth, usual.speed, hold)
    return Experiment(name, words, segments, {"tool_radius": _mm(other)}, TOOL_MINUTES, other)


TOOL_MINUTES = 5.0


def _round(radius: float) -> float:
    """A radius in whole half millimetres, as tools come; below 2 mm in tenths."""
    step = 5e-4 if radius >= 2e-3 else 1e-4
    return step * max(round(radius / step), 1)


def rigid_block(force: float) -> Experiment:
    """A press of the rig against itself."""
    steps = (
        _approach(),
        {"kind": "move", "force": f"{force:.3g} N", "speed": "0.2 mm/s"},
        _wait("hold", 2.0),
        _retract(2e-3),
    )
    words = (
        f"Put a rigid block in the specimen's place and press to {force:.3g} N, or as hard as the rig and its force "
        "sensor bear: what gives way is the rig."
    )
    return Experiment("rigid block", words, steps, {"specimen": "a rigid block (steel or aluminium)"}, 10.0)


def ruler_image() -> Experiment:
    """A picture of known lengths."""
    words = "Lay a ruler or a printed grid in the plane of the markers and take a picture, then press nothing."
    steps = (_retract(2e-3), _wait("rest", 5.0))
    return Experiment("ruler image", words, steps, {"image": "a ruler in the plane of the markers"}, 5.0)


def _press(depth: float, speed: float, hold: float) -> tuple[Mapping[str, Any], ...]:
    moved = ({"kind": "move", "depth": _mm(depth), "speed": _pace(speed)},)
    held = (_wait("hold", hold),) if hold > 0.0 else ()
    back = ({"kind": "move", "depth": "0 mm", "speed": _pace(speed)},)
    return (_approach(), *moved, *held, *back, _retract(max(speed, 1e-3)))


def _cycled(depth: float, speed: float) -> tuple[Mapping[str, Any], ...]:
    cycle = {"kind": "cycle", "depth": ["0 mm", _mm(depth)], "speed": _pace(speed), "count": CYCLES}
    return (_approach(), cycle, _retract(max(speed, 1e-3)))


def _approach() -> Mapping[str, Any]:
    return {"kind": "approach", "touch_force": "0.05 N", "speed": _pace(APPROACH_SPEED), "max_depth": "15 mm"}


def _retract(speed: float) -> Mapping[str, Any]:
    return {"kind": "retract", "depth": _mm(AIR), "speed": _pace(speed)}


def _wait(kind: str, duration: float) -> Mapping[str, Any]:
    return {"kind": kind, "duration": f"{duration:.4g} s"}


def _mm(length: float) -> str:
    return f"{1e3 * length:.4g} mm"


def _pace(speed: float) -> str:
    return f"{1e3 * speed:.4g} mm/s"


BETWEEN = 0.5
"""Minutes between two trials."""


def motion(experiment: Experiment, rows: int) -> tuple[Array, Array]:
    """Time s and depth m (rows,) of one trial, evenly spaced."""
    steps = dry_run(experiment).steps
    times = np.array([0.0, *(step.start + step.duration for step in steps)])
    depths = np.array([steps[0].depth_from, *(step.depth_to for step in steps)])
    time = np.linspace(0.0, times[-1], rows)
    return time, np.interp(time, times, depths)


def minutes(experiment: Experiment, trials: int) -> float:
    """Bench time of as many trials."""
    return experiment.setup_minutes + trials * (dry_run(experiment).duration / 60.0 + BETWEEN)


def protocol_toml(experiment: Experiment) -> str:
    """The protocol file, checked as the bench checks it."""
    import tomli_w

    table = experiment.table()
    validated(Protocol, table, experiment.name)
    return tomli_w.dumps(table)


def dry_run(experiment: Experiment) -> MotionPlan:
    """Where the tool would be when."""
    return plan(validated(Protocol, experiment.table(), experiment.name))
