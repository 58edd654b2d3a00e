"""One line of the verification table."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from fem.verification import Case, Quantity


@dataclass(frozen=True)
class Row:
    """A compared quantity of a case, or a case that could not be computed.

    Attributes
    ----------
    case
        Name of the case, "/" and the quantity where there are several.
    source
        Where the reference comes from.
    quantity
        What was compared; None where the case failed before.
    seconds
        Wall time of the case; its quantities come from the same run and share it.
    reason
        Why the case could not be computed, or "".
    """

    case: str
    source: str
    quantity: Quantity | None
    seconds: float
    reason: str = ""

    @property
    def passed(self) -> bool:
        """Whether there is a quantity and its error is allowed."""
        return self.quantity is not None and self.quantity.passed

    def to_dict(self) -> dict[str, Any]:
        """Return the row as `verification.json` has it; None stands for what could not be computed."""
        found = self.quantity
        return {
            "case": self.case,
            "source": self.source,
            "reference": None if found is None else found.reference,
            "ours": None if found is None else found.ours,
            "unit": "" if found is None else found.unit,
            "error_percent": None if found is None else found.error_percent,
            "allowed_percent": None if found is None else found.allowed_percent,
            "unknowns": None if found is None else found.unknowns,
            "seconds": self.seconds,
            "passed": self.passed,
        }


def rows_of(case: Case, found: tuple[Quantity, ...], seconds: float) -> tuple[Row, ...]:
    """Rows of a computed case."""
    names = (f"{case.name}/{quantity.name}" if quantity.name else case.name for quantity in found)
    return tuple(Row(name, case.source, quantity, seconds) for name, quantity in zip(names, found, strict=True))
