"""Tracks that are kept: by what they were made from, read back whole, bounded, and never in the way."""

import os
from dataclasses import replace
from pathlib import Path

import pytest

from benchmark.runs.trials import film_cache
from benchmark.runs.trials.film_cache import KeptFilm, film_key, keep_film, kept_film

FILM = KeptFilm(b"time_s,marker\n", b"\x89PNG", 30, 1.5, ("one marker was lost",))


@pytest.fixture
def sources(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Path, Path]:
    monkeypatch.setenv("TISSUEBENCH_CACHE", str(tmp_path / "kept"))
    film, camera = tmp_path / "film.mcap", tmp_path / "camera.toml"
    film.write_bytes(b"pictures")
    camera.write_text("camera")
    return film, camera


def test_what_is_kept_comes_back(sources: tuple[Path, Path]) -> None:
    key = film_key(*sources, (3, 6))
    assert kept_film(key) is None
    for film in (FILM, replace(FILM, still=None, warnings=())):
        keep_film(key, film)
        assert kept_film(key) == film


def test_another_film_camera_or_layout_is_another_entry(sources: tuple[Path, Path]) -> None:
    film, camera = sources
    keys = [film_key(film, camera, (3, 6)), film_key(film, camera, (6, 3))]
    camera.write_text("another")
    keys.append(film_key(film, camera, (3, 6)))
    film.write_bytes(b"other pictures")
    keys.append(film_key(film, camera, (3, 6)))
    assert len(set(keys)) == 4


@pytest.mark.parametrize("damage", [b"", b"no archive", b"PK\x05\x06" + bytes(18)])
def test_a_damaged_entry_is_none(sources: tuple[Path, Path], tmp_path: Path, damage: bytes) -> None:
    key = film_key(*sources, (3, 6))
    keep_film(key, FILM)
    (tmp_path / "kept" / "films" / f"{key}.zip").write_bytes(damage)
    assert kept_film(key) is None


def test_the_oldest_go_first(sources: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for place, name in enumerate("abc"):
        keep_film(name, FILM)
        os.utime(tmp_path / "kept" / "films" / f"{name}.zip", (place, place))
    assert kept_film("a") == FILM  # used just now
    size = (tmp_path / "kept" / "films" / "a.zip").stat().st_size
    monkeypatch.setattr(film_cache, "MOST_BYTES", 2 * size)
    keep_film("d", FILM)
    assert [name for name in "abcd" if kept_film(name)] == ["a", "d"]


def test_nothing_is_kept_where_nobody_wants_it_or_nothing_can_be(
    sources: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TISSUEBENCH_CACHE", "")
    assert film_key(*sources, (3, 6)) == ""
    keep_film("", FILM)
    (tmp_path / "file").touch()
    monkeypatch.setenv("TISSUEBENCH_CACHE", str(tmp_path / "file"))
    key = film_key(*sources, (3, 6))
    keep_film(key, FILM)
    assert kept_film(key) is None
    assert film_key(tmp_path / "gone", sources[1], (3, 6)) == ""
