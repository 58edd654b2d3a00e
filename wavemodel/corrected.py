"""From the set-up of a linear press to its large-press correction."""

from wavemodel.errors import NotCoveredError, WaveError
from wavemodel.large_press.contact import BondedContact, Contact, PressureContact
from wavemodel.large_press.disc_modes import disc_modes, thickness_of
from wavemodel.large_press.equilibrium import Equilibrium
from wavemodel.large_press.law import LargePress, large_press
from wavemodel.large_press.modal_body import ModalBody
from wavemodel.large_press.path import follow
from wavemodel.press import Press
from wavemodel.specimen import DiscTool

RESOLUTION, MOST_MODES = 16.0, 256
"""Largest wavenumber times the tool's radius, and the most modes."""
BORDER = 0.75
"""Radius of the disc over the side of the window, which just lets the linear field die away."""
REACH, DEEP = 0.4, 0.75
"""The path goes to this depth, in heights of the stack; the second on demand."""
VERIFIED = 0.3
"""Compared with finite-strain FEM up to here, on four skins. Under a pressure on 2 to 8 mm of radius the maxima are
within 1.1 % and the profiles within 1.1 % of peak at every load; under a bonded rigid tool within 1.7 % and 2.7 %. A
radius of 1 mm presses up to 4.4 % off."""
FEWEST_LEVELS = 4


def correction(press: Press, tool: DiscTool, *, deep: bool = False) -> LargePress:
    """Set up the correction of a press.

    Parameters
    ----------
    press, tool
        What is pressed.
    deep
        Follow it to `DEEP`, and let the law go on from where the path ends, along its tangent, to the stack's height.

    Raises
    ------
    NotCoveredError
        For pretension, a free lower face, or a contact other than "uniform_pressure" and "rigid_bonded".
    WaveError
        If the stack finds no equilibrium beyond small loads.
    """
    if press.stack.tension is not None:
        raise NotCoveredError("the large-press correction does not cover pretension")
    if press.stack.base != "bonded":
        raise NotCoveredError("the large-press correction covers a bonded base, not a free lower face")
    if tool.contact not in ("uniform_pressure", "rigid_bonded"):
        raise NotCoveredError(
            f"the large-press correction does not cover tool contact {tool.contact!r}: 'uniform_pressure' and "
            "'rigid_bonded' are covered"
        )
    border = BORDER * press.field.domain.width
    limit = min(RESOLUTION / tool.radius, 3.1 * MOST_MODES / border)
    body = ModalBody(disc_modes(border, limit), thickness_of(press.stack))
    equilibrium = Equilibrium(body, contact_of(press, body))
    height = press.stack.height
    path = follow(equilibrium, height, (DEEP if deep else REACH) * height)
    if path.force.size < FEWEST_LEVELS:
        raise WaveError("large press: no equilibrium was found beyond a small load")
    radius = tool.radius if tool.rigid else 0.0
    return large_press(path, body.modes.wavenumber, press.compliance, radius, height if deep else 0.0)


def contact_of(press: Press, body: ModalBody) -> Contact:
    """How the tool of a press pushes the modes of a body."""
    basis = press.field.traction.basis
    if press.flexibility is None:
        return PressureContact(body, basis)
    return BondedContact(body, basis, press.flexibility)
