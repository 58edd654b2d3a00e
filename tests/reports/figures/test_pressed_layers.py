import numpy as np
import pytest

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
