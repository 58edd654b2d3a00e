import pytest

from benchmark.errors import (
    DeviceError,
    GateError,
    InputError,
    InterruptedRunError,
    NotComparableError,
    SolverError,
    TissuebenchError,
)


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (GateError, 1),
        (InputError, 2),
        (NotComparableError, 3),
        (SolverError, 4),
        (DeviceError, 5),
        (InterruptedRunError, 130),
    ],
)
def test_each_error_knows_its_exit_code(error, code):
    assert error.exit_code == code
    assert issubclass(error, TissuebenchError)
    assert str(error("tissue.toml, line 3, name: what is wrong.")) == "tissue.toml, line 3, name: what is wrong."
