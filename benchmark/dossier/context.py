"""The context of a dossier: what the model is asked for, what hangs on it, and what only a person can say.

schema = 1
name = "tool force in a trainer"
question_of_interest = "Is the force within 10 % of what a surgeon feels?"
context_of_use = "Presses to 5 N with tools of 2 to 8 mm radius; the model alone gives the force."
model_influence = "high"              # low | medium | high
decision_consequence = "low"          # low | medium | high
quantities = ["force over depth"]     # "force over depth", "maximum deformation", "deflection profile"
max_force = "5 N"                     # optional: the largest load of the question
[[evidence]]
question = "review"                   # a question of the page that a person answers
says = "Inputs were read against the laboratory book by a second person."
source = "lab book 12, page 40"
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, model_validator

from benchmark.dossier.factors import questions
from benchmark.files.quantities import Force, problem
from benchmark.files.schema import FileModel, Name, Schema, validated
from benchmark.files.sources import read_toml

Degree = Literal["low", "medium", "high"]
Quantity = Literal["force over depth", "maximum deformation", "deflection profile"]


def _some_text(text: str) -> str:
    if not text.strip() or len(text) > 4000:
        raise problem("the text is empty or very long; allowed: 1 to 4000 characters")
    return text


Text = Annotated[str, AfterValidator(_some_text)]


class PersonalEvidence(FileModel):
    """What a person answers to a question of the page, and where it can be looked up."""

    question: Name
    says: Text
    source: Name

    @model_validator(mode="after")
    def _is_a_question(self) -> PersonalEvidence:
        known = [each.slug for each in questions()]
        if self.question not in known:
            raise problem(f"{self.question!r} is no question; allowed: {', '.join(known)}", key="question")
        return self


class Context(FileModel):
    """The whole file."""

    schema_: Annotated[Schema, Field(alias="schema")] = 1
    name: Name
    question_of_interest: Text
    context_of_use: Text
    model_influence: Degree
    decision_consequence: Degree
    quantities: tuple[Quantity, ...] = ()
    max_force: Force | None = None
    evidence: tuple[PersonalEvidence, ...] = ()

    @property
    def risk(self) -> str:
        """Model risk in words: what the standard puts together from influence and consequence."""
        return f"model influence {self.model_influence}, decision consequence {self.decision_consequence}"


def load_context(path: Path) -> Context:
    """Read a context file.

    Raises
    ------
    InputError
        It cannot be read, or a key is wrong: the message names file, line, key and what is allowed.
    """
    table, source = read_toml(path, "context of use")
    return validated(Context, table, source)
