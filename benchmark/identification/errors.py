"""The errors of the fits."""

from benchmark.response.force_curve import ResponseError


class FittingError(ResponseError):
    """Trials or curves that cannot be fitted; the message names which, the value and what is allowed."""


class NoContactError(FittingError):
    """A trial without motion or without a force that rises over the noise: it tells no stiffness."""
