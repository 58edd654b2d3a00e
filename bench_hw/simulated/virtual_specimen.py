"""`VirtualSpecimen`: a specimen known by force over depth under several tools, with an effect that may be put into it.

For benches without hardware on which experiments are proposed, done and judged. It takes what a protocol's `[setup]`
asks a person to do first (another tool, a rigid block in its place). Everything is synthetic. The effects are in forms
of their own: relaxation and drainage as sums of modes, drainage's times growing with the tool radius squared; slip as
three elements that slide one after the other; a rig that gives way in series; a zero that creeps. No markers.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import Field
from scipy.signal import lfilter

from bench_hw.configuration import StrictModel, parse_quantity, read_toml, validated
from bench_hw.errors import InputError
from bench_hw.simulated.specimen import FloatArray, Response

MODES = 6
"""Of drainage: mode n is n^2 times as fast and as small."""
ELEMENTS = (0.5, 1.0, 2.0)
"""Forces at which the slipping elements slide, over the stated one."""
BLOCK = 4e5
"""Stiffness of a rigid block with what holds it, N/m."""
Rows = Annotated[tuple[float, ...], Field(min_length=4, max_length=10_000)]
Share = Annotated[float, Field(ge=0.0, lt=1.0)]
Positive = Annotated[float, Field(gt=0.0, le=1e6)]


class ToolCurve(StrictModel):
    """Force over depth under one tool, as the file has it."""

    radius_mm: Positive
    depth_mm: Rows
    force_N: Rows


class HiddenEffects(StrictModel):
    """What is put in; nothing by default."""

    relaxation: tuple[tuple[Share, Positive], ...] = ()
    drainage_share: Share = 0.0
    drainage_mm2_per_s: Positive = 1.0
    drift_mN_per_s: Annotated[float, Field(ge=-100.0, le=100.0)] = 0.0
    compliance_mm_per_N: Annotated[float, Field(ge=0.0, le=10.0)] = 0.0
    slip_share: Share = 0.0
    slip_force_N: Positive = 1.0


class SpecimenFile(StrictModel):
    """A specimen's file; `support` is what a session file says of it."""

    schema_version: Annotated[Literal[1], Field(alias="schema")]
    synthetic: Literal[True]
    contact: Annotated[str, Field(max_length=40)] = "rigid_bonded"
    support: dict[str, str] = Field(default_factory=dict)
    tools: Annotated[tuple[ToolCurve, ...], Field(min_length=1, max_length=20)]
    effects: HiddenEffects = HiddenEffects()


@dataclass(slots=True)
class _Past:
    """Where the history stands at the newest row: elastic force, that with slip, lags of the fading modes, elements."""

    time: float = -1.0
    elastic: float = 0.0
    carried: float = 0.0
    lags: tuple[float, ...] = ()
    held: tuple[float, ...] = (0.0,) * len(ELEMENTS)


