"""Tracks that are kept: by what they were made from, read back whole, bounded, and never in the way."""

import os
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from bench_hw.storage.regular_file import sealed
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


@pytest.fixture
def entry(sources: tuple[Path, Path], tmp_path: Path) -> Path:
    key = film_key(*sources, (3, 6))
    keep_film(key, FILM)
    return tmp_path / "kept" / "films" / f"{key}.zip"


@pytest.mark.parametrize("damage", [b"", b"no archive", b"PK\x05\x06" + bytes(18)])
def test_a_damaged_entry_is_none(entry: Path, damage: bytes) -> None:
    entry.write_bytes(damage)
    assert kept_film(entry.stem) is None


def test_an_entry_with_a_bit_changed_in_any_byte_is_none_and_the_next_one_takes_its_place(entry: Path) -> None:
    """15 of 100 were a fault of the program, and one of 100 lost the still without a word."""
    whole = entry.read_bytes()
    for place in range(len(whole)):
        bad = bytearray(whole)
        bad[place] ^= 1 << place % 8
        entry.write_bytes(bad)
        assert kept_film(entry.stem) is None
    keep_film(entry.stem, FILM)
    assert kept_film(entry.stem) == FILM


@pytest.mark.parametrize("damage", [b"no archive", b"PK\x05\x06" + bytes(18)])
def test_a_whole_entry_of_something_else_is_none(entry: Path, damage: bytes) -> None:
    entry.write_bytes(sealed(entry.name, damage))
    assert kept_film(entry.stem) is None


def test_pipes_and_devices_are_no_entries_and_are_replaced(entry: Path, tmp_path: Path) -> None:
    """A pipe was waited for; a link to /dev/zero took all memory."""
    for odd in (os.mkfifo, lambda path: path.symlink_to("/dev/zero")):
        entry.unlink()
        odd(entry)
        assert kept_film(entry.stem) is None
        keep_film(entry.stem, FILM)
        assert kept_film(entry.stem) == FILM
        assert not entry.is_symlink()
    os.mkfifo(tmp_path / "pipe")
    assert film_key(tmp_path / "pipe", tmp_path / "camera.toml", (3, 6)) == ""


def test_the_oldest_go_first(sources: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for place, name in enumerate("abc"):
        keep_film(name, FILM)
        os.utime(tmp_path / "kept" / "films" / f"{name}.zip", (place, place))
    assert kept_film("a") == FILM  # used just now
    size = (tmp_path / "kept" / "films" / "a.zip").stat().st_size
    monkeypatch.setattr(film_cache, "MOST_BYTES", 2 * size)
    keep_film("d", FILM)
    assert [name for name in "abcd" if kept_film(name)] == ["a", "d"]
    folder = tmp_path / "kept" / "films"
    os.utime(folder / "a.zip", (4, 4))
    os.mkfifo(folder / "0.zip")  # neither counts, nor keeps the others from going
    (folder / "1.zip").symlink_to("nowhere")
    keep_film("e", FILM)
    assert [name for name in "abcde" if kept_film(name)] == ["d", "e"]
    assert sorted(path.name for path in folder.iterdir()) == ["0.zip", "1.zip", "d.zip", "e.zip"]


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


def test_the_documentation_says_where_it_is_and_how_large(monkeypatch: pytest.MonkeyPatch) -> None:
    page = " ".join((Path(__file__).parents[4] / "docs" / "robustness.md").read_text().split())
    assert f"`{film_cache.VARIABLE}` names" in page
    assert f"{film_cache.MOST_BYTES / 1e6:.0f} MB at most" in page
    monkeypatch.delenv("TISSUEBENCH_CACHE", raising=False)
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    folder = film_cache.cache_folder()
    assert folder is not None
    if sys.platform == "linux":
        assert folder == Path("~/.cache/tissuebench/films").expanduser()
        assert f"the folder `{folder.name}`" in page
        assert "Linux `~/.cache/tissuebench`" in page
