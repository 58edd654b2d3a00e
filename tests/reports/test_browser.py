"""The page with everything on it in headless Chromium, with and without JavaScript, light, dark and narrow."""

import shutil

import pytest

from reports import write_page

CHROMIUM = shutil.which("chromium")
FLAGS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
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
        page.on("console", lambda message: page.said.append(message.text))
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
    boxes = [item.bounding_box() for item in page.locator("figure svg").all()]
    assert len(boxes) == panels
    assert all(box and box["width"] > 200 and box["height"] > 100 for box in boxes)


@pytest.mark.parametrize("width", [400, 760, 1280])
def test_the_page_never_scrolls_sideways(visit, width):
    page = visit(viewport={"width": width, "height": 900})
    assert page.evaluate("document.documentElement.scrollWidth") == width


def test_figures_follow_the_readers_theme(visit):
    strokes = {}
    for scheme in ("light", "dark"):
        page = visit(color_scheme=scheme)
        strokes[scheme] = page.evaluate(
            "() => getComputedStyle(document.querySelector('figure svg path[style*=\"--fem\"]')).stroke"
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
    page = visit(viewport={"width": 1280, "height": 900})
    outside = page.evaluate(
        """() => [...document.querySelectorAll('figure svg text')].filter(text => {
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
