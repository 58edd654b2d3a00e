"""The effects in FEM and wave on the page, in the table and on the terminal."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from benchmark.discovery.discovery_request import DiscoverRequest, _refitted
from benchmark.discovery.discovery_result import Estimate
from benchmark.discovery.refitting.refit_result import CarriedEffect, ModelRefit, Prediction, RefittedNumber
from benchmark.discovery.report.discovery_files import COLUMNS, discovery_document, discovery_tables
from benchmark.discovery.report.discovery_page import discovery_page
from benchmark.discovery.report.discovery_record import DiscoveryRecord
from benchmark.discovery.report.refit_section import refit_line, remarks
from benchmark.errors import InputError
from benchmark.physics import catalogue
from reports import write_page

SHARE = Estimate("g_1", 0.2, "", (0.19, 0.21))
REFIT = ModelRefit(
    "fem",
    (CarriedEffect("viscoelastic_relaxation", True, "a Prony series"),),
    (
        RefittedNumber("viscoelastic_relaxation", SHARE, Estimate("g_1", 0.31, "", (0.29, 0.33))),
        RefittedNumber("base", Estimate("tool.radius", 0.2, "", (0.1, 0.3)), prior=0.05),
    ),
    (
        Prediction("nothing", "all", "force_z", 0.2, 0.011, 0.01, 0.999),
        Prediction("condition", "fast", "force_z", 0.2, 0.3, 0.01, -1.2),
        Prediction("tool", "wide", "force_z", 0.2, 0.02, 0.01, 0.99),
    ),
    adds=0.1,
    found_adds=0.2,
)
WITHOUT = ModelRefit("wave", reason="the wave does not cover it")


def test_the_page_says_where_a_refit_disagrees() -> None:
    said = " ".join(remarks(REFIT))
    assert "a Prony series" in said
    assert "g_1 = 0.200 disagrees with the search, 0.310" in said
    assert "4 standard deviations from what was told" in said
    assert "by a factor of 0.5" in said
    assert "of the condition fast is predicted worse" in said
    assert "wide" not in said


def test_a_refit_that_agrees_is_told_without_a_warning() -> None:
    good = replace(REFIT, numbers=(), predictions=REFIT.predictions[:1], adds=0.2)
    assert len(remarks(good)) == 2


def test_the_line_tells_of_an_unseen_tool_first() -> None:
    assert "an unseen tool (wide): rms 0.2 -> 0.02 N (replicates: 0.01 N)" in refit_line(REFIT)
    assert "no refit: the wave does not cover it" in refit_line(WITHOUT)


def test_document_table_and_page_have_both_models(record: DiscoveryRecord, tmp_path) -> None:
    with_both = replace(record, refits=(REFIT, WITHOUT))
    document = discovery_document(with_both)
    assert document["refitted"]["wave"] == {"reason": "the wave does not cover it"}
    table = discovery_tables(document)["refitted.csv"]
    assert tuple(table) == COLUMNS["refitted.csv"]
    assert table["after_in_noise"] == pytest.approx([1.1, 30.0, 2.0])
    environment = {"made": "now", "packages": {"tissuebench": "0"}}
    write_page(tmp_path / "report.html", discovery_page(with_both, environment, list(discovery_tables(document))))
    text = (tmp_path / "report.html").read_text()
    assert "The effects in the FEM and the wave model" in text
    assert "No refit: the wave does not cover it." in text


def test_a_pick_that_is_no_effect_is_refused() -> None:
    found = SimpleNamespace(chosen=object(), known=())
    listener = SimpleNamespace(say=lambda text: None)
    request = DiscoverRequest([], refit="strain_stifening")
    with pytest.raises(InputError, match="strain_stiffening"):
        _refitted(SimpleNamespace(name="s"), request, found, catalogue(), listener)
