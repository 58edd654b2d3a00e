"""The words of instruments: which quantity a column's name means, in which unit, and what a header line tells.

Words are those that the makers' software writes in English, German, French, Spanish, Italian, Portuguese, Polish,
Turkish, Chinese and Japanese. A name that is not here is no guess: it is asked for.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import date
from typing import Final

from bench_hw.configuration import parse_quantity

MM2: Final = 1e-6
UNITS: Final[dict[str, tuple[float, str]]] = {
    **dict.fromkeys(("s", "sec", "secs", "second", "seconds", "sek", "sekunden", "秒"), (1.0, "s")),
    "ms": (1e-3, "s"), "msec": (1e-3, "s"), "us": (1e-6, "s"), "µs": (1e-6, "s"),
    "min": (60.0, "s"), "h": (3600.0, "s"),
    "m": (1.0, "m"), "cm": (1e-2, "m"), "mm": (1e-3, "m"), "毫米": (1e-3, "m"), "um": (1e-6, "m"), "µm": (1e-6, "m"),
    "micron": (1e-6, "m"), "microns": (1e-6, "m"), "nm": (1e-9, "m"), "in": (0.0254, "m"), "inch": (0.0254, "m"),
    **dict.fromkeys(("inches", '"'), (0.0254, "m")), **dict.fromkeys(("mil", "mils", "thou"), (2.54e-5, "m")),
    "N": (1.0, "N"), "newton": (1.0, "N"), "newtons": (1.0, "N"), "牛": (1.0, "N"), "mN": (1e-3, "N"),
    "cN": (1e-2, "N"), "daN": (10.0, "N"),
    "uN": (1e-6, "N"), "µN": (1e-6, "N"), "nN": (1e-9, "N"), "pN": (1e-12, "N"), "kN": (1e3, "N"), "MN": (1e6, "N"),
    **dict.fromkeys(("g", "gf", "grams", "gram", "p"), (9.80665e-3, "N")),
    **dict.fromkeys(("kg", "kgf", "kp"), (9.80665, "N")),
    "mg": (9.80665e-6, "N"), "lbf": (4.4482216152605, "N"), "lb": (4.4482216152605, "N"), "lbs": (4.4482216152605, "N"),
    "ozf": (0.27801385095378125, "N"), "oz": (0.27801385095378125, "N"),
    "Pa": (1.0, "Pa"), "hPa": (1e2, "Pa"), "kPa": (1e3, "Pa"), "MPa": (1e6, "Pa"), "GPa": (1e9, "Pa"),
    "N/mm2": (1e6, "Pa"), "N/mm²": (1e6, "Pa"), "psi": (6894.757293168361, "Pa"),
    "%": (1e-2, "1"), "mm/mm": (1.0, "1"), "m/m": (1.0, "1"), "-": (1.0, "1"), "1": (1.0, "1"),
    "mm2": (MM2, "m2"), "mm²": (MM2, "m2"), "mm^2": (MM2, "m2"), "cm2": (1e-4, "m2"), "cm²": (1e-4, "m2"),
    "mm/s": (1e-3, "m/s"), "mm/sec": (1e-3, "m/s"), "mm/min": (1e-3 / 60.0, "m/s"), "µm/s": (1e-6, "m/s"),
    "V": (1.0, "V"), "mV": (1e-3, "V"), "°C": (1.0, "K"), "C": (1.0, "K"), "Hz": (1.0, "Hz"),
    "N/m": (1.0, "N/m"), "mN/m": (1e-3, "N/m"),
}  # fmt: skip
"""SI value and dimension of a unit as instruments write it; a gram in a column of forces is a gram-force."""

MASSES: Final = frozenset({"g", "gram", "grams", "kg", "mg", "lb", "lbs", "oz"})
"""Units of a mass, which a column of forces has for its weight."""
RELATIVE: Final = frozenset({"%", "mm/mm", "m/m"})
"""Units of a strain that no displacement has."""
_BY_FOLDED: Final = {unit.casefold(): unit for unit in reversed(UNITS)}
_CLASHING: Final = {"mn", "pa", "mpa", "m", "h", "s", "g", "c"}
"""Folded spellings that mean two things (mN and MN): only the exact one counts, but for those below."""
_FOLDED_ANYWAY: Final = {"S": "s", "SEC": "s", "PA": "Pa", "MPA": "MPa", "G": "g", "Mn": "mN"}


def unit_of(text: str) -> str | None:
    """The unit a cell spells, brackets around it taken off, as a key of `UNITS`; None where it is none."""
    bare = text.strip().strip("()[]{}").strip().replace("μ", "µ").replace("\u00a0", " ")
    bare = _FOLDED_ANYWAY.get(bare, bare)
    if bare in UNITS:
        return bare
    folded = bare.casefold()
    return None if folded in _CLASHING else _BY_FOLDED.get(folded)


def unit_scale(text: str, dimension: str) -> float | None:
    """SI value of one unit of a dimension; None where it is no such unit. Others than `UNITS` are read by pint."""
    unit = unit_of(text)
    if unit is not None:
        scale, found = UNITS[unit]
        return scale if found == dimension else None
    try:
        return parse_quantity(f"1 {text}", "" if dimension == "1" else dimension)
    except ValueError:
        return None


_BRACKETS = re.compile(r"(?P<label>.*?)\s*[(\[{](?P<unit>[^()\[\]{}]*)[)\]}]\s*")
_AFTER = re.compile(r"(?P<label>.+?)\s*(?:\s/\s|/|,\s*|\sin\s|_|\s)\s*(?P<unit>[^\s,_]+)\s*")


def label_and_unit(header: str) -> tuple[str, str]:
    """Split `Load (kN)`, `Force [N]`, `Weg / mm`, `Kraft in N`, `Size_mm` into label and unit; "" without one."""
    for pattern in (_BRACKETS, _AFTER):
        found = pattern.fullmatch(header.strip())
        if found and found["label"] and (unit := unit_of(found["unit"])) is not None:
            if pattern is _AFTER and found["unit"].strip("()[]").isdigit():
                break  # the first of several, `Dehnung 1`
            return found["label"].strip(), unit
    return header.strip(), ""


DIMENSIONS: Final = {
    "time": "s", "force": "N", "depth": "m", "displacement": "m", "position": "m", "gap": "m",
    "stress": "Pa", "strain": "1",
}  # fmt: skip
"""What each quantity is measured in."""

_QUALIFIED = r"(?:(?:ch|engineering|eng|nominal|running|axial|normal|vertical|compressive|compression|tensile|standard|test|primary|measured|tip|net|machine|digital|corrected|probe|actuator|tool|indenter|crosshead) )?"  # noqa: E501
_WORDS: Final[tuple[tuple[str, int, str], ...]] = (
    ("time", 0, r"time|(?:test|elapsed|total|running|run) time|zeit|pr(?:ü|ue|u)fzeit|testzeit|laufzeit|temps|tiempo|tempo|czas|godzina|zaman|时间|測試時間|测试时间|試験時間|経過時間|時間|t"),  # noqa: E501
    ("time", 1, r"time(?: ?stamp)?(?: \d+)?|series time|scan time|zeit \d+"),
    ("force", 0, r"force|load|(?:force|f) ?z|f ?n|f|kraft|standardkraft|pr(?:ü|ue|u)fkraft|normalkraft|druckkraft|last|si(?:ł|l)a|obci(?:ąż|az)enie|fuerza|carga|charge|effort|forza|kuvvet|y[uü]k|力|载荷|负荷|试验力|荷重|試験力"),  # noqa: E501
    ("force", 1, _QUALIFIED + r"(?:force|load)(?: (?:z|sensor))?|load ?cell|kraft(?: ?sensor| z| f)|weight|gewicht|poids|peso"),  # noqa: E501
    ("force", 2, _QUALIFIED + r"(?:force|load|load ?cell|kraft) \d+"),
    ("depth", 0, r"enfoncement|profondeur (?:d[’' ]?)?(?:indentation|enfoncement|p[eé]n[eé]tration)|p[eé]n[eé]tration|depth|indentation(?: depth)?|penetration(?: depth)?|eindring(?:tiefe|weg|ung)|profondeur|profundidad|压入深度|压痕深度|押込み深さ"),  # noqa: E501
    ("displacement", 0, r"displacement|disp|extension|travel|distance|stroke|standardweg|weg|verfahrweg|d[eé]placement|desplazamiento|przemieszczenie|wyd(?:ł|l)u(?:ż|z)enie|course|allongement|uzama|deplasman|spostamento|corsa|deslocamento|curso|位移|行程|変位|ストローク|つかみ具間変位|伸び"),  # noqa: E501
    ("displacement", 1, _QUALIFIED + r"(?:displacement|disp|extension|travel|distance|stroke|deflection|elongation|separation)|grip(?: to grip)? separation|traversenweg|verformung|deformation|stauchung|nutzweg|absolutweg|wegaufnehmer|变形|横梁位移"),  # noqa: E501
    ("displacement", 2, r"(?:absolute )?crosshead(?: travel)?|traverse(?:nweg)?(?: abs(?:olut)?)?|piezo|" + _QUALIFIED + r"(?:displacement|disp|extension) \d+"),  # noqa: E501
    ("gap", 0, r"gap|tool gap|spalt(?:ma(?:ß|ss)|h[oö]he|weite|breite)?|(?:current )?size|plate (?:separation|distance)|werkzeugabstand|abstand|entrefer|间隙|隙间"),  # noqa: E501
    ("position", 0, _QUALIFIED + r"(?:position|pos)|height|z|h[oö]he|position z|z position|tip position"),
    ("position", 1, r"height measured|z sensor|" + _QUALIFIED + r"(?:position|pos) \d+"),
    ("stress", 0, _QUALIFIED + r"stress|(?:druck|zug|nenn)?spannung|contrainte|esfuerzo|gerilme|napr(?:ęż|ez)enie|(?:压缩|拉伸)?应力|応力"),  # noqa: E501
    ("strain", 0, _QUALIFIED + r"strain(?: (?:extension|displacement|crosshead))?|dehnung|d[eé]formation relative|% uzama|birim uzama|(?:压缩|拉伸)?应变(?: 位移)?|歪み?|ひずみ"),  # noqa: E501
    ("strain", 1, _QUALIFIED + r"strain(?: strain)? \d+|extensometer strain|dehnung \d+|(?:nominelle |nenn|gesamt)(?:stauchung|dehnung)|odkszta(?:ł|l)cenie(?: \d+)?"),  # noqa: E501
)  # fmt: skip
_PATTERNS: Final = tuple((role, rank, re.compile(words)) for role, rank, words in _WORDS)


def plain(label: str) -> str:
    """A name as it is compared: lower case, one blank for what separates words."""
    return re.sub(r"[\s_\-.()\[\]:]+", " ", label).strip().casefold()


def role_of(label: str, unit: str = "") -> tuple[str, int] | None:
    """The quantity that a column's label means and how plainly (0 best); None where no word is known.

    A displacement in per cent is a strain: testXpert writes `Stauchung`, and `Standardweg` too, in either.
    """
    bare = plain(label)
    role, rank = next(((role, rank) for role, rank, pattern in _PATTERNS if pattern.fullmatch(bare)), ("", 0))
    if role == "displacement" and unit in RELATIVE:
        return "strain", rank
    return (role, rank) if role else None


CLOCK: Final = re.compile(
    r"(?:(?P<day>\d{4}-\d{2}-\d{2}|\d{1,2}\.\d{1,2}\.\d{4}|\d{1,4}/\d{1,2}/\d{1,4})(?:T|,? +))?"
    r"(?:(?P<hours>\d+):)?(?P<minutes>\d{1,2}):(?P<seconds>\d{2}(?:[.,]\d+)?)"
    r"(?P<half> ?[AaPp][Mm])?(?:Z| ?[+-]\d{2}:?\d{2})?",
    re.ASCII,
)
"""A time of the clock, `12:00:01.5`, with its day, `2024-03-01T12:00:01.5Z` or `01.03.2024 12:00:01`, or without."""


def clock_seconds(text: str) -> float | None:
    """Seconds since midnight of a clock, since 2000 where its day stands before it; None for any other text.

    A day with slashes, which has the month first in one country and second in another, does not count.
    """
    found = CLOCK.fullmatch(text) if ":" in text else None
    if found is None:
        return None
    day, hours, half = found["day"], int(found["hours"] or 0), (found["half"] or "").strip().casefold()
    hours = hours % 12 + 12 * (half == "pm") if half else hours
    seconds = 3600.0 * hours + 60.0 * int(found["minutes"]) + float(found["seconds"].replace(",", "."))
    if day is None or "/" in day:
        return seconds
    parts = [int(part) for part in (day.split("-") if "-" in day else day.split(".")[::-1])]
    try:
        return seconds + 86400.0 * (date(parts[0], parts[1], parts[2]) - date(2000, 1, 1)).days
    except ValueError:
        return None


@dataclass(frozen=True)
class HeaderFact:
    """A line of a header: its key, its value as written, and the unit ("" where none stands there)."""

    key: str
    value: str
    unit: str


_DIAMETER = r"diameter|durchmesser|dia|diam[eè]tre|di[aá]metro|直径"
_TOOL = r"probe|indenter|punch|tool|tip|plunger|stempel|indentor|bead|sphere|druckstempel|压头"
_SPECIMEN = r"specimen|sample|probe|proben|probek[oö]rper|test piece|试样"
_HEIGHT = r"height|thickness|h[oö]he|dicke|[eé]paisseur|espesor|高度|厚度"
FACTS: Final = {
    "tool_diameter": re.compile(rf"(?:{_TOOL}) ?(?:{_DIAMETER})|(?:{_DIAMETER}) (?:of )?(?:{_TOOL})"),
    "tool_radius": re.compile(rf"(?:{_TOOL}) ?(?:radius|rayon|半径)"),
    "height": re.compile(rf"(?:(?:initial|{_SPECIMEN}) ?)?(?:{_HEIGHT})|h ?0|gauge length|anvil height"),
    "specimen_diameter": re.compile(rf"(?:{_SPECIMEN}) ?(?:{_DIAMETER})|{_DIAMETER}|d ?0"),
    "area": re.compile(r"area|cross section(?:al)? area|querschnitt(?:sfl[aä]che)?|a ?0|s ?0|面积"),
    "spring_constant": re.compile(r"k|spring constant|cantilever stiffness|cantilever k"),
}  # fmt: skip
"""What a header may tell of tool and specimen, by its key in plain words (`Probendurchmesser` is the specimen's)."""

FACT_DIMENSIONS: Final = {
    "tool_diameter": "m", "tool_radius": "m", "height": "m", "specimen_diameter": "m", "area": "m2",
    "spring_constant": "N/m",
}  # fmt: skip

TA_PROBE = re.compile(
    r"\b(?P<size>\d+(?:[.,]\d+)?)\s*mm\b(?=.*\b(?:dia|cylinder|ball|spher|probe)|\s*\()", re.IGNORECASE
)
"""A probe's catalogue line, `P/10 10mm DIA CYLINDER ALUMINIUM`: its diameter."""
SPHERE = re.compile(r"\b(?:ball|spher\w*|bead|kugel)\b", re.IGNORECASE)
TENSION = re.compile(
    r"\b(?:tensile|tension|elongation|dehnung|zug(?:versuch|spannung)?|rozci(?:ą|a)gani\w*|traction)\b|拉伸",
    re.IGNORECASE,
)
COMPRESSION = re.compile(
    r"\b(?:compressive|compression|druck(?:versuch|spannung)?|stauch\w*|(?:ś|s)ciskani\w*)\b|压缩", re.IGNORECASE
)
