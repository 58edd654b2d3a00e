"""What a reader of the wave's results must know: warnings in words, with figures."""

from collections.abc import Iterator

import numpy as np

from wavemodel.integrators.load_history import History
from wavemodel.layered.body_options import verified_depth
from wavemodel.layered.press import Press
from wavemodel.specimen import DiscTool

SMALL_STRAIN = 0.05
SUBLAYER_ERROR = 0.003
BORDER_COST = 0.005
INERTIA = 0.02


def notices(press: Press, tool: DiscTool, history: History, method: str, ringing: float) -> tuple[str, ...]:
    """Warnings of one run.

    Parameters
    ----------
    press, tool
        The set-up.
    history
        The run.
    method
        "quasi_static" or "exact".
    ringing
        About what inertia adds, over the peak.
    """
    inertia = _inertia(ringing) if method == "quasi_static" else iter(())
    return (*_strain(press, tool, history), *_sublayers(press), *_border(press), *inertia)


def _strain(press: Press, tool: DiscTool, history: History) -> Iterator[str]:
    pressed, pulled, height = float(history.depth.max()), -float(history.depth.min()), press.stack.height
    deepest, of_stack = max(pressed, pulled), f"of the {height * 1e3:.3g} mm stack"
    verified = verified_depth(tool, height)
    if press.field.large is None:
        if deepest > SMALL_STRAIN * height:
            yield (
                f"layered wave: the deepest press, {deepest * 1e3:.3g} mm, is {_percent(deepest / height, 3)} "
                f"{of_stack}; this wave is linear, for small strain (up to about {100 * SMALL_STRAIN:.0f} %)"
            )
        return
    if pressed > verified:
        yield (
            f"layered wave: the deepest press, {pressed * 1e3:.3g} mm, is {_percent(pressed / height, 3)} {of_stack} "
            f"and beyond the {verified * 1e3:.3g} mm to which the large-press correction is verified under this tool"
            f"{_continued(press, pressed)}"
        )
    if pulled > SMALL_STRAIN * height:
        yield (
            f"layered wave: a pull to {pulled * 1e3:.3g} mm above the surface is followed in small strain (up to about "
            f"{100 * SMALL_STRAIN:.0f} % {of_stack}): finite strain is worked out for a push"
        )


def _continued(press: Press, deepest: float) -> str:
    large = press.field.large
    if large is None or deepest <= large.followed:
        return ""
    return f", and from {large.followed * 1e3:.3g} mm on, its last equilibrium, the law goes straight along its tangent"


def _sublayers(press: Press) -> Iterator[str]:
    if press.sublayer_error > SUBLAYER_ERROR:
        yield (
            f"layered wave: the sub-layers cost {_percent(press.sublayer_error)} of a layer's peak against exact "
            "layered elasticity; left automatic they cost 0.05 %"
        )


def _border(press: Press) -> Iterator[str]:
    if press.border_cost > BORDER_COST:
        yield (
            f"layered wave: the border of the {press.field.domain.width * 1e3:.4g} mm window costs up to "
            f"{_percent(press.border_cost)} of a layer's peak; an automatic window costs 0.1 %"
        )


def _inertia(ringing: float) -> Iterator[str]:
    if ringing > INERTIA:
        yield (
            "layered wave: inertia is left out, though the load changes fast enough for it to add about "
            f"{_percent(ringing)} of the peak; the integrator 'exact' follows it"
        )


def _percent(share: float, digits: int = 2) -> str:
    """A share in so many significant digits of a percentage, without a power of ten."""
    plain = np.format_float_positional(100.0 * share, digits, unique=False, fractional=False, trim="-")
    return f"{plain} %"
