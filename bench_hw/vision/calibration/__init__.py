"""From pictures of a board to a camera: corners, fit, held-out error, refusals with reasons, the marker plane."""

from bench_hw.vision.calibration.board import Board, parse_corners
from bench_hw.vision.calibration.camera_calibration import CalibrationOrder, CalibrationOutcome, calibrate

__all__ = ["Board", "CalibrationOrder", "CalibrationOutcome", "calibrate", "parse_corners"]
