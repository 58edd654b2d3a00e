"""The one error of the comparisons."""


class ComparisonError(ValueError):
    """Two samples cannot be compared; the message names which, the value found and what is allowed."""
