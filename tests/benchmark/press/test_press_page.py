"""What a word or a file after `press` means."""

import json
import re
from contextlib import nullcontext
from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.cli.app import main
from benchmark.errors import InputError
from benchmark.files import load_scenario
from benchmark.press import pressed_specimen as pressed
from benchmark.press.press_page import SIGN, PressRequest, render_press_page, specimens
from benchmark.press.pressed_specimen import pressed_specimen
from benchmark.runs.options import Listener
from benchmark.runs.output.destination import check_file
from tests.instruments.samples import press
from wavemodel import DiscTool, LayeredWave, Prony, WaveLayer

COARSE = {"fem.mesh": "coarse", "wave.large_press": "linear"}
STIFFENING = """schema = 1
[base]
tissue = "{tissue}"
model = "wave"
large_press = "linear"
[[effects]]
name = "strain_stiffening"
[effects.parameters]
b_1 = "0.7"
b_2 = "6.3"
[[effects]]
name = "viscoelastic_relaxation"
[effects.parameters]
g_1 = "0.3"
tau_1 = "0.5 s"
[[effects]]
name = "dry_friction"
[effects.parameters]
coefficient = "0.2"
"""


class Silent(Listener):
    def say(self, text):
        pass

    def progress(self, title):
        return nullcontext(lambda *_: None)


def tissues(**request):
    return [one.scenario.tissue.name for one in specimens(PressRequest(settings=COARSE, **request), Silent())]


def test_a_tissue_is_pressed_as_in_the_default_scenario():
    [one] = specimens(PressRequest("skin_traction", settings={**COARSE, "load.peak": "1 N"}), Silent())
    assert one.scenario.tissue.name == "skin_traction"
    assert one.scenario.tool.radius == pytest.approx(5e-3)
    assert np.interp(one.wave.deepest / 1.3, one.wave.depth, one.wave.force) == pytest.approx(1.0, rel=1e-4)


def test_an_unknown_word_is_refused_with_what_ships():
    with pytest.raises(InputError, match="skin_forearm"):
        tissues(what="skim")


def test_a_folder_that_is_no_result_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"no scenario\.toml.*no session"):
        tissues(what=str(tmp_path))


def test_a_model_file_stands_beside_the_model_as_it_was(tmp_path):
    text = re.sub(r"coefficient.*", _friction(), STIFFENING).format(tissue="skin_forearm")
    (tmp_path / "model.toml").write_text(text)
    [one] = specimens(PressRequest(str(tmp_path), settings={**COARSE, "load.peak": "1 N"}), Silent())
    assert one.effects == ("strain_stiffening", "viscoelastic_relaxation")
    assert any("dry_friction" in remark for remark in one.remarks)
    assert one.after_memory.series.strength == pytest.approx((0.3,))
    share = one.wave.depth[-1] / one.scenario.tissue.thickness
    expected = one.wave.force[-1] * (1.0 + 0.7 * share + 6.3 * share**2)
    assert one.after.force[-1] == pytest.approx(expected, rel=1e-6)


def test_a_compressible_layer_relaxes_on_the_page_as_in_a_run(tmp_path):
    tissue = tmp_path / "tissue.toml"
    tissue.write_text(
        'schema = 1\nname = "one"\n[[layers]]\nname = "pad"\nthickness = "5 mm"\ndensity = "1000 kg/m^3"\n'
        'youngs_modulus = "50 kPa"\npoisson_ratio = 0.4\nrelaxation = [{ g = 0.4, tau = "1 s" }]\n'
    )
    scenario = load_scenario("skin-5N", {**COARSE, "tissue": str(tissue), "load.peak": "0.2 N"})
    pad, tool = WaveLayer("pad", 5e-3, 1000.0, 50e3, 0.4), DiscTool(scenario.tool.radius)
    shape = LayeredWave([pad], tool, relaxation=Prony((0.4,), (1.0,)), relaxing="shape", large_press="linear")
    found = pressed_specimen(scenario).memory.series
    assert found.strength == pytest.approx(shape.relaxation[0].strength)
    assert found.strength[0] < 0.37


def test_a_shipped_session_is_pressed_by_its_name():
    [one] = specimens(PressRequest("gel_pad", settings=COARSE), Silent())
    assert one.scenario.tool.radius == pytest.approx(5e-3)


