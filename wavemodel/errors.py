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


def require_not_negative(name: str, value: float, unit: str) -> None:
    """Refuse a value that is negative or not a finite number.

    Raises
    ------
    WaveError
        If it is.
    """
    if not 0.0 <= value < float("inf"):
        raise WaveError(f"{name} = {value:g} {unit} is not allowed: finite and not negative")


def require_between(
    option: str, name: str, value: float, unit: str, low: float, high: float, *, open_low: bool = False
) -> None:
    """Refuse a parameter of an option outside its bounds.

    Raises
    ------
    WaveError
        If `value` is not a number from `low` (excluded if `open_low`) to `high`, both included.
    """
    if (low < value if open_low else low <= value) and value <= high:
        return
    bound = f"above {low:g}" if open_low else f"{low:g}"
    text = f"{value:g} {unit}".strip()
    raise WaveError(f"{option}: {name} = {text} is not allowed: {bound} to {high:g}{' ' + unit if unit else ''}")
