"""A discovery that was interrupted, at whatever fit, ends with the answer it would have had, to the last bit."""

import os
import sys
from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from bench_hw.storage.regular_file import sealed
from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.base.candidate_fit import fit_candidate
from benchmark.discovery.criteria import Settings
from benchmark.discovery.evidence import pool as module
from benchmark.discovery.evidence.gains import foretold
from benchmark.discovery.evidence.pool import Pool, forget, own_code, pool, silent, stored
from benchmark.discovery.evidence.selection import select
from benchmark.discovery.trials.preparing import prepare
from benchmark.physics import catalogue, load_effects

SETTINGS = Settings(rows=40, workers=1, bootstraps=20, most_effects=2, accept_z=0.5)
TRIED = ("viscous_damping", "machine_compliance", "viscoelastic_relaxation")


def damped(time, depth, elastic):
    return elastic + 0.15 * np.gradient(elastic, time)


@pytest.fixture(scope="module")
def base(tmp_path_factory, quick_session):
    from benchmark.files import load_session

    folder = quick_session.write_session(tmp_path_factory.mktemp("pool") / "s", trials=2, noise=0.003, force=damped)
    session = load_session(folder)
    return calibrate(session, prepare(session, SETTINGS.rows)).base


EFFECTS = tuple(effect for effect in catalogue() if effect.slug in TRIED)


class Killed(BaseException):
    """In the place of the signal."""


def bits(selection):
    """All that follows from a selection, to the last bit."""
    steps = [(step.slug, stored(step.fit), step.gain.mean, step.gain.z, step.delta_bic) for step in selection.steps]
    tried = [(each.slug, stored(each.fit), each.gain.mean, each.delta_bic) for each in selection.candidates]
    rivals = {slug: [stored(fit) for fit in fits] for slug, fits in selection.rivals.items()}
    return stored(selection.chosen), steps, tried, selection.lookalikes, rivals


def counted(monkeypatch, most):
    """Let `most` fits be made, then kill; returns the list that grows by each, of what it is made from."""
    made = []

    def fit(base, effect):
        if len(made) == most:
            raise Killed
        made.append((effect.names, stored(base)))
        return fit_candidate(base, effect)

    monkeypatch.setattr(module, "fit_candidate", fit)
    return made


def test_killed_after_every_fit_the_answer_is_the_same(base, tmp_path, monkeypatch):
    made = counted(monkeypatch, -1)
    whole = bits(select(base, EFFECTS, SETTINGS, Pool(None, None, "key")))
    different = set(made)
    assert len({under for _, under in different}) > 1  # more than one round
    kills = 0
    while True:
        made = counted(monkeypatch, 1)
        try:
            answer = bits(select(base, EFFECTS, SETTINGS, Pool(None, tmp_path, "key")))
        except Killed:
            kills += 1
            continue
        break
    assert kills == len(different) - 1  # a fit that is asked for twice is kept once
    assert answer == whole
    counted(monkeypatch, 0)
    assert bits(select(base, EFFECTS, SETTINGS, Pool(None, tmp_path, "key"))) == whole


class Backwards:
    """A pool of processes whose jobs end last first; it is killed after `most`."""

    def __init__(self, most):
        self.most, self.waiting = most, []

    map = staticmethod(map)

    def submit(self, work, base, effect):
        future = Future()
        self.waiting.append((future, work, base, effect))
        return future

    def as_completed(self, _):
        while self.waiting:
            if self.most == 0:
                raise Killed
            self.most -= 1
            future, work, base, effect = self.waiting.pop()
            future.set_result(work(base, effect))
            yield future


@pytest.mark.slow
def test_neither_the_order_of_the_processes_nor_a_kill_among_them_matters(base, tmp_path, monkeypatch):
    whole = bits(select(base, EFFECTS, SETTINGS, Pool(None, None, "key")))
    for most in (2, 3, -1):
        crew = Backwards(most)
        monkeypatch.setattr(module, "as_completed", crew.as_completed)
        try:
            answer = bits(select(base, EFFECTS, SETTINGS, Pool(crew, tmp_path, "key")))
        except Killed:
            continue
    assert answer == whole


