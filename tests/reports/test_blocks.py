"""A picture that no lines can draw stands in the page as data."""

import base64
import dataclasses

import pytest

from reports import (
    Column,
    Download,
    Equation,
    Figure,
    Notice,
    Page,
    Panel,
    Picture,
    Section,
    Table,
    Verdict,
    render_page,
)
from reports.blocks import NOTICES, VERDICTS


@pytest.mark.parametrize("status", VERDICTS)
def test_a_verdict_has_a_word_for_its_status(status):
    assert Verdict(status, "All is known.").label.lower() == status


@pytest.mark.parametrize("kind", ["warning", "finding", "synthetic", "circular", "assumption"])
def test_a_notice_has_words_for_its_kind(kind):
    assert Notice(kind, "text").label == NOTICES[kind]


def test_an_unknown_status_is_refused_with_those_allowed():
    with pytest.raises(ValueError, match="'great'; allowed: good, finding, failed, incomplete, unknown"):
        Verdict("great", "")


def test_an_unknown_notice_is_refused():
    with pytest.raises(ValueError, match="Notice kind is 'info'"):
        Notice("info", "")


def test_a_row_of_another_length_is_refused():
    with pytest.raises(ValueError, match="'Times', row 2 has 1 cells, allowed: 2"):
        Table("Times", ["model", Column("wall", "s")], [["fem", 1.0], ["wave"]])


@pytest.mark.parametrize("href", ["https://example.org/a.csv", "javascript:alert(1)", "/etc/passwd", "//host/a", ""])
def test_a_download_is_a_file_beside_the_page(href):
    with pytest.raises(ValueError, match="relative to the page"):
        Download(href)


def test_a_download_has_the_name_of_its_file():
    assert Download("tables/a.csv").name == "a.csv"


def test_a_figure_of_one_picture():
    assert Figure.of("<svg/>", "caption", "alt") == Figure((Panel("<svg/>", "alt"),), "caption")


def test_blocks_cannot_be_changed():
    with pytest.raises(dataclasses.FrozenInstanceError):
        Notice("warning", "a").text = "b"


PNG = b"\x89PNG\r\n\x1a\nbytes"


def test_a_picture_is_part_of_the_page():
    figure = Figure((Picture(PNG, 'a "pressed" <body>'),), "what is seen", "Body")
    page = render_page(Page(title="t", verdict=Verdict("good", "fine"), sections=[Section("S", [figure])]))
    assert f'src="data:image/png;base64,{base64.b64encode(PNG).decode()}"' in page
    assert 'alt="a &#34;pressed&#34; &lt;body&gt;"' in page


def test_an_equation_is_typeset_with_its_words_and_number():
    equation = Equation("<mi>F</mi><mo>=</mo><mi>k</mi><mi>x</mi>", "F = k x", "(1)")
    html = render_page(Page("p", Verdict("good", "x"), [Section("s", [equation])]))
    assert '<math display="block" aria-label="F = k x"><mi>F</mi>' in html
    assert '<span class="label">(1)</span>' in html


@pytest.mark.parametrize("content", ["<mi>F", "<script>1</script>", '<mi onclick="x">F</mi>', "<mtext><img/></mtext>"])
def test_an_equation_holds_nothing_but_presentation(content):
    with pytest.raises(ValueError, match="Equation"):
        Equation(content, "F")
