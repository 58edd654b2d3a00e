"""`Bench`: the devices of a rig together, connected and let go as one."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass, field
from types import TracebackType
from typing import TYPE_CHECKING, Self

from bench_hw.devices.protocols import Actuator, CameraDriver, DeviceInfo, ForceBlock, ForceSensor

if TYPE_CHECKING:
    from numpy import float64
    from numpy.typing import NDArray

    from bench_hw.rig.rig_file import Rig
    from bench_hw.simulated.replayed_trial import Replay
    from bench_hw.simulated.twins import Twins


@dataclass(slots=True)
class Bench:
    """A rig's devices.

    Parameters
    ----------
    rig : Rig
        What it was made from.
    force : ForceSensor
        The force sensor.
    actuator : Actuator
        The actuator.
    camera : CameraDriver or None
        The camera, if the rig has one.
    twins : Twins or None
        The simulated devices behind the drivers, if any.
    replay : Replay or None
        The recorded trial behind the drivers, if any.
    travel : tuple of 2 floats
        Lowest and highest position as the connected actuator has them, m.
    """

    rig: Rig
    force: ForceSensor
    actuator: Actuator
    camera: CameraDriver | None = None
    twins: Twins | None = None
    replay: Replay | None = None
    travel: tuple[float, float] = (0.0, 0.0)
    _infos: dict[str, DeviceInfo] = field(default_factory=dict)
    _opened: ExitStack = field(default_factory=ExitStack)

    def connect(self) -> None:
        """Connect every device, each checked to be the right one; nothing moves.

        Raises
        ------
        DeviceError
            The first device that is missing, wrong or silent; those connected before are let go.
        """
        with ExitStack() as stack:
            stack.enter_context(self.force)
            if self.camera is not None:
                stack.enter_context(self.camera)
            stack.enter_context(self.actuator)
            self.travel = self.actuator.set_limits(*self.rig.travel)
            self._infos = self._ask_infos()
            self._opened = stack.pop_all()

    def start(self) -> None:
        """Begin to stream.

        Raises
        ------
        DeviceError
            A device does not stream.
        """
        self.force.start()
        if self.camera is not None:
            self.camera.start()
        self._infos = self._ask_infos()

    def zero_force(self) -> None:
        """Take the present load as zero if the rig says so; the tool must be in air.

        Raises
        ------
        DeviceError
            The sensor is lost.
        """
        if self.rig.force.bias:
            self.force.bias()

    @property
    def contact(self) -> float | None:
        """Position at which the tool meets the specimen, m: as the rig says, or as it was in the replayed trial."""
        said = self.rig.actuator.contact
        return self.replay.zero if said is None and self.replay is not None else said

    def begin_trial(self, now: float) -> None:
        """Let a replayed trial begin again, with `now` (s of the clock) as the trial's time zero."""
        if self.replay is not None:
            self.replay.rewind(now)

    def catch_up(self) -> None:
        """Let simulated devices do what is due, however busy this machine is; real ones need no such help."""
        if self.twins is not None:
            self.twins.catch_up()

    def close(self) -> None:
        """Let every device go and switch the twins off; may be repeated."""
        self._opened.close()
        if self.twins is not None:
            self.twins.close()

    def press(self, block: ForceBlock) -> NDArray[float64]:
        """Press force of each sample, (n,) N, positive where the tool presses."""
        axis = self.rig.force.press_axis
        column = block.wrench[:, "xyz".index(axis[1])]
        return -column if axis[0] == "-" else column

    def infos(self) -> dict[str, DeviceInfo]:
        """What each device said of itself when it was connected or started."""
        return dict(self._infos)

    def _ask_infos(self) -> dict[str, DeviceInfo]:
        infos = {"force": self.force.info, "actuator": self.actuator.info}
        return infos if self.camera is None else {**infos, "camera": self.camera.info}

    def __enter__(self) -> Self:
        try:
            self.connect()
        except BaseException:
            self.close()
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
