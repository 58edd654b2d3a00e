"""The dimension of an effect's parameter from its SI unit, for quantities as text."""

from __future__ import annotations

from benchmark.files.units import DIMENSIONS, Dimension

_NUMBER = Dimension("plain number", "", (("", 0.0),), "0.3 ")
_MORE = {
    "m/N": Dimension("compliance", "m/N", (("mm/N", 0.0),), "0.1 mm/N"),
    "N/m": Dimension("stiffness", "N/m", (("N/mm", 100.0), ("N/m", 0.0)), "1.5 N/mm"),
    "m^2/s": Dimension("diffusivity", "m^2/s", (("mm^2/s", 0.0),), "0.1 mm^2/s"),
    "kg": Dimension("mass", "kg", (("kg", 1.0), ("g", 0.0)), "20 g"),
}
_KNOWN = {**{each.si: each for each in DIMENSIONS if each.si}, **_MORE, "": _NUMBER}


def dimension_of(unit: str) -> Dimension:
    """The dimension whose SI unit is `unit` ("" for a plain number), with the units that people read it in."""
    spelled = {"m2/s": "m^2/s", "m**2/s": "m^2/s", "rad": "radian", "Hz": "1/s", "1/m": "m^-1"}.get(unit, unit)
    return _KNOWN.get(spelled, Dimension(f"quantity in {unit}", spelled, ((spelled, 0.0),), f"1 {spelled}"))


def shown(value: float, unit: str) -> tuple[float, str]:
    """A value in an SI unit as number and unit for a reader: lengths in mm, pressures in kPa, compliance in mm/N."""
    factor, name = _SHOWN.get(unit, (1.0, unit))
    return factor * value, name


_SHOWN = {
    "m": (1e3, "mm"),
    "Pa": (1e-3, "kPa"),
    "m/s": (1e3, "mm/s"),
    "m/N": (1e3, "mm/N"),
    "N/m": (1e-3, "N/mm"),
    "m2/s": (1e6, "mm^2/s"),
    "m^2/s": (1e6, "mm^2/s"),
    "m**2/s": (1e6, "mm^2/s"),
    "kg": (1e3, "g"),
}
