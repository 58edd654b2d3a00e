"""`calibrate`: from pictures of a board to a camera file."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bench_hw.cli._report import Debug, Json, Quiet, print_json, reporting

if TYPE_CHECKING:
    from bench_hw.vision.calibration.camera_calibration import CalibrationOutcome


def register(app: typer.Typer) -> None:
    """Add the verb."""
    app.command("calibrate")(calibrate)


def calibrate(
    images: Annotated[list[Path], typer.Argument(help="At least 20 views of a chessboard, or a folder of them.")],
    corners: Annotated[str, typer.Option(help="Inner corners of the board, COLUMNSxROWS, for instance 9x6.")],
    square_mm: Annotated[float, typer.Option(help="Side of a square, mm.")],
    out: Annotated[Path, typer.Option(help="The file to write, for instance camera.toml.")],
    plane: Annotated[
        Path | None, typer.Option(help="The board, or a ruler, lying in the marker plane: gives mm_per_px.")
    ] = None,
    mark_mm: Annotated[float, typer.Option(help="Distance of the ruler's finest marks, mm.", min=0.01)] = 1.0,
    origin: Annotated[
        str, typer.Option(help="Of the marker plane: axis, plane (middle of its picture), or X,Y in px.")
    ] = "axis",
    free_k3: Annotated[bool, typer.Option("--free-k3", help="Fit k3, too; rarely determined.")] = False,
    as_json: Json = False,
    quiet: Quiet = False,
    debug: Debug = False,
) -> None:
    """Calibrate a camera: matrix, distortion (k3 fixed at 0), scale of the marker plane, and how good they are.

    Judged by the map's error over held-out views and the parameters' deviations, not by the reprojection error.
    Exit 2 and no file: too few views, views too alike, another board, blurred, a plane without board or ruler.
    """
    with reporting(debug):
        from bench_hw.vision import silence_opencv
        from bench_hw.vision.calibration.board import parse_corners
        from bench_hw.vision.calibration.camera_calibration import CalibrationOrder
        from bench_hw.vision.calibration.camera_calibration import calibrate as run

        silence_opencv()
        board = parse_corners(corners, square_mm / 1e3)
        order = CalibrationOrder(tuple(images), board, out, plane, mark_mm / 1e3, origin, free_k3)
        outcome = run(order)
        for warning in outcome.warnings:
            print(f"warning: {warning}", file=sys.stderr)
        if as_json:
            print_json(outcome.to_dict())
        elif not quiet:
            print("\n".join(_lines(outcome)))


def _lines(outcome: CalibrationOutcome) -> list[str]:
    camera, quality = outcome.camera, outcome.camera.quality
    deviations = outcome.fit.deviations
    values = (*camera.focal, *camera.centre)
    lines = [
        f"{outcome.out}: {'' if quality is None else quality.views} views, map error over held-out views "
        f"{0.0 if quality is None else quality.map_error_rms:.3f} px rms",
        "  "
        + ", ".join(
            f"{name} {value:.2f} +- {std:.2f} px"
            for name, value, std in zip(("fx", "fy", "cx", "cy"), values, deviations, strict=False)
        ),
        "  "
        + ", ".join(
            f"{name} {value:.5f} +- {std:.5f}"
            for name, value, std in zip(("k1", "k2", "p1", "p2", "k3"), camera.distortion, deviations[4:], strict=True)
        ),
        f"  {outcome.domain}",
    ]
    if camera.plane is None:
        return [*lines, "  no mm_per_px: `track` will refuse millimetres; give --plane IMAGE"]
    scale, std = camera.plane.scale * 1e3, camera.plane.scale_std * 1e3
    return [*lines, f"  {scale:.6f} +- {std:.6f} mm per px in the marker plane"]
