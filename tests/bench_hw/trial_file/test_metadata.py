"""The header in a file: complete, and guarded against flipped characters."""

import dataclasses

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.trial_file.metadata import header_entries, is_sealed, press_axis, read_header, sealed
from bench_hw.trial_file.records import TrialHeader


def test_a_header_comes_back(header):
    assert read_header(header_entries(header)) == header
    assert is_sealed(header_entries(header))


def test_any_changed_entry_breaks_the_seal(header):
    entries = header_entries(header)
    for key, value in entries.items():
        assert not is_sealed({**entries, key: value + "x"}), key
        assert not is_sealed({k: v for k, v in entries.items() if k != key}), key
    assert not is_sealed({**entries, "new": ""})


@given(st.dictionaries(st.text(max_size=5), st.text(max_size=5), max_size=4))
def test_a_seal_fits_whatever_is_in_it(entries):
    assert is_sealed(sealed({k: v for k, v in entries.items() if k != "crc32"}))


def test_the_smallest_header_comes_back():
    header = TrialHeader("t", "", 0.0)
    assert read_header(header_entries(header)) == header


def test_another_schema_and_another_axis_are_refused(header):
    entries = header_entries(header)
    with pytest.raises(ValueError, match="schema '2' of the trial metadata; allowed: '1'"):
        read_header({**entries, "schema": "2"})
    for axis in ("+x", "-x", "+y", "-y", "+z", "-z"):
        assert press_axis(axis) == axis
        assert read_header(header_entries(dataclasses.replace(header, press_axis=axis))).press_axis == axis
    with pytest.raises(ValueError, match="press axis 'z'; allowed: "):
        press_axis("z")
