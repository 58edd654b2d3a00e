"""The page in headless Chromium: pressed by a pointer, read back, compared with the model in Python."""

import asyncio
import shutil
import threading
from concurrent.futures import ThreadPoolExecutor

import cv2
import numpy as np
import pytest

from bench_hw.trial_file import ForceRecord, FrameRecord, PositionRecord, TrialHeader, open_trial
from bench_hw.trial_file.records import EventRecord
from benchmark.assessment.attempt_measures import read_attempt
from benchmark.press.live_capture import LiveCapture, LiveLine, tell
from benchmark.press.press_page import render_press_page
from benchmark.press.press_server import FemLine, FemOnDemand, Served, make_server
from benchmark.press.radial_table import table_of_body
from wavemodel import Prony
from wavemodel.control import Grid, InteractiveTissue, layered_body
from wavemodel.control.pressed_body import radii_of

CHROMIUM = shutil.which("chromium")
FLAGS = [
    "--no-sandbox",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
]
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="needs the program chromium to open the page in")
SEEN = "new Promise((done) => requestAnimationFrame(() => setTimeout(done)))"  # a new size has reached the page
STEP = """(seconds) => { for (let t = 0; t < seconds; t += 0.02) press.advance(0.02); return press.computed(); }"""


CHOOSE = """(kind) => {
  const task = document.getElementById("task");
  task.value = kind;
  task.dispatchEvent(new Event("change"));
}"""


@pytest.fixture(scope="module")
def browser():
    playwright = pytest.importorskip("playwright.sync_api", reason="needs playwright to drive Chromium")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def address(page_document, tmp_path_factory):
    file = tmp_path_factory.mktemp("press") / "press.html"
    file.write_text(render_press_page(page_document), encoding="utf-8")
    return file.as_uri()


@pytest.fixture(scope="module")
def opened(browser, address):
    page = browser.new_context(viewport={"width": 900, "height": 700}).new_page()
    page.seen, page.said = [], []
    page.on("request", lambda request: page.seen.append(request.url))
    page.on("console", lambda message: page.said.append(message.text) if message.type == "error" else None)
    page.on("pageerror", lambda error: page.said.append(str(error)))
    page.goto(address)
    for _ in range(100):
        if page.evaluate("Boolean(window.press) && press.state.frames.length > 0"):
            break
        page.wait_for_timeout(100)
    page.evaluate("press.state.manual = true")  # frames by hand from here on: a busy machine draws few
    yield page
    page.context.close()


@pytest.fixture
def page(opened):
    opened.mouse.up()
    opened.evaluate("document.getElementById('home').click(); press.state.demo = false")
    return opened


def faces(page):
    return np.array(page.evaluate("Array.from(press.state.bench.shown.frame(1e-3))")).reshape(3, 50, 50)


def expected(specimen, x, y, depth):
    at = 1e-3 * np.arange(50)
    distance = np.hypot(at[:, None] - x, at - y)
    return np.array([np.interp(distance, radii_of(specimen.wave.reach), row) for row in specimen.wave.profile(depth)])


def hold(page, across=0.5, along=0.45):
    box = page.locator("#view").bounding_box()
    page.mouse.move(box["x"] + across * box["width"], box["y"] + along * box["height"])
    page.mouse.down()
    return box


def tool(page, k=0):
    return page.evaluate(f"({{...press.state.bench.shown.tools[{k}]}})")


def test_it_opens_from_disk_without_a_word_or_a_request(page, address):
    assert page.said == []
    assert page.seen == [address]


def test_a_drag_presses_the_mesh_by_the_model_s_value(page, specimen):
    box = hold(page)
    page.evaluate(STEP, 2.0)
    first = tool(page)
    page.mouse.move(box["x"] + 0.6 * box["width"], box["y"] + 0.4 * box["height"], steps=4)
    page.evaluate(STEP, 0.1)
    second = tool(page)
    assert first["phase"] == second["phase"] == "pressed"
    assert np.hypot(first["x"] - second["x"], first["y"] - second["y"]) > 2e-3
    assert second["depth"] == pytest.approx(0.7 * specimen.wave.deepest)
    found = faces(page)
    np.testing.assert_allclose(
        found, expected(specimen, second["x"], second["y"], second["depth"]), atol=1e-6 * second["depth"]
    )
    assert page.evaluate("press.state.bench.shown.force[0]") == pytest.approx(
        np.interp(second["depth"], specimen.wave.depth, specimen.wave.force), rel=1e-6
    )


