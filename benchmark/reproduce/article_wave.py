"""The article's wave number by number: Table 1 with eqs. (5) and (6), which print the same, and eqs. (7) and (8).

What it prints stands in `wavemodel.published.membrane`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

import numpy as np

from benchmark.reproduce.evidence import Chain
from benchmark.reproduce.items import SESSION, Item, compare, rounding_span
from reports import Equation
from wavemodel import WaveError
from wavemodel.published import PublishedWave, table_one
from wavemodel.published import membrane as printed

MODES = 15
UNITS = ("mm/frame²", "mm/frame", "mm")
POWERS = ("coefficient of x²", "coefficient of x", "constant")
MILLI = 1e-3
PRESS_MM = 2.0
"""Section 3.3.3: the tool is "approximately 0.002m below the starting point"."""


def _typed(text: str) -> str:
    """Letters, digits and signs as MathML, one element each; a number stays whole."""
    kinds = {"n": r"[0-9.]+", "i": r"[a-zA-Zα-ω]", "o": r"[^0-9.a-zA-Zα-ω]"}
    parts = re.finditer("|".join(f"(?P<{kind}>{pattern})" for kind, pattern in kinds.items()), text.replace(" ", ""))
    return "".join(f"<m{part.lastgroup}>{part[0]}</m{part.lastgroup}>" for part in parts)


def _over(top: str, under: str) -> str:
    return f"<mfrac><mrow>{top}</mrow><mrow>{under}</mrow></mfrac>"


def _sine(letters: str, under: str) -> str:
    return f"<mtext>\N{THIN SPACE}</mtext><mi>sin</mi>{_over(_typed(letters), _typed(under))}"


def _raised(base: str, power: str) -> str:
    return f"<msup><mrow>{_typed(base)}</mrow><mrow>{_typed(power)}</mrow></msup>"


def _lowered(base: str) -> str:
    return f"<msub>{_typed(base)}<mrow>{_typed('mn')}</mrow></msub>"


def _integral(end: str) -> str:
    return f"<munderover><mo>∫</mo><mn>0</mn><mi>{end}</mi></munderover>"


def _parabola_typed(name: str, axis: str, size: str, constant: str) -> str:
    return (
        f"{_typed(f'{name}({axis})=−{size}·')}{_raised('10', '−6')}{_raised(axis, '2')}"
        f"{_typed(f'+0.002{axis}+{constant}')}"
    )


_FREQUENCY = (
    f"{_lowered('λ')}{_typed('=cπ')}<msqrt><mrow>{_over(_raised('m', '2'), _raised('a', '2'))}<mo>+</mo>"
    f"{_over(_raised('n', '2'), _raised('b', '2'))}</mrow></msqrt>"
)
EQUATIONS = {
    "Table 1 and equations (5) and (6)": (
        Equation(
            f"{_lowered('B')}<mo>=</mo>{_over(_typed('4'), _typed('ab'))}{_integral('b')}{_integral('a')}"
            f"{_typed('f(x,y)')}{_sine('mπx', 'a')}{_sine('nπy', 'b')}"
            f"<mtext>\N{THIN SPACE}</mtext>{_typed('dxdy,')}{_FREQUENCY}",
            "B_mn = 4/(ab) int_0^b int_0^a f(x, y) sin(m pi x / a) sin(n pi y / b) dx dy, "
            "lambda_mn = c pi sqrt(m^2/a^2 + n^2/b^2)",
            "(3)",
        ),
        Equation(_typed("f(x,y)=dO(x)p(y)"), "f(x, y) = d O(x) p(y)", "(4)"),
        Equation(_parabola_typed("O", "x", "8.393", "1.3322"), "O(x) = -8.393e-6 x^2 + 0.002 x + 1.3322", "(5)"),
        Equation(_parabola_typed("p", "y", "8.1904", "0.9876"), "p(y) = -8.1904e-6 y^2 + 0.002 y + 0.9876", "(6)"),
    ),
    "Equations (7) and (8)": (
        Equation(
            f"{_typed('u(x,y)=−39.2012')}<mi>cos</mi>{_typed('(1.7409t)')}{_sine('πx', '23.6053')}"
            f"{_sine('πy', '23.6053')}",
            "u(x, y) = -39.2012 cos(1.7409 t) sin(pi x / 23.6053) sin(pi y / 23.6053)",
            "(7)",
        ),
        Equation(
            f"{_typed('t=')}{_over(_typed('1'), _lowered('λ'))}<msup><mi>cos</mi><mrow>{_typed('−1')}</mrow></msup>"
            f"{_over('<mtext>collision depth</mtext>', _typed('β'))}{_typed(',β=')}{_sine('πx', 'a')}"
            f"{_sine('πy', 'a')}",
            "t = acos(collision depth / beta) / lambda_mn, beta = sin(pi x / a) sin(pi y / a)",
            "(8)",
        ),
    ),
}
"""The article's equations as it prints them, by the section of the page."""


