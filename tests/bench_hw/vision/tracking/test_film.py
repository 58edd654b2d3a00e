"""Videos to tables: what is right, what is missing, what is refused."""

import tracemalloc

import numpy as np
import pytest

from bench_hw.errors import InputError
from bench_hw.vision.camera import from_plane
from bench_hw.vision.markers import Layout
from bench_hw.vision.tracking import TrackOrder, track

COUNT = 14
RIGHT = np.array([1.0, 0.0])


@pytest.fixture
def renderer(rendering, scene):
    random = np.random.default_rng(8)
    return rendering.Renderer(scene, rendering.sheet(random), random)


def stretching(renderer, count: int = COUNT) -> list[np.ndarray]:
    return [renderer.sheet.middles * (1 + 0.03 * np.sin(np.pi * frame / count)) for frame in range(count)]


@pytest.fixture
def follow(renderer, scene, camera_file, video, read_tracks, tmp_path):
    """Render middles, spoil the pictures, track: the outcome, and the error of each place in undistorted pixels."""

    def run(middles, spoil=lambda frame, grey: grey, **options):
        pictures = [spoil(frame, renderer.frame(moved)) for frame, moved in enumerate(middles)]
        order = TrackOrder(str(video(pictures)), camera_file(scene), tmp_path / "markers.csv", **options)
        outcome = track(order)
        time, places, confidence = read_tracks(order.out)
        truth = np.array([renderer.sheet.truth(moved) for moved in middles])
        assert np.allclose(time, np.arange(len(middles)) / 30)
        assert np.array_equal(np.isnan(places[:, :, 0]), confidence == 0)
        return outcome, np.hypot(*np.moveaxis((places - truth) / scene.mm_per_px, 2, 0))

    return run


def test_a_press_is_tracked_to_hundredths_of_a_pixel(follow, renderer):
    outcome, error = follow(stretching(renderer))
    assert np.sqrt((error**2).mean()) < 0.02
    assert error.max() < 0.1
    assert outcome.warnings == ()
    assert outcome.to_dict() | {"frames": COUNT, "markers": 18, "rows": 3, "missing": [0] * 18} == outcome.to_dict()


@pytest.mark.parametrize("share", [0.2, 0.45])
def test_a_jump_below_half_the_spacing_is_linked(follow, renderer, share):
    middles = [renderer.sheet.middles + (frame >= 3) * share * 8.5 * np.array([0.6, 0.8]) for frame in range(6)]
    _, error = follow(middles)
    assert error.max() < 0.1


def test_a_like_spot_where_no_neighbours_way_leads_is_not_the_marker(follow, renderer):
    """A third of the spacing away, where the marker is gone from one picture to the next, while the others rest."""
    middles = [renderer.sheet.middles.copy() for _ in range(10)]
    for moved in middles[4:]:
        moved[8] += 0.35 * 8.5 * RIGHT
    outcome, error = follow(middles)
    assert np.isnan(error[4:, 8]).all()
    assert np.isfinite(np.delete(error, 8, axis=1)).all()
    assert "sightings are missing" in outcome.warnings[0]


def test_a_knock_below_half_the_spacing_is_told(follow, renderer):
    still = np.zeros(2)
    knocked = [renderer.sheet.middles + (still if frame < 5 else 8.5 * np.array([0.15, 0.0])) for frame in range(12)]
    outcome, error = follow(knocked)
    assert error.max() < 0.1
    (said,) = outcome.warnings
    assert said.startswith("picture 5 at 0.167 s: all markers moved together by ")
    assert follow(stretching(renderer))[0].warnings == ()
    pulled = [renderer.sheet.middles + 8.5 * np.array([0.12, 0.0]) * frame for frame in range(6)]
    assert follow(pulled)[0].warnings == ()  # as far in each picture: so it goes there


def test_pictures_that_repeat_are_told(follow, renderer):
    kept = []

    def freeze(frame, grey):
        kept.append(grey)
        return kept[min(frame, 7)]

    outcome, _ = follow(stretching(renderer), freeze)
    (said,) = outcome.warnings
    assert said.startswith(f"{COUNT - 8} pictures are the one before to the last grey level")


@pytest.mark.parametrize("way", [(0.55, 0.0), (0.6, 0.8), (1.0, 0.0), (0.0, -1.0), (-2.0, 0.0)])
def test_a_jump_of_half_the_spacing_or_more_is_refused(follow, renderer, tmp_path, way):
    middles = [renderer.sheet.middles + (frame >= 3) * 8.5 * np.array(way) for frame in range(5)]
    with pytest.raises(InputError, match=r"picture 3 at 0.100 s: the whole grid jumped by"):
        follow(middles)
    assert not (tmp_path / "markers.csv").exists()


