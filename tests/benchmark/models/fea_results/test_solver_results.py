"""What CalculiX and FEBio print, as a reference; a damaged file is refused in one paragraph, whatever is in it."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from benchmark.errors import InputError
from benchmark.files import load_scenario
from benchmark.models import read_reference, scenario_drive

SCENARIO = load_scenario("skin-5N", {"load.observations": "8", "load.peak": "2 N"})
DEPTH = load_scenario(
    "skin-5N", {"load.observations": "8", "load.control": "depth", "load.peak": "1 mm", "tool.contact": "rigid_bonded"}
)
DRIVE = scenario_drive(SCENARIO)
LAYERS = len(SCENARIO.tissue.layers)


def moved(load, layer):
    """Deflection in m of a layer."""
    return 1e-3 * load / (layer + 1.0)


def dat(drive, force=None) -> str:
    out = []
    for time, value in zip(drive.time, drive.value, strict=True):
        for k in range(LAYERS):
            out.append(f"\n displacements (vx,vy,vz) for set AXIS_{k + 1} and time  {time:.7E}\n")
            out.append(f"        {k + 7}  0.000000E+00 {-moved(value, k):.6E}  0.000000E+00")
        if force is not None:
            out.append(f"\n total force (fx,fy,fz) for set TOOL_SLICE and time  {time:.7E}\n")
            out.append(f"        0.000000E+00 {-force(value) / 180.0:.6E}  0.000000E+00")
    return "\n".join(out) + "\n"


def frd(drive) -> str:
    thickness = [one.thickness for one in SCENARIO.tissue.layers]
    tops = -np.concatenate([[0.0], np.cumsum(thickness)])
    nodes = [(x, y) for y in tops for x in (0.0, 2e-3, 30e-3)]
    lines = ["    1C", f"    2C{len(nodes):30d}"]
    lines += [f" -1{k + 1:10d}{x:12.5E}{y:12.5E}{0.0:12.5E}" for k, (x, y) in enumerate(nodes)] + [" -3"]
    for time, value in zip(drive.time, drive.value, strict=True):
        lines += [f"  100CL  101{time:12.6f}{len(nodes):12d}", " -4  DISP        4    1", " -5  D1"]
        for k, (x, y) in enumerate(nodes):
            down = moved(value, int(np.argmin(np.abs(tops - y)))) * (y > tops[-1]) * np.exp(-x / 5e-3)
            lines.append(f" -1{k + 1:10d}{0.0:12.5E}{-down:12.5E}{0.0:12.5E}")
        lines.append(" -3")
    return "\n".join([*lines, " 9999"]) + "\n"


def febio(drive, star="", head="Data Record #1\n=====\n", named=True) -> str:
    depth = np.concatenate([[0.0], np.cumsum([one.thickness for one in SCENARIO.tissue.layers])])
    out = []
    for step, (time, value) in enumerate(zip(drive.time, drive.value, strict=True)):
        rows = [(k + 5, 0.0, 0.0, -depth[k] - moved(value, k), 0.0, 0.0, -moved(value, k)) for k in range(LAYERS)]
        parts = [(f"AXIS_{k + 1}: ", [row]) for k, row in enumerate(rows)] if named else [("", rows)]
        for name, some in parts:
            out.append(f"{head}{star}Step = {step + 1}\n{star}Time = {time:.9g}\n{star}Data = {name}x;y;z;ux;uy;uz\n")
            out.append("".join(",".join(f"{x:.9g}" for x in row) + "\n" for row in some) + "\n")
    return "".join(out)


TEXTS = {
    "a.dat": dat(DRIVE),
    "a.frd": frd(DRIVE),
    "a.log": febio(DRIVE),
    "b.log": febio(DRIVE, named=False),
    "a.txt": febio(DRIVE, star="*", head=""),
}


@pytest.mark.parametrize("name", list(TEXTS))
def test_deflections_come_back_at_the_scenarios_steps(name: str, tmp_path) -> None:
    (tmp_path / name).write_text(TEXTS[name])
    found = read_reference(tmp_path / name, SCENARIO).result
    expected = np.column_stack([moved(DRIVE.value, k) for k in range(LAYERS)])
    np.testing.assert_allclose(found.top_deflection, expected, atol=1e-8)


def test_a_frd_has_the_profile_at_peak_load(tmp_path) -> None:
    (tmp_path / "a.frd").write_text(TEXTS["a.frd"])
    found = read_reference(tmp_path / "a.frd", SCENARIO).result
    at = np.interp(2e-3, found.profile_radii, found.profile[0])
    assert at == pytest.approx(moved(2.0, 0) * np.exp(-0.4), rel=0.02)


def test_the_force_under_depth_control_is_the_whole_circumferences(tmp_path) -> None:
    drive = scenario_drive(DEPTH)
    (tmp_path / "a.dat").write_text(dat(drive, lambda depth: 3e3 * depth))
    found = read_reference(tmp_path / "a.dat", DEPTH).result
    np.testing.assert_allclose(found.force, 3e3 * drive.value, atol=1e-4)


def test_a_frd_does_not_tell_the_force(tmp_path) -> None:
    (tmp_path / "a.frd").write_text(TEXTS["a.frd"])
    with pytest.raises(InputError, match=r"give the \.dat"):
        read_reference(tmp_path / "a.frd", DEPTH)


def test_a_missing_layer_is_named(tmp_path) -> None:
    (tmp_path / "a.dat").write_text(TEXTS["a.dat"].replace("AXIS_2", "OTHER"))
    with pytest.raises(InputError, match="no displacement of the layer dermis"):
        read_reference(tmp_path / "a.dat", SCENARIO)


@pytest.mark.parametrize("text", ["", "\n\n", "nothing of the kind\n", "\0\1\2", "    2C\n", " displacements"])
@pytest.mark.parametrize("ending", ["dat", "frd", "log", "txt"])
def test_what_is_no_result_is_refused(text: str, ending: str, tmp_path) -> None:
    (tmp_path / f"a.{ending}").write_text(text)
    with pytest.raises(InputError, match=f"a.{ending}"):
        read_reference(tmp_path / f"a.{ending}", SCENARIO)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture], derandomize=True)
@given(data=st.data(), name=st.sampled_from(sorted(TEXTS)))
def test_damage_ends_in_an_answer_or_a_refusal(data, name: str, tmp_path) -> None:
    """Cut off, lines lost or doubled, or bytes replaced: never another exception, and no value that is not finite."""
    text = TEXTS[name]
    at = data.draw(st.integers(0, len(text) - 1))
    length = data.draw(st.integers(0, 40))
    junk = data.draw(st.text("0123456789.E+-naif ;,\n=AXIS_", max_size=12))
    whole = data.draw(st.booleans())
    (tmp_path / name).write_text(text[:at] if whole else text[:at] + junk + text[at + length :])
    said, found = "", None
    try:
        found = read_reference(tmp_path / name, SCENARIO).result
    except InputError as refusal:
        said = str(refusal)
    assert "\n" not in said
    assert name in said if found is None else np.isfinite(found.top_deflection).all()