def table_one_items(chain: Chain) -> tuple[Item, ...]:
    """Return the items; what the article measured on its phantom is measured on the synthetic session."""
    return (
        *_parabola("O(x), eq. (5)", "O", printed.PARABOLA_X, chain),
        *_parabola("p(y), eq. (6)", "p", printed.PARABOLA_Y, chain),
        depth_factor(),
        squared_speed(),
        *(mode_number(name) for name in ("m", "n")),
        *(_side(name, chain) for name in ("a", "b")),
        *_wave(),
        _frequency_in_si(),
    )


def _parabola(label: str, name: str, parabola: printed.Parabola, chain: Chain) -> list[Item]:
    vertex = -0.5 * parabola.first / parabola.second
    specimen = "synthetic " if chain.synthetic else ""
    reason = (
        f"measured on the article's phantom, whose trials are not published; this is the mean over {chain.trials} "
        f"{specimen}trials in the same way, in which markers on opposite sides of the tool cancel; the printed vertex "
        f"lies at {vertex:.0f}, so it is a fit over frame numbers, used as if they were mm"
    )
    values = (parabola.second, parabola.first, parabola.constant)
    return [
        compare(
            f"Table 1: {label}, {POWERS[place]}",
            value,
            chain.variables.get(f"published.{name}_{2 - place}"),
            reason,
            UNITS[place],
            SESSION,
        )
        for place, value in enumerate(values)
    ]


def depth_factor() -> Item:
    """Return d of eq. (4): what makes f the depth of the tool in the middle of the window."""
    middle = np.array([0.5 * printed.SIDE])
    shape = float(printed.PARABOLA_X(middle)[0] * printed.PARABOLA_Y(middle)[0])
    reason = (
        f"f = d O p must be the {PRESS_MM:g} mm of section 3.3.3 in the middle of the window; with the printed d it is "
        f"{printed.DEPTH_FACTOR * shape:.2f} mm there"
    )
    return compare("Table 1: d", printed.DEPTH_FACTOR, PRESS_MM / shape, reason, "mm")


def squared_speed() -> Item:
    """Return c^2 from the printed c."""
    reason = (
        "the square of the printed c; T and rho are not printed, and with T in N and rho in kg/m³, as eq. (1) has "
        "them, T / rho would not be m²/s²"
    )
    return compare("Table 1: c²", printed.SPEED_SQUARED, printed.SPEED**2, reason, "m²/s²")


def mode_number(name: str) -> Item:
    """Return m or n of the largest coefficient of eq. (3)."""
    size = np.abs(PublishedWave("corrected", MODES).coefficient)
    place = np.unravel_index(int(size.argmax()), size.shape)[0 if name == "m" else 1]
    share = float(size[0, 0] ** 2 / (size**2).sum())
    reason = (
        f"assumed, not computed, in the article; m = n = 1 is the largest of the first {MODES} x {MODES} coefficients "
        f"of eq. (3) and holds {100 * share:.0f} % of the sum of their squares, for f is a nearly flat box"
    )
    return compare(f"Table 1: {name}", 1.0, float(place + 1), reason)


def _side(name: str, chain: Chain) -> Item:
    reason = (
        "the diameter of the largest circle through the nine markers: that of another specimen, whose markers are 8 mm "
        f"apart, for the article's trials are not published; its own c and lambda give {side_of_frequency():.4f} mm"
    )
    return compare(f"Table 1: {name}", printed.SIDE, chain.variables.get(f"published.{name}"), reason, "mm", SESSION)


