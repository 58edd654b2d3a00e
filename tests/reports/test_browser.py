"""The page with everything on it in headless Chromium, with and without JavaScript, light, dark and narrow."""

import shutil
from pathlib import Path
from urllib.parse import urlparse

import pytest

from reports import (
    Bullets,
    Download,
    Fact,
    Facts,
    KeyFigure,
    KeyFigures,
    Listing,
    Notice,
    Page,
    Panel,
    Paragraph,
    Section,
    Table,
    Verdict,
    write_page,
)

CHROMIUM = shutil.which("chromium")
FLAGS = [
    "--no-sandbox",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
    "--enable-unsafe-swiftshader",
    "--use-angle=swiftshader",
]

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="needs the program chromium to open the page in")


@pytest.fixture(scope="module")
def address(demo_page, tmp_path_factory):
    return write_page(tmp_path_factory.mktemp("page") / "report.html", demo_page).as_uri()


@pytest.fixture(scope="module")
def browser():
    playwright = pytest.importorskip("playwright.sync_api", reason="needs playwright to drive Chromium")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield browser
        browser.close()


@pytest.fixture
def visit(browser, address):
    contexts = []

    def visit(**options):
        contexts.append(browser.new_context(**options))
        page = contexts[-1].new_page()
        page.seen, page.said = [], []
        page.on("request", lambda request: page.seen.append(request.url))
        page.on("console", lambda message: page.said.append(message.text) if message.type == "error" else None)
        page.on("pageerror", lambda error: page.said.append(str(error)))
        page.goto(address)
        return page

    yield visit
    for context in contexts:
        context.close()


@pytest.mark.parametrize("javascript", [True, False])
def test_the_page_opens_without_a_word_or_a_request(visit, address, javascript, every_figure):
    page = visit(java_script_enabled=javascript, viewport={"width": 1280, "height": 900})
    assert page.said == []
    assert page.seen == [address]
    panels = sum(len(figure.panels) for figure in every_figure.values())
    assert page.locator(".panel").count() == panels
    assert not javascript or enlivened(page) == live_panels(every_figure)
    shown = ".panel.alive > .live, .panel:not(.alive) svg:not(.main-svg)"
    boxes = [item.bounding_box() for item in page.locator(shown).all()]
    assert len(boxes) == panels
    assert all(box and box["width"] > 200 and box["height"] > 100 for box in boxes)
    assert page.said == []
    assert page.seen == [address]


def test_the_page_is_light_enough_to_send(address):
    assert Path(urlparse(address).path).stat().st_size < 8e6


def live_panels(figures):
    return sum(
        isinstance(panel, Panel) and panel.live is not None for each in figures.values() for panel in each.panels
    )


def enlivened(page):
    """Scroll every picture into sight, wait for what takes its place, and count it."""
    for panel in page.locator(".panel[data-live]").all():
        panel.scroll_into_view_if_needed()
        panel.locator(".swap").wait_for(state="attached", timeout=60_000)
    return page.locator(".panel.alive .live.js-plotly-plot").count()


def test_a_plot_follows_the_theme_and_gives_way_to_its_drawing(visit):
    page = visit(color_scheme="dark")
    panel = page.locator(".panel[data-live]").first
    panel.scroll_into_view_if_needed()
    panel.locator(".swap").wait_for(timeout=60_000)
    stroke = "() => document.querySelector('.live .scatterlayer path.js-line').style.stroke"
    assert page.evaluate(stroke) == "rgb(109, 179, 255)"
    page.emulate_media(color_scheme="light")
    for _ in range(100):
        if page.evaluate(stroke) == "rgb(11, 95, 174)":
            break
        page.wait_for_timeout(100)
    assert page.evaluate(stroke) == "rgb(11, 95, 174)"
    panel.locator(".swap").click()
    assert panel.locator(".drawing svg").is_visible()
    assert not panel.locator(".live").is_visible()


@pytest.mark.slow
def test_a_plot_can_be_zoomed(visit):
    page = visit(viewport={"width": 1280, "height": 900})
    panel = page.locator(".panel[data-live]").first
    panel.scroll_into_view_if_needed()
    panel.locator(".swap").wait_for(timeout=60_000)
    span = "() => [...document.querySelector('.live')._fullLayout.xaxis.range]"
    before = page.evaluate(span)
    box = panel.locator(".nsewdrag").first.bounding_box()
    page.mouse.move(box["x"] + 0.3 * box["width"], box["y"] + 0.3 * box["height"])
    page.mouse.down()
    page.mouse.move(box["x"] + 0.6 * box["width"], box["y"] + 0.7 * box["height"], steps=5)
    page.mouse.up()
    after = page.evaluate(span)
    assert before[0] < after[0] < after[1] < before[1]


@pytest.mark.slow
def test_a_body_turns_by_the_arrow_keys(visit):
    page = visit(viewport={"width": 1280, "height": 900})
    panel = page.locator("figure:has-text('Pressed layers') .panel").first
    panel.scroll_into_view_if_needed()
    panel.locator(".swap").wait_for(state="attached", timeout=60_000)
    place = panel.locator(".live")
    place.focus()
    eye = "place => place._fullLayout.scene._scene.getCamera().eye.x"
    before = place.evaluate(eye)
    page.keyboard.press("ArrowLeft")
    page.wait_for_timeout(300)
    assert abs(place.evaluate(eye) - before) > 0.05


