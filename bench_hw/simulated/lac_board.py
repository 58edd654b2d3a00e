"""The firmware of the simulated LAC board: a packet in, a packet out, and an actuator that obeys."""

from __future__ import annotations

from bench_hw.clock import Clock
from bench_hw.devices.lac_wire import COUNTS, LARGEST, Code, packet, parse
from bench_hw.simulated.bench import VirtualBench

FACTORY = {
    Code.SET_ACCURACY: 4,
    Code.SET_RETRACT_LIMIT: 0,
    Code.SET_EXTEND_LIMIT: LARGEST,
    Code.SET_SPEED: LARGEST,
}
"""Settings at power-on and after RESET."""


class LacBoard:
    """A board with an actuator on it.

    Parameters
    ----------
    bench : VirtualBench
        What its actuator moves.
    clock : Clock
        Its clock.
    max_speed : float
        Speed of the actuator at the largest speed value, m/s.
    """

    def __init__(self, bench: VirtualBench, clock: Clock, max_speed: float = 0.020) -> None:
        self._bench, self._clock, self._max_speed = bench, clock, max_speed
        bench.motion.resolution = bench.motion.stroke / COUNTS
        self.settings: dict[Code, int] = {}
        self.eeprom_writes = 0
        self.received: list[bytes] = []
        self._restore()

    @property
    def target(self) -> float:
        """Where the actuator was last sent, m."""
        with self._bench.lock:
            return self._bench.motion.target

    def handle(self, data: bytes) -> bytes | None:
        """Obey one packet and give the answer; None for bytes that are no command."""
        self.received.append(data)
        command = parse(data)
        if command is None or command[0] not in set(Code) or command[1] > LARGEST:
            return None
        code, value = Code(command[0]), command[1]
        with self._bench.lock:
            self._bench.advance(self._clock.now())
            if code is Code.GET_FEEDBACK:
                return packet(code, self._feedback())
            if code is Code.SET_POSITION:
                self._send_to(value)
                return packet(code, self._feedback())
            self._set(code, value)
        return packet(code, value)

    def _set(self, code: Code, value: int) -> None:
        if code is Code.RESET:
            self._restore()
        elif code is Code.DISABLE_MANUAL:
            self.eeprom_writes += 1
        else:
            self.settings[code] = value
            self._apply()

    def _restore(self) -> None:
        self.settings = dict(FACTORY)
        self._apply()

    def _apply(self) -> None:
        motion = self._bench.motion
        motion.speed = self.settings[Code.SET_SPEED] / LARGEST * self._max_speed
        motion.dead_band = self.settings[Code.SET_ACCURACY] * motion.stroke / COUNTS

    def _send_to(self, value: int) -> None:
        low, high = self.settings[Code.SET_RETRACT_LIMIT], self.settings[Code.SET_EXTEND_LIMIT]
        self._bench.motion.target = min(max(value, low), high) * self._bench.motion.stroke / COUNTS

    def _feedback(self) -> int:
        motion = self._bench.motion
        return min(LARGEST, max(0, round(motion.reading() / motion.stroke * COUNTS)))
