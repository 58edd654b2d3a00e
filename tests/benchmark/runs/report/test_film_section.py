"""What a page shows of films, through the result folder and back."""

import numpy as np

from benchmark.runs.report.film_section import FilmPart, MotionPart, StillPart, film_section, read_film, write_film


def part(ring: float = 10.5) -> FilmPart:
    random = np.random.default_rng(0)
    moved = random.normal(0.0, 0.3, (12, 18, 2))
    moved[3, 5] = np.nan
    time = np.linspace(0.0, 1.0, 12)
    motion = MotionPart("slow/press 1", time, 2.0 * time, np.full(12, ring - 0.5), np.full(12, ring), moved)
    stills = (StillPart("slow/press 1", 12, 0.1 / 3.0, b"\x89PNG\r\n\x1a\n"), StillPart("press 2", 9, 0.0, None))
    return FilmPart(2, True, stills, (motion,), (("press 1", "slow", 1.1, 0.01, 0.1, -0.2, None, 0.1 / 3.0),))


def test_the_folder_holds_all_that_is_shown(tmp_path):
    before = part()
    write_film(tmp_path / "markers", before)
    after = read_film(tmp_path / "markers")
    names = {path.name for path in (tmp_path / "markers").iterdir()}
    assert names == {"markers.json", "still_0.png", "motion_0.csv"}
    assert (after.count, after.synthetic, after.tracked, after.rows) == (2, True, before.tracked, before.rows)
    for name in ("time", "depth", "radius_nine", "radius_ring", "moved"):
        assert np.array_equal(getattr(after.motions[0], name), getattr(before.motions[0], name), equal_nan=True)


def test_without_films_there_is_nothing(tmp_path):
    assert read_film(tmp_path / "markers") is None


def test_a_session_without_nine_markers_shows_no_circle():
    assert len(film_section(part(np.nan)).blocks) == len(film_section(part()).blocks) - 1
