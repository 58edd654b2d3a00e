"""The page and the folder, from small evidence."""

import json

import numpy as np
import pandas as pd
import pytest

from benchmark.cli.app import main
from benchmark.reproduce import article_page, reproduction
from benchmark.reproduce.article_page import redrawn
from benchmark.runs.report import published_section

KEYS = {"item", "printed", "recomputed", "agrees", "reason"}


@pytest.fixture(scope="module")
def figures(evidence):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(published_section, "FRAMES", 2)
        patch.setattr(published_section, "VERTICES", 5)
        return redrawn(evidence)


@pytest.fixture(scope="module")
def folder(evidence, figures, tmp_path_factory):
    folder = tmp_path_factory.mktemp("reproduce") / "out"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(reproduction, "gather", lambda _: evidence)
        patch.setattr(article_page, "redrawn", lambda _: figures)
        assert main(["reproduce", "--out", str(folder), "--quiet"]) == 0
    return folder


def test_the_folder_is_whole(folder) -> None:
    files = {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}
    assert files == {"manifest.json", "reproduce.json", "report.html", "tables/items.csv"}
    found = json.loads((folder / "reproduce.json").read_text())
    assert found.keys() == {"schema", "items"}
    assert found["schema"] == 1
    assert all(item.keys() == KEYS and isinstance(item["agrees"], bool) for item in found["items"])
    table = pd.read_csv(folder / "tables/items.csv")
    assert list(table["item"]) == [item["item"] for item in found["items"]]
    assert len(set(table["item"])) == len(table)
    assert table["difference"].tolist() == pytest.approx((table["recomputed"] - table["printed"]).tolist(), nan_ok=True)


def test_the_page_says_what_is_synthetic_and_what_circular(folder) -> None:
    html = (folder / "report.html").read_text()
    for text in ("Synthetic data", "Circular comparison", "31.77882", "39.20117", "It lets pass any scale error"):
        assert text in html
    for number in (7, 8, 10, 11, 12, 13):
        assert f"Figure {number} of the article" in html


def test_the_page_has_the_equations_and_table_2_as_the_article_does(folder) -> None:
    html = (folder / "report.html").read_text()
    for number in ("(3)", "(4)", "(5)", "(6)", "(7)", "(8)"):
        assert f'<span class="label">{number}</span>' in html
    assert html.count("<math ") == 6
    layout = html[html.index("layout (mm)") :].split("</table>")[0]
    rows = [
        "Mean",
        "Variance",
        "Observations",
        "Hypothesized Mean Difference",
        "P(T&lt;=t) two-tail",
        "t Stat",
        "t Critical",
    ]
    places = [layout.index(f">{row}") for row in rows]
    assert places == sorted(places)
    for text in ("0.05508", "0.05509", "0.997171", "1.97202"):
        assert text in layout


def test_no_is_parted_from_what_the_inputs_rounding_explains(folder) -> None:
    table = pd.read_csv(folder / "tables/items.csv").set_index("item")
    assert table.loc["Table 2: t Stat, from the printed means", "verdict"] == "input rounding"
    assert table.loc["Eq. (7): side under x", "verdict"] == "input rounding"
    assert table.loc["Table 1: d", "verdict"] == "no"
    assert (table["agrees"] == (table["verdict"] == "yes")).all()
    html = (folder / "report.html").read_text()
    assert html.count(">input rounding<") == 4
    assert "the rounding of the inputs explains 4 more" in html


def test_an_earlier_result_is_replaced_and_json_is_one_object(folder, evidence, monkeypatch, capfd) -> None:
    monkeypatch.setattr(reproduction, "gather", lambda _: evidence)
    monkeypatch.setattr(article_page, "redrawn", lambda _: {})
    assert main(["reproduce", "--out", str(folder), "--json"]) == 0
    found = json.loads(capfd.readouterr().out)
    assert found["out"] == str(folder)
    assert {"schema": 1, "items": found["items"]} == json.loads((folder / "reproduce.json").read_text())


def test_a_folder_of_something_else_is_refused_before_anything_runs(tmp_path, monkeypatch, capfd) -> None:
    monkeypatch.setattr(reproduction, "gather", lambda _: pytest.fail("it ran"))
    (tmp_path / "thesis.tex").write_text("mine")
    assert main(["reproduce", "--out", str(tmp_path)]) == 2
    assert "not a result of this program" in " ".join(capfd.readouterr().err.split())
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


def test_figures_are_those_of_the_article(evidence, figures) -> None:
    assert list(figures) == [7, 8, 10, 11, 12, 13]
    assert all(figures.values())
    for number in (7, 8, 10):
        assert all("synthetic" in figure.caption for figure in figures[number])
    largest = 1e3 * np.nanmax(evidence.chain.shown.radius_nine)
    assert f"{largest:.3f} mm at its largest" in figures[8][-1].caption
    assert [len(figure.panels) for figure in (figures[12][0], figures[13][0])] == [3, 3]


@pytest.mark.slow
def test_the_whole_of_it(tmp_path, capfd) -> None:
    assert main(["reproduce", "--out", str(tmp_path / "out"), "--json", "--quiet"]) == 0
    items = {item["item"]: item for item in json.loads(capfd.readouterr().out)["items"]}
    assert len(items) == 46
    assert items["Table 2: mean, FEA"]["agrees"]
    assert items["Table 2: variance, FEA"]["agrees"]
    assert "The markers found" in (tmp_path / "out/report.html").read_text()
