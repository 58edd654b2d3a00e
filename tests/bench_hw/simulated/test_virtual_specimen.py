import numpy as np
import pytest
import tomli_w

from bench_hw.errors import InputError
from bench_hw.simulated.virtual_specimen import read_specimen

STEP = 0.01
TIME = STEP * np.arange(2001)
HELD = np.interp(TIME, [0.0, 1.0, 20.0], [0.0, 2e-3, 2e-3])
UP_AND_DOWN = np.interp(TIME, [0.0, 10.0, 20.0], [0.0, 2e-3, 0.0])


def made(tmp_path, **effects):
    tools = [
        {"radius_mm": r, "depth_mm": [0.0, 1.0, 2.0, 4.0], "force_N": [0.0, 1.0 * r, 2.0 * r, 4.0 * r]} for r in (5, 8)
    ]
    path = tmp_path / "specimen.toml"
    path.write_text(tomli_w.dumps({"schema": 1, "synthetic": True, "tools": tools, "effects": effects}))
    return read_specimen(path)


def press(specimen, depth):
    return specimen(TIME, depth, 0).force[:, 2]


def test_without_an_effect_it_follows_the_curve_of_the_tool_in_use(tmp_path) -> None:
    specimen = made(tmp_path)
    assert press(specimen, UP_AND_DOWN) == pytest.approx(5e3 * UP_AND_DOWN)
    assert press(specimen.with_setup({"tool_radius": "8 mm"}), UP_AND_DOWN) == pytest.approx(8e3 * UP_AND_DOWN)
    with pytest.raises(InputError, match=r"6 mm radius: allowed for this specimen are 5 mm, 8 mm"):
        specimen.with_setup({"tool_radius": "6 mm"})


def test_rows_asked_for_piece_by_piece_are_those_asked_for_at_once(tmp_path) -> None:
    effects = {"relaxation": [[0.2, 1.0]], "slip_share": 0.3, "drift_mN_per_s": 5.0}
    whole = press(made(tmp_path, **effects), UP_AND_DOWN)
    other = made(tmp_path, **effects)
    parts = [
        other(TIME[:end], UP_AND_DOWN[:end], start).force[:, 2] for start, end in ((0, 700), (700, 701), (701, 2001))
    ]
    assert np.concatenate(parts) == pytest.approx(whole)


def test_drainage_takes_as_much_longer_as_the_contact_is_larger_and_relaxation_does_not(tmp_path) -> None:
    for effects, longer in (
        ({"drainage_share": 0.3, "drainage_mm2_per_s": 10.0}, True),
        ({"relaxation": [[0.3, 2.5]]}, False),
    ):
        small = made(tmp_path, **effects)
        wide = small.with_setup({"tool_radius": "8 mm"})
        fading = [press(each, HELD) / press(made(tmp_path), HELD)[-1] * 5 / r for each, r in ((small, 5), (wide, 8))]
        after = int(4.0 / STEP)
        assert bool(fading[1][after] > fading[0][after] + 0.02) is longer


def test_a_rig_that_gives_way_shows_more_depth_and_gives_way_to_a_block_too(tmp_path) -> None:
    giving = made(tmp_path, compliance_mm_per_N=0.05)
    force = press(giving, UP_AND_DOWN)
    assert force == pytest.approx(UP_AND_DOWN / (1.0 / 5e3 + 5e-5), rel=1e-6)
    shallow = 1e-4 * np.sin(0.1 * TIME).clip(0.0)
    slope = [
        np.polyfit(press(each.with_setup({"specimen": "block"}), shallow), shallow, 1)[0]
        for each in (giving, made(tmp_path))
    ]
    assert slope == pytest.approx([5.25e-5, 2.5e-6], rel=1e-3)


def test_slip_comes_back_another_way_and_drift_goes_on_in_air(tmp_path) -> None:
    slipping = press(made(tmp_path, slip_share=0.4, slip_force_N=2.0), UP_AND_DOWN)
    half = TIME.size // 4
    assert slipping[half] > slipping[-1 - half] + 0.3
    drifting = press(made(tmp_path, drift_mN_per_s=10.0), np.full_like(TIME, -1e-3))
    assert drifting == pytest.approx(0.01 * TIME)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            {"tools": [{"radius_mm": 5.0, "depth_mm": [0.0, 1.0, 1.0, 2.0], "force_N": [0.0, 1.0, 2.0, 3.0]}]},
            "increase",
        ),
        ({"effects": {"slip": 1.0}}, "slip"),
        ({"synthetic": False}, "synthetic"),
    ],
)
def test_a_file_that_says_something_else_is_refused(tmp_path, change, said) -> None:
    good = {"radius_mm": 5.0, "depth_mm": [0.0, 1.0, 2.0, 3.0], "force_N": [0.0, 1.0, 2.0, 3.0]}
    path = tmp_path / "specimen.toml"
    path.write_text(tomli_w.dumps({"schema": 1, "synthetic": True, "tools": [good], **change}))
    with pytest.raises(InputError, match=said):
        read_specimen(path)
