"""What a person sees."""

import io
import sys

from bench_hw.capture.progress import CaptureState, PlainLines, Silent, TerminalLine, choose_progress

SHOWN = CaptureState(2, 10, "3 of 5: move", 4.2, 8.0, 1.5e-3, 0.75, lost=3)


def test_a_snapshot_in_one_line():
    line = SHOWN.line()
    assert "trial 2/10" in line
    assert "depth +1.500 mm" in line
    assert "force +0.750 N" in line
    assert "lost 3" in line
    assert "3 of 5: move" in line


def test_before_the_first_trial_no_trial_is_counted():
    line = CaptureState(depth=-5e-3).line()
    assert line.startswith("before the first trial  depth -5.000 mm")
    assert "0/0" not in line


def test_a_camera_is_shown_with_its_rate_and_its_dropped_frames():
    shown = CaptureState(1, 1, camera=29.97, dropped=2).line()
    assert "camera 30.0/s dropped 2" in shown
    assert "camera" not in SHOWN.line()


def test_plain_lines_come_once_a_second():
    stream = io.StringIO()
    progress = PlainLines(stream)
    with progress.showing():
        for tenth in range(25):
            progress.update(CaptureState(1, 1, "press", tenth / 10, 8.0))
    assert stream.getvalue().count("\n") == 3


def test_a_live_line_is_drawn_from_the_last_snapshot(monkeypatch, capsys):
    progress = TerminalLine()
    with progress.showing():
        progress.update(SHOWN)
        progress.say("fault (force_limit): [too] much")
    assert progress._draw().plain == SHOWN.line()
    assert "fault (force_limit): [too] much" in capsys.readouterr().err


def test_a_narrow_terminal_shows_what_was_lost():
    from rich.console import Console

    console = Console(file=io.StringIO(), width=80)
    progress = TerminalLine(console)
    progress.update(CaptureState(1, 1, "1 of 1: rest", 2.0, 3.0, camera=30.0, lost=17))
    console.print(progress._draw())
    assert "lost 17" in " ".join(console.file.getvalue().split())


def test_the_choice_suits_the_place(monkeypatch):
    assert isinstance(choose_progress(quiet=True), Silent)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: False, raising=False)
    assert isinstance(choose_progress(quiet=False), PlainLines)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    assert isinstance(choose_progress(quiet=False), TerminalLine)
