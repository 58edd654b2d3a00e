"""The laws, the relaxation and the fibres of a tissue file in the finite-element solver."""

import numpy as np
import pytest

from benchmark.errors import InputError
from benchmark.files import load_scenario
from benchmark.models import prepare, scenario_drive

PRESS = {"load.peak": "1 N", "load.observations": "4", "fem.mesh": "coarse"}
FAT = "subcutaneous_fat"
LAWS = {
    "mooney_rivlin": 'c10 = "{half} Pa", c01 = "0 Pa"',
    "yeoh": 'c10 = "{half} Pa"',
    "ogden": 'terms = [{{ mu = "{full} Pa", alpha = 2 }}]',
    "gent": 'mu = "{full} Pa", jm = 1e6',
}


def depth(**settings) -> float:
    scenario = load_scenario("skin-5N", {**PRESS, **settings})
    result = prepare("fem", scenario).run(scenario_drive(scenario))
    assert result.failure is None
    return float(result.depth[1])


@pytest.mark.parametrize("law", LAWS)
def test_a_law_with_neo_hookean_constants_is_neo_hookean(law: str) -> None:
    shear = load_scenario("skin-5N").tissue.layer(FAT).shear_modulus
    constants = LAWS[law].format(half=f"{shear / 2:.12g}", full=f"{shear:.12g}")
    assert depth(**{f"{FAT}.hyperelastic": f'{{ law = "{law}", {constants} }}'}) == pytest.approx(depth(), rel=1e-5)


def test_fibres_and_stiffening_make_the_press_shallower() -> None:
    soft = depth()
    assert depth(**{"dermis.fibre": '{ k1 = "1 MPa", k2 = 2.0, dispersion = 0.1 }'}) < 0.99 * soft
    shear = load_scenario("skin-5N").tissue.layer(FAT).shear_modulus
    yeoh = f'{{ law = "yeoh", c10 = "{shear / 2:.12g} Pa", c20 = "{shear:.12g} Pa" }}'
    assert depth(**{f"{FAT}.hyperelastic": yeoh}) < 0.99 * soft


def test_a_fibre_direction_breaks_the_symmetry() -> None:
    with pytest.raises(InputError, match=r"dermis.*30 deg.*leave the angle out"):
        depth(**{"dermis.fibre": '{ angle = "30 deg", k1 = "50 kPa", k2 = 2.0 }'})


def test_relaxation_reaches_the_solver_in_real_time() -> None:
    held = {"load.shape": "ramp_hold", "load.hold": "100 s", "load.duration": "1 ms", "load.peak": "0.2 N"}
    series = {f"{name}.relaxation": '[{ g = 0.3, tau = "1 s" }]' for name in ("epidermis", "dermis", FAT)}
    for kinematics in ("linear", "finite"):
        scenario = load_scenario("skin-5N", {**PRESS, **held, **series, "fem.kinematics": kinematics})
        found = prepare("fem", scenario).run(scenario_drive(scenario)).depth
        elastic = load_scenario("skin-5N", {**PRESS, **held, "fem.kinematics": kinematics})
        first = prepare("fem", elastic).run(scenario_drive(elastic)).depth
        assert found[0] == pytest.approx(first[0], rel=1e-3)
        assert 1.15 < found[-1] / first[-1] < 1 / 0.7


def test_pretension_is_the_same_in_fem_and_wave() -> None:
    """One thin soft layer, small strain: the deflection under and outside the tool within 1 % of the peak."""
    layer = '[{ name = "fat", thickness = "3 mm", density = "1000 kg/m^3", '
    layer += 'youngs_modulus = "20 kPa", poisson_ratio = 0.45 }]'
    thin = {"tissue.layers": layer, "fem.kinematics": "linear", "wave.large_press": "linear", "load.peak": "0.01 N"}
    found = {}
    for pretension in ("0 kPa", "20 kPa"):
        scenario = load_scenario("skin-5N", {"load.observations": "2", **thin, "physics.pretension": pretension})
        drive = scenario_drive(scenario)
        found[pretension] = [prepare(model, scenario).run(drive) for model in ("fem", "wave")]
    for fem, wave in found.values():
        np.testing.assert_allclose(wave.depth[0], fem.depth[0], rtol=0.01)
        inside = np.isfinite(wave.profile[0])
        assert inside.sum() > 20
        np.testing.assert_allclose(
            wave.profile[0][inside], fem.profile[0][inside], rtol=0, atol=0.01 * fem.profile.max()
        )
    free, taut = (result[0].depth[0] for result in found.values())
    assert taut < 0.9 * free
