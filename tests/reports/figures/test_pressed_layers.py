"""A GIF that moves."""

import base64
import io

import numpy as np
import pytest
from PIL import Image

from reports import Figure, Page, Section, Verdict, render_page
from reports.figures import moving_surface
from reports.figures.pressed_layers import pressed_layers

RADIUS = np.linspace(0.0, 20.0, 21)
DENT = 2.0 * np.exp(-((RADIUS / 6.0) ** 2))
FEM = np.array([DENT, 0.5 * DENT])


def draw(base=10.0, fem=FEM, wave=None):
    return pressed_layers(["skin", "fat"], [0.0, 2.0], base, RADIUS, fem, wave, 5.0)


def test_faces_lie_where_the_press_has_moved_them():
    body = draw().panels[0].live
    skin, fat = body.faces
    assert np.allclose(skin.height, -DENT)
    assert np.allclose(skin.below, fat.height)
    assert np.allclose(fat.height, -2.0 - 0.5 * DENT)
    assert np.allclose(fat.below, -10.0)
    assert np.allclose(skin.value, DENT)


def test_a_last_layer_whose_lower_face_moves_is_a_face_alone():
    figure = draw(base=None)
    assert figure.panels[0].live.faces[-1].below is None
    assert "only the top face" in figure.caption


def test_both_models_share_a_scale_and_a_window_ends_the_body():
    wave = np.where(RADIUS < 12.0, 1.5 * FEM, np.nan)
    first, second = (panel.live for panel in draw(wave=wave).panels)
    assert first.limit == second.limit == pytest.approx(3.0)
    assert max(second.radius) == 11.0


def test_nothing_is_drawn_without_a_profile():
    assert draw(fem=np.full_like(FEM, np.nan)) is None


def test_the_words_name_model_layers_and_deflections():
    words = draw().panels[0].alt
    assert words.startswith("FEM: ")
    assert "skin by 2.000 mm on the axis" in words


@pytest.mark.parametrize(("base", "thin", "wanted"), [(10.0, 1.0, 3), (None, 0.01, 1)])
def test_a_flat_section_has_no_more_ticks_than_fit_beside_it(texts, base, thin, wanted):
    figure = pressed_layers(["skin"], [0.0], base, RADIUS, thin * DENT[None], None, 5.0)
    across = {f"{value}" for value in range(-20, 21, 5)}
    heights = [text.replace("−", "-") for text in texts(figure.panels[0].svg)]
    assert sum(text not in across and text.lstrip("-").replace(".", "").isdigit() for text in heights) <= wanted


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
    gif = moving_surface(SIDE, SIDE, FRAMES)
    block = Figure.of_picture(gif, "Moves <down>.", "A surface that sinks", "Sinking")
    html = render_page(Page("title", Verdict("finding", "Nothing."), [Section("One", [block])]))
    assert f'src="data:image/gif;base64,{base64.b64encode(gif).decode()}"' in html
    assert "Moves &lt;down&gt;." in html
    assert "Figure 1" in html


def test_nothing_moves_until_it_is_asked_for():
    block = Figure.of_picture(moving_surface(SIDE, SIDE, FRAMES), "Moves.", "A surface that sinks")
    html = render_page(Page("title", Verdict("finding", "Nothing."), [Section("One", [block])]))
    before, behind = html.split('<details class="moving">')
    assert '<img src="data:image/png;' in before
    assert "data:image/gif" not in before
    assert '<img src="data:image/gif;' in behind.split("</details>")[0]
    still = Image.open(io.BytesIO(base64.b64decode(before.split("data:image/png;base64,")[1].split('"')[0])))
    assert getattr(still, "n_frames", 1) == 1


def test_other_content_is_refused():
    with pytest.raises(ValueError, match="no PNG and no GIF"):
        Figure.of_picture(b"<svg>", "", "")
