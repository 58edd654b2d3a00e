"""Print the wave in finite strain against the finite elements, law by law: part of `make bench-accuracy`.

All layers of the shipped skin, and the phantom's sheet over its hole, by each law with the shear moduli that their
files give at rest; constants chosen before any comparison, so that the press is clearly not the neo-Hookean one.
"""

from __future__ import annotations

import os

for _name in ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[_name] = "1"  # before NumPy is loaded

from collections.abc import Callable, Iterator, Mapping  # noqa: E402
from types import MappingProxyType  # noqa: E402

from benchmark.files import Layer, load_scenario  # noqa: E402
from benchmark.files.tissue import (  # noqa: E402
    Fibre,
    Gent,
    MooneyRivlin,
    NeoHookean,
    Ogden,
    OgdenTerm,
    Yeoh,
)
from tests.performance.wave.tissues import Press, compare, row  # noqa: E402

LAWS: Mapping[str, Callable[[float], dict[str, object]]] = MappingProxyType(
    {
        "neo_hookean": lambda mu: {"hyperelastic": NeoHookean()},
        "yeoh, c20 = mu / 2, c30 = mu / 5": lambda mu: {
            "hyperelastic": Yeoh(law="yeoh", c10=mu / 2, c20=mu / 2, c30=mu / 5)
        },
        "yeoh, c20 = -mu / 50, c30 = mu / 100": lambda mu: {
            "hyperelastic": Yeoh(law="yeoh", c10=mu / 2, c20=-mu / 50, c30=mu / 100)
        },
        "gent, jm = 3": lambda mu: {"hyperelastic": Gent(law="gent", mu=mu, jm=3.0)},
        "mooney_rivlin, c01 = mu / 5": lambda mu: {
            "hyperelastic": MooneyRivlin(law="mooney_rivlin", c10=0.3 * mu, c01=0.2 * mu)
        },
        "ogden, alpha = 10": lambda mu: {
            "hyperelastic": Ogden(law="ogden", terms=(OgdenTerm(mu=0.2 * mu, alpha=10.0),))
        },
        "ogden, alpha = 2, -4": lambda mu: {
            "hyperelastic": Ogden(
                law="ogden", terms=(OgdenTerm(mu=0.5 * mu, alpha=2.0), OgdenTerm(mu=-0.25 * mu, alpha=-4.0))
            )
        },
        "fibres, k1 = mu, k2 = 2, 0.1 dispersed": lambda mu: {"fibre": Fibre(k1=mu, k2=2.0, dispersion=0.1)},
    }
)
"""Changes of a layer whose shear modulus at rest is mu, Pa."""
PLACES = (
    ("skin-5N", "uniform_pressure", 5.0),
    ("skin-5N", "rigid_bonded", 9.0),
    ("phantom", "uniform_pressure", 5.0),
    ("phantom", "rigid_bonded", 5.0),
)
"""Scenario, contact and peak, N."""


def presses() -> Iterator[Press]:
    """Each law at each place."""
    for base, contact, peak in PLACES:
        scenario = load_scenario(base, {"tool.contact": contact, "fem.mesh": "fine"})
        for law, of in LAWS.items():

            def changed(layer: Layer, of: Callable[[float], dict[str, object]] = of) -> Layer:
                return layer.model_copy(update=of(layer.shear_modulus))

            tissue = scenario.tissue.model_copy(update={"layers": tuple(map(changed, scenario.tissue.layers))})
            yield Press(f"{base}, {contact}: {law}", scenario.model_copy(update={"tissue": tissue}), peak)


def main() -> None:
    """Measure and print, Markdown."""
    print(
        "| press | peak N | depth over height, or hole radius | maximum % | profile % | deeper: maximum % | profile % |"
    )
    print("|---|---|---|---|---|---|---|")
    for press in presses():
        try:
            print(row(compare(press)).rsplit("|", 2)[0] + "|", flush=True)
        except ArithmeticError as error:
            print(f"| {press.name} | {press.peak:g} | {error} | - | - | - | - |", flush=True)


if __name__ == "__main__":
    main()
