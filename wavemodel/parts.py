"""What a press is put together from, before the contact traction is known: the modes' part and the remainder's."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.domains.domain import Domain
from wavemodel.layers.compliance import Compliance, compliance
from wavemodel.layers.laminate import Laminate
from wavemodel.loads.rigid import solve_contact
from wavemodel.loads.traction import Traction, TractionBasis
from wavemodel.remainder import Remainder, work
from wavemodel.taper import Taper


@dataclass(frozen=True)
class Parts:
    """Static response of the window and of the remainder to each of J basis tractions.

    Attributes
    ----------
    domain
        Window and modes.
    basis
        The tractions.
    modal
        Compliance of the sub-layers at the K wavenumbers of the modes.
    load
        (K, J, 2) of the tractions along U and W.
    share
        (K,) share of the load that the modes carry.
    rest
        Answer to what they leave out; None where they carry all.
    """

    domain: Domain
    basis: TractionBasis
    modal: Compliance
    load: FloatArray
    share: FloatArray
    rest: Remainder | None

    @cached_property
    def remainder_flexibility(self) -> FloatArray:
        """(J, J) work of each traction on the remainder's displacement under each other, m/N."""
        count = self.basis.net_force.size
        return np.zeros((count, count)) if self.rest is None else self.rest.flexibility

    @cached_property
    def flexibility(self) -> FloatArray:
        """(J, J) work of each traction on the whole displacement under each other, m/N."""
        weight = self.share * self.domain.axis_weight
        return np.asarray(work(self.load, self.modal.faces[:, 0], weight) + self.remainder_flexibility)

    def contact(self, rigid: bool) -> Traction:
        """The traction of unit force: solved for under a rigid tool, else the basis's only one."""
        return solve_contact(self.basis, self.flexibility) if rigid else Traction(self.basis, np.ones(1))


def parts(stack: Laminate, domain: Domain, basis: TractionBasis, taper: Taper, rest: Remainder | None) -> Parts:
    """Evaluate a stack on a window for the tractions of a tool."""
    k = domain.wavenumber
    return Parts(domain, basis, compliance(k, stack), basis.transform(k), taper.modes(k), rest)