def test_a_model_of_a_lab_s_own_session_is_pressed_beside_that_session(tmp_path):
    session = tmp_path / "days"
    session.mkdir()
    one = press(peak=1.5)
    rows = zip(one.time, one.depth + 0.5, one.force, strict=True)
    lines = [",".join(f"{cell:.6f}" for cell in row) for row in rows]
    (session / "gel_1.csv").write_text("\n".join(["time_s,depth_mm,force_N", *lines]))
    (tmp_path / "model.toml").write_text(re.sub(r"coefficient.*", _friction(), STIFFENING).format(tissue="my_gel"))
    with pytest.raises(InputError, match=r"'my_gel', does not ship.*press SESSION --model model\.toml"):
        tissues(what=str(tmp_path / "model.toml"))
    settings = {**COARSE, "tool.radius": "4 mm"}
    request = PressRequest(str(session), settings=settings, model=tmp_path / "model.toml")
    [pressed] = specimens(request, Silent())
    assert pressed.scenario.tool.radius == pytest.approx(4e-3)
    assert pressed.wave.deepest >= 1.5e-3
    assert pressed.effects == ("strain_stiffening", "viscoelastic_relaxation")


def _friction():
    from benchmark.physics import catalogue

    [effect] = [one for one in catalogue() if one.slug == "dry_friction"]
    return "\n".join(f'{one.name} = "{one.start[0]:g} {one.unit}"' for one in effect.description.parameters)


def test_the_command_writes_one_file(tmp_path, capsys, monkeypatch):
    target = tmp_path / "press.html"
    code = main(
        [
            "press",
            "skin-5N",
            "--save",
            str(target),
            "--set",
            "fem.mesh=coarse",
            "--set",
            "wave.large_press=linear",
            "--set",
            "load.peak=1 N",
            "--json",
        ]
    )
    said = json.loads(capsys.readouterr().out)
    assert code == 0
    assert said["bytes"] == target.stat().st_size < 2e6
    assert [one["tissue"] for one in said["presses"]] == ["skin_forearm"]
    check_file(target, "--save", SIGN, "a page of press")
    target.write_text("mine")
    assert main(["press", "skin-5N", "--save", str(target), "--quiet"]) == 2
    assert target.read_text() == "mine"


def test_nothing_in_the_page_ends_its_data_early(page_document):
    hostile = {
        **page_document,
        "specimens": [{**page_document["specimens"][0], "tissue": "</script><script>alert(1)</script>"}],
    }
    page = render_press_page(hostile)
    assert "<script>alert" not in page
    assert "connect-src" not in page


@pytest.mark.parametrize("live", [False, True])
def test_the_page_as_it_is_written_names_its_controls_and_gives_no_number(page_document, live):
    page = render_press_page(page_document, served=live, live=live)
    labels = re.findall(r"<label.*?</label>", page, re.DOTALL)
    sliders = re.findall(r'<input id="(\w+)"[^>]*type="range"', page)
    assert len(sliders) == 6
    assert all(f'<label for="{name}">' in page for name in sliders)
    assert all(len(re.findall("<(?:input|output|select|button)", label)) <= 1 for label in labels)
    assert all("role=" in canvas or 'aria-hidden="true"' in canvas for canvas in re.findall("<canvas[^>]*>", page))
    assert {*re.findall(r'class="number"[^>]*>([^<]*)<', page)} == {"–"}
    assert "<output" not in page  # a live region that would be read out at every change


@pytest.mark.parametrize(
    ("request_", "says"),
    [
        (PressRequest("skin-5N", tools=("2",)), "--tool: the bare number 2 has no unit"),
        (PressRequest("skin-5N", tissues=("skin_foream",)), "--tissue: no tissue 'skin_foream' ships"),
    ],
)
def test_what_can_be_chosen_is_refused_by_the_option_it_was_given_with(request_, says) -> None:
    with pytest.raises(InputError, match=f"^{says}"):
        specimens(request_, Silent())


def test_the_finite_elements_end_where_their_press_is_not_stable(monkeypatch):
    """Behind a fold their curve was a zig-zag of slopes from -1196 to 617 N/m, without a word."""

    class Folding:
        unknowns = 10

        def run(self, load):
            force = np.where(load.value < 1e-3, load.value, 0.9 * load.value)
            profile = lambda step, radii: np.full((3, radii.size), load.value[step])  # noqa: E731
            return SimpleNamespace(force=force, profile=profile, unstable_from=1e-3)

    monkeypatch.setattr(pressed, "FemModel", lambda scenario, **_: SimpleNamespace(prepared=Folding()))
    found = pressed_specimen(load_scenario("skin-5N", {**COARSE, "load.peak": "1 N"}))
    assert found.fem is not None
    assert found.fem.table.deepest < 1e-3
    assert (np.diff(found.fem.table.force) > 0.0).all()
    assert any(text.startswith("The finite elements end at 1 mm: from there on") for text in found.remarks)