def test_what_is_let_go_returns(page):
    hold(page)
    page.evaluate(STEP, 1.0)
    page.mouse.up()
    page.evaluate(STEP, 1.0)
    assert tool(page)["phase"] == "idle"
    assert not faces(page).any()


def test_the_finite_elements_stand_beside_it(page, specimen):
    hold(page)
    now = page.evaluate(STEP, 2.0)
    page.evaluate("press.tick(performance.now())")
    depth = tool(page)["depth"]
    direct = np.abs(specimen.wave.profile(depth) - specimen.fem.table.profile(depth)).max() / depth
    assert now["compared"]
    assert now["share"] == pytest.approx(direct, rel=0.15)
    assert float(page.locator("#fem-force").text_content()) == pytest.approx(
        np.interp(depth, specimen.fem.table.depth, specimen.fem.table.force), abs=0.006
    )


def test_a_second_tool_takes_the_finite_elements_away(page):
    page.evaluate("document.getElementById('stay').checked = true")
    hold(page, 0.42, 0.42)
    page.mouse.up()
    hold(page, 0.66, 0.36)
    now = page.evaluate(STEP, 1.0)
    page.evaluate("press.tick(performance.now()); document.getElementById('stay').checked = false")
    assert page.evaluate("press.state.bench.busy") == 2
    assert not now["compared"]
    assert "one tool" in page.locator("#note").text_content()


OFFER = """([wave, memory]) => {
  press.data.specimens[1] = { ...press.data.specimens[0], wave, memory, fem: null, after: null, made: undefined };
  press.choose(1);
}"""
RECORD = """press.state.bench.record.map(
  ({ dt, tools }) => [dt, tools.map((tool) => tool && [tool[0], tool[1], tool[2].wave])]
)"""


@pytest.mark.parametrize(("strain", "remembers"), [("linear", False), ("linear", True), ("corrected", True)])
def test_two_dragged_tools_press_the_mesh_as_the_library_does(page, wave, series, strain, remembers):
    grid, prony = Grid(49e-3, 49e-3, 1e-3), series if remembers else Prony()
    body = layered_body(wave(large_press=strain), grid)
    memory = {"strength": prony.strength, "time_s": prony.time, "retardation_s": 0.0}
    page.evaluate(OFFER, [table_of_body(body, min(body.deepest, 3e-3)).to_dict(), memory])
    page.evaluate("document.getElementById('stay').checked = true")
    hold(page, 0.42, 0.42)
    page.evaluate(STEP, 0.3)
    page.mouse.up()
    box = hold(page, 0.66, 0.36)
    page.evaluate(STEP, 0.3)
    page.mouse.move(box["x"] + 0.62 * box["width"], box["y"] + 0.46 * box["height"], steps=3)
    page.evaluate(STEP, 0.5)
    tissue = InteractiveTissue(body, grid, 4, series=prony)
    for dt, tools in page.evaluate(RECORD):
        for k, touch in enumerate(tools):
            if touch:
                tissue.touch(k, *touch)
        tissue.frame(dt)
    force = np.array(page.evaluate("Array.from(press.state.bench.shown.force)"))
    np.testing.assert_allclose(force, tissue.force, rtol=0.0, atol=1e-6 * tissue.force.max())
    found, wanted = faces(page), tissue.frame(1e-3)
    page.evaluate("document.getElementById('stay').checked = false; press.choose(0)")
    assert np.count_nonzero(force) == 2
    assert wanted.max() > 1e-3
    np.testing.assert_allclose(found, wanted, rtol=0.0, atol=1e-6 * wanted.max())


def test_memory_lets_the_force_fade_while_the_tool_holds(page):
    page.evaluate("document.getElementById('fade').value = 40; press.restart()")
    hold(page)
    page.evaluate(STEP, 1.0)
    early = page.evaluate("press.state.bench.shown.force[0]")
    page.evaluate(STEP, 3.0)
    late = page.evaluate("press.state.bench.shown.force[0]")
    page.evaluate("document.getElementById('fade').value = 0; press.restart()")
    assert 0.5 * early < late < 0.95 * early


