"""Rivals: what they see, and what they say of cases that are easy for them."""

from pathlib import Path

import numpy as np
import pytest

from benchmark.blind.cases import CaseName
from benchmark.blind.rivals.textbook import ForceSamples, _library, force_samples, gaussian_process, plain_bic, sindy
from benchmark.blind.session_files import case
from benchmark.files import Session, load_session


@pytest.fixture(scope="module")
def null(tmp_path_factory: pytest.TempPathFactory) -> Session:
    return load_session(case(CaseName("null", "", 0, 0.0), tmp_path_factory.mktemp("blind"))[0])


def strong(slug: str, folder: Path) -> Session:
    return load_session(case(CaseName("effect", slug, 0, strength=150.0), folder)[0])


def test_samples_are_of_all_trials_and_of_size_one(null: Session) -> None:
    samples = force_samples(null, 100)
    assert np.unique(samples.trial).size == len(null.trials)
    assert samples.depth.min() == 0.0
    assert samples.depth.max() == 1.0
    assert np.abs(samples.rate).max() == 1.0
    assert np.abs(samples.force).max() == 1.0
    deepest = [samples.depth[samples.trial == number].max() for number in range(10)]
    stiffness = [
        samples.force[(samples.trial == number) & (samples.depth > 0.4) & (samples.depth < 0.5)].mean()
        for number in range(10)
    ]
    assert np.ptp(deepest) > 0.2
    assert np.ptp(stiffness) < 0.2 * np.mean(stiffness)


def test_the_library_has_a_name_for_each_term() -> None:
    x = np.linspace(-1.0, 1.0, 7)
    names, terms = _library(ForceSamples(x, np.clip(x, 0.0, None), x, x))
    assert terms.shape == (7, len(names))
    assert terms[-1, names.index("d v")] == 1.0
    assert not terms[:3, [names.index(name) for name in ("d", "v", "sign v")]].any()


def test_sparse_regression_names_drag(tmp_path: Path) -> None:
    pytest.importorskip("pysindy", reason="needs pysindy (extra `rivals`)")
    said = sindy(strong("viscous_damping", tmp_path), seed=0)
    assert [effect.slug for effect in said.effects] == ["viscous_damping"]


@pytest.mark.slow
def test_a_process_sees_a_discrepancy(tmp_path: Path) -> None:
    pytest.importorskip("sklearn", reason="needs scikit-learn (extra `rivals`)")
    assert gaussian_process(strong("dry_friction", tmp_path), seed=0).verdict == "outside_catalogue"


@pytest.mark.slow
def test_plain_bic_names_what_is_plain(tmp_path: Path) -> None:
    said = plain_bic(strong("viscoelastic_relaxation", tmp_path), seed=0)
    assert said.verdict == "named"
    assert len(said.effects) == 1