@pytest.mark.parametrize("level", [40, 150])
def test_a_hand_in_front_leaves_gaps_and_no_wrong_places(follow, renderer, level):
    def hand(frame, grey):
        left = 50 * (frame - 3)
        grey[:, max(left, 0) : max(left + 220, 0)] = level
        return grey

    outcome, error = follow(stretching(renderer), hand)
    assert np.isnan(error).any(axis=1).sum() >= 8
    assert np.isfinite(error[-1]).sum() >= 12
    assert np.nanmax(error) < 0.1
    assert "sightings are missing" in outcome.warnings[0]
    assert sum(outcome.to_dict()["missing"]) == np.isnan(error).sum()


def test_black_pictures_in_between_and_at_the_beginning_are_gaps(follow, renderer):
    def dark(frame, grey):
        return np.zeros_like(grey) if frame in (0, 1, 7, 8) else grey

    outcome, error = follow(stretching(renderer), dark)
    assert np.flatnonzero(np.isnan(error).all(axis=1)).tolist() == [0, 1, 7, 8]
    assert np.isnan(error).sum() == 4 * 18
    assert np.nanmax(error) < 0.1
    assert outcome.warnings[0].startswith("2 pictures before the first one with the whole grid")


def test_markers_that_leave_the_picture_are_gaps_and_the_others_keep_their_numbers(follow, renderer):
    middles = [renderer.sheet.middles + 1.6 * frame * RIGHT for frame in range(11)]
    _, error = follow(middles)
    gone = np.isnan(error[-1])
    assert gone.reshape(3, 6).tolist() == [[False] * 5 + [True]] * 3
    assert np.nanmax(error) < 0.1


def test_what_has_slid_by_a_spacing_behind_a_hand_is_where_its_neighbours_carried_it(follow, renderer):
    """Behind the hand marker 1 ends where marker 0 was last seen; the rightmost columns were seen all the time."""

    def hand(frame, grey):
        if 2 <= frame < 12:
            grey[:, :330] = 120
        return grey

    middles = [renderer.sheet.middles + (4.0 - 8.5 * np.clip((frame - 2) / 10, 0, 1)) * RIGHT for frame in range(COUNT)]
    _, error = follow(middles, hand)
    assert np.nanmax(error) < 0.1
    assert (error[-1, [0, 6, 12]] < 0.1).all()


def test_another_grid_another_method_another_origin(rendering, scene, camera_file, video, read_tracks, tmp_path):
    random = np.random.default_rng(1)
    renderer = rendering.Renderer(scene, rendering.sheet(random, 4, 5, spacing=7.0), random)
    pictures = [renderer.frame(renderer.sheet.middles + 2.0 * RIGHT) for _ in range(2)]
    path, out = video(pictures), tmp_path / "markers.csv"
    order = TrackOrder(str(path), camera_file(scene), out, layout=Layout(4, 5), method="paper", recentre=True)
    outcome = track(order)
    _, places, _ = read_tracks(out)
    assert places.shape == (2, 20, 2)
    assert np.abs(places[0].mean(axis=0)).max() < 1e-9
    assert np.abs(places - renderer.sheet.middles).max() < 0.5
    assert outcome.method == "paper"


def test_perspective_is_taken_off_where_depth_is_known(rendering, scene, camera_file, video, read_tracks, tmp_path):
    random = np.random.default_rng(1)
    sheet = rendering.sheet(random)
    renderer = rendering.Renderer(scene, sheet, random)
    pressed = [rendering.press(sheet, depth) for depth in (0.0, 1.0, 2.0)]
    path = video([renderer.frame(middles, sunk) for middles, sunk in pressed])
    table = tmp_path / "sinking.csv"
    rows = [(k / 30, m, w) for k, (_, sunk) in enumerate(pressed[:2]) for m, w in enumerate(sunk)]
    table.write_text("time_s,marker,sunk_mm\n" + "".join(f"{t!r},{m},{float(w)!r}\n" for t, m, w in rows))
    camera, out = camera_file(scene), tmp_path / "markers.csv"
    track(TrackOrder(str(path), camera, out))
    plain = read_tracks(out)[1]
    outcome = track(TrackOrder(str(path), camera, out, sinking=table))
    corrected = read_tracks(out)[1]
    truth = sheet.truth(pressed[1][0])
    assert np.abs(plain[1] - truth).max() > 0.1
    assert np.abs(corrected[1] - truth).max() < 0.005
    assert np.isnan(corrected[2]).all()
    assert any("18 places are left empty" in warning for warning in outcome.warnings)


