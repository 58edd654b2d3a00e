"""Cases that cost nothing, with answers made up for the tests."""

from collections.abc import Callable

import pytest

from fem.verification import Case, Quantity


def _case(name: str = "made_up/one", *errors: float, raises: Exception | None = None) -> Case:
    def compute() -> tuple[Quantity, ...]:
        if raises is not None:
            raise raises
        return tuple(
            Quantity("" if len(errors) == 1 else f"part_{n}", 200.0, 200.0 * (1 + error / 100), "mm", 0.5, 12)
            for n, error in enumerate(errors)
        )

    return Case(name, "made up for a test", compute)


@pytest.fixture
def case() -> Callable[..., Case]:
    """Factory: name, then the error in percent of each quantity (0.5 is allowed), or the exception it raises."""
    return _case
