"""The simple specimen."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.simulated.specimen import MarkerGrid, SheetSpecimen, pressed_sheet, swinging

SHEET = SheetSpecimen(stiffness=600.0, stiffening_depth=6e-3, damping=20.0)


def respond(depth, start=0, step=1e-3, specimen=SHEET):
    depth = np.asarray(depth, float)
    return specimen(step * np.arange(len(depth)), depth, start)


def test_the_grid_is_centred_and_numbered_row_by_row():
    positions = MarkerGrid(rows=3, columns=6, spacing=8e-3).positions()
    assert positions.shape == (18, 2)
    assert positions.mean(axis=0) == pytest.approx([0.0, 0.0], abs=1e-18)
    assert positions[1] - positions[0] == pytest.approx([8e-3, 0.0])
    assert positions[6] - positions[0] == pytest.approx([0.0, 8e-3])


def test_no_force_in_air_and_the_stated_law_in_contact():
    answer = respond([-2e-3, -1e-3, 0.0, 2e-3, 2e-3, 2e-3])
    assert answer.force[:3].tolist() == [[0, 0, 0]] * 3
    assert answer.force[-1] == pytest.approx([0.0, 0.0, 600 * 2e-3 * (1 + 2 / 6)])
    assert answer.force[3, 2] == pytest.approx(1.6 + 20.0 * 2.0)  # 2 mm in a millisecond


def test_it_never_pulls():
    answer = respond(np.linspace(2e-3, 0.0, 5))
    assert answer.force[:, 2].min() == 0.0


def test_the_lower_face_sinks_and_its_markers_move_outwards():
    markers = respond([0.0, 2e-3, 2e-3]).markers
    moved = markers[-1, :, :2] - MarkerGrid().positions()
    rest = MarkerGrid().positions()
    assert np.all(np.sum(moved * rest, axis=1) > 0.0)
    assert 0.0 < markers[-1, :, 2].max() <= 0.9 * 2e-3
    assert markers[0] == pytest.approx(np.column_stack([rest, np.zeros(18)]))


@given(st.lists(st.floats(-3e-3, 5e-3), min_size=2, max_size=40), st.data())
def test_answering_in_pieces_is_answering_at_once(depth, data):
    cut = data.draw(st.integers(1, len(depth) - 1))
    whole = respond(depth)
    first, rest = respond(depth[:cut]), respond(depth, start=cut)
    assert np.allclose(np.concatenate([first.force, rest.force]), whole.force, rtol=1e-12, atol=1e-15)
    assert np.allclose(np.concatenate([first.markers, rest.markers]), whole.markers, rtol=1e-12, atol=1e-15)


def test_session_keys_are_those_of_a_session_file():
    keys = SHEET.session_keys()
    assert keys["support"] == {"kind": "hole", "hole_radius": "30 mm"}
    assert keys["camera"] == {"marker_rows": 3, "marker_columns": 6, "marker_spacing": "8 mm"}


def test_the_press_swings_between_nothing_and_its_peak():
    force = swinging(2.0)(np.array([0.0, 1.0, 2.0, 3.0, 4.0]))
    assert force[:, 2] == pytest.approx([0.0, 1.0, 2.0, 1.0, 0.0], abs=1e-12)
    assert not force[:, :2].any()


def test_the_sheet_is_deepest_in_mid_swing():
    markers = pressed_sheet(2e-3)
    assert markers(0.0)[:, 2].max() == 0.0
    assert markers(2.0)[:, 2].max() > markers(1.0)[:, 2].max() > 0.0
