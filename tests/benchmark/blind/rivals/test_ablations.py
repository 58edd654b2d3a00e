"""The discovery without one of its parts: what it gets, and that nothing stays changed."""

from pathlib import Path

import pytest

from benchmark.blind.cases import CaseName
from benchmark.blind.rivals import ablations
from benchmark.blind.rivals.ablations import ABLATIONS, discoverer_without
from benchmark.blind.running import load_discoverer
from benchmark.blind.session_files import case
from benchmark.cli.app import main
from benchmark.discovery import criteria
from benchmark.errors import InputError
from benchmark.files import Session, load_session


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Session:
    name = CaseName("null", "", 1, 0.0, wrong_layers=True, print_scatter=0.06e-3)
    return load_session(case(name, tmp_path_factory.mktemp("blind"))[0])


@pytest.fixture
def given(monkeypatch: pytest.MonkeyPatch, session: Session):
    """What the discovery is given without a part, and the shape's priors meanwhile."""
    calls = []

    def answer(seen, *, settings):
        calls.append((seen, settings, dict(criteria.SHAPE_PRIOR)))
        return "answer"

    monkeypatch.setattr(ablations, "discover", answer)

    def ask(name: str):
        assert load_discoverer(discoverer_without(name))(session, seed=3) == "answer"
        return calls.pop()

    return ask


def test_every_part_can_be_taken_away(given) -> None:
    before = {name: getattr(criteria, name) for name in dir(criteria) if name.isupper()}
    for name in ABLATIONS:
        _, settings, _ = given(name)
        assert (settings.seed, settings.workers) == (3, 1)
    assert {name: getattr(criteria, name) for name in before} == before


def test_what_is_taken_away(given, session: Session) -> None:
    (setup,) = session.setups
    assert session.uncertainties(setup)
    assert given("stated_uncertainties")[0].uncertainties(setup) == {}
    assert given("stated_uncertainties")[0].fingerprint == session.fingerprint
    assert session.camera is not None
    assert given("print_offsets")[0].camera.print_scatter == pytest.approx(0.0, abs=1e-8)
    bare = given("markers")[0]
    assert bare.camera is None
    assert all(trial.markers is None for trial in bare.trials)
    assert given("several_effects")[1].most_effects == 1
    assert given("shape_nuisances")[2]["width"] == pytest.approx(1e-3 * criteria.SHAPE_PRIOR["width"])
    assert given("shape_nuisances")[2]["modulus"] == criteria.SHAPE_PRIOR["modulus"]


def test_an_unknown_part_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(InputError, match="allowed: stated_uncertainties"):
        discoverer_without("luck")
    command = ["blind", "--without", "markers", "--discoverer", "some:thing", "--out", str(tmp_path / "out")]
    assert main(command) == 2
    assert "only the product's own discovery" in capsys.readouterr().err.replace("\n", " ")
