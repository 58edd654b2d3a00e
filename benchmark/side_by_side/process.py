"""The parent's handle on a model's process."""

from __future__ import annotations

import multiprocessing
import signal
from pathlib import Path
from types import TracebackType

from benchmark.child_processes import start_child
from benchmark.errors import InputError, SolverError
from benchmark.files import Scenario
from benchmark.model_file import RepairedModel
from benchmark.models import UserFile
from benchmark.side_by_side.worker import Answer, Crashed, Message, ModelJob, RunCommand, serve

KILLED = -9
"""Exit code of a process that the system killed, on Linux mostly for want of memory."""


def ended_by(code: int | None) -> str:
    """How a process ended, in words: its exit code, or the signal that a negative one stands for."""
    if code is None or code >= 0:
        return f"exit code {code}"
    try:
        name = signal.Signals(-code).name
    except ValueError:
        name = f"signal {-code}"
    return f"exit code {code}, {name}" + ("; usually memory ran out" if code == KILLED else "")


class ModelProcess:
    """A model alone in a process of its own, on one core where the system lets us choose.

    Use as a context manager: leaving it ends the process.
    """

    def __init__(
        self,
        model: str,
        scenario: Scenario,
        *,
        every_field: bool = False,
        core: int | None = None,
        own: UserFile | RepairedModel | None = None,
        keep: Path | None = None,
    ):
        context = multiprocessing.get_context("spawn")
        self.model = model
        self._who = f"your model {own.path}" if isinstance(own, UserFile) else f"the {model} model"
        self.connection, far_end = context.Pipe()
        arguments = (far_end, ModelJob(model, scenario, every_field, own, keep), core)
        self._process = context.Process(target=serve, args=arguments, daemon=True, name=f"tissuebench-{model}")
        start_child(self._process)
        far_end.close()

    def command(self, *, keep_result: bool, steps: int | None = None) -> None:
        """Start one execution; its messages arrive on `connection`."""
        self.connection.send(RunCommand(keep_result, steps))

    def receive(self) -> Message:
        """Return the next message; a crash of the model is raised as the error it is.

        Raises
        ------
        InputError
            The scenario is at fault.
        SolverError
            The model's code failed or its process died.
        """
        try:
            message: Message = self.connection.recv()
        except EOFError:
            self._process.join(5)
            raise SolverError(
                f"the process of {self._who} ended unexpectedly ({ended_by(self._process.exitcode)})"
            ) from None
        if isinstance(message, Crashed):
            failure = (
                InputError(message.message)
                if message.input_error
                else SolverError(f"the {self.model} model failed: {message.message}")
            )
            failure.add_note(message.trace)
            raise failure
        return message

    def answer(self) -> Answer:
        """Wait for the end of the execution, passing over progress."""
        while not isinstance(message := self.receive(), Answer):
            pass
        return message

    def __enter__(self) -> ModelProcess:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None and self._process.is_alive():
            self.connection.send(None)
            self._process.join(5)
        if self._process.is_alive():
            self._process.terminate()
            self._process.join(5)
        self.connection.close()