def test_the_keyboard_presses_and_lets_go(page):
    page.locator("#view").focus()
    page.keyboard.press("ArrowRight")
    page.evaluate(STEP, 1.0)
    at = tool(page)
    assert at["phase"] == "pressed"
    assert at["x"] == pytest.approx(25.5e-3)
    page.keyboard.press("Escape")
    page.evaluate(STEP, 1.0)
    assert tool(page)["phase"] == "idle"


def test_a_replay_presses_as_before(page):
    hold(page)
    page.evaluate(STEP, 1.0)
    before = tool(page)
    page.mouse.up()
    count = page.evaluate("press.state.bench.record.length")
    page.locator("#replay").click()
    page.evaluate(f"for (let k = 0; k < {count}; k++) press.advance(0.02)")
    after = tool(page)
    assert (after["x"], after["y"], after["depth"]) == (before["x"], before["y"], before["depth"])


FOLLOW = """() => {
  const { bench } = press.state, { task } = bench;
  for (let turn = 0; turn < 60 && !task.done; turn++) {
    task.current.forEach((target, k) => { bench.put(k, target.x, target.y, target.depth); });
    for (let n = 0; n < 60; n++) press.advance(0.02);
    if (task.dwell) { bench.hands.forEach((_, k) => bench.lift(k)); press.advance(0.02); }
  }
  return [task.done, bench.csv()];
}"""


@pytest.mark.parametrize(("kind", "targets"), [("touch", 6), ("trace", 25), ("hands", 6)])
def test_a_task_done_is_a_record_to_assess(page, tmp_path, kind, targets):
    page.evaluate(CHOOSE, kind)
    done, text = page.evaluate(FOLLOW)
    page.evaluate(CHOOSE, "")
    (tmp_path / "record.csv").write_text(text)
    attempt = read_attempt(tmp_path / "record.csv")
    found = attempt.measures()
    assert done
    assert set(attempt.position) == ({0, 1} if kind == "hands" else {0})
    assert len(attempt.target) == targets
    assert found["depth_error_mm"] < 0.01
    assert found["path_length_mm"] > 30.0


def test_the_published_animation_stands_beside(page):
    page.evaluate("document.getElementById('beside').click()")
    page.locator("#play").click()
    page.evaluate(STEP, 0.9)
    deep = page.evaluate("Math.max(...press.state.bench.tissues.published.frame(1e-3))")
    page.evaluate("press.tick(performance.now()); document.getElementById('beside').click()")
    assert deep == pytest.approx(39.2e-3, rel=0.01)


PLACES = """() => {
  const { camera, state, data } = press, view = document.getElementById("view").getBoundingClientRect();
  const wide = view.width / 2, side = 49, radius = 1e3 * data.specimens[0].wave.tool_radius_m, corners = [];
  for (const x of [0, side]) for (const y of [side / 2, side]) for (const z of [0, -12]) corners.push([x, y, z]);
  const at = (point) => camera.project(point, wide / view.height);
  const [, top] = at([side / 2, side / 2 + radius, 20]);
  return {
    across: corners.map((point) => at(point)[0]), tool: view.top + 0.5 * (1 - top) * view.height,
    figures: document.querySelector(".reading").getBoundingClientRect().bottom,
  };
}"""


@pytest.mark.parametrize(("width", "height"), [(390, 844), (1280, 800)])
def test_beside_the_animation_block_and_tool_keep_to_their_half_and_off_the_figures(page, width, height):
    page.set_viewport_size({"width": width, "height": height})
    page.evaluate(SEEN)
    page.evaluate("document.getElementById('beside').click(); press.tick(performance.now())")
    found = page.evaluate(PLACES)
    page.evaluate("document.getElementById('beside').click()")
    page.set_viewport_size({"width": 900, "height": 700})
    assert max(map(abs, found["across"])) < 0.97
    assert found["tool"] > found["figures"]


@pytest.mark.parametrize("width", [390, 1280])
def test_it_never_scrolls_sideways(page, width):
    page.set_viewport_size({"width": width, "height": 800})
    assert page.evaluate("document.documentElement.scrollWidth") == width