def test_on_paper_the_drawings_stand_for_the_plots(visit):
    page = visit()
    panel = page.locator(".panel[data-live]").first
    panel.scroll_into_view_if_needed()
    panel.locator(".swap").wait_for(timeout=60_000)
    page.emulate_media(media="print")
    assert panel.locator(".drawing svg").is_visible()
    assert not panel.locator(".live").is_visible()


@pytest.mark.parametrize("width", [400, 760, 1280])
def test_the_page_never_scrolls_sideways(visit, width):
    page = visit(viewport={"width": width, "height": 900})
    assert page.evaluate("document.documentElement.scrollWidth") == width


def test_figures_follow_the_readers_theme(visit):
    strokes = {}
    for scheme in ("light", "dark"):
        page = visit(color_scheme=scheme)
        strokes[scheme] = page.evaluate(
            "() => getComputedStyle(document.querySelector('.drawing svg path[style*=\"--fem\"]')).stroke"
        )
    assert strokes == {"light": "rgb(11, 95, 174)", "dark": "rgb(109, 179, 255)"}


def test_print_is_dark_on_white_whatever_the_theme(visit):
    page = visit(color_scheme="dark")
    page.emulate_media(media="print", color_scheme="dark")
    assert page.evaluate("() => getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"


def test_folded_tables_open_without_javascript(visit):
    page = visit(java_script_enabled=False)
    table = page.locator("details.table table")
    assert not table.is_visible()
    page.locator("details.table > summary").click()
    assert table.is_visible()


def test_the_first_key_reaches_the_link_past_the_head(visit):
    page = visit()
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.className") == "skip"
    box = page.locator(".skip").bounding_box()
    assert box["x"] >= 0


def test_no_text_of_a_figure_leaves_its_picture(visit):
    page = visit(viewport={"width": 1280, "height": 900}, java_script_enabled=True)
    outside = page.evaluate(
        """() => [...document.querySelectorAll('svg:not(.main-svg) text')].filter(text => {
            const box = text.getBoundingClientRect(), svg = text.closest('svg').getBoundingClientRect();
            return box.left < svg.left - 1 || box.right > svg.right + 1
                || box.top < svg.top - 1 || box.bottom > svg.bottom + 1;
        }).map(text => text.textContent)"""
    )
    assert outside == []


def test_the_embedded_file_can_be_taken(visit):
    page = visit()
    with page.expect_download() as download:
        page.locator(".downloads a.copy").first.click()
    assert download.value.suggested_filename == "results.json"


@pytest.mark.parametrize("width", [390, 1280])
def test_a_name_without_a_space_does_not_push_the_page(browser, tmp_path, width):
    name = "W" * 200
    blocks = [
        Paragraph(name), Bullets([name]), Notice("warning", name, [name]), Facts([Fact(name, name)]),
        Listing("text", name), KeyFigures([KeyFigure(name, 1.0, "mm", name)]), Table(name, [name], [[name]]),
    ]  # fmt: skip
    verdict = Verdict("good", name, [name])
    shown = Page(name, verdict, [Section(name, blocks)], name, downloads=[Download(name, name)], footer=name)
    page = browser.new_page(viewport={"width": width, "height": 900})
    page.goto(write_page(tmp_path / "report.html", shown).as_uri())
    assert page.evaluate("document.documentElement.scrollWidth") == width
    page.close()


def test_on_paper_only_what_comes_before_something_stays_with_it(visit):
    page = visit()
    page.emulate_media(media="print")
    after = "() => [...document.querySelectorAll('%s')].map(each => getComputedStyle(each).breakAfter)"
    assert set(page.evaluate(after % "h2, h3, summary, caption")) == {"avoid"}
    assert set(page.evaluate(after % "figure > figcaption:last-child")) == {"auto"}  # or no part may end a page


def test_no_label_of_a_figure_is_too_small_on_a_phone(visit):
    page = visit(viewport={"width": 390, "height": 844}, java_script_enabled=True)
    small = page.evaluate(
        """() => [...document.querySelectorAll('svg:not(.main-svg) text')].map(text => {
            const { a, b, c, d } = text.getScreenCTM();
            return [parseFloat(getComputedStyle(text).fontSize) * Math.sqrt(Math.abs(a * d - b * c)), text.textContent];
        }).filter(([size]) => size > 0 && size < 9)"""
    )
    assert small == []


def test_the_chosen_tool_of_a_plot_is_told_without_its_colour(visit):
    page = visit(viewport={"width": 1280, "height": 900})
    panel = page.locator(".panel[data-live]").first
    panel.scroll_into_view_if_needed()
    panel.locator(".swap").wait_for(timeout=60_000)
    buttons = panel.locator(".modebar-btn[data-attr=dragmode]")
    pressed = "() => document.querySelector('.modebar-btn[data-val=pan]').getAttribute('aria-pressed')"
    assert page.evaluate(pressed) == "false"
    buttons.nth(1).click()
    page.wait_for_function(pressed.replace("() =>", "() => 'true' ==="))
    assert buttons.nth(0).get_attribute("aria-pressed") == "false"
