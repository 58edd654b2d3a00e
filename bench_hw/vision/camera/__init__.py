"""The camera as numbers: matrix, distortion and its inverse, the marker plane, the file `camera.toml`."""

from bench_hw.vision.camera.distortion import distort
from bench_hw.vision.camera.domain import Domain, survey_domain
from bench_hw.vision.camera.file import read_camera, write_camera
from bench_hw.vision.camera.inverse import undistort
from bench_hw.vision.camera.model import Camera, Plane, Quality
from bench_hw.vision.camera.plane import from_plane, to_plane

__all__ = [
    "Camera",
    "Domain",
    "Plane",
    "Quality",
    "distort",
    "from_plane",
    "read_camera",
    "survey_domain",
    "to_plane",
    "undistort",
    "write_camera",
]
