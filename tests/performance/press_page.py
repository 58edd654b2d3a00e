"""Frames a second of the page, and the wave's own time in it: `python -m tests.performance.press_page PRESS.HTML`.

Chromium without a graphics card opens a saved page, and a pointer drags the tool round for ten seconds: once as it does
by itself on such a machine (the page's picture by SwiftShader, the window by the processor), once with the window drawn
by SwiftShader, too, which is slower. Processor time a frame tells more than frames do on a busy machine. Needs
playwright and the program chromium.
"""

import math
import os
import shutil
import sys
import time
from pathlib import Path

import numpy as np
from playwright.sync_api import sync_playwright

WAYS = {
    "no graphics card": ["--disable-gpu", "--enable-unsafe-swiftshader"],
    "all by SwiftShader": ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
}
SECONDS, WIDTH, HEIGHT = 10.0, 1280, 800
MODEL = """() => {
  const { state, Wave, grid } = press, memory = { strength: [0.3], time_s: [0.5] };
  const tissue = new Wave.InteractiveTissue(state.bodies.wave, grid, 4, memory);
  const times = [];
  for (let k = 0; k < 4000; k++) {
    tissue.touch(0, 24e-3 + 5e-3 * Math.sin(k / 50), 24e-3, state.bodies.wave.deepest * (0.5 + 0.4 * Math.sin(k / 30)));
    if (k % 40 === 0) times.push(performance.now());
    tissue.frame(0.016);
  }
  times.push(performance.now());
  return times.slice(1).map((time, k) => (time - times[k]) / 40);
}"""


def main(file: Path) -> None:
    """Open, drag, and print medians."""
    print(f"{os.cpu_count()} cores; 50 x 50 x 3 points, {WIDTH} x {HEIGHT} pixels, {SECONDS:g} s of dragging")
    with sync_playwright() as driver:
        for way, flags in WAYS.items():
            browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox", *flags])
            page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
            page.goto(file.resolve().as_uri())
            page.wait_for_timeout(1500)
            frames, spent = dragged(page)
            detail = page.evaluate("press.state.renderer?.detail ?? 1")
            model = np.array(page.evaluate(MODEL))
            browser.close()
            print(
                f"{way}: load {os.getloadavg()[0]:.1f}; {frames.size} frames, median {np.median(frames):.1f} ms, "
                f"{1e3 / np.median(frames):.0f} per s, 9 in 10 within {np.percentile(frames, 90):.0f} ms; "
                f"{1e3 * spent / frames.size:.0f} ms of the processor a frame; "
                f"{detail:.2f} of the screen's pixels each way"
            )
            print(
                f"  wave in the page: median {1e3 * np.median(model):.0f} us a frame, least {1e3 * model.min():.0f} us"
            )


def dragged(page):
    """Times of the frames (ms) while a pointer drags the tool round, and processor time of the browser, s."""
    box = page.locator("#view").bounding_box()
    middle = box["x"] + 0.5 * box["width"], box["y"] + 0.45 * box["height"]
    page.mouse.move(*middle)
    page.mouse.down()
    page.wait_for_timeout(3000)
    page.evaluate("press.state.frames.length = 0")
    before, start = used(), time.monotonic()
    while (gone := time.monotonic() - start) < SECONDS:
        page.mouse.move(middle[0] + 80 * math.cos(2 * gone), middle[1] + 30 * math.sin(2 * gone))
        page.wait_for_timeout(25)
    return np.array(page.evaluate("press.state.frames")), used() - before


def used():
    """Processor time of this process's descendants so far, s."""
    tree = {}
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            fields = (folder / "stat").read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue
        tree[int(folder.name)] = (int(fields[1]), (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK"))
    own = {os.getpid()}
    while more := {number for number, (parent, _) in tree.items() if parent in own} - own:
        own |= more
    return sum(tree[number][1] for number in own - {os.getpid()} if number in tree)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
