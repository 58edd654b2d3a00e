import json
from dataclasses import replace

import pytest

from benchmark.discovery.files import discovery_document
from benchmark.discovery.record import NextExperiment
from reports.atomic import plain


def test_the_contract_of_the_answer(record) -> None:
    document = discovery_document(record)
    assert document["schema"] == 1
    assert document["verdict"] == "named"
    (effect,) = document["effects"]
    assert effect["name"] == "viscoelastic_relaxation"
    assert effect["confidence"] == 0.99
    assert effect["lookalikes"] == ["poroelastic_drainage"]
    assert effect["parameters"]["g_1"] == {"value": 0.31, "unit": "", "ci95": [0.29, 0.33]}
    first = document["where"][0]
    assert first["channel"] == "force_z"
    assert first["phase"] == "hold"
    assert first["cycle"] == 1
    assert first["depth_mm"] == [1.5, 2.0]
    assert (first["size"], first["unit"], first["percent_of_signal"], first["p"]) == (-0.21, "N", -8.1, 0.002)
    assert document["gap"]["force_z"] == {
        "unit": "N", "rmse_before": 0.21, "rmse_after": 0.035, "noise_floor": 0.03, "closed": 0.99,
        "ci95": [0.95, 1.0], "held_out": "condition",
    }  # fmt: skip
    assert document["candidates"][0]["name"] == "viscoelastic_relaxation"
    assert set(document["candidates"][0]) >= {"z", "delta_bic", "gap_closed"}


def test_markers_are_in_millimetres(record) -> None:
    document = discovery_document(record)
    assert document["where"][3]["unit"] == "mm"
    assert abs(document["where"][3]["size"] + 0.021) < 1e-12
    assert document["gap"]["marker_radial"]["unit"] == "mm"
    assert document["smallest_visible_effect"]["marker_radial"] == {"size": 2e-3, "unit": "mm"}
    assert document["base"]["tool_radius"]["unit"] == "mm"
    assert document["base"]["tool_radius"]["ci95"] == pytest.approx([4.9, 5.1])


def test_nothing_found_is_plain_json(empty) -> None:
    document = plain(discovery_document(empty))
    assert json.loads(json.dumps(document, allow_nan=False)) == document
    assert document["effects"] == []
    assert "next_experiment" not in document


def test_the_proposal_is_told(record) -> None:
    rivals = ("viscoelastic_relaxation", "force_drift")
    menu = {"rest in air": (40.8, 22.0)}
    proposal = NextExperiment(rivals, "rest in air", "Rest.", 6.9, 40.8, 22.0, menu, "schema = 1\n")
    document = discovery_document(replace(record, proposal=proposal))
    assert document["next_experiment"]["rivals"] == list(rivals)
    assert document["next_experiment"]["menu"]["rest in air"] == {"separation": 40.8, "minutes": 22.0}
