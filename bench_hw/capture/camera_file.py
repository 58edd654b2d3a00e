"""The `camera.toml` of a session: the rig's own, or the true optics of a simulated camera."""

from __future__ import annotations

from typing import Any

from bench_hw.rig.loading import LoadedRig
from bench_hw.rig.schema import Rig, SimulatedCamera

NAME = "camera.toml"


def camera_text(loaded: LoadedRig) -> str | None:
    """Give the text of the session's `camera.toml`; None if the camera is not calibrated.

    Raises
    ------
    OSError
        The rig's calibration cannot be read.
    """
    camera = loaded.rig.camera
    if camera is None:
        return None
    if camera.calibration is not None:
        return loaded.resolve(camera.calibration).read_text(encoding="utf-8")
    return _of_simulated(loaded) if isinstance(camera, SimulatedCamera) else None


def place(rig: Rig) -> dict[str, str]:
    """Give what a session file says of where the camera is: known of a simulated one only."""
    camera = rig.camera
    return {"distance": f"{camera.distance * 1e3:g} mm"} if isinstance(camera, SimulatedCamera) else {}


def _of_simulated(loaded: LoadedRig) -> str:
    import tomli_w

    from bench_hw.rig.twin_settings import optics_of

    optics = optics_of(loaded.rig)
    centre = [(optics.size[0] - 1) / 2.0, (optics.size[1] - 1) / 2.0]
    content: dict[str, Any] = {
        "schema": 1,
        "image_size": list(optics.size),
        "matrix": {"fx": optics.focal_length, "fy": optics.focal_length, "cx": centre[0], "cy": centre[1]},
        "distortion": dict(zip(("k1", "k2", "p1", "p2", "k3"), optics.distortion, strict=True)),
        "plane": {
            "mm_per_px": optics.distance * 1e3 / optics.focal_length,
            "mm_per_px_std": 0.0,
            "origin_px": centre,
        },
        "quality": {"views": 0, "reprojection_rms_px": 0.0, "map_error_rms_px": 0.0},
    }
    return "# The true optics of the simulated camera; not measured.\n" + tomli_w.dumps(content)
