"""Verification of the solver: cases whose answer is published or known in closed form.

Cases are pure functions that return compared quantities; what is printed or written is not decided here. All of them:
:func:`fem.verification.registry.fem_cases`.
"""

from fem.verification.case import Case, Quantity

__all__ = ["Case", "Quantity"]
