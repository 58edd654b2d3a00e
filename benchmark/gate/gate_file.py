"""The gate file: which scenarios are gated, what is timed beside which reference, and how much may change.

    schema = 1
    name = "mine"
    [timing]
    rounds = [3, 10]                  # fewest and most measured processes
    blocks = 24                       # interleavings in each
    margin = "12 %"                   # slower than the stored baseline by more is a regression
    margin_against = "5 %"            # slower than a revision measured in the same minutes
    other_machine_margin = "50 %"     # against a baseline from another processor
    [[tolerances]]                    # the first whose pattern fits a quantity's name holds
    quantity = "*.max_deformation_mm.*"
    rtol = "0.1 %"
    atol = "1 nm"
    [[cases]]
    name = "press"
    model = "wave"                    # fem | wave, or of a session: fit | track | discover
    scenario = "press.toml"           # a shipped name or a path; of a session: session = "FOLDER" instead
    own = "my_model.py"               # optional: your own model in the wave's place
    [[cases]]
    name = "lab"
    model = "discover"
    session = "phantom"
    expected = "viscoelastic_relaxation"    # the effect that it should name
    [[timed]]
    name = "wave.step"
    workload = "history"              # history | wave_frame | fem_assembly | fit
    model = "wave"
    scenario = "press.toml"
    references = ["elements", "dense"]
    set = { "load.peak" = "2 N" }     # optional: values put into the scenario, as by --set
    calls = 2                         # in a row, in each block

Each timed quantity is divided by its references, each block's by the same block's.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Literal, Self, TypeVar

from pydantic import AfterValidator, Field, model_validator

from benchmark.files.quantities import Bounds, Margin, Number, problem
from benchmark.files.schema import FileModel, Name, Schema
from benchmark.files.units import DIMENSIONS, QuantityError, dimension_of, parse_quantity

Count = Annotated[int, Number("1 to 1000 (a whole number)", Bounds(1, 1000), whole=True)]
Reference = Literal["dense", "elements", "calls", "batched"]


class Timing(FileModel):
    """How time is measured and judged.

    Attributes
    ----------
    rounds : (int, int)
        Fewest and most processes: fewer than the most where every quantity is surely on one side of its limit.
    blocks : int
        Interleavings of all workloads and references in each process.
    margin : float
        How much slower than a stored baseline is let pass, a fraction.
    margin_against : float
        The same where another revision is measured in the same minutes, which knows nothing of a baseline's day.
    other_machine_margin : float
        The same where the baseline comes from another machine.
    """

    rounds: tuple[Count, Count] = (3, 10)
    blocks: Count = 24
    margin: Margin = 0.12
    margin_against: Margin = 0.05
    other_machine_margin: Margin = 0.5

    @model_validator(mode="after")
    def _in_order(self) -> Self:
        if self.rounds[0] > self.rounds[1]:
            raise problem(f"{list(self.rounds)}: the fewest rounds come first", key="rounds")
        return self


def _some_quantity(text: str) -> str:
    """Refuse what is no quantity of any dimension, or a negative one; which one it must be, the gated value says."""
    for dimension in (*DIMENSIONS, dimension_of("")):
        try:
            if parse_quantity(text, dimension) >= 0.0:
                return text
        except QuantityError:
            continue
    raise problem(
        f'{text!r} is no tolerance; allowed: a quantity from 0 with its unit, such as "1 nm", or a plain number'
    )


class Tolerance(FileModel):
    """How far the quantities whose names fit a pattern may be from the baseline: rtol |baseline| + atol.

    Attributes
    ----------
    quantity : str
        A pattern with * and ?.
    rtol : float
        A fraction.
    atol : str
        With the quantity's unit, "1 nm"; a plain number for a quantity without one.
    """

    quantity: Name
    rtol: Margin
    atol: Annotated[Name, AfterValidator(_some_quantity)]


class GatedWork(FileModel):
    """What a case and a timed quantity share: what the model is given.

    Attributes
    ----------
    name : str
        First part of the names of a case's quantities; the name of a timed quantity.
    scenario, session : str or None
        A shipped name or a path, relative to the gate file.
    set : mapping of str to str
        Values put into the scenario, as by `--set`.
    own : str or None
        A user's own model in the wave's place.
    """

    name: Name
    scenario: Name | None = None
    session: Name | None = None
    set: Mapping[str, str] = Field(default_factory=dict)
    own: Name | None = None


Found = TypeVar("Found", bound=GatedWork)


class GatedCase(GatedWork):
    """A gated scenario or session.

    Attributes
    ----------
    model : str
        What computes it: fem | wave of a scenario, fit | track (its films) | discover of a session.
    expected : str or None
        The effect that a discovery should name.
    """

    model: Literal["fem", "wave", "fit", "track", "discover"]
    expected: Name | None = None

    @model_validator(mode="after")
    def _has_input(self) -> Self:
        if (self.expected is None) == (self.model == "discover"):
            needs = "needs" if self.expected is None else "is no discovery and has no use for"
            raise problem(f"{self.name!r} {needs} an expected effect", key="expected")
        needed = "scenario" if self.model in ("fem", "wave") else "session"
        return _with_input(self, needed, wave=self.model == "wave")


class Timed(GatedWork):
    """A timed quantity.

    Attributes
    ----------
    workload : str
        history (all load steps of a scenario) | wave_frame | fem_assembly | fit.
    model : str
        fem | wave, for a history.
    references : tuple of str
        dense | elements | calls | batched; the time is divided by their geometric mean.
    calls : int
        How often it runs in a row in each block; 3 to 10 ms in all are a good length.
    margin : float or None
        In the place of the file's two.
    """

    workload: Literal["history", "wave_frame", "fem_assembly", "fit"]
    model: Literal["fem", "wave"] = "wave"
    references: Annotated[tuple[Reference, ...], Field(min_length=1, max_length=3)]
    calls: Count = 1
    margin: Margin | None = None

    @model_validator(mode="after")
    def _has_input(self) -> Self:
        wave = self.workload == "history" and self.model == "wave"
        return _with_input(self, "session" if self.workload == "fit" else "scenario", wave=wave)


class GateFile(FileModel):
    """The whole file."""

    schema_: Annotated[Schema, Field(alias="schema")] = 1
    name: Name
    timing: Timing = Timing()
    tolerances: Annotated[tuple[Tolerance, ...], Field(min_length=1)]
    cases: Annotated[tuple[GatedCase, ...], Field(min_length=1)]
    timed: tuple[Timed, ...] = ()

    @model_validator(mode="after")
    def _names_are_unique(self) -> Self:
        for key in ("cases", "timed"):
            names = [each.name for each in getattr(self, key)]
            twice = [name for index, name in enumerate(names) if name in names[:index]]
            if twice:
                raise problem(f"the name {twice[0]!r} is there twice", key=f"{key}.{names.index(twice[0])}.name")
        return self


def _with_input(work: Found, needed: str, *, wave: bool) -> Found:
    """Refuse work without its scenario or session, with both, or with a user's model in the wrong place."""
    other = "scenario" if needed == "session" else "session"
    if getattr(work, needed) is None:
        raise problem(f"{work.name!r} needs a {needed}", key=needed)
    if getattr(work, other) is not None:
        raise problem(f"{work.name!r} has no use for a {other}", key=other)
    if work.own is not None and not wave:
        raise problem("a user's own model stands in the wave's place only", key="own")
    return work


def gate_path(path: Path | None) -> Path:
    """The gate file that is meant: the shipped one where none is given."""
    return Path(__file__).parent / "default.toml" if path is None else path