SLIDERS = """[...document.querySelectorAll("input[type=range]")].map((one) => [
  one.labels.length, one.labels[0]?.control === one, one.getAttribute("aria-valuetext"),
  document.getElementById(one.id + "-shown").textContent,
])"""


def test_every_slider_is_named_by_its_label_and_says_its_value_with_the_unit(page):
    page.evaluate("document.getElementById('target').value = 50; document.getElementById('follow').checked = false")
    page.evaluate("document.getElementById('cut').value = 50; press.restart()")
    found = page.evaluate(SLIDERS)
    page.evaluate("document.getElementById('target').value = 70; document.getElementById('home').click()")
    assert [one[:2] for one in found] == 6 * [[1, True]]
    assert all(said == shown for _, _, said, shown in found)
    assert [said.split(" ", 1)[1] for _, _, said, _ in found if said != "none"] == ["mm", "mm/s", "mm", "s"]


ANOTHER = """() => {
  const { wave } = press.data.specimens[0];
  press.data.specimens[1] = { ...press.data.specimens[0], fem: null, after: null, made: undefined,
    wave: { ...wave, deepest_m: 0.6 * wave.deepest_m } };
  press.state.bench.put(0, 24.5e-3, 24.5e-3, 0.7 * press.state.bodies.wave.deepest);
  for (let n = 0; n < 100; n++) press.advance(0.02);
  press.choose(1);
  for (let n = 0; n < 100; n++) press.advance(0.02);
  const told = [parseFloat(document.getElementById("target-shown").textContent), press.state.bodies.wave.deepest];
  const depth = press.state.bench.shown.tools[0].depth;
  press.choose(0);
  return [depth, ...told];
}"""


def test_on_another_tissue_the_tool_goes_where_target_says(page, specimen):
    depth, target, deepest = page.evaluate(ANOTHER)
    assert deepest < 0.7 * specimen.wave.deepest
    assert depth == pytest.approx(0.7 * deepest)
    assert 1e3 * depth == pytest.approx(target, abs=0.006)


REST = """() => {
  const told = document.getElementById("told"), heard = [], now = performance.now() + 1e6;
  press.state.bench.put(0, 24.5e-3, 24.5e-3, 1e-3);
  for (let n = 0; n < 150; n++) {  // three seconds: the press ends within the first half
    press.advance(0.02); press.tick(now + 20 * n);
    if (told.textContent !== heard.at(-1)) heard.push(told.textContent);
  }
  const live = [...document.querySelectorAll("output, [role=status], [aria-live=polite]")];
  return [heard, live.map((one) => one.id)];
}"""


def test_figures_are_told_once_and_at_rest(page):
    heard, live = page.evaluate(REST)
    assert [bool(text) for text in heard] == [False, True]
    assert heard[1].startswith("Force ")
    assert "at 1.00 mm; finite elements" in heard[1]
    assert sorted(live) == ["note", "told"]


def test_every_chart_says_what_it_shows(page):
    hold(page)
    page.evaluate(STEP, 1.0)
    page.evaluate("press.tick(performance.now())")
    force = page.evaluate("press.state.bench.shown.force[0]")
    assert f"{force:.2f} by the wave" in page.locator("#trace").get_attribute("aria-label")
    assert "mm by finite elements" in page.locator("#law").get_attribute("aria-label")


LONG = """(name) => {
  const [{ layers: [first, ...others] }] = press.data.specimens;
  press.data.specimens[1] = { ...press.data.specimens[0], layers: [{ ...first, name }, ...others], made: undefined };
  press.choose(1);
  press.tick(performance.now());
  const stage = document.querySelector(".stage").getBoundingClientRect();
  const labels = [...document.querySelectorAll(".layers > span")];
  const right = (one) => one.getBoundingClientRect().right;
  const found = labels.map((label) => [stage.right - right(label), right(label.lastChild) - right(label)]);
  const cut = labels[0].firstChild.scrollWidth > labels[0].firstChild.clientWidth;
  const stack = document.getElementById("stack").textContent;
  press.choose(0);
  return [found, cut, stack];
}"""


