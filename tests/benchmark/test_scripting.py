"""What the verbs of a script refuse before anything runs."""

import pytest

import benchmark
from benchmark.errors import InputError


def deform(layers, tool, support, time, force):
    """A model of one's own that is no file."""


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"wave": deform}, "wave is the function deform; allowed: the path of a file"),
        ({"reference": [1.0, 2.0]}, "reference is a list; allowed: the path of a file"),
        ({"model": pytest}, "model is the module pytest; allowed"),
    ],
)
def test_what_is_no_path_is_refused_by_its_argument(arguments, words: str) -> None:
    """It was a TypeError of the standard library that named no argument."""
    with pytest.raises(InputError, match=words):
        benchmark.run("skin-5N", **arguments)
