"""What may be said of a test's outcome: a t-test that does not reject is never called agreement."""

import math

from benchmark.comparison.equivalence import Equivalence
from benchmark.comparison.power import PassingRange
from benchmark.comparison.t_test import TwoSampleT


def describe_t_test(test: TwoSampleT, passing: PassingRange, power: float | None = None) -> str:
    """One paragraph on the pooled t-test, with the scale errors it lets pass and its `power` at the margin."""
    if math.isnan(test.p_value):
        return f"The two-sample t-test has no outcome: {test.note}."
    reach = f"It lets pass any scale error from {_percent(passing.low)} to {_percent(passing.high)}."
    if power is not None:
        reach += f" Its power to see a scale error as large as the equivalence margin is {100.0 * power:.3g} %."
    numbers = f"t = {test.t:.4g}, df = {test.df:.4g}, p = {test.p_value:.4g}, t critical = {test.t_critical:.6f}"
    if test.rejects:
        return f"The two-sample t-test rejects the hypothesis of one common mean ({numbers}). {reach}"
    return f"The two-sample t-test does not reject, which shows nothing either way ({numbers}). {reach}"


def describe_equivalence(test: Equivalence) -> str:
    """One paragraph on the equivalence test, with its margin."""
    margin = f"{100.0 * test.margin_fraction:.3g} % of the FEM's mean"
    found = f"p = {test.p_value:.3g}, 90 % interval of the difference {_share(test)}"
    if test.equivalent:
        return f"Equivalent within {margin} (TOST, {test.form.replace('_', '-')}: {found})."
    return f"Equivalence within {margin} is not shown (TOST, {test.form.replace('_', '-')}: {found})."


def _share(test: Equivalence) -> str:
    scale = 100.0 * test.margin_fraction / test.margin
    return f"{scale * test.ci90_low:+.3g} to {scale * test.ci90_high:+.3g} % of it"


def _percent(fraction: float) -> str:
    return "any size" if math.isinf(fraction) else f"{100.0 * fraction:+.1f} %"
