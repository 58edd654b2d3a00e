"""`LacActuator`: a linear actuator with potentiometer feedback (Actuonix L16) on its LAC board.

The board takes a target and a speed and moves by itself; the driver turns metres into counts, keeps the
travel limits in the board and in software, and checks each answer. Packets and USB link are in `lac_usb`.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from bench_hw.devices.lac_usb import COUNTS, GUARDED, LARGEST, WHERE, Code, LacLink
from bench_hw.devices.protocols import Connection, DeviceInfo
from bench_hw.errors import DeviceError

if TYPE_CHECKING:
    from usb.backend import IBackend


class LacActuator(Connection):
    """Driver of the LAC board.

    Parameters
    ----------
    stroke : float
        Length of travel of the actuator, m.
    max_speed : float
        Speed at the board's largest speed value, m/s; the board sets the motor's power, so the true speed
        depends on the load and is recorded, not assumed.
    accuracy : int
        Dead band around the target, counts (factory setting 4: +-0.195 mm on 50 mm).
    serial : str, optional
        USB serial number the board must have.
    backend : usb.backend.IBackend, optional
        USB backend; by default libusb.
    timeout : float
        Longest wait for one packet, s.
    """

    def __init__(
        self,
        stroke: float,
        *,
        max_speed: float = 0.020,
        accuracy: int = 4,
        serial: str | None = None,
        backend: IBackend | None = None,
        timeout: float = 0.1,
    ) -> None:
        self._stroke, self._max_speed, self._accuracy = stroke, max_speed, accuracy
        self._serial, self._backend, self._timeout = serial, backend, timeout
        self._link: LacLink | None = None
        self._limits = (0, LARGEST)
        self._speed_value: int | None = None
        self._counts: int | None = None

    @property
    def info(self) -> DeviceInfo:
        """Serial number and settings.

        Raises
        ------
        DeviceError
            Not connected.
        """
        settings = {
            "stroke": f"{self._stroke * 1e3:g} mm",
            "accuracy": f"{self._accuracy} counts",
            "uncertainty": f"{self.uncertainty * 1e3:.3g} mm",
            "max_speed": f"{self._max_speed * 1e3:g} mm/s",
        }
        return DeviceInfo("Actuonix LAC", self._opened().serial, "", settings)

    @property
    def uncertainty(self) -> float:
        """Half-width within which it stops around a target, m: dead band and half a count."""
        return (self._accuracy + 0.5) * self._stroke / COUNTS

    @property
    def counts(self) -> int | None:
        """The board's last reading, 0 to 1023; None before the first."""
        return self._counts

    def connect(self) -> None:
        """Find the board, set its dead band, read its position; nothing moves.

        Raises
        ------
        DeviceError
            No board, another serial number, no permission, or no answer.
        """
        self.close()
        self._link = LacLink(self._serial, self._backend, self._timeout)
        self._speed_value = None
        try:
            self.command(Code.SET_ACCURACY, self._accuracy)
            self.position()
        except DeviceError:
            self.close()
            raise

    def set_limits(self, low: float, high: float) -> tuple[float, float]:
        """Set the travel limits (m from fully retracted) in the board and in this driver; give them in whole counts.

        Raises
        ------
        DeviceError
            The limits are empty or outside the stroke, or the board does not take them.
        """
        allowed = f"allowed is 0 mm <= low < high <= {self._stroke * 1e3:g} mm"
        if not 0.0 <= low < high <= self._stroke * (1.0 + 1e-9):
            raise DeviceError(f"{WHERE}: travel {low * 1e3:g} to {high * 1e3:g} mm; {allowed}")
        counts = (math.ceil(self._to_counts(low)), min(LARGEST, math.floor(self._to_counts(high))))
        self.command(Code.SET_RETRACT_LIMIT, counts[0])
        self.command(Code.SET_EXTEND_LIMIT, counts[1])
        self._limits = counts
        return counts[0] * self._stroke / COUNTS, counts[1] * self._stroke / COUNTS

    def position(self) -> float:
        """Ask for the present position, m; a lost answer is asked for once more.

        Raises
        ------
        DeviceError
            Unplugged, or no answer twice.
        """
        try:
            self._counts = self.command(Code.GET_FEEDBACK)
        except DeviceError:
            self._counts = self.command(Code.GET_FEEDBACK)
        return self._counts * self._stroke / COUNTS

    def move_to(self, position: float, speed: float) -> None:
        """Start moving to `position` (m) at `speed` (m/s); returns at once.

        Raises
        ------
        DeviceError
            Outside the travel limits, a speed the actuator has not, or no answer.
        """
        low, high = self._limits
        exact = self._to_counts(position)
        if not low - 1.0 < exact < high + 1.0:
            span = f"{low * self._stroke / COUNTS * 1e3:.2f} to {high * self._stroke / COUNTS * 1e3:.2f} mm"
            raise DeviceError(f"{WHERE}: target {position * 1e3:.3f} mm is outside the travel of {span}")
        if not 0.0 < speed <= self._max_speed * (1.0 + 1e-9):
            raise DeviceError(
                f"{WHERE}: speed {speed * 1e3:g} mm/s; allowed is above 0 to {self._max_speed * 1e3:g} mm/s"
            )
        self._set_speed(max(1, round(speed / self._max_speed * LARGEST)))
        self._counts = self.command(Code.SET_POSITION, min(max(round(exact), low), high))

    def halt(self) -> None:
        """Stop where it is: the present position becomes the target."""
        here = self.command(Code.GET_FEEDBACK)
        self._counts = self.command(Code.SET_POSITION, min(max(here, self._limits[0]), self._limits[1]))

    def retract(self) -> None:
        """Start moving to the lower limit at full speed; searches for the board again if it was lost.

        Raises
        ------
        DeviceError
            The board does not take the command: the tool goes where it was last sent. Try again.
        """
        if self._link is None:
            self._link = LacLink(self._serial, self._backend, self._timeout)
        try:
            self._link.send(Code.SET_POSITION, self._limits[0])
            self._link.flush()
            self._link.send(Code.SET_SPEED, LARGEST)
            self._link.flush()
        except DeviceError:
            self.close()
            raise
        self._speed_value = LARGEST

    def command(self, code: Code, value: int = 0) -> int:
        """Send any unguarded command and give the value of its answer.

        Raises
        ------
        DeviceError
            A guarded command, not connected, unplugged, no answer or a wrong one.
        ValueError
            A value outside 0 to 1023.
        """
        if code in GUARDED:
            raise DeviceError(f"{WHERE}: {code.name} is guarded; use the method made for it")
        return self._opened().exchange(code, value)

    def disable_manual(self, *, write_eeprom: bool) -> None:
        """Save the settings to EEPROM and switch the board's own potentiometers off.

        Raises
        ------
        DeviceError
            `write_eeprom` is not True (the EEPROM wears, and the potentiometers stay off), or no answer.
        """
        if write_eeprom is not True:
            raise DeviceError(f"{WHERE}: DISABLE_MANUAL writes the EEPROM; allowed with write_eeprom=True only")
        self._opened().exchange(Code.DISABLE_MANUAL)

    def reset(self, *, lose_settings: bool) -> None:
        """Go back to the factory settings, limits included.

        Raises
        ------
        DeviceError
            `lose_settings` is not True, or no answer.
        """
        if lose_settings is not True:
            raise DeviceError(f"{WHERE}: RESET throws limits away; allowed with lose_settings=True only")
        self._opened().exchange(Code.RESET)
        self._limits, self._speed_value = (0, LARGEST), None

    def close(self) -> None:
        """Give the board back; it keeps its last target. May be repeated."""
        if self._link is not None:
            self._link.close()
            self._link = None

    def _set_speed(self, value: int) -> None:
        if value != self._speed_value:
            self.command(Code.SET_SPEED, value)
            self._speed_value = value

    def _to_counts(self, position: float) -> float:
        return position / self._stroke * COUNTS

    def _opened(self) -> LacLink:
        if self._link is None:
            raise DeviceError(f"{WHERE}: not connected")
        return self._link
