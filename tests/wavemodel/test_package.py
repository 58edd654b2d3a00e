"""What is there on importing the package: every public name, the example of its help, and next to no time spent."""

import doctest
import subprocess
import sys

import pytest

import wavemodel
from wavemodel import physics


@pytest.mark.parametrize("package", [wavemodel, physics])
def test_every_public_name_is_there(package):
    for name in package.__all__:
        assert getattr(package, name).__name__ == name
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = package.nothing


def test_the_example_of_the_help_runs():
    tried = doctest.testmod(wavemodel)
    assert (tried.attempted, tried.failed) == (9, 0)


def test_importing_it_loads_neither_numpy_nor_scipy():
    code = "import sys, wavemodel, wavemodel.physics; print({'numpy', 'scipy'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_tab_completion_shows_what_there_is():
    assert set(wavemodel.__all__) <= set(dir(wavemodel))
