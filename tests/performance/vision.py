"""How fast markers are tracked, and what memory a long video takes: `make bench-vision`.

18 markers at 640 x 480 in pictures of the simulated camera (noise 4, the published lens), one thread. Printed, never
asserted: wall times suffer from whoever else runs on the machine, so CPU time stands beside them.
"""

from __future__ import annotations

import argparse
import resource
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from bench_hw.simulated.picture import CameraModel, Painter
from bench_hw.simulated.specimen import pressed_sheet
from bench_hw.trial_file import FrameRecord, TrialHeader, open_trial
from bench_hw.vision.camera.camera_file import write_camera
from bench_hw.vision.camera.pinhole import Camera, Plane
from bench_hw.vision.markers import detect_grid
from bench_hw.vision.tracking import METHODS, TrackOrder, track

PERIOD = 120
LOSSLESS = {"FFV1": "FFV1", "PNG pictures": "MPNG", "HuffYUV": "HFYU", "grey levels as they are": "Y800"}
"""Ways to keep a film without loss, by OpenCV's code of four letters; HuffYUV has colours only."""
LENS = (0.07, -0.48, -0.01, -0.01, 0.0)
Pictures = list[NDArray[np.uint8]]


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(description="Speed and memory of the marker tracker.")
    parser.add_argument("--minutes", type=float, default=10.0, help="length of the long video at 30 frames a second")
    minutes = parser.parse_args(arguments).minutes
    import cv2

    cv2.setNumThreads(1)
    model = CameraModel(focal_length=650.0, distortion=LENS, noise=4.0)
    camera = _camera(model)
    painter, markers = Painter(model, np.random.default_rng(0)), pressed_sheet()
    pictures = [painter.paint(markers(4.0 * k / PERIOD)) for k in range(PERIOD)]
    for method in METHODS:
        _in_memory(method, pictures, camera)
    with tempfile.TemporaryDirectory() as folder:
        for kind in ("jpeg", "png"):
            _from_trial(Path(folder), pictures, camera, 20 * 30, kind)
        for kind in LOSSLESS:
            _from_file(Path(folder), pictures, camera, 20 * 30, kind)
        _from_file(Path(folder), pictures, camera, round(minutes * 60 * 30), "FFV1")
    return 0


def _camera(model: CameraModel) -> Camera:
    width, height = model.size
    centre = ((width - 1) / 2.0, (height - 1) / 2.0)
    plane = Plane(model.distance / model.focal_length, 0.0, centre)
    return Camera(model.size, (model.focal_length, model.focal_length), centre, model.distortion, plane)


@contextmanager
def _measured(what: str, count: int) -> Iterator[None]:
    wall, busy = time.perf_counter(), time.process_time()
    yield
    wall, busy = time.perf_counter() - wall, time.process_time() - busy
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(
        f"{what}: {count / wall:.0f} frames a second, {count / busy:.0f} a CPU second, {memory:.0f} MB at most",
        flush=True,
    )


def _in_memory(method: str, pictures: Pictures, camera: Camera) -> None:
    rounds = 5 if method == "subpixel" else 1
    tracker = METHODS[method](pictures[0], detect_grid(pictures[0]), camera)
    with _measured(f"{method}, frames in memory", rounds * len(pictures)):
        for _ in range(rounds):
            for picture in pictures:
                tracker.step(picture)


def _from_file(folder: Path, pictures: Pictures, camera: Camera, frames: int, kind: str) -> None:
    """Write a lossless video and track it, start-up included."""
    import cv2

    size, coloured = (pictures[0].shape[1], pictures[0].shape[0]), kind == "HuffYUV"
    path, camera_path = folder / "film.avi", write_camera(folder / "camera.toml", camera)
    writer = cv2.VideoWriter(str(path), cv2.CAP_FFMPEG, cv2.VideoWriter.fourcc(*LOSSLESS[kind]), 30.0, size, coloured)
    for number in range(frames):
        picture = pictures[number % len(pictures)]
        writer.write(cv2.cvtColor(picture, cv2.COLOR_GRAY2BGR) if coloured else picture)
    writer.release()
    with _measured(f"subpixel, lossless file ({kind}) of {frames / 30.0:.0f} s", frames):
        track(TrackOrder(str(path), camera_path, folder / "markers.csv"))


def _from_trial(folder: Path, pictures: Pictures, camera: Camera, frames: int, kind: str) -> None:
    """Write the pictures as `capture` keeps them, as the camera sends them, and track the trial, start-up included."""
    import cv2

    ending, quality = (".jpg", [cv2.IMWRITE_JPEG_QUALITY, 95]) if kind == "jpeg" else (".png", [])
    encoded = [cv2.imencode(ending, picture, quality)[1].tobytes() for picture in pictures]
    path, camera_path = folder / f"{kind}.mcap", write_camera(folder / "camera.toml", camera)
    header = TrialHeader("trial", "2024-05-06T07:08:09+00:00", 10.0, "-z", "press", synthetic=True)
    with open_trial(path, header, background=False) as writer:
        for number in range(frames):
            writer.write_frame(FrameRecord(10.0 + number / 30.0, number, encoded[number % len(encoded)], kind))
    size = path.stat().st_size / frames / 1e3
    with _measured(f"subpixel, a trial of capture ({kind}, {size:.0f} kB a picture) of {frames / 30.0:.0f} s", frames):
        track(TrackOrder(str(path), camera_path, folder / "markers.csv"))


if __name__ == "__main__":
    sys.exit(main())