def side_of_frequency(frequency: float = printed.FREQUENCY, speed: float = printed.SPEED) -> float:
    """Return a = b in mm that gives lambda_11 with c, the printed ones."""
    return float(speed * np.pi * np.sqrt(2.0) / frequency)


def _wave() -> Sequence[Item]:
    units: Mapping[float, str] = {printed.SPEED: "m/s", printed.FREQUENCY: "1/ms", printed.COEFFICIENT: "mm"}
    spans = {printed.SPEED: rounding_span(np.sqrt, printed.SPEED_SQUARED)}
    return [
        compare(
            f"Table 1: {row.item}",
            row.printed,
            row.value,
            row.reason,
            units[row.printed],
            span=spans.get(row.printed),
        )
        for row in table_one()
    ]


def _frequency_in_si() -> Item:
    value = float(PublishedWave("corrected").frequency[0, 0])
    reason = "with a in m like c, lambda is in 1/s: the printed one divides m/s by mm"
    return compare("Table 1: lambda_11 taken per second, as eq. (2) does", printed.FREQUENCY, value, reason, "1/s")


def equation_items() -> tuple[Item, ...]:
    """Return the items of eqs. (7) and (8)."""
    return (*_equation_7(), *_equation_8())


def _equation_7() -> list[Item]:
    as_printed, corrected = PublishedWave("as_printed"), PublishedWave("corrected")
    amplitude = float(corrected.coefficient[0, 0]) / MILLI
    frequency = float(as_printed.frequency[0, 0])
    side, (low, high) = side_of_frequency(), rounding_span(side_of_frequency, printed.FREQUENCY, printed.SPEED)
    why_side = f"from the printed c and lambda; their rounding leaves {low:.4f} to {high:.4f} mm"
    middle = np.array([0.5 * as_printed.side])
    deep = float(as_printed.deflection(middle, middle, 0.0)[0, 0]) / MILLI
    return [
        compare(
            "Eq. (7): amplitude by eq. (3), downwards",
            -printed.COEFFICIENT,
            -amplitude,
            "eq. (3) as it stands; the printed number follows if sin(n pi y / b) is written as sin(pi x / a)",
            "mm",
        ),
        compare(
            "Eq. (7): amplitude as B_11 of Table 1",
            -printed.COEFFICIENT,
            printed.COEFFICIENT,
            "Table 1 prints it with the other sign: eq. (7) counts upwards, f of eq. (4) downwards",
            "mm",
        ),
        compare("Eq. (7): factor of t", printed.FREQUENCY, frequency, "c in m/s over a in mm", "1/ms"),
        *(
            compare(f"Eq. (7): side under {axis}", printed.SIDE, side, why_side, "mm", span=(low, high))
            for axis in ("x", "y")
        ),
        compare(
            "Eq. (7): depth in the middle at t = 0, against the press of section 3.3.3",
            PRESS_MM,
            deep,
            "the wave starts some twenty times as deep as the tool ever was: d, in no proper unit, carries into B_11",
            "mm",
        ),
    ]


def _equation_8() -> list[Item]:
    """Depths fed to eq. (8) and read off eq. (7) again; the article expects what was fed."""
    beyond = "acos(depth / beta) has no value beyond a depth of 1, for beta is at most 1: eq. (8) lacks the amplitude"
    multiple = "eq. (8) lacks the amplitude, so that eq. (7) gives B_11 times the depth that was fed"
    circular = "acos(depth / (|B_11| beta)) / lambda returns what it is fed: circular, it predicts nothing"
    label = "Eq. (8): depth read off eq. (7) for {:g} mm fed in, {}"
    return [
        compare(label.format(1.0, "as printed"), 1.0, _replayed("as_printed", 1.0), multiple, "mm"),
        compare(label.format(PRESS_MM, "as printed"), PRESS_MM, _replayed("as_printed", PRESS_MM), beyond, "mm"),
        compare(
            label.format(PRESS_MM, "with the amplitude put in"),
            PRESS_MM,
            _replayed("corrected", PRESS_MM),
            circular,
            "mm",
        ),
    ]


def _replayed(variant: str, depth_mm: float) -> float | None:
    wave = PublishedWave(variant)
    middle = 0.5 * wave.side
    try:
        return float(wave.replay(np.array([MILLI * depth_mm]), middle, middle)[0]) / MILLI
    except WaveError:
        return None
