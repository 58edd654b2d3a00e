"""Force curves of Bruker's NanoScope to blocks: the header's lines, and the counts behind it that they give a scale.

A header is lines `Key: value` in sections, each behind a backslash. A value `V [Sens. Zsens] (0.006 V/LSB) 12 V` is in
volts, which the sensitivity of that name turns into lengths. Each `Ciao force image list` is a channel: little-endian
counts, those of the approach first, both from one end of the ramp to the other (NanoScope 8.10 User Guide, "General
format for CIAO parameter objects"). At which end the tip touches is found out by the deflection. Maps are refused.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from bench_hw.errors import TableError
from bench_hw.instrument_files.blocks import Block, block_of_arrays
from bench_hw.instrument_files.vocabulary import HeaderFact, unit_scale
from bench_hw.storage.regular_file import DOCUMENT, read_regular
from bench_hw.tables.units import FloatArray

Section = Mapping[str, str]
HEADER_END: Final = b"\\*File list end"
CURVE: Final = "Ciao force image list"
LINES: Final = "Ciao force list"
RAMPS: Final = ("@Ramp size Zsweep", "@Ramp size", "@Ramp Size", "@Z scan size")
"""Keys of the ramp's length, of newer and older versions."""
MOST_VOLTS: Final = 100.0
"""Beyond which a count's volts are no reading of a photodiode or a sensor: the scale is another one's."""
_VALUE: Final = re.compile(
    r"V (?:\[(?P<sensitivity>[^\]]*)\] )?(?:\((?P<step>[-+.\deE]+) [^)]*\) )?(?P<value>[-+.\deE]+) ?(?P<unit>\S*)"
)


@dataclass(frozen=True, eq=False)
class Channel:
    """Counts of approach and retract (each (n,)), with the volts of one and the m of a volt."""

    approach: np.ndarray
    retract: np.ndarray
    volts: float
    metres: float

    def lengths(self, flipped: bool) -> tuple[FloatArray, FloatArray]:
        """Approach and retract in the order of time, m; `flipped` where the counts begin where the tip touches."""
        scale = self.volts * self.metres
        first, second = (self.approach[::-1], self.retract) if flipped else (self.approach, self.retract[::-1])
        return scale * first, scale * second


def nanoscope_blocks(path: Path) -> list[Block]:
    """The one curve of a file, approach and retract: times where the header tells speeds, force, the tip's position.

    The position is the sensor's, or else the ramp's, less the cantilever's bending.

    Raises
    ------
    TableError
        The file holds pictures or a map of curves, breaks off, or lacks a scale or the spring constant.
    """
    raw = read_regular(path, DOCUMENT)
    head, end, _ = raw.partition(HEADER_END)
    sections = list(_sections(head.decode("latin-1")))
    images = [section for name, section in sections if name == CURVE]
    if not end or not images:
        allowed = "a single force curve, or its export as text"
        raise TableError(path, "this NanoScope file holds no force curve", allowed)
    if any(name == "Ciao image list" for name, _ in sections):
        raise TableError(path, "this NanoScope file is a map of force curves", "its curves, each saved on its own")
    bend = _channel(path, raw, sections, _named(path, images, "deflection"))
    flipped = _touches_first(bend)
    bent = bend.lengths(flipped)
    ways = _ways(path, raw, sections, images, [each.size for each in bent], flipped)
    if ways[0][-1] < ways[0][0]:
        ways = (-ways[0], -ways[1])
    stiffness = _spring_constant(path, images)
    columns = {
        "force": stiffness * np.concatenate(bent),
        "tip position": np.concatenate(ways) - np.concatenate(bent),
    }
    time = _times(path, sections, [each.size for each in bent])
    columns, units = ({"time": time, **columns} if time is not None else columns), {"force": "N", "tip position": "m"}
    facts = [HeaderFact("spring constant", f"{stiffness:g}", "N/m")]
    return [block_of_arrays(path, "", columns, {"time": "s", **units}, facts)]


def _sections(text: str) -> Iterator[tuple[str, Section]]:
    """The sections in order; the group number in front of a key (`@4:Z scale`) is taken off."""
    name, lines = "", dict[str, str]()
    for line in text.splitlines():
        if line.startswith("\\*"):
            yield name, lines
            name, lines = line.removeprefix("\\*").strip(), {}
        elif line.startswith("\\"):
            key, _, value = re.sub(r"^\\@\d+:", r"\\@", line).partition(":")
            lines[key.removeprefix("\\").strip()] = value.strip()
    yield name, lines


def _find(sections: Sequence[tuple[str, Section]], *keys: str) -> str:
    """What the first section with one of the keys says; "" where none does."""
    return next((section[key] for key in keys for _, section in sections if key in section), "")


def _named(path: Path, images: Sequence[Section], word: str) -> Section:
    found = [image for image in images if word in image.get("@Image Data", "").casefold()]
    if not found:
        listed = ", ".join(image.get("@Image Data", "?") for image in images)
        raise TableError(path, f"no channel is the {word} (it has {listed})", f"a curve saved with the {word}")
    return found[0]


