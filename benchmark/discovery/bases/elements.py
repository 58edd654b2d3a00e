"""The finite elements as an elastic base, by one depth ramp of a set-up for each of three tool radii."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator

from benchmark.discovery.bases.law import MARGIN, POINTS, STEP, BaseLaw, BaseLaws, orders, reduced, resized
from benchmark.discovery.bases.wave import wave_law
from benchmark.discovery.discovery_result import Array
from benchmark.errors import InputError
from benchmark.files import Session, Support, Tissue, Tool
from benchmark.models import Drive, UncoveredError, prepare
from benchmark.models.lower_face import LowerFace, lower_face
from benchmark.runs.base_curve import setup_scenario

STEPS = 24
LEAST_REACH = 0.5
"""A ramp that the solver followed at least this far of the trials' depth serves; beyond it goes on like the wave."""


@dataclass(frozen=True, eq=False)
class Ramp:
    """A press as far as the solver followed: depth (k,) m and force (k,) N from 0, and the lower face."""

    depth: Array
    force: Array
    face: LowerFace | None


def elements_or_wave(session: Session) -> BaseLaws:
    """The base of each set-up of a session: the finite elements', or the wave's where they do not cover it."""

    def law(tissue: Tissue, tool: Tool, support: Support, depth: float) -> BaseLaw:
        try:
            return _law(session, tissue, tool, support, depth)
        except InputError as error:
            return _noted(wave_law(tissue, tool, support, depth), str(error))

    return law


def elements_only(session: Session) -> BaseLaws:
    """The base of each set-up of a session by the finite elements; an error where they do not cover it."""

    def law(tissue: Tissue, tool: Tool, support: Support, depth: float) -> BaseLaw:
        try:
            return _law(session, tissue, tool, support, depth)
        except InputError as error:
            raise InputError(f"--model fem: {error}; --model wave goes on without them.") from None

    return law


def _law(session: Session, tissue: Tissue, tool: Tool, support: Support, depth: float) -> BaseLaw:
    """The base of one set-up.

    Raises
    ------
    InputError
        The solver has no answer, or stops before half the depth.
    """
    tools = [resized(tool, change) for change in (-STEP, 0.0, STEP)]
    ramps = [_ramp(session, tissue, each, support, MARGIN * depth) for each in tools]
    reached = min(float(ramp.depth[-1]) for ramp in ramps)
    if reached < LEAST_REACH * depth:
        raise InputError(
            f"the finite elements of {session.name} stop at {1e3 * reached:.3g} mm of {1e3 * depth:.3g} mm"
        )
    if reached < depth:
        wave = wave_law(tissue, tool, support, depth)
        note = f"the finite elements stop at {1e3 * reached:.3g} mm; beyond, the base goes on like the wave model"
        return _noted(_with_force(wave, ramps[1].depth, ramps[1].force), note)
    return _tables(ramps, reached)


def _ramp(session: Session, tissue: Tissue, tool: Tool, support: Support, deepest: float) -> Ramp:
    fractions = np.arange(1, STEPS + 1) / STEPS
    elastic = tissue.model_copy(
        update={"layers": tuple(one.model_copy(update={"relaxation": ()}) for one in tissue.layers)}
    )
    try:
        model = prepare("fem", setup_scenario(session, elastic, (tool, support)), every_field=True)
        run = model.run(Drive("depth", fractions, deepest * fractions))
    except UncoveredError as error:
        raise InputError(f"the finite elements do not cover {session.name}: {error}") from None
    face = lower_face(run) if support.kind == "hole" else None
    return Ramp(np.append(0.0, run.depth), np.append(0.0, run.force), face)


def _tables(ramps: list[Ramp], reached: float) -> BaseLaw:
    """Tables to the depth that all ramps reached."""
    grid = np.linspace(0.0, reached, POINTS)
    forces = [CubicSpline(ramp.depth, ramp.force)(grid) for ramp in ramps]
    by_radius = np.stack(orders(*forces))
    told = ramps[1].face
    if told is None:
        return BaseLaw(grid, forces[1], by_radius, np.array([0.0, 1.0]))
    levels = told.depth[told.depth <= reached * (1.0 + 1e-9)]
    outward = [_at(ramp.face, ramp.face.outward, levels, told.radius) for ramp in ramps if ramp.face is not None]
    return BaseLaw(
        grid,
        forces[1],
        by_radius,
        told.radius,
        reduced(levels, outward[1], grid),
        reduced(levels, told.sunk[: levels.size], grid),
        tuple(reduced(levels, order, grid) for order in orders(*outward)),
    )


def _at(face: LowerFace, table: Array, levels: Array, radius: Array) -> Array:
    """A table of a lower face at other depths (levels,) and radii (q,)."""
    over_depth = CubicSpline(face.depth, table)(levels)
    return np.asarray(CubicSpline(face.radius, over_depth, axis=1)(np.clip(radius, 0.0, face.radius[-1])))


def _with_force(wave: BaseLaw, depth: Array, force: Array) -> BaseLaw:
    """The wave's tables with another force; beyond the last depth it grows like the wave's."""
    inside = wave.depth <= depth[-1]
    ratio = np.ones_like(wave.force)
    curve = PchipInterpolator(depth, force)(np.minimum(wave.depth, depth[-1]))
    np.divide(curve, wave.force, out=ratio, where=inside & (wave.force > 0.0))
    ratio[~inside] = ratio[inside][-1]
    return replace(wave, force=ratio * wave.force, force_by_radius=ratio * wave.force_by_radius)


def _noted(law: BaseLaw, note: str) -> BaseLaw:
    return replace(law, note=f"{note}; what the wave model itself misses there may be taken for an effect")
