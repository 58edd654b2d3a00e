"""The error of an elastic answer that is no such thing, or that ends too early."""


class ResponseError(ValueError):
    """Curves or faces that are no elastic answer, or a depth beyond them; the message names the value and the limit."""
