"""Laboratories by name: how far what a session tells lies from what is, and how its rig measures, drawn from a seed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

Draw = Callable[[np.random.Generator], "LabConditions"]

PRINTED = 0.06e-3
"""Standard deviation of dots made by hand with a stencil, m."""
USUAL_RATE = 30.0
USUAL_THICKNESS_ERROR, USUAL_MODULUS_ERROR = 0.035, 0.35
"""What people know of a layer who do not say how well: the middles of 2 to 5 % and 20 to 50 %."""
AS_TOLD, UNSTATED = "as_told", "unstated"


@dataclass(frozen=True)
class LabConditions:
    """What differs from a session that tells everything as it is; the defaults are such a session.

    Attributes
    ----------
    name : str
        Of `LABS`.
    print_scatter : float
        Standard deviation by which markers are printed off their grid, m.
    print_stated : bool
        Whether the session states it.
    touch_scatter : float
        Standard deviation of the reported depth's zero from trial to trial, m.
    touch_threshold : float
        Share of the peak force at which the rig finds the surface; 0 where depth 0 is the surface.
    clamp : str
        "plate", as told, or "rim" for sheets.
    modulus_error, thickness_error : float
        Standard deviations of each layer's told modulus (of its logarithm) and thickness, as shares.
    stated : bool
        Whether the specimen states these two.
    stiffness_spread, height_spread : float
        Standard deviations of stiffness (of its logarithm) and height among the trials' specimens; 0: one specimen.
    lens : float
        Radial distortion: by which share places 15 mm from the picture's middle look farther out.
    frame_rate : float
        Of the camera, Hz.
    trials : int
        In all; 0 for the usual ten.
    unloading : bool
        Whether trials go on after the hold.
    """

    name: str = AS_TOLD
    print_scatter: float = 0.0
    print_stated: bool = False
    touch_scatter: float = 0.0
    touch_threshold: float = 0.0
    clamp: str = "plate"
    modulus_error: float = 0.0
    thickness_error: float = 0.0
    stated: bool = True
    stiffness_spread: float = 0.0
    height_spread: float = 0.0
    lens: float = 0.0
    frame_rate: float = USUAL_RATE
    trials: int = 0
    unloading: bool = True

    @property
    def doubtful(self) -> bool:
        """Whether the strength of an effect must leave room for what the lab does not know."""
        return self.name != AS_TOLD

    @property
    def unsure(self) -> LabConditions:
        """The same lab, with what it does not state of the layers as uncertain as that usually is."""
        if self.stated and (self.modulus_error or self.thickness_error):
            return self
        thickness = max(self.thickness_error, USUAL_THICKNESS_ERROR)
        return replace(
            self,
            name=self.name if self.doubtful else UNSTATED,
            stated=False,
            thickness_error=thickness,
            modulus_error=max(self.modulus_error, USUAL_MODULUS_ERROR),
        )

    @property
    def in_words(self) -> str:
        """What is not as told or not as usual."""
        told = "stated" if self.stated else "not stated"
        words = (
            (self.print_scatter, f"print {1e3 * self.print_scatter:.3f} mm"),
            (self.touch_scatter, f"touch {1e3 * self.touch_scatter:.3f} mm"),
            (self.touch_threshold, f"touch at {100 * self.touch_threshold:.1f} % of the peak"),
            (self.clamp != "plate", f"clamped at the {self.clamp}"),
            (self.modulus_error, f"moduli {100 * self.modulus_error:.0f} % ({told})"),
            (self.thickness_error, f"thicknesses {100 * self.thickness_error:.0f} % ({told})"),
            (self.stiffness_spread, f"stiffness spread {100 * self.stiffness_spread:.0f} %"),
            (self.height_spread, f"height spread {100 * self.height_spread:.1f} %"),
            (self.lens, f"lens {100 * self.lens:+.2f} %"),
            (self.frame_rate != USUAL_RATE, f"{self.frame_rate:.0f} Hz"),
            (self.trials, f"{self.trials} trials"),
            (not self.unloading, "no unloading"),
        )
        return ", ".join(text for said, text in words if said)


def _clamped_otherwise(_: np.random.Generator) -> LabConditions:
    return LabConditions(print_scatter=PRINTED, clamp="rim")


def _as_labs_are(_: np.random.Generator) -> LabConditions:
    return LabConditions(print_scatter=0.1e-3, touch_scatter=0.05e-3, modulus_error=0.25, thickness_error=0.04)


def _specimens_differ(rng: np.random.Generator) -> LabConditions:
    return LabConditions(
        print_scatter=PRINTED,
        stiffness_spread=float(rng.uniform(0.1, 0.35)),
        height_spread=float(rng.uniform(0.01, 0.04)),
    )


def _found_by_force(rng: np.random.Generator) -> LabConditions:
    return LabConditions(
        print_scatter=PRINTED,
        touch_threshold=float(rng.uniform(0.01, 0.04)),
        touch_scatter=float(rng.uniform(0.01e-3, 0.05e-3)),
    )


def _another_camera(rng: np.random.Generator) -> LabConditions:
    return LabConditions(
        print_scatter=float(rng.uniform(0.0, 0.3e-3)),
        print_stated=bool(rng.random() < 0.5),
        lens=float(rng.uniform(-0.01, 0.01)),
        frame_rate=_rate(rng),
    )


def _short_of_trials(rng: np.random.Generator) -> LabConditions:
    return LabConditions(print_scatter=PRINTED, trials=_trials(rng), unloading=bool(rng.random() < 0.5))


def _anything(rng: np.random.Generator) -> LabConditions:
    return LabConditions(
        print_scatter=float(rng.uniform(0.0, 0.3e-3)),
        print_stated=bool(rng.random() < 0.5),
        touch_scatter=float(rng.uniform(0.0, 0.05e-3)),
        touch_threshold=float(rng.choice([0.0, 0.02])),
        clamp=str(rng.choice(["plate", "plate", "rim"])),
        modulus_error=float(rng.uniform(0.0, 0.3)),
        thickness_error=float(rng.uniform(0.0, 0.04)),
        stated=bool(rng.random() < 0.5),
        stiffness_spread=float(rng.choice([0.0, 0.2])),
        lens=float(rng.uniform(-0.01, 0.01)),
        frame_rate=_rate(rng),
        trials=_trials(rng),
        unloading=bool(rng.random() < 0.7),
    )


def _rate(rng: np.random.Generator) -> float:
    return float(round(np.exp(rng.uniform(np.log(10.0), np.log(60.0)))))


def _trials(rng: np.random.Generator) -> int:
    """Three to fifty, few as likely as many."""
    return round(float(np.exp(rng.uniform(np.log(3.0), np.log(50.0)))))


LABS: dict[str, Draw] = {
    AS_TOLD: lambda _: LabConditions(),
    "printed": lambda _: LabConditions(print_scatter=PRINTED),
    "clamped_otherwise": _clamped_otherwise,
    "as_labs_are": _as_labs_are,
    "found_by_force": _found_by_force,
    "specimens_differ": _specimens_differ,
    "another_camera": _another_camera,
    "short_of_trials": _short_of_trials,
    "anything": _anything,
}
"""What a laboratory's conditions are drawn by, by its name."""
