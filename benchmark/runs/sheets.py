"""The sheets of a session: force and lower face of its specimen over depth, as its file has it and a little thicker."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from benchmark.errors import SolverError
from benchmark.files import Session, Tissue
from benchmark.fitting import FaceField, ForceCurve, Sheet, View
from benchmark.models import Drive, StepProgress, prepare
from benchmark.models.lower_face import lower_face
from benchmark.runs.base_curve import Setup, setup_scenario
from benchmark.runs.listener import Advance, Listener

THICKER = 1.1
STEPS = 24


def session_sheets(
    session: Session, depths: Mapping[Setup, float], view: View, listener: Listener
) -> tuple[dict[Setup, Sheet], tuple[str, ...]]:
    """Compute a sheet for each tool and support over a hole; others, and what the solver cannot follow, are said.

    Parameters
    ----------
    session : Session
    depths : mapping
        How deep (m) each setup is needed.
    view : View
        The camera.
    listener : Listener
    """
    sheets, warnings = {}, []
    with listener.progress(f"{session.name}: lower face of the specimen") as advance:
        for setup, depth in depths.items():
            if setup[1].kind != "hole":
                warnings.append("the markers of trials without a hole are not fitted: their face is held")
                continue
            try:
                thin, thick = (_ramp(session, tissue, setup, depth, advance) for tissue in _pair(session.specimen))
            except SolverError as error:
                warnings.append(f"the markers are not fitted: {error}")
                continue
            sheets[setup] = Sheet(*thin, *thick, THICKER, view)
    return sheets, tuple(dict.fromkeys(warnings))


def _pair(tissue: Tissue) -> tuple[Tissue, Tissue]:
    layers = [layer.model_copy(update={"thickness": THICKER * layer.thickness}) for layer in tissue.layers]
    return tissue, tissue.model_copy(update={"layers": tuple(layers), "name": f"{tissue.name}, thicker"})


def _ramp(
    session: Session, tissue: Tissue, setup: Setup, depth: float, advance: Advance
) -> tuple[ForceCurve, FaceField]:
    scenario = setup_scenario(session, tissue, setup)
    fractions = np.arange(1, STEPS + 1) / STEPS

    def on_step(step: StepProgress) -> None:
        advance(tissue.name, step.step, step.total, f"{1e3 * step.depth:.3g} mm")

    result = prepare("fem", scenario, every_field=True).run(Drive("depth", fractions, depth * fractions), on_step)
    face = lower_face(result)
    if result.failure is not None or face is None:
        raise SolverError(f"the finite elements do not follow the sheet to {1e3 * depth:.4g} mm ({result.failure})")
    return ForceCurve(result.depth, result.force), FaceField(face.depth, face.radius, face.outward, face.sunk)
