"""Table 1 and eqs. (5) to (8) against computations by hand."""

import math

import numpy as np
import pytest
from scipy.integrate import dblquad

from benchmark.reproduce.article_wave import equation_items, table_one_items
from benchmark.reproduce.items import SESSION

A, C, LAMBDA, D, B = 23.6053, 9.2496, 1.7409, 14.3321, 39.2012


def o(x: float) -> float:
    return -8.393e-6 * x**2 + 0.002 * x + 1.3322


def p(y: float) -> float:
    return -8.1904e-6 * y**2 + 0.002 * y + 0.9876


def sine(x: float) -> float:
    return math.sin(math.pi * x / A)


def integral(second: str) -> float:
    """4 d / (a b) times the double integral of O(x) p(y) sin(pi x / a) and the sine of `second`."""
    value, _ = dblquad(lambda y, x: o(x) * p(y) * sine(x) * sine(x if second == "x" else y), 0, A, 0, A, epsabs=1e-9)
    return 4.0 * D / A**2 * value


@pytest.fixture(scope="module")
def table(chain):
    return {item.item.removeprefix("Table 1: "): item for item in table_one_items(chain)}


@pytest.fixture(scope="module")
def equations():
    return {item.item: item for item in equation_items()}


def test_every_printed_number_is_there(table) -> None:
    printed = sorted(item.printed for item in table.values())
    parabolas = [-8.393e-6, 0.002, 1.3322, -8.1904e-6, 0.002, 0.9876]
    assert printed == sorted([*parabolas, D, 85.56, C, 1.0, 1.0, A, A, LAMBDA, LAMBDA, B, B])
    assert all(item.reason for item in table.values())


def test_b_11(table) -> None:
    by_equation = table["B_11 (eq. 3 with eqs. 4 to 6)"]
    assert by_equation.recomputed == pytest.approx(integral("y"), rel=1e-8)
    assert by_equation.recomputed == pytest.approx(31.7788, abs=5e-5)
    assert not by_equation.agrees
    assert "sin(pi x / a)" in by_equation.reason
    slip = table["B_11 with sin(n pi y / b) written as sin(pi x / a)"]
    assert slip.recomputed == pytest.approx(integral("x"), rel=1e-8)
    assert slip.recomputed == pytest.approx(39.20117, abs=5e-6)
    assert slip.agrees


def test_c_and_lambda(table) -> None:
    assert table["c, root of c^2 (eq. 1)"].recomputed == pytest.approx(9.24986, abs=5e-6)
    assert not table["c, root of c^2 (eq. 1)"].agrees
    assert table["c²"].recomputed == pytest.approx(C * C)
    assert table["c²"].agrees
    assert table["lambda_11 (eq. 3)"].recomputed == pytest.approx(C * math.pi * math.sqrt(2 / A**2), rel=1e-12)
    assert table["lambda_11 (eq. 3)"].agrees
    per_second = table["lambda_11 taken per second, as eq. (2) does"]
    assert per_second.recomputed == pytest.approx(math.sqrt(85.56) * math.pi * math.sqrt(2) / 0.0236053, rel=1e-12)
    assert not per_second.agrees


def test_d_is_that_of_a_press_of_two_millimetres(table) -> None:
    assert table["d"].recomputed == pytest.approx(2.0 / (o(A / 2) * p(A / 2)), rel=1e-12)
    assert f"{D * o(A / 2) * p(A / 2):.2f} mm" in table["d"].reason
    assert not table["d"].agrees


def test_the_first_mode_is_the_largest(table) -> None:
    assert [table[name].recomputed for name in ("m", "n")] == [1.0, 1.0]
    # a box: 4 / pi for each sine, odd ones only; the share of the first is (sum of 1 / n^2)^-2
    box = sum(1.0 / n**2 for n in range(1, 16, 2)) ** -2
    assert float(table["m"].reason.split(" %")[0].split()[-1]) == pytest.approx(100 * box, abs=2)


def test_what_was_measured_comes_from_the_session_and_says_so(table, chain) -> None:
    measured = [item for item in table.values() if item.basis == SESSION]
    assert len(measured) == 8
    assert not any(item.agrees for item in measured)
    assert all("not published" in item.reason for item in measured)
    assert "119" in table["O(x), eq. (5), constant"].reason
    assert "122" in table["p(y), eq. (6), constant"].reason
    assert table["a"].recomputed == pytest.approx(2e3 * np.nanmax(chain.shown.radius_nine), rel=2e-3)


def test_equation_7(equations) -> None:
    assert [item.printed for item in equations.values()][:6] == [-B, -B, LAMBDA, A, A, 2.0]
    assert equations["Eq. (7): amplitude by eq. (3), downwards"].recomputed == pytest.approx(-integral("y"), rel=1e-8)
    assert equations["Eq. (7): amplitude as B_11 of Table 1"].recomputed == B
    for axis in ("x", "y"):
        side = equations[f"Eq. (7): side under {axis}"]
        assert side.recomputed == pytest.approx(C * math.pi * math.sqrt(2) / LAMBDA, rel=1e-12)
        assert "23.6047 to 23.6063" in side.reason  # with c from 9.24955 to 9.24965, lambda from 1.74085 to 1.74095
    deep = equations["Eq. (7): depth in the middle at t = 0, against the press of section 3.3.3"]
    assert deep.recomputed == pytest.approx(39.20117, abs=5e-6)
    assert not deep.agrees


def test_equation_8_lacks_the_amplitude(equations) -> None:
    one, two, put_in = list(equations.values())[-3:]
    assert one.recomputed == pytest.approx(39.20117, abs=5e-6)
    assert (two.recomputed, two.agrees) == (None, False)
    assert put_in.recomputed == pytest.approx(2.0, rel=1e-12)
    assert put_in.agrees
    assert "circular" in put_in.reason
