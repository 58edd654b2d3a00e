"""The credibility of a model on one page: what results show for each factor of ASME V&V 40, and what they lack."""

from benchmark.dossier.dossier_run import DossierOutcome, make_dossier

__all__ = ["DossierOutcome", "make_dossier"]