@dataclass(frozen=True, eq=False, slots=True)
class VirtualSpecimen:
    """A specimen under one tool.

    Parameters
    ----------
    file : SpecimenFile
        What it is.
    radius : float
        Of the tool in use, m.
    block : bool
        Whether a rigid block lies in its place.
    """

    file: SpecimenFile
    radius: float
    block: bool = False
    _past: _Past = field(default_factory=_Past)

    def __call__(self, time: FloatArray, depth: FloatArray, start: int) -> Response:
        """Answer a history of depth in rows equally spaced in time; rows before the last answer must not change.

        Raises
        ------
        ValueError
            A depth beyond the curve of the tool.
        """
        goes_on = start > 0 and self._past.time == time[start - 1]
        past, first = (self._past, start) if goes_on else (_Past(), 0)
        step = float(time[1] - time[0]) if len(time) > 1 else 1e-3
        pressed = np.maximum(depth[first:], 0.0)
        elastic = self._elastic(pressed)
        carried, held = self._slipped(elastic, past)
        force, lags = self._faded(carried, past, step)
        if len(elastic) and (time[-1] > self._past.time or time[start] == 0.0):  # not one of the past
            self._past.time, self._past.lags, self._past.held = float(time[-1]), lags, held
            self._past.elastic, self._past.carried = float(elastic[-1]), float(carried[-1])
        press = np.maximum(force, 0.0) * (pressed > 0.0)
        out = np.zeros((len(depth) - start, 3))
        out[:, 2] = (press + 1e-3 * self.file.effects.drift_mN_per_s * time[first:])[start - first :]
        return Response(out, np.zeros((len(out), 0, 3)))

    def session_keys(self) -> dict[str, dict[str, object]]:
        """What a session file says of this specimen: tool and support."""
        tool = {"radius": f"{1e3 * self.radius:g} mm", "contact": self.file.contact}
        return {"tool": dict(tool), **({"support": dict(self.file.support)} if self.file.support else {})}

    def with_setup(self, setup: Mapping[str, object]) -> VirtualSpecimen:
        """Do what a protocol asks a person to do first.

        Raises
        ------
        InputError
            There is no such tool here.
        """
        wanted = setup.get("tool_radius")
        radius = self.radius if wanted is None else parse_quantity(str(wanted), "m")
        specimen = replace(self, radius=radius, block="specimen" in setup, _past=_Past())
        specimen._curve()
        return specimen

    def _curve(self) -> ToolCurve:
        near = min(self.file.tools, key=lambda tool: abs(1e-3 * tool.radius_mm - self.radius))
        if abs(1e-3 * near.radius_mm - self.radius) > 0.01 * self.radius:
            there = ", ".join(f"{tool.radius_mm:g} mm" for tool in self.file.tools)
            raise InputError(f"a tool of {1e3 * self.radius:g} mm radius: allowed for this specimen are {there}")
        return near

    def _elastic(self, pressed: FloatArray) -> FloatArray:
        """Force (n,) at reported depths (n,): the rig's give is in series."""
        give = 1e-3 * self.file.effects.compliance_mm_per_N
        if self.block:
            return np.asarray(pressed / (give + 1.0 / BLOCK))
        curve = self._curve()
        depth, force = 1e-3 * np.array(curve.depth_mm), np.array(curve.force_N)
        reported = depth + give * force
        if len(pressed) and float(pressed.max()) > reported[-1]:
            raise ValueError(f"depth {1e3 * pressed.max():g} mm: the curve ends at {1e3 * reported[-1]:g} mm")
        return np.asarray(np.interp(pressed, reported, force))

    def _slipped(self, elastic: FloatArray, past: _Past) -> tuple[FloatArray, tuple[float, ...]]:
        """Force (n,) of which a share goes through elements that slide, and what they hold at the end."""
        effects = self.file.effects
        if effects.slip_share == 0.0 or self.block:
            return elastic, past.held
        each = effects.slip_share / len(ELEMENTS)
        limits = [each * factor * effects.slip_force_N for factor in ELEMENTS]
        held, before, out = list(past.held), past.elastic, np.empty(len(elastic))
        for row, now in enumerate(elastic.tolist()):
            held = [min(max(y + each * (now - before), -most), most) for y, most in zip(held, limits, strict=True)]
            out[row], before = (1.0 - effects.slip_share) * now + sum(held), now
        return out, tuple(held)

    def _modes(self) -> list[tuple[float, float]]:
        """Shares and times (s) of what fades."""
        effects = self.file.effects
        weights = np.arange(1, MODES + 1) ** -2.0
        slowest = (1e3 * self.radius) ** 2 / effects.drainage_mm2_per_s
        drained = [(effects.drainage_share * w / weights.sum(), slowest * w) for w in weights.tolist()]
        return [*effects.relaxation, *(drained if effects.drainage_share else [])] if not self.block else []

    def _faded(self, force: FloatArray, past: _Past, step: float) -> tuple[FloatArray, tuple[float, ...]]:
        """Force (n,) with what has faded missing, and where each mode stands at the end."""
        total, ends, modes = force, [], self._modes()
        rises = np.diff(force, prepend=past.carried)
        for (share, tau), lag in zip(modes, past.lags or (0.0,) * len(modes), strict=True):
            keep = np.exp(-step / tau)
            held, _ = lfilter([share * tau / step * (1.0 - keep)], [1.0, -keep], rises, zi=[keep * lag])
            total = total - share * force + held
            ends.append(float(held[-1]) if len(held) else lag)
        return np.asarray(total), tuple(ends)


def read_specimen(path: Path) -> VirtualSpecimen:
    """Read a specimen's file; the first tool is in use.

    Raises
    ------
    InputError
        No such file, or it says something that is not allowed.
    """
    tables, _ = read_toml(path)
    file = validated(SpecimenFile, tables, str(path))
    for place, tool in enumerate(file.tools, 1):
        rising = len(tool.depth_mm) == len(tool.force_N) and bool((np.diff(tool.depth_mm) > 0.0).all())
        if not rising or bool((np.diff(tool.force_N) < 0.0).any()):
            raise InputError(f"{path}: tools[{place}]: depth_mm and force_N are of one length and increase")
    return VirtualSpecimen(file, 1e-3 * file.tools[0].radius_mm)
