"""A reader who types what a page says meets no unknown verb, option or shipped name."""

import pytest
import typer

from bench_hw.cli._app import app as bench_hw
from benchmark.cli.app import app as benchmark
from tests.documentation.commands import Command, documented

COMMANDS = [command for command in documented() if "..." not in command.arguments]
PROGRAMS = {"benchmark": typer.main.get_command(benchmark), "bench_hw": typer.main.get_command(bench_hw)}


def test_there_are_commands_to_look_at() -> None:
    assert len(COMMANDS) > 80
    assert {command.page for command in COMMANDS} >= {"README.md", "first-run.md", "bench.md", "sweeps.md"}


@pytest.mark.parametrize("command", COMMANDS, ids=str)
def test_the_program_has_what_the_page_types(command: Command) -> None:
    program = PROGRAMS[command.program]
    context = program.make_context(command.program, list(command.arguments))
    name, verb, rest = program.resolve_command(context, [*context._protected_args, *context.args])
    verb.make_context(name, rest, parent=context)
