import base64
import gzip
import hashlib
import itertools
import json
import re
from html.parser import HTMLParser

import pytest

from reports import (
    Bullets,
    Column,
    Download,
    Equation,
    Fact,
    Facts,
    Figure,
    KeyFigure,
    KeyFigures,
    Listing,
    Notice,
    Page,
    Panel,
    Paragraph,
    Section,
    Subsection,
    Table,
    Verdict,
    render_page,
    write_page,
)
from reports.blocks import LiveAxes, LiveLine, LivePlot
from reports.page import embedded_json, scripts

VOID = {"meta", "link", "br", "hr", "img", "input"}
EVIL = "<script>alert('x')</script><b onclick=\"y\">&amp;"


class Checker(HTMLParser):
    """Collects what a test asks for, and fails on tags that are not closed in order."""

    def __init__(self, html: str) -> None:
        super().__init__(convert_charrefs=True)
        self.open: list[str] = []
        self.tags: list[tuple[str, dict[str, str]]] = []
        self.feed(html)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        assert len({name for name, _ in attrs}) == len(attrs), f"<{tag}> has an attribute twice"
        self.tags.append((tag, {name: value or "" for name, value in attrs}))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        assert "svg" in self.open, f"<{tag}/> outside of SVG"
        self.tags.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, f"</{tag}> closes another element"

    def all(self, tag):
        return [attributes for name, attributes in self.tags if name == tag]


@pytest.fixture(scope="module")
def html(demo_page):
    return render_page(demo_page)


@pytest.fixture(scope="module")
def checked(html):
    return Checker(html)


def bare(*blocks, **options):
    return Page("t", Verdict("good", "h"), [Section("s", blocks)], **options)


def test_every_tag_is_closed_and_every_id_is_there_once(checked):
    ids = [attributes["id"] for _, attributes in checked.tags if "id" in attributes]
    assert len(ids) == len(set(ids))


def test_every_reference_inside_the_page_has_its_target(checked, html):
    ids = {attributes["id"] for _, attributes in checked.tags if "id" in attributes}
    wanted = {attributes["href"][1:] for _, attributes in checked.tags if attributes.get("href", "").startswith("#")}
    wanted |= {name for _, attributes in checked.tags for name in attributes.get("aria-labelledby", "").split()}
    wanted |= set(re.findall(r"url\(#([^)]+)\)", html))
    assert wanted - ids == set()
    assert len(wanted) > 50


def test_one_first_level_heading_and_no_level_skipped(checked):
    levels = [int(tag[1]) for tag, _ in checked.tags if re.fullmatch("h[1-6]", tag)]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(later <= earlier + 1 for earlier, later in itertools.pairwise(levels))


def test_the_verdict_comes_before_everything_else(html):
    assert html.index('class="verdict finding"') < html.index('class="key-figures"') < html.index('class="contents"')
    assert html.index("too soft at 5 N") < html.index("<svg")


def test_every_picture_has_words_and_every_figure_a_caption(checked, demo_page):
    pictures = checked.all("svg")
    assert all(picture["role"] == "img" and picture["aria-labelledby"] for picture in pictures)
    assert len(pictures) == len(checked.all("desc")) > 25
    figures = [item for item in checked.all("figure") if item.get("id", "").startswith("figure-")]
    assert len(figures) == 19


def test_every_table_has_a_caption_and_every_heading_a_scope(checked):
    assert len(checked.all("caption")) == len(checked.all("table")) == 2
    assert {heading["scope"] for heading in checked.all("th")} == {"col", "row"}


def test_the_first_link_skips_to_the_report(checked):
    assert checked.all("a")[0]["href"] == "#main"


def test_the_contents_list_every_section(html, demo_page):
    contents = html[html.index("<nav") : html.index("</nav>")]
    titles = [section.title for section in demo_page.sections]
    assert re.findall(r'<a href="#section-\d+">([^<]+)</a>', contents) == [*titles, "Downloads"]


def test_figures_and_tables_are_numbered_in_order(html):
    assert re.findall(r'<figcaption id="figure-\d+-caption"><span class="label">Figure (\d+)<', html) == [
        str(n) for n in range(1, 20)
    ]
    assert re.findall(r'<caption[^>]*><span><span class="label">Table (\d+)<', html) == ["1", "2"]


def test_nothing_is_fetched_and_one_script_runs(checked, html):
    assert "http://" not in html
    assert "https://" not in html
    assert "@import" not in html
    scripts = checked.all("script")
    assert len([item for item in scripts if "type" not in item]) == 1  # the loader, see test_live; the rest is data
    assert {item.get("type", "") for item in scripts} == {"", "application/json", "application/octet-stream"}
    assert not checked.all("img")
    assert {item["href"] for item in checked.all("link")} == {"data:,"}
    assert not [name for _, attributes in checked.tags for name in attributes if name.startswith("on") or name == "src"]