def test_pixels_need_no_plane_and_millimetres_do(scene, renderer, camera_file, video, read_tracks, tmp_path):
    camera = camera_file(scene)
    camera.write_text(camera.read_text().split("[plane]")[0])
    path, out = video([renderer.frame()]), tmp_path / "markers.csv"
    with pytest.raises(InputError, match="no mm_per_px"):
        track(TrackOrder(str(path), camera, out))
    assert not out.exists()
    track(TrackOrder(str(path), camera, out, pixels=True))
    assert out.read_text().startswith("time_s,marker,x_px,y_px,confidence\n")
    truth = renderer.sheet.truth() / scene.mm_per_px + np.array(scene.centre)
    assert np.abs(read_tracks(out)[1][0] - truth).max() < 0.1


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        ({"method": "other"}, "allowed: subpixel, paper"),
        ({"rate": -1.0}, "allowed: more than 0"),
        ({"still": "markers.csv"}, "this file is read or written already"),
        ({"overlay": "overlay.mp4"}, "allowed: a name that ends in .avi"),
        ({"still": "still.jpg"}, "allowed: a name that ends in .png"),
        ({"layout": Layout(3, 5)}, "18 markers in 3 rows and 6 columns; allowed: 15 markers, 3 x 5"),
    ],
)
def test_what_cannot_be_done_leaves_no_file(renderer, scene, camera_file, video, tmp_path, options, reason):
    options = {key: tmp_path / value if key in ("still", "overlay") else value for key, value in options.items()}
    path, camera = video([renderer.frame()]), camera_file(scene)
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(InputError) as refused:
        track(TrackOrder(str(path), camera, tmp_path / "markers.csv", **options))
    assert reason in str(refused.value)
    assert sorted(tmp_path.rglob("*")) == before


def test_the_wrong_size_is_refused_and_a_picture_of_another_size_is_a_gap(
    renderer, rendering, scene, camera_file, read_tracks, tmp_path
):
    import cv2

    folder = tmp_path / "frames"
    folder.mkdir()
    for number in range(4):
        grey = renderer.frame()
        cv2.imwrite(str(folder / f"{number}.png"), grey[:400] if number == 2 else grey)
    camera, out = camera_file(scene), tmp_path / "markers.csv"
    outcome = track(TrackOrder(str(folder), camera, out, rate=30.0))
    assert np.isnan(read_tracks(out)[1]).all(axis=(1, 2)).tolist() == [False, False, True, False]
    assert outcome.warnings[0].startswith("1 pictures have another size")
    small = camera_file(rendering.replace(scene, size=(320, 240)), "small.toml")
    with pytest.raises(InputError, match=r"picture 0 is 640 x 480 pixels; allowed: 320 x 240"):
        track(TrackOrder(str(folder), small, out, rate=30.0))


def test_a_lens_that_folds_over_is_warned_of(rendering, camera_file, video, tmp_path):
    """At a focal length of 560 px the paper's distortion folds over inside the picture."""
    scene = rendering.Scene(focal=560.0, distortion=rendering.PAPER_DISTORTION)
    random = np.random.default_rng(1)
    renderer = rendering.Renderer(scene, rendering.sheet(random), random)
    outcome = track(TrackOrder(str(video([renderer.frame()])), camera_file(scene), tmp_path / "m.csv"))
    assert "the distortion folds over" in outcome.warnings[0]


def test_memory_does_not_grow_with_the_length(renderer, scene, camera_file, tmp_path, monkeypatch):
    """Allocations at the peak are the same for 20 and for 120 pictures."""
    pictures = [renderer.frame() for _ in range(4)]

    class Repeated:
        name, synthetic, rate = "repeated", False, 30.0

        def __init__(self, count):
            self.expected = count

        def frames(self):
            from bench_hw.vision.frames import Frame

            return (Frame(number, number / 30, pictures[number % 4]) for number in range(self.expected))

        def notes(self):
            return ()

    peaks = []
    for count in (20, 20, 120):
        monkeypatch.setattr("bench_hw.vision.tracking.film.open_frames", lambda *_, count=count: Repeated(count))
        tracemalloc.start()
        outcome = track(TrackOrder("repeated", camera_file(scene), tmp_path / "markers.csv"))
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        assert outcome.tally.frames == count
    assert peaks[2] < peaks[1] + 100_000


def test_places_and_the_way_back_agree(scene, camera_of):
    """The tests' renderer and the product have the same idea of the plane."""
    camera = camera_of(scene)
    place = np.array([[3.0, -4.0]])
    assert np.allclose(
        camera.to_pixels(camera.undistorted(scene.project(place))), camera.to_pixels(from_plane(camera, place / 1e3))
    )
