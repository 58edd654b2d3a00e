"""What a sheet under a tool does in one trial: its force and where its markers are seen."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from benchmark.fitting.curve import Array, ForceCurve
from benchmark.fitting.face import EVERYWHERE, FaceField, View
from benchmark.fitting.film import FilmedTrial
from benchmark.fitting.relaxation import NONE, Relaxation, relaxed


@dataclass(frozen=True)
class Sheet:
    """A model's answer to one tool and support: of the specimen as its file has it, and of a thicker one.

    Attributes
    ----------
    curve, face
        Force and lower face of the specimen.
    thick_curve, thick_face
        The same with all layers `thicker` times as thick.
    thicker : float
        Above 1.
    view : View
        The camera.
    """

    curve: ForceCurve
    face: FaceField
    thick_curve: ForceCurve
    thick_face: FaceField
    thicker: float
    view: View = EVERYWHERE

    @property
    def reach(self) -> float:
        """Deepest depth that both curves cover, m."""
        return min(self.curve.reach, self.thick_curve.reach)

    def force(self, below: Array, log_thickness: float) -> Array:
        """Elastic force (n,) N at stiffness factor 1, at depths below contact; a power of the thickness."""
        depth = np.minimum(below, self.reach)
        thin = self.curve(depth)
        if log_thickness == 0.0:
            return thin
        share = log_thickness / math.log(self.thicker)
        ratio = np.divide(self.thick_curve(depth), thin, out=np.ones_like(thin), where=thin > 0.0)
        return np.asarray(thin * ratio**share)

    def markers(self, rest: Array, axis: Array, below: Array, log_thickness: float) -> Array:
        """Where the camera sees the markers, (n, m, 2) m; linear in the logarithm of the thickness."""
        thin = self.face.markers(rest, axis, below, self.view)
        if log_thickness == 0.0:
            return thin
        share = log_thickness / math.log(self.thicker)
        return np.asarray(thin + share * (self.thick_face.markers(rest, axis, below, self.view) - thin))


@dataclass(frozen=True)
class SheetState:
    """Parameters of one trial; SI, thickness as the logarithm of its ratio to the file's."""

    log_stiffness: float
    onset: float
    zero: float
    axis: tuple[float, float] = (0.0, 0.0)
    log_thickness: float = 0.0
    relaxation: Relaxation = NONE


def sheet_force(filmed: FilmedTrial, sheet: Sheet, state: SheetState) -> Array:
    """Force (n,) N of each row of a trial."""
    trial = filmed.trial
    elastic = math.exp(state.log_stiffness) * sheet.force(trial.depth - state.onset, state.log_thickness)
    pressing = np.maximum(relaxed(trial.time, elastic, state.relaxation), 0.0)
    return np.asarray(state.zero + np.where(trial.depth > state.onset, pressing, 0.0))


def sheet_markers(filmed: FilmedTrial, sheet: Sheet, state: SheetState) -> Array:
    """Where the camera sees each marker, (f, m, 2) m."""
    below = filmed.depth - state.onset
    return sheet.markers(filmed.rest, np.array(state.axis), below, state.log_thickness)
