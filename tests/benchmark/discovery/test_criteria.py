"""Every threshold stands once: told what it is, and used."""

import ast
import re
from pathlib import Path

import benchmark.discovery
from benchmark.discovery import criteria

ROOM = Path(benchmark.discovery.__file__).parent
BODY = ast.parse((ROOM / "criteria.py").read_text()).body


def constants():
    for statement, after in zip(BODY, [*BODY[1:], None], strict=True):
        if isinstance(statement, ast.Assign):
            names = [name.id for name in ast.walk(statement.targets[0]) if isinstance(name, ast.Name)]
            yield names, after


def test_each_threshold_says_what_it_is():
    for names, after in constants():
        assert isinstance(after, ast.Expr), names
        assert len(ast.literal_eval(after.value)) > 20, names


def test_each_threshold_is_used_under_its_name_and_kept_nowhere_else():
    users = [path for path in ROOM.rglob("*.py") if path.name != "criteria.py"]
    text = "\n".join(path.read_text() for path in users)
    for names, _ in constants():
        for name in names:
            assert re.search(rf"\bcriteria\.{name}\b", text), name
            assert not re.search(rf"^{name}\b.* = ", text, re.MULTILINE), name


def test_six_trials_are_the_fewest_whose_signs_reach_the_level():
    least = 2.0 / 2.0**criteria.ENOUGH_TRIALS / criteria.LEVEL_SHARES[0]
    assert least < criteria.Settings().level < 4.0 / 2.0**criteria.ENOUGH_TRIALS
