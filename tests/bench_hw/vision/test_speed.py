"""How fast markers are tracked, and what memory it takes. Measured, never asserted: run with `-m bench`.

One thread of OpenCV; for one core in all set OMP_NUM_THREADS=1, too. Wall times suffer from whoever else runs: CPU
time is printed beside them.
"""

import resource
import time

import cv2
import numpy as np
import pytest

from bench_hw.vision.camera import to_plane
from bench_hw.vision.markers import detect_grid
from bench_hw.vision.tracking import METHODS, TrackOrder, track

pytestmark = pytest.mark.bench
ROUND = 60


@pytest.fixture
def pictures(rendering):
    """A press and release in sixty pictures of 640 x 480, 18 markers, noise 4, the paper's distortion."""
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    scene = rendering.Scene(focal=640.0, distortion=rendering.PAPER_DISTORTION)
    random = np.random.default_rng(0)
    renderer = rendering.Renderer(scene, rendering.sheet(random), random)
    depths = 4.0 * np.sin(np.pi * np.arange(ROUND) / ROUND) ** 2
    middles = [rendering.press(renderer.sheet, depth)[0] for depth in depths]
    yield renderer, [renderer.frame(moved) for moved in middles], np.array([renderer.sheet.truth(m) for m in middles])
    cv2.setNumThreads(threads)


@pytest.mark.parametrize("method", METHODS)
def test_pictures_in_memory(benchmark, pictures, camera_of, method):
    renderer, greys, truth = pictures
    camera = camera_of(renderer.scene)
    tracker = METHODS[method](greys[0], detect_grid(greys[0]), camera)
    started, done = time.process_time(), 0

    def run():
        nonlocal done
        done += len(greys)
        return [tracker.step(grey) for grey in greys]

    sightings = benchmark(run)
    busy = time.process_time() - started
    error = np.hypot(*np.moveaxis(np.array([to_plane(camera, s.points) for s in sightings]) * 1e3 - truth, 2, 0))
    benchmark.extra_info |= {
        "pictures_per_cpu_second": round(done / busy),
        "pictures_per_second": round(len(greys) / benchmark.stats.stats.median),
        "rms_px": round(float(np.sqrt(np.nanmean(error**2))) / renderer.scene.mm_per_px, 4),
        "max_px": round(float(np.nanmax(error)) / renderer.scene.mm_per_px, 3),
        "missed": int(np.isnan(error).sum()),
    }
    print(method, benchmark.extra_info)


@pytest.mark.parametrize(("code", "count"), [("FFV1", 600), ("MJPG", 600), ("MJPG", 18_000)])
def test_a_video_file_with_start_up(pictures, camera_file, video, tmp_path, code, count):
    """600 pictures are 20 s, 18,000 are ten minutes."""
    renderer, greys, _ = pictures
    colour = [cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR) for grey in greys] if code == "MJPG" else greys
    path = video([colour[k % ROUND] for k in range(count)], code=code)
    order = TrackOrder(str(path), camera_file(renderer.scene), tmp_path / "markers.csv")
    wall, busy = time.perf_counter(), time.process_time()
    outcome = track(order)
    wall, busy = time.perf_counter() - wall, time.process_time() - busy
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(
        f"{code} {count} pictures: {count / wall:.0f} a second, {count / busy:.0f} a CPU second, "
        f"missed {int(outcome.tally.missing.sum())}, {memory:.0f} MB at most in this process"
    )
