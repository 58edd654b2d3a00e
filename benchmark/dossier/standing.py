"""Where each factor stands: the evidence under its questions, and the questions that nothing answers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from benchmark.dossier.context import Context
from benchmark.dossier.evidence import AGAINST, CIRCULAR, PARTIAL, SYNTHETIC, Evidence, ResultFolder
from benchmark.dossier.factors import FACTORS, Factor, Question

SHOWN, WEAK, PARTLY, MISSING, CONTRADICTED = "shown", "weak", "partly", "missing", "contradicted"
MEASURED = "force over depth"
COMPARED = {
    MEASURED: "tables/measured.csv",
    "maximum deformation": "tables/max_deformation.csv",
    "deflection profile": "tables/profile.csv",
}
"""The table in which a run compares a quantity of the context."""


@dataclass(frozen=True)
class Standing:
    """A factor with what was found for it.

    Attributes
    ----------
    factor
    evidence
        In the order of the factor's questions.
    """

    factor: Factor
    evidence: tuple[Evidence, ...]

    @property
    def missing(self) -> tuple[Question, ...]:
        """Questions without an answer."""
        answered = {each.question for each in self.evidence}
        return tuple(each for each in self.factor.questions if each.slug not in answered)

    def to(self, question: Question) -> tuple[Evidence, ...]:
        """The answers to one of the factor's questions."""
        return tuple(each for each in self.evidence if each.question == question.slug)

    @property
    def status(self) -> str:
        """`contradicted` first, then `missing`, `partly`, `weak` (a question has limited answers alone), `shown`."""
        if any(AGAINST in each.limits for each in self.evidence):
            return CONTRADICTED
        if self.missing:
            return PARTLY if self.evidence else MISSING
        weak = any(all(each.limits for each in self.to(question)) for question in self.factor.questions)
        return WEAK if weak else SHOWN

    @property
    def limits(self) -> tuple[str, ...]:
        """Why the evidence shows less than it seems to."""
        told = {limit for each in self.evidence for limit in each.limits}
        return tuple(each for each in (AGAINST, SYNTHETIC, CIRCULAR, PARTIAL) if each in told)


def standing_of(evidence: Iterable[Evidence]) -> tuple[Standing, ...]:
    """Every factor of the standard, with the evidence under it."""
    found = tuple(evidence)
    return tuple(
        Standing(factor, tuple(e for question in factor.questions for e in found if e.question == question.slug))
        for factor in FACTORS
    )


def headline(standing: Sequence[Standing]) -> str:
    """How far the factors are covered, in one sentence."""
    counted = {status: sum(each.status == status for each in standing) for status in (SHOWN, CONTRADICTED, MISSING)}
    first = f"{counted[SHOWN]} of {len(standing)} credibility factors have evidence for every question"
    against = f"; in {counted[CONTRADICTED]} evidence speaks against the model" if counted[CONTRADICTED] else ""
    nothing = f"; {counted[MISSING]} have none" if counted[MISSING] else ""
    return f"{first}{against}{nothing}"


def evidence_of_context(context: Context, path: Path, results: Iterable[ResultFolder]) -> Iterator[Evidence]:
    """What a person answers, and the question's quantities and loads beside those that results have."""
    for each in context.evidence:
        yield Evidence(each.question, each.says, each.source)
    found = tuple(results)
    for quantity in context.quantities:
        yield _compared(quantity, path, found)
    if context.max_force is not None:
        yield from _reached(context.max_force, found)


def _compared(quantity: str, path: Path, results: tuple[ResultFolder, ...]) -> Evidence:
    table = COMPARED[quantity]
    where = [each for each in results if (each.folder / table).is_file()]
    if where:
        how = "compared with trials" if quantity == MEASURED else "compared, code to code"
        return Evidence("quantities_compared", f"{quantity}: {how}.", where[0].file(table))
    return Evidence("quantities_compared", f"{quantity}: no result compares it.", path.name, (AGAINST,))


def _reached(wanted: float, results: tuple[ResultFolder, ...]) -> Iterator[Evidence]:
    """The largest measured force beside the question's."""
    for each in results:
        table = each.table(COMPARED[MEASURED])
        if table is None or "force_N" not in table:
            continue
        largest = float(table["force_N"].max())
        says = f"Measured to {largest:.3g} N; the question goes to {wanted:.3g} N."
        limits = (SYNTHETIC,) if each.document.get("trials", {}).get("synthetic") else ()
        yield Evidence("load_range", says, each.file(COMPARED[MEASURED]),
                       limits if largest >= wanted else (*limits, AGAINST))  # fmt: skip