def test_a_kept_fit_is_known_by_its_base_its_key_and_its_bytes(base, tmp_path, monkeypatch):
    effect = EFFECTS[0]
    counted(monkeypatch, 1)
    (made,) = Pool(None, tmp_path, "key").fits("x", [(base, effect)])
    (file,) = tmp_path.iterdir()
    assert file.read_bytes() == sealed(file.name, stored(made))
    counted(monkeypatch, 0)
    with pytest.raises(Killed):
        Pool(None, tmp_path, "another session, setting or version").fits("x", [(base, effect)])
    with pytest.raises(Killed):
        Pool(None, tmp_path, "key").fits("x", [(made, effect)])


def cut(file):
    file.write_bytes(file.read_bytes()[:-100])


def method(file):
    """The way of packing that the last part's entry in the archive's list tells is no known one."""
    whole = bytearray(file.read_bytes())
    whole[whole.rfind(b"PK\x01\x02") + 10] ^= 0x20
    file.write_bytes(whole)


def pipe(file):
    file.unlink()
    os.mkfifo(file)


def device(file):
    file.unlink()
    file.symlink_to("/dev/zero")


@pytest.mark.parametrize("damage", [cut, method, pipe, device])
def test_a_damaged_fit_is_made_anew_and_kept_whole(base, tmp_path, monkeypatch, damage):
    effect = EFFECTS[0]
    (made,) = Pool(None, tmp_path, "key").fits("x", [(base, effect)])
    (file,) = tmp_path.iterdir()
    whole = file.read_bytes()
    damage(file)
    (again,) = Pool(None, tmp_path, "key").fits("x", [(base, effect)])
    assert stored(again) == stored(made)
    assert file.read_bytes() == whole


def test_only_kept_fits_are_forgotten(tmp_path):
    kept, mine = tmp_path / f"{'a' * 24}.npz", tmp_path / "notes.txt"
    kept.touch()
    mine.touch()
    forget(tmp_path)
    assert list(tmp_path.iterdir()) == [mine]
    mine.unlink()
    forget(tmp_path)
    assert not tmp_path.exists()


def test_the_same_job_gives_the_same_fit_while_its_base_lives(base, monkeypatch):
    made = counted(monkeypatch, -1)
    work = Pool(None, None, "key")
    first = work.fits("x", [(base, EFFECTS[0]), (base, EFFECTS[1]), (base, EFFECTS[0])])
    assert first[2] is first[0]
    assert work.fits("x", [(base, EFFECTS[1])])[0] is first[1]
    assert len(made) == 2
    other = work.fits("x", [(first[0], EFFECTS[1])])[0]
    assert other is not first[1]
    assert len(other.model.effects) == 2


def test_processes_foretell_what_one_does(base):
    made = Pool(None, None, "key").fits("x", [(base, effect) for effect in EFFECTS])
    alone = foretold(made)
    with pool(2, None, "key", (), silent) as work:
        together = foretold([replace(each) for each in made], work.map)
    np.testing.assert_array_equal(together, alone)


def test_an_effect_is_known_by_what_its_file_imports_from_its_folder(tmp_path, monkeypatch) -> None:
    """Fits of a changed helper were recalled as those of the one before."""
    own = (Path(__file__).parents[4] / "examples/own_effect.py").read_text()
    (tmp_path / "own.py").write_text(f"import effect_helper\n{own}")
    (tmp_path / "effect_helper.py").write_text("FACTOR = 1\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    (effect,) = load_effects(tmp_path / "own.py")
    before = own_code(effect)
    (tmp_path / "unused.py").write_text("FACTOR = 1\n")
    assert own_code(effect) == before
    (tmp_path / "effect_helper.py").write_text("FACTOR = 2\n")
    assert own_code(effect) != before
    sys.modules.pop("effect_helper")
