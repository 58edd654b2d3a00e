"""The elastic answer of a session's specimen, from depth ramps of the finite elements for each tool and support.

One ramp gives the force over depth; where markers were filmed over a hole, two more give the lower face as the file has
the specimen and a little thicker.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

from benchmark.errors import InputError, SolverError
from benchmark.files import Session, Setup, Tool
from benchmark.models import StepProgress, UncoveredError, prepare
from benchmark.models.model_result import OnStep
from benchmark.response import CameraView, FaceField, ForceCurve, Neighbour, Ramp, RampTable, depth_ramp
from benchmark.response.nearest_curve import NearestCurve, continued, nearest_curve
from benchmark.response.ramp import setup_scenario
from benchmark.response.setup_change import THICKNESS, changed_setup
from benchmark.runs.options import Advance, Listener

STEP = 0.5e-3
LEAST_STEPS = 24
MOST_STEPS = 40
THICKER = 0.1
FACE_STEPS = 24


Followed: TypeAlias = tuple[tuple[Tool, Ramp], ...]


@dataclass(frozen=True)
class BaseCurves:
    """One curve for each tool and support, and what a reader must know of them.

    `followed` are the tools that the solver covers in each set-up, the one told first, each with its own ramp.
    """

    curves: Mapping[Setup, ForceCurve]
    followed: Mapping[Setup, Followed]
    warnings: tuple[str, ...]


def base_curves(session: Session, depths: Mapping[Setup, float], listener: Listener) -> BaseCurves:
    """Compute a curve for each set-up, deep enough for the `depths` (m) asked for.

    Where the finite elements stop, or do not cover the tool, the curve goes on by the nearest tools that they follow,
    and then by its last power of the depth; the warnings say so.

    Raises
    ------
    SolverError
        There is no curve at all.
    """
    curves, followed, warnings = {}, {}, []
    with listener.progress(f"{session.name}: force over depth of the specimen") as advance:
        for number, (setup, depth) in enumerate(depths.items(), start=1):
            found = _followed(session, setup, depth, _told(advance, f"FEM {number}"))
            points, force, beyond = continued(found, depth)
            curves[setup], followed[setup] = ForceCurve(points, force), found.followed
            warnings += ["; ".join(text for text in (found.remark(depth), beyond) if text)]
    return BaseCurves(curves, followed, tuple(dict.fromkeys(text for text in warnings if text)))


def _followed(session: Session, setup: Setup, depth: float, on_step: OnStep) -> NearestCurve:
    """The curve of one set-up, by the nearest tools where the solver does not follow it."""
    steps = min(max(math.ceil(depth / STEP), LEAST_STEPS), MOST_STEPS)
    tissue, told, support = setup

    def ramp_of(tool: Tool) -> Ramp:
        model = prepare("fem", setup_scenario(session, (tissue, tool, support)), beyond_limits=False)
        return depth_ramp(model, depth, steps, on_step)

    try:
        return nearest_curve(told, ramp_of)
    except SolverError as error:
        thick = tissue.thickness
        deeper = f"; asked for {1e3 * depth:.4g} mm of a specimen {1e3 * thick:.4g} mm thick: is another unit meant?"
        raise SolverError(f"session {session.name}: {error}{deeper if depth > thick else ''}") from None


def session_sheets(
    session: Session, depths: Mapping[Setup, float], view: CameraView, listener: Listener
) -> tuple[dict[Setup, RampTable], tuple[str, ...]]:
    """Compute a sheet for each set-up over a hole; others, and what the solver cannot follow, are said.

    Parameters
    ----------
    session : Session
    depths : mapping
        How deep (m) each setup is needed.
    view : CameraView
        The camera.
    listener : Listener
    """
    sheets, warnings = {}, []
    with listener.progress(f"{session.name}: lower face of the specimen") as advance:
        for setup, depth in depths.items():
            if setup[2].kind != "hole":
                warnings.append("the markers of trials without a hole are not fitted: their face is held")
                continue
            try:
                thin, thick = (_sheet(session, setup, share, depth, advance) for share in (0.0, THICKER))
            except (SolverError, InputError, UncoveredError) as error:
                warnings.append(f"the markers are not fitted: {error}")
                continue
            sheets[setup] = RampTable(*thin, {THICKNESS: Neighbour(1.0 + THICKER, *thick)}, view)
    return sheets, tuple(dict.fromkeys(warnings))


def _sheet(
    session: Session, setup: Setup, thicker: float, depth: float, advance: Advance
) -> tuple[ForceCurve, FaceField]:
    """Force and lower face with all layers thicker by a share; raises SolverError."""
    changed = changed_setup(*setup, THICKNESS, thicker)
    name = changed[0].name
    task = f"{name}, thicker" if thicker else name
    model = prepare("fem", setup_scenario(session, changed), every_field=True, beyond_limits=False)
    ramp = depth_ramp(model, depth, FACE_STEPS, _told(advance, task), face=True)
    face = ramp.face
    if ramp.failure is not None or face is None:
        raise SolverError(f"the finite elements do not follow the sheet to {1e3 * depth:.4g} mm ({ramp.failure})")
    return ForceCurve(ramp.depth, ramp.force), FaceField(face.depth, face.radius, face.outward, face.sunk)


def _told(advance: Advance, task: str) -> OnStep:
    def on_step(step: StepProgress) -> None:
        advance(task, step.step, step.total, f"{1e3 * step.depth:.3g} mm")

    return on_step
