"""Rendered pictures, videos and camera files, shared by the tests of the vision rooms. All synthetic."""

import importlib.util
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from types import ModuleType

import cv2
import numpy as np
import pytest

from bench_hw.vision.camera import Camera, read_camera

HERE = Path(__file__).parent


def load(name: str) -> ModuleType:
    """A module that lies beside this file, under a name of its own."""
    unique = f"vision_tests_{name}"
    if unique not in sys.modules:
        spec = importlib.util.spec_from_file_location(unique, HERE / f"{name}.py")
        sys.modules[unique] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(sys.modules[unique])
    return sys.modules[unique]


@pytest.fixture(scope="session")
def rendering() -> ModuleType:
    return load("rendering")


@pytest.fixture(scope="session")
def boards() -> ModuleType:
    return load("boards")


@pytest.fixture
def scene(rendering):
    """The paper's distortion, wide enough that it does not fold over inside the picture."""
    return rendering.Scene(focal=640.0, distortion=rendering.PAPER_DISTORTION)


@pytest.fixture
def camera_file(tmp_path: Path) -> Callable[..., Path]:
    def write(scene, name: str = "camera.toml") -> Path:
        path = tmp_path / name
        path.write_text(scene.camera_toml())
        return path

    return write


@pytest.fixture
def camera_of(camera_file) -> Callable[..., Camera]:
    return lambda scene: read_camera(camera_file(scene))


@pytest.fixture
def video(tmp_path: Path) -> Callable[..., Path]:
    """Write pictures into a video; FFV1 is lossless."""

    def write(pictures: Sequence[np.ndarray], name: str = "video.avi", code: str = "FFV1", rate: float = 30.0) -> Path:
        path, colour = tmp_path / name, pictures[0].ndim == 3 if pictures else False
        size = pictures[0].shape[1::-1] if pictures else (640, 480)
        writer = cv2.VideoWriter(str(path), cv2.CAP_FFMPEG, cv2.VideoWriter.fourcc(*code), rate, size, colour)
        assert writer.isOpened()
        for picture in pictures:
            writer.write(picture)
        writer.release()
        return path

    return write


@pytest.fixture
def read_tracks() -> Callable[[Path], tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Times (n,), places (n, m, 2) in the table's unit with NaN for empty cells, confidences (n, m)."""

    def read(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        header, *lines = path.read_text().splitlines()
        assert header in ("time_s,marker,x_mm,y_mm,confidence", "time_s,marker,x_px,y_px,confidence")
        rows = np.array([[float(cell or "nan") for cell in line.split(",")] for line in lines])
        count = int(rows[:, 1].max()) + 1
        shaped = rows.reshape(-1, count, 5)
        assert np.array_equal(shaped[:, :, 1], np.broadcast_to(np.arange(count), shaped.shape[:2]))
        return shaped[:, 0, 0], shaped[:, :, 2:4], shaped[:, :, 4]

    return read
