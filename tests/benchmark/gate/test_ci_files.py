"""What CI services read: JUnit XML by a parser of its own, and Markdown."""

from dataclasses import replace
from xml.etree import ElementTree

from benchmark.gate.ci_files import junit_text, markdown_text


def test_every_quantity_is_a_test_case_and_what_got_worse_fails(verdict) -> None:
    root = ElementTree.fromstring(junit_text(verdict(slow=True)))
    suites = {suite.get("name"): suite for suite in root}
    assert set(suites) == {"tiny.accuracy", "tiny.time"}
    assert (suites["tiny.accuracy"].get("failures"), suites["tiny.time"].get("failures")) == ("0", "1")
    (failure,) = root.iter("failure")
    assert failure.get("type") == "slower"
    assert "frame: baseline 2 x the reference workload, now 2.6" in str(failure.get("message"))
    assert {case.get("name") for case in root.iter("testcase")} == {"skin_mm", "frame"}


def test_names_cannot_break_the_xml(verdict) -> None:
    text = junit_text(replace(verdict(off=True), gate='<b> & "mine"'))
    assert ElementTree.fromstring(text).get("name") == 'tissuebench check: <b> & "mine"'


def test_the_summary_says_verdict_worse_and_power(verdict) -> None:
    text = markdown_text(verdict(slow=True, off=True))
    assert text.startswith("### ❌ Regression check `tiny`")
    assert "**Got worse**" in text
    assert "| frame | +30.0 % | +28.7 % to +31.3 % | +12.0 % | **slower** |" in text
    assert "a slowdown of 13 % in 19 of 20 checks (frame); a value off by 0.1 % in every check" in text


def test_what_got_faster_is_said_and_no_failure(verdict) -> None:
    plain = verdict()
    faster = replace(plain, timing=[replace(plain.timing[0], now=1.6, ci95=(1.58, 1.62))])
    assert faster.passed
    assert "1 timing got faster" in faster.headline()
    text = markdown_text(faster)
    assert text.startswith("### ✅")
    assert "**Got better**" in text
    assert "**Got better**" not in markdown_text(plain)


def test_a_little_faster_is_not_an_improvement(verdict) -> None:
    plain = verdict()
    assert not replace(plain.timing[0], now=1.9, ci95=(1.88, 1.92)).faster
    assert not replace(plain.timing[0], now=1.6, ci95=(1.2, 2.1)).faster


def test_quantities_cannot_write_markdown(verdict) -> None:
    plain = verdict()
    odd = replace(plain, accuracy=[replace(plain.accuracy[0], quantity="a|<b>*c*")])
    assert "a\\|&lt;b>\\*c\\*" in markdown_text(odd)
