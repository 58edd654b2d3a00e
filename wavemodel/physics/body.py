"""Which effects a body has: all of them off by default."""

from dataclasses import dataclass

from wavemodel.integrators.prony import Prony
from wavemodel.physics.adhesion import Adhesion
from wavemodel.physics.course import Option
from wavemodel.physics.damping import ViscousDamping
from wavemodel.physics.drainage import PoroelasticDrainage
from wavemodel.physics.floor import Floor
from wavemodel.physics.friction import DryFriction
from wavemodel.physics.permanent_set import PermanentSet
from wavemodel.physics.pretension import Pretension
from wavemodel.physics.relaxation import Relaxation
from wavemodel.physics.slip import InterfaceSlip
from wavemodel.physics.softening import StressSoftening
from wavemodel.physics.stiffening import StrainStiffening


@dataclass(frozen=True)
class Physics:
    """Options of a body on top of an elastic law f(d), acting in this order.

    The tool meets the surface where `permanent_set` left it; `adhesion` says whether they touch. The elastic force is
    f, changed by `stiffening`, `pretension`, `floor`, `slip` and `softening`. It fades by `relaxation` and `drainage`,
    and `damping` and `friction` act beside it. A tool that is not held cannot be pulled.

    Attributes
    ----------
    stiffening, pretension, floor, slip, softening, permanent_set, relaxation, drainage, damping, friction, adhesion
        See the classes of these options.
    """

    stiffening: StrainStiffening | None = None
    pretension: Pretension | None = None
    floor: Floor | None = None
    slip: InterfaceSlip | None = None
    softening: StressSoftening | None = None
    permanent_set: PermanentSet | None = None
    relaxation: Prony | None = None
    drainage: PoroelasticDrainage | None = None
    damping: ViscousDamping | None = None
    friction: DryFriction | None = None
    adhesion: Adhesion | None = None

    @property
    def elastic(self) -> tuple[Option, ...]:
        """What changes the elastic force, in order."""
        chosen = (self.stiffening, self.pretension, self.floor, self.slip, self.softening)
        return tuple(option for option in chosen if option is not None)

    @property
    def fading(self) -> tuple[Option, ...]:
        """What lets the force fade, in order."""
        relaxation = None if self.relaxation is None else Relaxation(self.relaxation)
        return tuple(option for option in (relaxation, self.drainage) if option is not None)

    @property
    def beside(self) -> tuple[Option, ...]:
        """What acts beside the elastic force."""
        return tuple(option for option in (self.damping, self.friction) if option is not None)
