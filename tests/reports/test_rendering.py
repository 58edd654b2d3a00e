"""WRITE"""

import base64
import gzip
import hashlib
import json
import re

import pytest

from reports import Column, Download, Figure, Page, Section, Table, Verdict, render_page
from reports.blocks import LiveAxes, LiveLine, LivePlot
from reports.rendering import embedded_json, scripts


def table_html(table: Table) -> str:
    page = render_page(Page("t", Verdict("good", "h"), [Section("s", [table])]))
    return page[page.index('id="table-1"') :]


def cells(html: str) -> list[str]:
    return [re.sub(r"<[^>]+>", "", cell) for cell in re.findall(r"<td[^>]*>(.*?)</td>", html)]


def test_units_stand_in_the_headings_and_numbers_to_the_right():
    html = table_html(Table("c", [Column("time", "s"), "layer"], [[0.5, "dermis"]]))
    assert '<th scope="col" class="n">time <span class="unit">(s)</span></th>' in html
    assert '<th scope="col">layer</th>' in html
    assert '<th scope="row" class="n">0.5</th>' in html


def test_exact_columns_lose_their_last_zeros_and_others_keep_their_digits():
    html = table_html(Table("c", ["a", "b"], [[0.1, 0.1], [0.2, 0.1234567]], row_headings=False))
    assert [cell.rstrip("\u2007") for cell in cells(html)] == ["0.1", "0.1000", "0.2", "0.1235"]


def test_nothing_is_shown_as_a_dash():
    assert cells(table_html(Table("c", ["a", "b"], [["x", None], ["y", float("nan")]]))) == ["–", "–"]


@pytest.mark.parametrize(
    ("rows", "folded", "wanted"), [(16, None, False), (17, None, True), (3, True, True), (99, False, False)]
)
def test_long_tables_are_folded_unless_told_otherwise(rows, folded, wanted):
    html = render_page(
        Page("t", Verdict("good", "h"), [Section("s", [Table("c", ["a"], [[1]] * rows, folded=folded)])])
    )
    assert ("<details" in html) is wanted
    assert html.count('<th scope="row"') == rows


def test_only_so_many_rows_are_shown_and_the_rest_is_counted():
    html = table_html(Table("c", ["a"], [[row] for row in range(30)], Download("tables/c.csv"), limit=20))
    assert html.count('<th scope="row"') == 20
    assert "The first 20 of 30 rows." in html
    assert '<a href="tables/c.csv">' in html


def test_an_embedded_file_is_whole():
    content = "a,µ\n1,2\n"
    html = table_html(Table("c", ["a"], [[1]], Download("tables/c.csv", content=content)))
    link = re.search(r'href="data:text/csv;base64,([^"]+)" download="c.csv"', html)
    assert base64.b64decode(link[1]).decode() == content


NAN = float("nan")
PLOT = LivePlot(
    "depth (mm)", (LiveAxes("force (N)", (LiveLine("</script>", [0.0, 1 / 3], [NAN, 2.0], "fem", (4, 1)),)),)
)
SVG = '<svg xmlns="http://www.w3.org/2000/svg"/>'


def page(live):
    figure = Figure.of(SVG, "c", "a", live=live)
    return render_page(Page("t", Verdict("good", "h"), [Section("s", [figure])]))


def test_a_page_without_anything_to_zoom_has_no_script():
    html = page(None)
    assert "<script" not in html
    assert "script-src" not in html


def test_only_the_two_scripts_of_the_page_may_run():
    html = page(PLOT)
    packed, loader = re.findall(
        r'<script(?: type="application/octet-stream" id="plotly")?>(.*?)</script>', html, re.DOTALL
    )
    policy = re.search(r"script-src ([^\"]+)", html)[1]
    bodies = gzip.decompress(base64.b64decode(packed)), loader.encode()
    sources = [f"'sha256-{base64.b64encode(hashlib.sha256(body).digest()).decode()}'" for body in bodies]
    assert policy.split() == sources
    assert b"plotly.js" in bodies[0][:200]
    assert len(html) < 2.5e6


def test_data_cannot_end_its_element_and_holds_no_nan():
    text = embedded_json(PLOT, "a panel")
    assert "<" not in text
    table = json.loads(text)
    assert table["title"] == "a panel"
    assert table["axes"][0]["lines"] == [
        {"name": "</script>", "x": [0.0, 0.333333], "y": [None, 2.0], "colour": "fem", "dash": "8px,2px"}
    ]


def test_the_library_is_packed_once():
    assert scripts() is scripts()
