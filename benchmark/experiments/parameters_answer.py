"""The whole answer of a fit of parameters: values, laws that were compared, the posterior, and what to measure next."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from benchmark.experiments.optimal_design import OptimalDesign
from benchmark.identification.parameters.identified import Identified
from benchmark.identification.parameters.law_selection import LawScore
from benchmark.identification.parameters.posterior import Posterior


@dataclass(frozen=True, eq=False)
class ParametersAnswer:
    """A fit of parameters with what was asked for beside it.

    Attributes
    ----------
    identified : Identified
    laws : tuple of LawScore
        Where several laws were compared, the best first.
    design : OptimalDesign or None
        What to measure next.
    posterior : Posterior or None
    """

    identified: Identified
    laws: tuple[LawScore, ...] = ()
    design: OptimalDesign | None = None
    posterior: Posterior | None = None

    @property
    def tied(self) -> str:
        """The laws that the trials do not tell apart, as a list in words; empty where one stands alone."""
        names = [one.law for one in self.laws if one.tied]
        return ", ".join(names) if len(names) > 1 else ""

    @property
    def headline(self) -> str:
        """The fit in one sentence, with the laws that are tied."""
        return self.identified.headline + (f"; tied laws: {self.tied}" if self.tied else "")

    @property
    def warnings(self) -> tuple[str, ...]:
        """What a reader must know before a figure is quoted."""
        said = [*self.identified.warnings]
        if self.tied:
            said.append(f"the trials do not tell these laws apart on what was held out: {self.tied}")
        if self.posterior is not None and not self.posterior.converged:
            said.append(f"the posterior's chains did not mix (R-hat {self.posterior.r_hat.max():.3g}): do not quote it")
        if self.posterior is not None and self.posterior.short:
            said.append(self.posterior.short)
        return tuple(said)

    def to_dict(self) -> dict[str, Any]:
        """What `fit.json` gains."""
        names, out = self.identified.names, self.identified.to_dict()
        if self.laws:
            out["laws"] = [one.to_dict() for one in self.laws]
        if self.posterior is not None:
            out["posterior"] = self.posterior.to_dict(names, self.identified.found)
        if self.design is not None:
            out["next_experiments"] = {
                "d_optimal": self.design.best_d.to_dict(names),
                "a_optimal": self.design.best_a.to_dict(names),
                "menu": [one.to_dict(names) for one in self.design.proposals],
            }
        return out