@pytest.mark.parametrize("name", ["subcutaneous_fat", 3 * "a layer with a long name "])
@pytest.mark.parametrize("width", [700, 1280])
def test_a_layer_s_name_ends_within_the_picture_with_its_thickness(page, name, width):
    page.set_viewport_size({"width": width, "height": 900})
    page.evaluate(SEEN)
    found, cut, stack = page.evaluate(LONG, name)
    page.set_viewport_size({"width": 900, "height": 700})
    assert all(room > 2 and beyond < 1 for room, beyond in found)
    assert cut == (len(name) > 40)
    assert name.replace("_", " ") in stack


APART = """() => {
  const parts = [...document.querySelectorAll(".note, .captions span, .tools button, .reading")];
  const boxes = parts.map((one) => one.getBoundingClientRect());
  const stage = document.querySelector(".stage").getBoundingClientRect(), over = [];
  boxes.forEach((a, k) => boxes.slice(k + 1).forEach((b) => over.push(Math.min(
    Math.min(a.right, b.right) - Math.max(a.left, b.left), Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top)))));
  const wide = stage.width / 2, across = [], at = (point) => press.camera.project(point, wide / stage.height)[0];
  for (const x of [0, 49]) for (const y of [0, 49]) for (const z of [0, -12]) across.push(Math.abs(at([x, y, z])));
  return [Math.max(...over), Math.max(...across)];
}"""


@pytest.mark.parametrize(("width", "height"), [(390, 844), (1280, 900)])
def test_a_task_beside_the_animation_has_its_words_apart_and_its_block_whole(page, width, height):
    page.set_viewport_size({"width": width, "height": height})
    page.evaluate(SEEN)
    page.evaluate("document.getElementById('beside').click()")
    page.evaluate(CHOOSE, "touch")
    page.evaluate("press.tick(performance.now())")
    over, across = page.evaluate(APART)
    said = page.locator("#note").text_content()
    page.evaluate("document.getElementById('beside').click()")
    page.evaluate(CHOOSE, "")
    page.set_viewport_size({"width": 900, "height": 700})
    assert "green target" in said
    assert over < 1
    assert across < 0.97


def test_without_a_script_it_says_so_and_shows_no_number(browser, address):
    page = browser.new_context(java_script_enabled=False).new_page()
    page.goto(address)
    seen = page.locator("main").inner_text()
    hidden = [page.locator(name).is_visible() for name in (".lead", ".stage", ".panel")]
    page.context.close()
    assert "JavaScript, which is off here" in seen
    assert "0.00" not in seen
    assert not any(hidden)


LOOKS = """() => {
  const ground = (one, part) => getComputedStyle(one, part).backgroundColor;
  const all = (what, part) => [...document.querySelectorAll(what)].map((one) => ground(one, part));
  return [all('input[name="colour"] + span, body'), all(".key span:not([hidden])", "::before")];
}"""


def test_forced_colours_leave_what_is_chosen_and_whose_line_it_is(browser, address):
    page = browser.new_context(forced_colors="active").new_page()
    page.goto(address)
    choices, keys = page.evaluate(LOOKS)
    page.context.close()
    plain, chosen, other = choices
    assert chosen not in (plain, other)
    assert len({*keys, "rgba(0, 0, 0, 0)"}) == 3


PAPER = """(event) => {
  dispatchEvent(new Event(event));
  const still = document.getElementById("still"), trace = document.getElementById("trace");
  const colours = (one, x, y, wide, high) => {
    const { data } = one.getContext("2d").getImageData(x, y, wide, high), found = new Set();
    for (let k = 0; k < data.length; k += 4) if (data[k + 3] === 255) found.add([...data.slice(k, k + 3)].join());
    return [...found];
  };
  const all = (one) => colours(one, 0, 0, one.width, one.height);
  return [colours(still, 0, 0, 4, 4), all(still).length, all(trace)];
}"""


