"""A dossier from request to result folder: read the results, put what they show under the factors, write it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from benchmark.dossier.context import Context, load_context
from benchmark.dossier.dossier_page import dossier_page
from benchmark.dossier.evidence import evidence_of, read_result
from benchmark.dossier.standing import Standing, evidence_of_context, headline, standing_of
from benchmark.errors import InputError
from benchmark.runs.output.destination import claimed, destination
from benchmark.runs.output.document import describe_environment
from reports import write_csv, write_json, write_page, write_whole

SCHEMA: Final = 1
TABLE: Final = "tables/evidence.csv"


@dataclass(frozen=True)
class DossierOutcome:
    """A dossier on disk: its folder, the content of `dossier.json`, and what it says in one sentence."""

    folder: Path
    document: dict[str, Any]
    headline: str


def make_dossier(results: Sequence[Path], context: Path | None = None, out: Path | None = None) -> DossierOutcome:
    """Collect what finished results show of a model's credibility.

    Parameters
    ----------
    results
        Result folders of `run`, `fit`, `discover`, `verify`, `check` and `sweep`, in any order.
    context
        A file with the context of use; without it what a person must say is missing.
    out
        The folder; by default `results/dossier-DATE-TIME`.

    Raises
    ------
    InputError
        No result, one twice, one that is none or cannot be read, a context file with a wrong key, or an `out` that
        cannot be written.
    """
    if not results:
        raise InputError("no result is given; allowed: one or more result folders")
    resolved = [each.resolve() for each in results]
    if twice := [each for index, each in enumerate(resolved) if each in resolved[:index]]:
        raise InputError(f"{twice[0]} is given twice; allowed: once")
    with claimed(out, "dossier"):
        folder = destination(out, "dossier", (*results, context))
        told = None if context is None else load_context(context)
        found = [read_result(each) for each in results]
        answers = [] if told is None or context is None else list(evidence_of_context(told, context, found))
        standing = standing_of([*(each for result in found for each in evidence_of(result)), *answers])
        document = _document(told, standing, results)
        _write(folder, document, told, standing)
    return DossierOutcome(folder, document, document["headline"])


def _document(context: Context | None, standing: Sequence[Standing], results: Sequence[Path]) -> dict[str, Any]:
    """The content of `dossier.json`."""
    return {
        "schema": SCHEMA,
        "headline": headline(standing),
        "context": None if context is None else context.to_table(),
        "results": [str(each) for each in results],
        "factors": [
            {
                "factor": each.factor.slug,
                "name": each.factor.name,
                "activity": each.factor.activity,
                "status": each.status,
                "missing": [question.slug for question in each.missing],
                "evidence": [
                    {"question": e.question, "says": e.says, "source": e.source, "limits": list(e.limits)}
                    for e in each.evidence
                ],
            }
            for each in standing
        ],
    }


def _columns(standing: Sequence[Standing]) -> dict[str, list[Any]]:
    """Columns of `evidence.csv`: a row a question, more where it has several answers."""
    rows = []
    for each in standing:
        for question in each.factor.questions:
            answers = [(e.says, e.source, "; ".join(e.limits)) for e in each.to(question)] or [("", "", "")]
            rows += [(each.factor.slug, question.slug, *answer) for answer in answers]
    names = ("factor", "question", "says", "source", "limits")
    return {name: [row[place] for row in rows] for place, name in enumerate(names)}


def _write(folder: Path, document: dict[str, Any], context: Context | None, standing: Sequence[Standing]) -> None:
    environment = describe_environment(seed=0)

    def fill(new: Path) -> None:
        write_json(new / "dossier.json", document)
        write_json(new / "environment.json", environment)
        write_csv(new / TABLE, _columns(standing))
        write_page(new / "report.html", dossier_page(context, standing, environment))

    write_whole(folder, fill)
