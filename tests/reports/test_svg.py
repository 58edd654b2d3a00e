import re
import xml.etree.ElementTree as ElementTree

import pytest

from reports.svg import SVG_NAMESPACE, embed, parse, renumber_ids, serialise, themed

SVG = (
    f'<svg xmlns="{SVG_NAMESPACE}" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 1 1">'
    '<defs><clipPath id="p1"><rect/></clipPath><path id="m1"/></defs><g id="unused">'
    '<use xlink:href="#m1" clip-path="url(#p1)"/></g><text>&lt;b&gt;</text></svg>'
)


def test_an_embedded_picture_has_words_and_ids_of_its_own():
    root = ElementTree.fromstring(embed(SVG, "f1-", "Dermis & fat", "<script>"))
    assert root.get("role") == "img"
    assert root.get("aria-labelledby") == "f1-title f1-desc"
    assert (root[0].tag, root[0].get("id"), root[0].text) == ("title", "f1-title", "Dermis & fat")
    assert (root[1].tag, root[1].get("id"), root[1].text) == ("desc", "f1-desc", "<script>")
    use = root.find(".//use")
    assert use.attrib == {"href": "#f1-m1", "clip-path": "url(#f1-p1)"}
    assert {item.get("id") for item in root.iter() if item.get("id")} >= {"f1-m1", "f1-p1"}


@pytest.mark.parametrize(("width", "expected"), [(340, None), (480, None), (610, "wide")])
def test_a_wide_picture_is_marked_so_that_a_phone_scrolls_it(width, expected):
    root = ElementTree.fromstring(embed(f'<svg viewBox="0 0 {width} 300"/>', "f1-", "", ""))
    assert root.get("class") == expected


def test_an_embedded_picture_names_no_address():
    assert "http" not in embed(SVG, "f1-", "", "")


def test_embedding_twice_keeps_one_pair_of_words():
    again = embed(embed(SVG, "a-", "one", "two"), "b-", "three", "four")
    assert again.count("<title") == again.count("<desc") == 1
    assert "three" in again


def test_ids_are_numbered_by_appearance_and_dropped_where_nothing_refers_to_them():
    root = parse(SVG)
    renumber_ids(root)
    text = serialise(root)
    assert 'clipPath id="i0"' in text
    assert 'href="#i1"' in text
    assert "url(#i0)" in text
    assert "unused" not in text


def test_a_standalone_picture_declares_its_namespace_once():
    assert serialise(parse(SVG), standalone=True).count(f'xmlns="{SVG_NAMESPACE}"') == 1


@pytest.mark.parametrize(
    "content",
    [
        "<script>alert(1)</script>",
        '<g onclick="alert(1)"/>',
        '<g ONLOAD="alert(1)"/>',
        '<a href="https://example.org/"><text>x</text></a>',
        '<image href="#a"/>',
        "<style>*{fill:red}</style>",
        "<foreignObject><p>x</p></foreignObject>",
        '<rect style="fill: url(https://example.org/a.svg#b)"/>',
        "<rect style=\"fill: url('data:x')\"/>",
        '<use href="other.svg#a"/>',
        '<animate attributeName="href" to="javascript:alert(1)"/>',
    ],
)
def test_what_could_run_or_fetch_is_refused(content):
    with pytest.raises(ValueError, match="which a page does not take in"):
        embed(f"<svg>{content}</svg>", "f1-", "", "")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<svg>", "no well-formed XML"),
        ("<html/>", "starts with <html>"),
        ('<!DOCTYPE svg [<!ENTITY a "b">]><svg>&a;</svg>', "EntitiesForbidden"),
    ],
)
def test_what_is_no_svg_is_refused(text, message):
    with pytest.raises(ValueError, match=message):
        parse(text)


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


def test_a_name_from_right_to_left_turns_no_number_beside_it_round():
    root = ElementTree.fromstring(embed('<svg viewBox="0 0 1 1"><text>עור, 3 trials</text></svg>', "f1-", "", ""))
    assert root.find("text").text == "\N{FIRST STRONG ISOLATE}עור\N{POP DIRECTIONAL ISOLATE}, 3 trials"
