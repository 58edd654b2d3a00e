"""What was fitted beside the effects: how the set-up lies against what was told, and what each trial has of its own."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class SetupEstimate:
    """A set-up parameter with the answer's effects in the model.

    Attributes
    ----------
    key : str
        As in `--set`.
    change : float
        Share of the told value by which it is larger; of a modulus the natural logarithm of the factor, of a choice the
        share of the way to the other one.
    ci95 : (low, high)
    prior : float or None
        Standard deviation of what people know of it, in the same terms; None where the answer names it.
    named : bool
        Whether the answer names it.
    """

    key: str
    change: float
    ci95: tuple[float, float]
    prior: float | None
    named: bool

    @property
    def of_prior(self) -> float | None:
        """The change in standard deviations of its prior."""
        return None if self.prior is None else self.change / self.prior


@dataclass(frozen=True)
class TrialValues:
    """What one trial has of its own, SI.

    Attributes
    ----------
    trial : str
    gain : float
        Factor on its force.
    zero : float
        Force at rest, N.
    late : float
        By which force and frames are late against depth, s.
    touch : float
        Depth at which the tool touches, m.
    at_bound : tuple of str
        Names of those that stand as far off as physics allows.
    thicker : float
        Share by which its specimen is thicker than the session's; 0 where specimens do not differ.
    """

    trial: str
    gain: float
    zero: float
    late: float
    touch: float
    at_bound: tuple[str, ...] = ()
    thicker: float = 0.0
