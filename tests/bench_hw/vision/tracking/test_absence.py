"""Markers that come back."""

import numpy as np
import pytest

from bench_hw.vision.markers.sighting import Sighting
from bench_hw.vision.tracking.absence import Absences

GRID = np.stack(np.meshgrid(np.arange(6.0), np.arange(3.0)), axis=-1).reshape(-1, 2) * 50.0


def sighting(places: np.ndarray, hidden=()) -> Sighting:
    seen = np.ones(18, dtype=bool)
    seen[list(hidden)] = False
    return Sighting(places / 600, places, np.full(18, 10.0), np.ones(18)).kept(seen)


@pytest.mark.parametrize(("came_back_to", "accepted"), [((40.0, 3.0), True), ((0.0, 0.0), False), ((90.0, 0.0), False)])
def test_a_marker_must_have_moved_as_its_neighbours_did(came_back_to, accepted):
    """While marker 8 was away the sheet went 40 to the right."""
    absences = Absences(limit=24.5)
    absences.note(sighting(GRID, hidden=[8]), GRID)
    later = GRID + np.array([40.0, 0.0])
    later[8] = GRID[8] + came_back_to
    assert absences.checked(sighting(later)).seen[8] == accepted
    assert absences.checked(sighting(later)).seen.sum() == 17 + accepted


def test_without_witnesses_the_place_alone_counts():
    absences = Absences(limit=24.5)
    absences.note(sighting(GRID, hidden=range(18)), GRID)
    assert absences.checked(sighting(GRID + 5.0)).seen.all()


def test_who_is_back_is_away_no_more():
    absences = Absences(limit=24.5)
    absences.note(sighting(GRID, hidden=[8]), GRID)
    absences.note(sighting(GRID), GRID)
    later = GRID.copy()
    later[8] += 60.0
    assert absences.checked(sighting(later)).seen.all()
