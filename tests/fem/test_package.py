"""What is there on importing the package: every public name, and next to no time spent."""

import subprocess
import sys

import pytest

import fem


def test_every_public_name_is_there():
    for name in fem.__all__:
        assert getattr(fem, name).__name__ == name or name == "Material"
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = fem.nothing


def test_a_name_is_looked_up_once():
    found = fem.Problem
    assert vars(fem)["Problem"] is found


def test_importing_it_loads_neither_numpy_nor_scipy():
    code = "import sys, fem; print({'numpy', 'scipy'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_tab_completion_shows_what_there_is():
    assert set(fem.__all__) <= set(dir(fem))