def test_on_paper_the_tissue_is_a_picture_on_white_and_the_charts_keep_their_shape(browser, address):
    page = browser.new_context(color_scheme="dark").new_page()
    page.goto(address)
    page.evaluate("press.state.manual = true")
    corner, colours, lines = page.evaluate(PAPER, "beforeprint")
    page.emulate_media(media="print")
    shown = [page.locator(name).is_visible() for name in ("#view", "#still", ".tools")]
    fit = page.evaluate("getComputedStyle(document.getElementById('law')).objectFit")
    page.emulate_media(media="screen", color_scheme="dark")
    _, _, after = page.evaluate(PAPER, "afterprint")
    page.context.close()
    assert corner in (["255,255,255"], [])
    assert colours > 50
    assert (shown, fit) == ([False, True, False], "contain")
    assert "221,226,232" in lines  # the palette's light grid, on a dark screen, too
    assert "44,53,64" in after


MEMBRANE = """(colour) => {
  const { state } = press, { renderer, sheet } = state, [fill, draw] = [sheet.fill, renderer.draw];
  let value = 0, mode;
  document.querySelector(`input[value="${colour}"]`).click();
  sheet.fill = (...of) => { value = Math.max(...of[3]); fill.apply(sheet, of); };
  renderer.draw = (...of) => { if (of[0] === sheet) mode = of[2].mode; draw.apply(renderer, of); };
  press.tick(performance.now());
  Object.assign(sheet, { fill }); Object.assign(renderer, { draw });
  document.querySelector('input[value="deflection"]').click();
  return [value, mode];
}"""


def test_the_membrane_has_the_colours_of_the_legend_or_none(page, specimen):
    page.evaluate("document.getElementById('beside').click()")
    hold(page, 0.25, 0.55)
    page.evaluate(STEP, 1.0)
    depth = page.evaluate("Math.max(...press.state.bench.tissues.published.frame(1e-3))")
    found = [page.evaluate(MEMBRANE, colour) for colour in ("deflection", "error")]
    page.evaluate("document.getElementById('beside').click()")
    assert depth > 0.0
    assert found[0] == [pytest.approx(depth / specimen.wave.deepest, rel=0.02), 0]
    assert found[1][1] == 2  # the plain colour: it was compared with nothing


NO_WEBGL = """(() => {
  const as = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
    return kind === "webgl2" ? null : as.call(this, kind, ...more);
  };
})()"""


def test_where_nothing_can_be_drawn_it_says_so_and_prints_its_charts(browser, address):
    page = browser.new_context().new_page()
    said = []
    page.on("pageerror", lambda error: said.append(str(error)))
    page.add_init_script(NO_WEBGL)
    page.goto(address)
    until(page, "document.getElementById('force').textContent !== '–'")
    page.evaluate("dispatchEvent(new Event('beforeprint')); dispatchEvent(new Event('afterprint'))")
    note = page.locator("#note").text_content()
    page.context.close()
    assert "No drawing here: WebGL 2 is not available" in note
    assert said == []


def serving(html, answer, lines, beside=None):
    """A page served from a thread of its own; yields its address."""
    started, loop = threading.Event(), asyncio.new_event_loop()
    place = {}

    async def start(served):
        place["server"], place["port"] = make_server(served, 0, lines)
        if beside is not None:
            place["telling"] = loop.create_task(beside(served))
        started.set()

    async def stop():
        if "telling" in place:
            place["telling"].cancel()
        place["server"].stop()
        await place["server"].close_all_connections()

    def run():
        with ThreadPoolExecutor(1) as worker:
            loop.run_until_complete(start(Served("token", html.encode(), answer, worker)))
            loop.run_forever()
            loop.run_until_complete(stop())

    thread = threading.Thread(target=run)
    thread.start()
    assert started.wait(30)
    yield f"http://127.0.0.1:{place['port']}/token/"
    loop.call_soon_threadsafe(loop.stop)
    thread.join(30)
    loop.close()


@pytest.fixture
def server(specimen, page_document):
    yield from serving(render_press_page(page_document, served=True), FemOnDemand([specimen]).answer, {"fem": FemLine})


def test_a_served_page_asks_the_finite_elements_for_the_press_as_it_was(browser, server):
    page = browser.new_context(viewport={"width": 900, "height": 700}).new_page()
    said = []
    page.on("console", lambda message: said.append(message.text) if message.type == "error" else None)
    page.goto(server)
    page.evaluate("press.state.manual = true; document.getElementById('home').click(); press.state.demo = false")
    hold(page)
    page.evaluate(STEP, 1.5)
    page.locator("#ask").dispatch_event("click")
    for _ in range(200):
        if page.evaluate("Boolean(press.state.asked)"):
            break
        page.wait_for_timeout(50)
    assert page.evaluate("press.state.asked.apart") < 0.03
    assert "Finite elements, asked now" in page.evaluate("press.state.said")
    assert said == []
    page.context.close()


