import base64
import gzip
import hashlib
import json
import re

from reports import Figure, Page, Section, Verdict, render_page
from reports.blocks import LiveAxes, LiveLine, LivePlot
from reports.live import embedded_json, scripts

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