def test_the_page_forbids_fetching(checked):
    policies = [item["content"] for item in checked.all("meta") if item.get("http-equiv") == "Content-Security-Policy"]
    source = "'sha256-[A-Za-z0-9+/=]{44}'"
    assert len(policies) == 1
    allowed = f"default-src 'none'; style-src 'unsafe-inline'; img-src data: blob:; script-src {source} {source}"
    assert re.fullmatch(allowed, policies[0])


def test_a_page_is_under_eight_megabytes(html):
    assert len(html.encode()) < 8e6


def test_the_same_page_is_the_same_text(demo_page, html):
    assert render_page(demo_page) == html


def test_markup_in_any_text_shows_as_text():
    page = Page(
        title=EVIL,
        subtitle=EVIL,
        verdict=Verdict("failed", EVIL, [EVIL]),
        facts=[Fact(EVIL, EVIL)],
        key_figures=[KeyFigure(EVIL, EVIL, EVIL, EVIL)],
        notices=[Notice("warning", EVIL, [EVIL])],
        sections=[
            Section(
                EVIL,
                [
                    Paragraph(EVIL),
                    Bullets([EVIL]),
                    Facts([Fact(EVIL, EVIL)]),
                    KeyFigures([KeyFigure(EVIL, 1.0)]),
                    Listing(EVIL, EVIL),
                    Listing(EVIL, EVIL, folded=False),
                    Table(EVIL, [Column(EVIL, EVIL)], [[EVIL]], Download(EVIL, content=EVIL), folded=True),
                    Figure([Panel("<svg/>", EVIL, EVIL)], EVIL, EVIL),
                    Subsection(EVIL, [Paragraph(EVIL)]),
                ],
            )
        ],
        downloads=[Download(EVIL, EVIL, EVIL)],
        footer=EVIL,
    )
    html = render_page(page)
    checked = Checker(html)
    assert not checked.all("script")
    assert not checked.all("b")
    assert html.count("&lt;script&gt;") > 25


def test_a_section_holds_blocks_only():
    with pytest.raises(TypeError, match="a section holds a str"):
        render_page(bare("text"))


def test_a_picture_that_runs_something_stops_the_page():
    with pytest.raises(ValueError, match="<script>"):
        render_page(bare(Figure.of("<svg><script/></svg>", "c", "a")))


def test_the_shortest_page_is_a_page():
    checked = Checker(render_page(Page("t", Verdict("good", "h"), [])))
    assert [tag for tag, _ in checked.tags if tag in {"h1", "h2", "nav"}] == ["h1", "h2"]


def test_a_page_is_written_whole(tmp_path):
    path = write_page(tmp_path / "report.html", bare(Paragraph("µ")))
    assert path.read_text(encoding="utf-8") == render_page(bare(Paragraph("µ")))


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


SQUARE = '<svg viewBox="0 0 1 1"/>'
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
        {"name": "</script>", "x": [0.0, 0.333333], "y": [None, 2.0], "colour": "fem", "dash": "8px,2px", "width": 2.0}
    ]


def test_the_library_is_packed_once():
    assert scripts() is scripts()


def test_names_from_right_to_left_turn_nothing_round():
    name, wanted = "<עור>", "&lt;<bdi>עור</bdi>&gt;"
    blocks = [
        Paragraph(name), Bullets([name]), Notice("warning", name, [name]), Facts([Fact(name, name)]),
        Listing("text", name), Subsection(name, []), KeyFigures([KeyFigure(name, name, "", name)]),
        Table(name, [name], [[name]], Download("c.csv", name)), Figure.of(SQUARE, name, name, name),
    ]  # fmt: skip
    told = Page(name, Verdict("good", name, [name]), [Section(name, blocks)], name, [Fact(name, name)], footer=name)
    html = render_page(told)
    assert html.count(wanted) == 25
    assert "<title>&lt;עור&gt;</title>" in html
    for element in ("title", "desc"):
        assert re.search(rf'<{element} id="[^"]+">&lt;\u2068עור\u2069&gt;</{element}>', html)


def test_what_may_scroll_can_be_reached_by_the_keyboard():
    equation = Equation("<mi>F</mi>", "F", "(1)")
    two = Figure([Panel(SQUARE, "a"), Panel(SQUARE, "b")], "c")
    html = render_page(
        Page("t", Verdict("good", "h"), [Section("s", [Figure.of(SQUARE, "c", "a"), two, equation, Listing("x", "y")])])
    )
    tags = Checker(html).tags
    reached = [attributes for _, attributes in tags if attributes.get("tabindex") == "0"]
    assert [each.get("class", "pre") for each in reached] == ["panel", "equation", "pre"]
    assert reached[0]["aria-labelledby"] in {attributes.get("id") for _, attributes in tags}
    assert reached[1]["aria-label"] == "Equation (1)"
