"""A GIF that moves."""

import io

import numpy as np
import pytest
from PIL import Image

from reports import Animation, Page, Section, Verdict, render_page
from reports.figures import moving_surface

SIDE = np.linspace(0.0, 10.0, 5)
FRAMES = [-depth * np.outer(np.sin(0.1 * np.pi * SIDE), np.sin(0.1 * np.pi * SIDE)) for depth in (0.0, 1.0, 2.0)]


def test_it_holds_every_frame_and_stays_small():
    gif = moving_surface(SIDE, SIDE, FRAMES)
    picture = Image.open(io.BytesIO(gif))
    assert (picture.format, picture.n_frames) == ("GIF", 3)
    assert len(gif) < 200_000


@pytest.mark.parametrize("frames", [[], [np.zeros((5, 4))]])
def test_frames_of_another_shape_are_refused(frames):
    with pytest.raises(ValueError, match="5 x 5"):
        moving_surface(SIDE, SIDE, frames)


def test_it_stands_in_a_page_with_its_words():
    block = Animation(b"GIF89a-and-so-on", "Moves <down>.", "A surface that sinks", "Sinking")
    html = render_page(Page("title", Verdict("finding", "Nothing."), [Section("One", [block])]))
    assert 'src="data:image/gif;base64,R0lGODlhLWFuZC1zby1vbg=="' in html
    assert "Moves &lt;down&gt;." in html
    assert "Figure 1" in html


def test_other_content_is_refused():
    with pytest.raises(ValueError, match="no GIF"):
        Animation(b"<svg>", "", "")
