"""The camera as numbers: matrix, distortion and its inverse, the marker plane, the file `camera.toml`."""

from bench_hw.vision.camera.camera_file import read_camera, write_camera
from bench_hw.vision.camera.distortion import distort, undistort
from bench_hw.vision.camera.pinhole import Camera, InvertibleDomain, Plane, Quality, from_plane, survey_domain, to_plane

__all__ = [
    "Camera",
    "InvertibleDomain",
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
