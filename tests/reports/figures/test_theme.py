import re

import pytest

from reports.figures.theme import themed

RAW = """<?xml version="1.0"?>
<svg xmlns:xlink="http://www.w3.org/1999/xlink" width="10pt" height="5pt" viewBox="0 0 10 5"
     xmlns="http://www.w3.org/2000/svg">
 <metadata><a/></metadata><defs><style>*{fill:red}</style></defs>
 <g id="figure_1"><path id="p" d="M 1.23456 -0.0001
L 2.999 1e3" style="stroke: #0B5FAE; fill: none"/>
 <text style="font-size: 10px; font-family: 'DejaVu Sans', sans-serif; text-anchor: middle" x="1.005">a  b</text></g>
</svg>"""


def test_what_matplotlib_writes_becomes_what_the_page_wants():
    svg = themed(RAW)
    assert 'style="stroke: var(--fem, #0b5fae); fill: none"' in svg
    assert 'd="M 1.23 0 L 3 1e3"' in svg
    assert "font-size: 10px; text-anchor: middle" in svg
    assert ">a  b</text>" in svg
    assert not re.search('metadata|<style|<defs|id=|pt"|figure_1', svg)


def test_what_is_themed_is_a_document_of_its_own():
    assert themed(RAW).startswith('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 10 5" width="10" height="5"')


def test_a_foreign_colour_is_named():
    with pytest.raises(ValueError, match="#ABCDEF is not in the palette"):
        themed(RAW.replace("#0B5FAE", "#ABCDEF"))
