"""The commands that README and docs tell a reader to type, in the order of each page."""

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")))


@dataclass(frozen=True)
class Command:
    """One command line of a page: the page's name, the line's number, the program and its arguments."""

    page: str
    line: int
    program: str
    arguments: tuple[str, ...]

    def __str__(self) -> str:
        return f"{self.page}:{self.line} {self.program} {shlex.join(self.arguments)}"


def documented() -> list[Command]:
    """Every `python -m benchmark ...` and `python -m bench_hw ...` of an indented block."""
    return [command for page in PAGES for command in _commands(page)]


def _commands(page: Path) -> list[Command]:
    text = page.read_text(encoding="utf-8")
    found = []
    for match in re.finditer(r"^    python -m (benchmark|bench_hw)(?= )((?:[^\n]*\\\n)*[^\n]*)$", text, re.MULTILINE):
        arguments = shlex.split(match[2].replace("\\\n", " "), comments=True)
        found.append(Command(page.name, text[: match.start()].count("\n") + 1, match[1], tuple(arguments)))
    return found
