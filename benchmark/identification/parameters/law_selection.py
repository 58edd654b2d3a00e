"""Which hyperelastic law: by how it predicts conditions that it was not fitted to, not by how it fits.

Laws are compared trial by trial on held-out conditions. A law that predicts no worse than the best, within twice the
standard error of the paired difference, is tied with it: the trials do not tell them apart, and are not said to.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmark.identification.parameters.identified import Identified

TIED = 2.0
"""Standard errors of a paired difference within which laws are tied."""
LEAST_SHARE = 0.02
"""Laws whose held-out residuals differ by less than this share are tied in any case: noise is the same for all."""


@dataclass(frozen=True)
class LawScore:
    """A law on held-out conditions.

    Attributes
    ----------
    law : str
    rms_percent : float
        Root mean square of measured minus predicted over held-out trials, in % of the peak.
    behind, behind_error : float
        Mean of the logarithm of its residual over the best law's, trial by trial, and its standard error.
    shape : str
        The constant of shape with its interval; empty for a law without one.
    """

    law: str
    rms_percent: float
    behind: float
    behind_error: float
    shape: str

    @property
    def tied(self) -> bool:
        """Whether the trials do not tell it from the best one."""
        return self.behind <= max(TIED * self.behind_error, LEAST_SHARE)

    @property
    def text(self) -> str:
        """The law with its score in words."""
        shape = f", {self.shape}" if self.shape else ""
        state = "tied with the best" if self.tied else f"residual {np.exp(self.behind):.2f} times the best law's"
        return f"{self.law}: {self.rms_percent:.3g} % of the peak held out ({state}){shape}"

    def to_dict(self) -> dict[str, Any]:
        """Entry of `fit.json`."""
        return {**vars(self), "tied": self.tied, "text": self.text}


def scores(answers: Mapping[str, Identified]) -> tuple[LawScore, ...]:
    """Laws by their held-out residuals, the best first; empty where nothing could be held out."""
    residuals = {law: _residuals(one) for law, one in answers.items()}
    if any(each.size == 0 for each in residuals.values()):
        return ()
    best = min(residuals, key=lambda law: float(np.mean(residuals[law] ** 2)))
    found = [_score(law, residuals[law], residuals[best], answers[law]) for law in answers]
    return tuple(sorted(found, key=lambda one: (one.law != best, one.rms_percent)))


def _residuals(answer: Identified) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Residual of each held-out trial, in % of its peak, in the order of conditions and trials."""
    return np.array([each for one in answer.held_out for each in one.trial_rms_percent])


def _score(law: str, own: Any, best: Any, answer: Identified) -> LawScore:
    ratio = np.log(np.maximum(own, 1e-12) / np.maximum(best, 1e-12))
    error = float(np.std(ratio, ddof=1) / np.sqrt(ratio.size)) if ratio.size > 1 else np.inf
    shape = next((one.text for one in answer.estimates if one.key.startswith("law.")), "")
    return LawScore(law, float(np.sqrt(np.mean(own**2))), float(ratio.mean()), error, shape)


def simplest(found: tuple[LawScore, ...]) -> str:
    """The law to go on with: of those that are tied, the one without a constant of shape, else the best."""
    tied = [one for one in found if one.tied]
    return next((one.law for one in tied if not one.shape), tied[0].law)
