"""Commands to a measured process, answered in this one."""

import math
from dataclasses import replace

import pytest

from benchmark.gate.measuring.costs import CostClock
from benchmark.gate.measuring.jobs import MOST_STEPS, first_of
from benchmark.gate.measuring.references import CALLS, REFERENCES
from benchmark.gate.measuring.service import Service
from benchmark.gate.plan import GatePlan, load_plan

UNCOVERED = """
def deform(layers, tool, support, time, force):
    raise NotImplementedError("it knows a hole only")
"""


@pytest.fixture
def service():
    with CostClock() as clock:
        yield Service(clock)


def values_of(service: Service, plan: GatePlan) -> dict[str, dict]:
    answer = service.answer({"do": "values", "cases": plan.cases})
    assert "error" not in answer, answer
    return {each["name"]: each for each in answer["values"]}


def test_values_of_a_users_model(service: Service, tiny_gate) -> None:
    found = values_of(service, load_plan(tiny_gate().path))
    assert found["springs.max_deformation_mm.skin"]["value"] == pytest.approx(5.0)
    assert found["springs.max_deformation_mm.fat"] == {
        "name": "springs.max_deformation_mm.fat", "value": pytest.approx(4.0), "unit": "mm", "reason": None,
        "curve": {f"step {k} ({n} N)": pytest.approx(0.8 * n) for k, n in enumerate([1, 2, 3, 4, 5, 4, 3, 2, 1, 0], 1)},
    }  # fmt: skip


def test_a_case_that_its_model_does_not_cover_is_told_of_by_name(service: Service, tiny_gate) -> None:
    gate = tiny_gate()
    (gate.path.parent / "my_model.py").write_text(UNCOVERED)
    answer = service.answer({"do": "values", "cases": load_plan(gate.path).cases})
    assert answer["fault"] is False
    assert answer["error"].startswith("case springs: ")
    assert answer["error"].endswith("my_model.py does not cover its scenario: it knows a hole only")


def test_of_a_long_history_some_steps_are_kept_the_peak_among_them(service: Service, tiny_gate) -> None:
    gate = tiny_gate()
    gate.change("press.toml", "observations = 10", "observations = 1234")
    curve = values_of(service, load_plan(gate.path))["springs.max_deformation_mm.skin"]["curve"]
    assert MOST_STEPS <= len(curve) <= MOST_STEPS + 1
    assert {"step 1 (0.00810373 N)", "step 617 (5 N)", "step 1234 (0 N)"} <= curve.keys()


def test_values_of_the_shipped_gate(service: Service) -> None:
    plan = load_plan(None)
    pressed = tuple(case for case in plan.cases if case["model"] in ("fem", "wave"))
    found = values_of(
        service, replace(plan, cases=(*pressed, *(case for case in plan.cases if case["model"] == "fit")))
    )
    assert {name.rsplit(".", 1)[0] for name in found if "max_deformation_mm" in name} == {
        f"{case['name']}.max_deformation_mm" for case in pressed
    }
    assert all(math.isfinite(each["value"]) and each["reason"] is None for each in found.values())
    fem, wave = (found[f"linear.{model}.max_deformation_mm.dermis"]["value"] for model in ("fem", "wave"))
    assert wave == pytest.approx(fem, rel=0.01)
    assert found["sheet.fem.max_deformation_mm.sheet"]["value"] == pytest.approx(5.0, rel=1e-6)
    assert found["sheet.fem.peak_force_N"]["value"] > 0.0
    assert 0.7 < found["fit.stiffness_factor"]["value"] < 0.95


def test_a_run_that_stops_early_has_no_value_but_a_reason(service: Service) -> None:
    plan = load_plan(None)
    case = next(case for case in plan.cases if case["name"] == "finite.fem")
    hopeless = {**case, "set": {"load.peak": "100 kN", "load.observations": "1", "fem.mesh": "coarse"}}
    answer = service.answer({"do": "values", "cases": [hopeless]})
    assert all(each["value"] is None and "stopped early" in each["reason"] for each in answer["values"])


def test_a_block_times_every_workload_and_reference(service: Service) -> None:
    plan = load_plan(None)
    prepared = service.answer({"do": "prepare", "timed": plan.jobs, "references": plan.references})
    assert set(prepared) == {"sees_waiting"}, prepared
    seconds = service.answer({"do": "block"})["seconds"]
    assert set(seconds) == {*plan.references, *(job["name"] for job in plan.jobs)}
    assert all(each > 0.0 for each in seconds.values())


def test_mistakes_and_faults_are_answers(service: Service, tiny_gate) -> None:
    gate = tiny_gate()
    plan = load_plan(gate.path)
    gate.change("my_model.py", "np.outer(force, [1e-3, 0.8e-3])", "1 / 0")
    answer = service.answer({"do": "values", "cases": plan.cases})
    assert "my_model.py, line 7" in answer["error"]
    assert answer["fault"] is False
    fault = service.answer({"do": "dance"})
    assert fault["fault"] is True
    assert "Traceback" in fault["trace"]


@pytest.mark.parametrize("name", REFERENCES)
def test_references_do_the_same_each_time(name: str) -> None:
    work = REFERENCES[name]()
    assert work() is None
    assert work() is None


def test_a_name_is_found_where_a_revision_keeps_it() -> None:
    assert first_of("benchmark.nowhere:thing", "benchmark.gate.measuring.references:CALLS") == CALLS
    assert first_of("math:nothing", "math:pi") == math.pi
    with pytest.raises(ImportError, match=r"benchmark\.nowhere:thing, math:nothing"):
        first_of("benchmark.nowhere:thing", "math:nothing")
