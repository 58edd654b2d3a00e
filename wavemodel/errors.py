"""What the wave models raise."""


class WaveError(ValueError):
    """Input the wave models cannot use; the message names the parameter, its value and what is allowed."""


class NotCoveredError(WaveError):
    """A sound scenario that the wave model does not describe.

    Parameters
    ----------
    reason
        What is not covered, in words for the user.
    """

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason


def require_positive(name: str, value: float, unit: str) -> None:
    """Refuse a value that is not a finite positive number.

    Raises
    ------
    WaveError
        If `value` is zero, negative, infinite or not a number.
    """
    if not 0.0 < value < float("inf"):
        raise WaveError(f"{name} = {value:g} {unit} is not allowed: a finite value above zero is needed")
