"""The thirteen credibility factors of ASME V&V 40-2018, and what this program asks under each of them.

The standard names factors and leaves to the reader how much of each his question needs; the questions here are the
standard's sub-factors as far as they apply to presses on soft tissue. No grades are given.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True)
class Question:
    """One question under a factor, and the command whose result answers it; without one a person must."""

    slug: str
    asks: str
    command: str = ""


@dataclass(frozen=True)
class Factor:
    """A credibility factor with the activity that it belongs to."""

    slug: str
    name: str
    activity: str
    questions: tuple[Question, ...]


CODE, CALCULATION = "Code verification", "Calculation verification"
MODEL, COMPARATOR, ASSESSMENT = "Validation: the model", "Validation: the comparator", "Validation: assessment"
APPLICABILITY = "Applicability"
FACTORS: Final = (
    Factor(
        "software_quality", "Software quality assurance", CODE,
        (
            Question("versions", "Which versions computed it, and are the files as they were written?", "run SCENARIO"),
            Question("gate", "Is the code held to what it gave before?", "check"),
        ),
    ),
    Factor(
        "code_verification", "Numerical code verification", CODE,
        (Question("closed_forms", "Does the code solve its equations?", "verify --out verification"),),
    ),
    Factor(
        "discretisation", "Discretisation error", CALCULATION,
        (Question("refinement", "How far are mesh, modes and load steps from their limit?", "run SCENARIO --refine"),),
    ),
    Factor(
        "solver", "Numerical solver error", CALCULATION,
        (Question("convergence", "Did every step reach equilibrium?", "run SCENARIO"),),
    ),
    Factor(
        "use", "Use error", CALCULATION,
        (
            Question("inputs_kept", "Are all inputs kept, with units, and checked?", "run SCENARIO"),
            Question("review", "Has a second person looked at inputs and results?"),
        ),
    ),
    Factor(
        "model_form", "Model form", MODEL,
        (
            Question("second_model", "What does a model of another form give?", "run SCENARIO"),
            Question("missing_effect", "Which physical effect do the measurements miss?", "discover SESSION"),
        ),
    ),
    Factor(
        "model_inputs", "Model inputs", MODEL,
        (
            Question("sources", "Where do the values come from?", "run SCENARIO"),
            Question("sensitivity", "Which of them matter?", "sweep SCENARIO --vary KEY=LOW:HIGH --sensitivity"),
            Question("input_uncertainty", "How surely are they known?", "fit SESSION --free KEY,KEY"),
        ),
    ),
    Factor(
        "test_samples", "Test samples", COMPARATOR,
        (
            Question("sample_quantity", "How many specimens and trials?", "run --trials SESSION"),
            Question("sample_range", "Do the specimens stand for those of the question?"),
        ),
    ),
    Factor(
        "test_conditions", "Test conditions", COMPARATOR,
        (
            Question("condition_range", "Which presses were measured?", "discover SESSION"),
            Question("condition_uncertainty", "How well was the press itself known?", "discover SESSION"),
        ),
    ),
    Factor(
        "equivalency", "Equivalency of input parameters", ASSESSMENT,
        (Question("same_press", "Do model and experiment get the same press?", "run --trials SESSION"),),
    ),
    Factor(
        "output", "Output comparison", ASSESSMENT,
        (
            Question("rigour", "Are differences set beside their uncertainties?", "run --trials SESSION --refine"),
            Question("agreement", "Do the differences lie within them?", "run --trials SESSION --refine"),
            Question("unseen", "Was anything predicted that no value was fitted to?", "discover SESSION"),
        ),
    ),
    Factor(
        "quantities", "Relevance of the quantities of interest", APPLICABILITY,
        (Question("quantities_compared", "Are the quantities of the question those that were compared?"),),
    ),
    Factor(
        "relevance", "Relevance of the validation activities to the context of use", APPLICABILITY,
        (
            Question("load_range", "Does the measured range reach the loads of the question?", "run --trials SESSION"),
            Question("differences", "What is different in the question, and why may it be?"),
        ),
    ),
)  # fmt: skip


def questions() -> Iterator[Question]:
    """Every question of every factor."""
    for factor in FACTORS:
        yield from factor.questions