def _value(path: Path, key: str, text: str) -> re.Match[str]:
    found = _VALUE.match(text)
    if found is None:
        raise TableError(
            path, f"the header's {key!r} says {text!r}", "a value with its scale, V [Sens. ...] (... V/LSB) ..."
        )
    return found


def _sensitivity(path: Path, sections: Sequence[tuple[str, Section]], name: str) -> float:
    """The length of a volt, m, that the header tells by a name (`Sens. DeflSens`)."""
    key = f"@{name}"
    found = _value(path, key, _find(sections, key))
    scale = unit_scale(found["unit"].partition("/")[0].replace("~", "u"), "m")
    if scale is None:
        raise TableError(path, f"the header's {key!r} has the unit {found['unit']!r}", "a length a volt, nm/V")
    return float(found["value"]) * scale


def _channel(path: Path, raw: bytes, sections: Sequence[tuple[str, Section]], image: Section) -> Channel:
    samples = [int(each) for each in (image.get("Samps/line") or _find(sections, "Samps/line")).split()]
    retract, approach = samples[0], samples[-1]
    offset, length = int(image["Data offset"]), int(image["Data length"])
    width = length // max(retract + approach, 1)
    if width not in (2, 4) or offset + length > len(raw):
        problem = f"a channel of {length} bytes from byte {offset}, for {approach} and {retract} points"
        raise TableError(path, f"{problem}, in a file of {len(raw)} bytes", "a whole file of 2 or 4 bytes a point")
    counts = np.frombuffer(raw, f"<i{width}", retract + approach, offset)
    scale = _value(path, "@Z scale", image.get("@Z scale", ""))
    if not scale["step"] or not scale["sensitivity"]:
        allowed = "a value with its scale, V [Sens. ...] (... V/LSB) ..."
        raise TableError(path, f"the header's '@Z scale' says {image['@Z scale']!r}", allowed)
    step = float(scale["step"])
    if step * float(np.abs(counts.astype(float)).max(initial=0.0)) > MOST_VOLTS:
        problem = f"counts of {width} bytes by {step:g} V/LSB are more than {MOST_VOLTS:g} V"
        raise TableError(path, problem, "a scale of these counts; or the curve's export as text")
    metres = _sensitivity(path, sections, scale["sensitivity"])
    return Channel(counts[:approach], counts[approach:], step, metres)


def _touches_first(bend: Channel) -> bool:
    """Whether the counts begin at the end of the ramp where the tip touches: there the deflection is larger."""
    part = max(1, bend.approach.size // 20)
    return float(bend.approach[:part].mean()) > float(bend.approach[-part:].mean())


def _ways(
    path: Path,
    raw: bytes,
    sections: Sequence[tuple[str, Section]],
    images: Sequence[Section],
    sizes: Sequence[int],
    flipped: bool,
) -> tuple[FloatArray, FloatArray]:
    """The stage's way in approach and retract, m: by its sensor where that is kept, else even steps of the ramp."""
    sensors = [image for image in images if "height sensor" in image.get("@Image Data", "").casefold()]
    if sensors:
        return _channel(path, raw, sections, sensors[0]).lengths(flipped)
    ramp = _ramp(path, sections)
    return np.arange(sizes[0]) * ramp / sizes[0], np.arange(sizes[1])[::-1] * ramp / sizes[1]


def _ramp(path: Path, sections: Sequence[tuple[str, Section]]) -> float:
    """The ramp's length, m."""
    found = _value(path, RAMPS[0], _find(sections, *RAMPS))
    return float(found["value"]) * _sensitivity(path, sections, found["sensitivity"] or "Sens. Zsens")


def _spring_constant(path: Path, images: Sequence[Section]) -> float:
    told = next((value for image in images for key, value in image.items() if key.casefold() == "spring constant"), "")
    try:
        stiffness = float(told.split()[0])
    except (IndexError, ValueError):
        stiffness = 0.0
    if not stiffness > 0.0:
        allowed = "a calibrated curve (N/m in its header)"
        raise TableError(path, "the cantilever's spring constant is not in the file", allowed)
    return stiffness


def _times(path: Path, sections: Sequence[tuple[str, Section]], sizes: Sequence[int]) -> FloatArray | None:
    """Times of approach and retract, s, by their speeds or else the rate of whole ramps; None where none is told."""
    forward, reverse = (_number(_find(sections, f"{way} vel.")) for way in ("Forward", "Reverse"))
    if forward > 0.0 and reverse > 0.0:
        found = _value(path, RAMPS[0], _find(sections, *RAMPS))
        durations = [float(found["value"]) / forward, float(found["value"]) / reverse]  # ramp in V, speeds in V/s
    elif (rate := _number(_find([each for each in sections if each[0] == LINES], "Scan rate"))) > 0.0:
        durations = [0.5 / rate, 0.5 / rate]
    else:
        return None
    still = _number(_find(sections, "Ramp delay"))
    into = np.arange(sizes[0]) * durations[0] / sizes[0]
    return np.concatenate([into, durations[0] + still + np.arange(sizes[1]) * durations[1] / sizes[1]])


def _number(text: str) -> float:
    try:
        return float(text.split()[0])
    except (IndexError, ValueError):
        return 0.0
