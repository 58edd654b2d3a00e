import base64
import re

import pytest

from reports import Column, Download, Page, Section, Table, Verdict, render_page


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
