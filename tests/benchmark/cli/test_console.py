import io

from benchmark.cli.console import Console


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def advance_to_the_end(console: Console) -> None:
    with console.progress("working") as advance:
        for done in range(1, 101):
            advance("task", done, 100, f"{done} N")


def test_plain_lines_come_once_a_quarter() -> None:
    stream = io.StringIO()
    advance_to_the_end(Console(quiet=False, stream=stream))
    assert stream.getvalue().splitlines() == [
        "working",
        "  task: 25/100 25 N",
        "  task: 50/100 50 N",
        "  task: 75/100 75 N",
        "  task: 100/100 100 N",
    ]


def test_a_terminal_gets_a_bar() -> None:
    stream = Terminal()
    advance_to_the_end(Console(quiet=False, stream=stream))
    assert "100/100" in stream.getvalue()


def test_quiet_says_nothing() -> None:
    stream = io.StringIO()
    console = Console(quiet=True, stream=stream)
    console.say("x")
    advance_to_the_end(console)
    assert stream.getvalue() == ""
