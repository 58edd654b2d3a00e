from benchmark.runs.finished.saved_tables import SavedTables, saved_trials

MEASURED = "trial,condition,time_s,depth_mm,force_N,fem_force_N,wave_force_N\na,slow,0.0,0.0,0.0,0.0,\n"
FITTED = """name,value,unit,ci95_low,ci95_high,identifiable,source
stiffness_factor,1.25,,1.2,1.3,true,fitted
fat.youngs_modulus,62.3,kPa,61.3,63.3,false,one stiffness
fat.thickness,5.0,mm,,,false,fixed
"""


def test_a_run_that_once_wrote_an_interval_of_what_is_not_identified_is_shown_without(tmp_path) -> None:
    (tmp_path / "tables").mkdir()
    (tmp_path / "tables/measured.csv").write_text(MEASURED)
    (tmp_path / "tables/fitted_parameters.csv").write_text(FITTED)
    document = {"trials": {"synthetic": False, "headline": "fitted", "notes": []}}
    factor, modulus, thickness = saved_trials(document, SavedTables(tmp_path), tmp_path / "none").parameters
    assert (factor.ci95_low, factor.ci95_high, factor.identifiable) == (1.2, 1.3, True)
    assert (modulus.value, modulus.ci95_low, modulus.identifiable) == (62.3, None, False)
    assert (thickness.unit, thickness.ci95_low) == ("mm", None)
