"""A system sums elements and items; a spring to the ground stands for every item."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest

from fem.arrays import IntArray
from fem.assembly.item import EquationItem, ItemForces
from fem.assembly.system import make_system


@dataclass(frozen=True)
class Spring(EquationItem):
    """Two unknowns joined by a spring, torn where it gets longer than 1 m, which counts the accepted states."""

    pair: IntArray
    stiffness: float = 3.0
    used: int = 0
    in_small_strain: ClassVar[bool] = True

    @property
    def unknowns(self):
        return self.pair

    @property
    def entries(self):
        i, j = self.pair
        return np.array([i, j, j]), np.array([i, j, i])

    @property
    def remembers(self):
        return True

    def respond(self, y):
        length = y[self.pair[1]] - y[self.pair[0]]
        if abs(length) > 1.0:
            return None
        k = self.stiffness
        return ItemForces(k * length * np.array([-1.0, 1.0]), k * np.array([1.0, 1.0, -1.0]), support=0.25)

    def accepted(self, y):
        return replace(self, used=self.used + 1)

    def corrected(self, y, press):
        return replace(self, stiffness=press) if press > self.stiffness else None

    def warning(self, y):
        return "stretched" if y[self.pair[1]] != y[self.pair[0]] else ""


class Nonlinear(Spring):
    """The same, but not in small strain."""

    in_small_strain = False


@pytest.fixture
def plain(block, system_of):
    return system_of(block())


def joined(plain, *items):
    return make_system(plain.elements, plain.numbering, plain.scatter, items)


def matrix(system, state):
    n = system.numbering.count
    full = np.zeros((n, n))
    rows = np.repeat(np.arange(n), np.diff(system.scatter.indptr))
    full[rows, system.scatter.indices] = system.tangent(state)
    return full + np.triu(full, 1).T


def test_forces_and_stiffness_are_sums(plain):
    last = plain.numbering.count - 1
    first, second = Spring(np.array([0, last])), Spring(np.array([2, 7]), 5.0)
    both = joined(plain, first, second)
    y = 0.01 * np.random.default_rng(1).normal(size=last + 1)
    pressure = plain.rest()[1]
    alone, found = plain.evaluate(y, pressure), both.evaluate(y, pressure)
    extra, stiffness = np.zeros(last + 1), np.zeros((last + 1, last + 1))
    for (i, j), k in (((0, last), 3.0), ((2, 7), 5.0)):
        extra[[i, j]] += k * (y[j] - y[i]) * np.array([-1.0, 1.0])
        stiffness[np.ix_([i, j], [i, j])] += k * np.array([[1.0, -1.0], [-1.0, 1.0]])
    np.testing.assert_allclose(found.residual - alone.residual, extra, atol=1e-14)
    np.testing.assert_allclose(matrix(both, found) - matrix(plain, alone), stiffness, atol=1e-12)
    rest = both.evaluate(*both.rest())
    np.testing.assert_allclose(both.linear_residual(rest, y), matrix(both, rest) @ y, atol=1e-12)
    more = both.reaction(found.elements.force, found.responses) - plain.reaction(alone.elements.force)
    assert more == pytest.approx(0.5, abs=1e-12)


def test_where_an_item_has_no_answer_there_is_none(plain):
    y = np.zeros(plain.numbering.count)
    y[1] = 2.0
    assert joined(plain, Spring(np.array([0, 1]))).evaluate(y, plain.rest()[1]) is None


def test_an_accepted_or_corrected_state_makes_new_items_and_leaves_the_old(plain):
    system = joined(plain, Spring(np.array([0, 1])), Spring(np.array([2, 3]), 9.0))
    y = np.zeros(plain.numbering.count)
    assert system.remembers
    assert [item.used for item in system.accepted(y).items] == [1, 1]
    assert [item.used for item in system.items] == [0, 0]
    assert system.corrected(y, 1.0) is None
    assert system.at_press(0.5) is None
    assert [item.stiffness for item in system.corrected(y, 5.0).items] == [5.0, 9.0]
    assert system.warnings(y) == ()
    y[3] = 0.1
    assert system.warnings(y) == ("stretched",)


def test_small_strain_has_the_items_that_belong_there(plain):
    kept = Spring(np.array([0, 1]))
    system = joined(plain, Nonlinear(np.array([2, 3])), kept)
    assert system.plain.items == (kept,)
    rest = system.plain.evaluate(*system.rest())
    difference = matrix(system.plain, rest) - matrix(plain, plain.evaluate(*plain.rest()))
    np.testing.assert_allclose(difference[:2, :2], [[3.0, -3.0], [-3.0, 3.0]], atol=1e-12)
    assert np.abs(difference[2:, 2:]).max() < 1e-12
