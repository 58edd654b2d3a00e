"""Errors that end a command, each with its exit code; no other module chooses one.

The message is one paragraph for a person: what is wrong, where (file, key, line), the value with its unit,
and what is allowed. Errors of the libraries (`fem`, `wavemodel`, `bench_hw`) are turned into these by the harness.
"""

from __future__ import annotations

from typing import ClassVar


class TissuebenchError(Exception):
    """What the command line reports in one paragraph instead of a traceback."""

    exit_code: ClassVar[int] = 2


class GateError(TissuebenchError):
    """A gate failed: accuracy or timing got worse, or a verification case missed its bar."""

    exit_code: ClassVar[int] = 1


class InputError(TissuebenchError):
    """Usage, configuration or input data that cannot be used."""

    exit_code: ClassVar[int] = 2


class NotComparableError(TissuebenchError):
    """There is no baseline to compare with, or it has another schema."""

    exit_code: ClassVar[int] = 3


class SolverError(TissuebenchError):
    """A solver did not converge; what it reached before is kept and marked incomplete."""

    exit_code: ClassVar[int] = 4


class DeviceError(TissuebenchError):
    """A device of the bench failed or is not what the rig file says."""

    exit_code: ClassVar[int] = 5


class InterruptedRunError(TissuebenchError):
    """The user ended a run that goes on from where it was when it is started again."""

    exit_code: ClassVar[int] = 130
