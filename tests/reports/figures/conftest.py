"""Reading a figure back: its texts, and the lines drawn in a colour."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import numpy as np
import pytest

NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


@pytest.fixture
def texts():
    """Return the function that gives all texts of an SVG document."""

    def texts(svg: str) -> list[str]:
        return [element.text or "" for element in ElementTree.fromstring(svg).iter() if element.tag.endswith("}text")]

    return texts


@pytest.fixture
def lines():
    """Return the function that gives the points, shape (n, 2), of each line drawn in a colour of the palette."""

    def lines(svg: str, colour: str) -> list[np.ndarray]:
        found = []
        for element in ElementTree.fromstring(svg).iter():
            style = element.get("style", "")
            if element.tag.endswith("}path") and "fill: none" in style and f"stroke: var(--{colour}," in style:
                found.append(np.array(NUMBER.findall(element.get("d")), dtype=float).reshape(-1, 2))
        return found

    return lines


@pytest.fixture
def is_drawn():
    """Return the function that says whether a line's points are an affine picture of data, to 0.02 px."""

    def is_drawn(points: np.ndarray, x, y) -> bool:
        if len(points) != len(x):
            return False
        return all(
            np.abs(np.polyval(np.polyfit(data, pixels, 1), data) - pixels).max() < 0.02
            for data, pixels in ((x, points[:, 0]), (y, points[:, 1]))
        )

    return is_drawn


@pytest.fixture
def ramp():
    """Return steps, shape (24,), and the deflections of two layers in two models, shape (24, 2) each.

    They are curved, so that no point of a line can be left out when it is drawn.
    """
    step = np.arange(1, 25)
    fem = np.outer(np.sqrt(step / 24), [2.0, 1.5])
    return step, fem, fem * [1.1, 0.9]
