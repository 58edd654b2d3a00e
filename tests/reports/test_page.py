import itertools
import re
from html.parser import HTMLParser

import pytest

from reports import (
    Bullets,
    Column,
    Download,
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
    assert re.findall(r'<figcaption><span class="label">Figure (\d+)<', html) == [str(n) for n in range(1, 20)]
    assert re.findall(r'<caption[^>]*><span class="label">Table (\d+)<', html) == ["1", "2"]


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
