import numpy as np
import pytest

from benchmark.response import CameraView, FaceField, ForceCurve, Neighbour, RampTable, ResponseError

DEPTH, RADIUS = np.linspace(0.0, 4e-3, 9), np.linspace(0.0, 30e-3, 31)
SUNK = DEPTH[:, None] * (1.0 - (RADIUS / 30e-3) ** 2) ** 2
OUTWARD = 10.0 * DEPTH[:, None] ** 2 * RADIUS
FIELD = FaceField(DEPTH, RADIUS, OUTWARD, SUNK)


def test_a_marker_that_comes_near_seems_to_move_outwards() -> None:
    view = CameraView(70e-3)
    seen = view.seen(np.array([[10e-3, 0.0]]), np.array([2e-3]))
    np.testing.assert_allclose(seen, [[10e-3 * 70.0 / 68.0, 0.0]])
    np.testing.assert_allclose(view.true(seen, np.array([2e-3])), [[10e-3, 0.0]])
    np.testing.assert_array_equal(CameraView().seen(seen, np.array([2e-3])), seen)


def test_markers_move_away_from_the_tool_axis_wherever_that_is() -> None:
    axis = np.array([1e-3, -2e-3])
    rest = axis + np.array([[5e-3, 0.0], [0.0, 12e-3]])
    moved = FIELD.markers(rest, axis, np.array([0.0, 2e-3, 3e-3]), CameraView()) - rest
    np.testing.assert_allclose(moved[0], 0.0, atol=1e-15)
    np.testing.assert_allclose(moved[1:, 0, 0], 10.0 * np.array([2e-3, 3e-3]) ** 2 * 5e-3, rtol=1e-6)
    np.testing.assert_allclose(moved[1:, 1, 1], 10.0 * np.array([2e-3, 3e-3]) ** 2 * 12e-3, rtol=1e-6)
    np.testing.assert_allclose(moved[:, 0, 1], 0.0, atol=1e-15)


def test_fields_of_another_shape_are_refused() -> None:
    with pytest.raises(ResponseError, match="lower face"):
        FaceField(DEPTH, RADIUS, OUTWARD.T, SUNK)


def test_a_parameter_acts_on_the_force_by_a_power_and_on_the_face_linearly() -> None:
    depth = np.linspace(0.0, 4e-3, 9)
    curve, thicker = (ForceCurve(depth, factor * 300.0 * depth) for factor in (1.0, 1.1**3))
    face = FaceField(DEPTH, RADIUS, 2.0 * OUTWARD, SUNK)
    table = RampTable(curve, FIELD, {"thickness": Neighbour(1.1, thicker, face)})
    below = np.array([-1e-3, 1e-3, 3e-3])
    np.testing.assert_array_equal(table.force(below, {"thickness": 0.0}), curve(below))
    np.testing.assert_allclose(table.force(below, {"thickness": np.log(2.0)}), 8.0 * curve(below))
    rest, axis = np.array([[12e-3, 0.0]]), np.zeros(2)
    told = table.markers(rest, axis, below, {}) - rest
    changed = table.markers(rest, axis, below, {"thickness": 0.5 * np.log(1.1)}) - rest
    np.testing.assert_allclose(changed, 1.5 * told, atol=1e-15)


def test_a_table_ends_where_the_shorter_curve_ends() -> None:
    depth = np.linspace(0.0, 4e-3, 9)
    short = ForceCurve(depth[:5], 300.0 * depth[:5])
    table = RampTable(ForceCurve(depth, 300.0 * depth), FIELD, {"thickness": Neighbour(1.1, short, FIELD)})
    assert table.reach == pytest.approx(1.01 * 2e-3)
    assert RampTable(ForceCurve(depth, 300.0 * depth), FIELD).reach == pytest.approx(1.01 * 4e-3)