@pytest.fixture
def bench(page_document, tmp_path):
    """A page that shows the captures of a folder; gives its address."""
    html, live = render_press_page(page_document, served=True, live=True), LiveCapture(tmp_path)
    yield from serving(html, lambda _: {}, {"live": LiveLine}, lambda served: tell(served, live, priority=0))


STANDS = """() => {
  const { live, traces } = press.state, one = traces.at(-1);
  live.shift += 0.5;  // as where news comes late
  return [press.instant(one), live.trace().length, one.led + live.shift, one.time];
}"""


def until(page, condition):
    for _ in range(200):
        if page.evaluate(condition):
            return
        page.wait_for_timeout(50)
    raise AssertionError(condition)


def test_a_running_capture_is_shown_with_its_pictures_and_leads_the_tool(browser, bench, tmp_path):
    page = browser.new_context(viewport={"width": 900, "height": 700}).new_page()
    said = []
    page.on("console", lambda message: said.append(message.text) if message.type == "error" else None)
    page.goto(bench)
    page.evaluate("press.state.manual = true")
    until(page, "document.getElementById('live-trial').textContent === 'Waiting for a capture'")
    assert page.evaluate("(press.advance(0.02), press.state.bench.busy)") == 0  # nothing but the bench presses here
    grey = np.full((240, 320), 220, np.uint8)
    for k in range(18):
        cv2.circle(grey, (60 + 40 * (k % 6), 80 + 40 * (k // 6)), 9, 30, -1, cv2.LINE_AA)
    picture = cv2.imencode(".png", grey)[1].tobytes()
    header = TrialHeader("trial_001", "2024-05-06T07:08:09+00:00", 10.0, "-z", "press", synthetic=True)
    with open_trial(tmp_path / "trial_001.mcap", header, background=False) as writer:
        for n in range(2000):
            if n not in (300, 301):
                writer.write_force(ForceRecord(10 + n / 1000, n, n, 0, (0.0, 0.0, -0.625), (0.0, 0.0, 0.0)))
            if n % 10 == 0:
                writer.write_position(PositionRecord(10 + n / 1000, 1e-3))
            if n % 40 == 0 and n != 400:
                writer.write_frame(FrameRecord(10 + n / 1000, n // 40, picture, "png"))
        writer._chunks.flush()
        until(page, "press.state.live.pictures > 0")
        until(page, "(press.advance(0.02), document.getElementById('live-dropped').textContent === '1')")
        page.evaluate("for (let n = 0; n < 5; n++) press.advance(0.02)")
        texts = [
            page.locator(f"#live-{name}").text_content() for name in ("force", "depth", "lost", "dropped", "markers")
        ]
        doing = page.locator("#live-doing").text_content()
        led = tool(page)
        stands = page.evaluate(STANDS)
        measured = page.evaluate("press.state.live.trace().at(-1)")
        lit = page.evaluate("[...document.getElementById('film').getContext('2d').getImageData(5, 5, 1, 1).data]")
        writer.write_event(EventRecord(12.0, "force_limit", "6.1 N; allowed are 6 N", "fault"))
    until(page, "document.getElementById('live-doing').textContent.includes('Waiting for the next trial')")
    stopped = page.locator("#live").inner_text()
    page.context.close()
    assert not any(letter.isdigit() for letter in doing)  # told to who listens: no clock in it
    assert texts == ["0.63", "1.00", "2", "1", "18 markers"]
    assert (led["phase"], led["depth"]) == ("pressed", pytest.approx(1e-3))
    assert measured[1] == 0.625
    assert stands[0] == pytest.approx(stands[2]) != stands[3]  # the wave's force moves with the measured
    assert lit == [220, 220, 220, 255]
    assert "trial_001 (simulated)" in stopped
    assert "ended (force_limit: 6.1 N; allowed are 6 N)" in stopped
    assert said == []
