"""Frames a second of the page, and the wave's own time in it: `python -m tests.performance.press_page PRESS.HTML`.

Chromium without a graphics card (software rendering) opens a saved page; a pointer drags the tool round for ten
seconds. Needs playwright and the program chromium.
"""

import math
import os
import shutil
import sys
import time
from pathlib import Path

import numpy as np
from playwright.sync_api import sync_playwright

FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
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
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
        page.goto(file.resolve().as_uri())
        page.wait_for_timeout(1500)
        box = page.locator("#view").bounding_box()
        middle = box["x"] + 0.5 * box["width"], box["y"] + 0.45 * box["height"]
        page.mouse.move(*middle)
        page.mouse.down()
        page.wait_for_timeout(2000)
        page.evaluate("press.state.frames.length = 0")
        start = time.monotonic()
        while (gone := time.monotonic() - start) < SECONDS:
            page.mouse.move(middle[0] + 80 * math.cos(2 * gone), middle[1] + 30 * math.sin(2 * gone))
            page.wait_for_timeout(25)
        frames = np.array(page.evaluate("press.state.frames"))
        detail = page.evaluate("press.state.renderer?.detail ?? 1")
        model = np.array(page.evaluate(MODEL))
        browser.close()
    print(
        f"load average {os.getloadavg()[0]:.1f}, {os.cpu_count()} cores; 50 x 50 x 3 points, {WIDTH} x {HEIGHT} pixels"
    )
    print(
        f"{frames.size} frames, {SECONDS:g} s: median {np.median(frames):.1f} ms, {1e3 / np.median(frames):.0f} per s"
    )
    print(f"pixels drawn each way: {detail:.2f} of the screen's")
    print(f"wave in the page: median {1e3 * np.median(model):.0f} us a frame, least {1e3 * model.min():.0f} us")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
