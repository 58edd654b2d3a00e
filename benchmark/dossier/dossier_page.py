"""The page of a dossier: the question first, then each factor with its evidence, its limits and what is missing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any, Final

from benchmark.dossier.context import Context
from benchmark.dossier.factors import Question
from benchmark.dossier.standing import CONTRADICTED, MISSING, PARTLY, SHOWN, WEAK, Standing, headline
from reports import (
    Block,
    Bullets,
    Column,
    Download,
    Fact,
    Facts,
    Notice,
    Page,
    Paragraph,
    Section,
    Subsection,
    Table,
    Verdict,
)

WORDS: Final = {
    SHOWN: "every question has an answer",
    WEAK: "answered by synthetic, circular or partial evidence alone",
    PARTLY: "some questions have no answer",
    MISSING: "nothing was given",
    CONTRADICTED: "evidence speaks against the model",
}
HOW: Final = (
    "Factors and their order are those of ASME V&V 40-2018. The standard asks for as much rigour under each as the "
    "risk of the model needs; that judgement, and whether it is met, is left to the reader: no grades are given here. "
    "Nothing is computed anew; every sentence has the file it comes from."
)


def dossier_page(context: Context | None, standing: Sequence[Standing], environment: Mapping[str, Any]) -> Page:
    """The page of a dossier."""
    against = [f"{each.factor.name}: {WORDS[CONTRADICTED]}" for each in standing if each.status == CONTRADICTED]
    status = "finding" if against else "good" if all(each.status == SHOWN for each in standing) else "incomplete"
    parts = [
        Section(activity, tuple(_factor(each) for each in group))
        for activity, group in groupby(standing, key=lambda each: each.factor.activity)
    ]
    return Page(
        title="Credibility dossier",
        subtitle="What was shown for a model, and what was not" if context is None else context.name,
        verdict=Verdict(status, f"{headline(standing)}.", against),
        facts=(Fact("Made", str(environment["made"])),),
        notices=tuple(_notices(context)),
        sections=(_question(context), _overview(standing), *parts),
        downloads=(
            Download("tables/evidence.csv", "questions and answers"),
            Download("dossier.json", "the same for programs", media_type="application/json"),
        ),
        footer=f"tissuebench {environment['packages']['tissuebench']}",
    )


def _notices(context: Context | None) -> Iterator[Notice]:
    if context is None:
        yield Notice("warning", "No context of use was given: how much evidence is enough cannot be judged.",
                     ("`--context FILE` tells it; docs/credibility.md has a file to start from",))  # fmt: skip


def _question(context: Context | None) -> Section:
    if context is None:
        return Section("How to read this", (Paragraph(HOW),))
    told = [
        Fact("Question of interest", context.question_of_interest),
        Fact("Context of use", context.context_of_use),
        Fact("Model risk", context.risk),
    ]
    if context.quantities:
        told.append(Fact("Quantities of interest", ", ".join(context.quantities)))
    if context.max_force is not None:
        told.append(Fact("Largest load", f"{context.max_force:.3g} N"))
    return Section("The question", (Facts(told), Paragraph(HOW)))


def _overview(standing: Sequence[Standing]) -> Section:
    rows = [
        (each.factor.name, each.factor.activity, WORDS[each.status], len(each.evidence), len(each.missing))
        for each in standing
    ]
    columns = (Column("factor"), Column("activity"), Column("standing"), Column("answers"), Column("open questions"))
    table = Table(
        "Credibility factors", columns, rows, download=Download("tables/evidence.csv", "all answers"), folded=False
    )
    return Section("All factors", (table,))


def _factor(standing: Standing) -> Subsection:
    blocks: list[Block] = [Paragraph(f"{WORDS[standing.status].capitalize()}.")]
    for question in standing.factor.questions:
        answers = [_answer(each.says, each.source, each.limits) for each in standing.to(question)]
        blocks.append(Paragraph(question.asks))
        blocks.append(Bullets(answers or [_how_to_answer(question)]))
    return Subsection(standing.factor.name, blocks)


def _answer(says: str, source: str, limits: Sequence[str]) -> str:
    marks = f" [{', '.join(limits)}]" if limits else ""
    return f"{says}{marks} ({source})"


def _how_to_answer(question: Question) -> str:
    if question.command:
        return f"No answer. Give the result of: python -m benchmark {question.command}"
    return f'No answer. A person gives it in the context file: [[evidence]] question = "{question.slug}"'
