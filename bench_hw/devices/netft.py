"""`NetFTSensor`: an ATI force/torque sensor behind a Net F/T box, streaming over UDP (RDT).

Bytes, counters and stamps are in `rdt`, the socket and the web interface in `netft_network`. `read` drains the
socket to the newest record, so that no queue can grow stale.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from bench_hw.clock import Clock, MonotonicClock, wait_until
from bench_hw.devices import netft_network, rdt
from bench_hw.devices.netft_network import NetFTConfiguration, RdtSocket
from bench_hw.devices.protocols import Connection, DeviceInfo, ForceBlock, StreamHealth
from bench_hw.devices.rdt import Command, SequenceTracker, back_dated, describe, is_fault
from bench_hw.errors import DeviceError

_START_ATTEMPTS = 3
_BIAS_SETTLES = 0.02
_DATAGRAM_TIME = 0.01


def _records_per_datagram(rate: int) -> int:
    """Buffer size of buffered mode: a datagram each 10 ms or more often, so that a force limit is seen in time."""
    return min(max(1, round(rate * _DATAGRAM_TIME)), rdt.LARGEST_BUFFER)


class NetFTSensor(Connection):
    """Driver of the Net F/T box.

    Parameters
    ----------
    host : str
        Address of the box.
    rate : float
        Records per second wanted, Hz (1 to 7000); the box takes the nearest it can above, see `rate`.
    mode : str
        `realtime` (one record a datagram) or `buffered` (several: fewer datagrams, later).
    serial : str, optional
        Serial number the calibration must have; another is refused.
    http_port, rdt_port : int
        Ports of the box.
    clock : Clock, optional
        The bench's clock.
    timeout : float
        Longest wait for an answer, s.
    """

    def __init__(
        self,
        host: str,
        *,
        rate: float = 1000.0,
        mode: Literal["realtime", "buffered"] = "realtime",
        serial: str | None = None,
        http_port: int = rdt.HTTP_PORT,
        rdt_port: int = rdt.RDT_PORT,
        clock: Clock | None = None,
        timeout: float = 2.0,
    ) -> None:
        self._host, self._http_port, self._rdt_port = host, http_port, rdt_port
        self._wanted_rate, self._mode, self._wanted_serial = rate, mode, serial
        self._clock = clock or MonotonicClock()
        self._timeout = timeout
        self._socket: RdtSocket | None = None
        self._configuration: NetFTConfiguration | None = None
        self._tracker = SequenceTracker()
        self._waiting = ForceBlock.empty()
        self._previous = -math.inf

    @property
    def info(self) -> DeviceInfo:
        """Product, serial number and settings read back.

        Raises
        ------
        DeviceError
            Not connected.
        """
        found = self._connected()
        settings = {"rate": f"{found.rate} Hz", "mode": self._mode, "address": self._where()}
        return DeviceInfo(found.product or "ATI Net F/T", found.serial, found.fingerprint, settings)

    @property
    def rate(self) -> float:
        """RDT output rate as read back, Hz."""
        return float(self._connected().rate)

    @property
    def latency(self) -> float:
        """Time between two datagrams, s."""
        records = max(1, self._connected().buffer) if self._mode == "buffered" else 1
        return records * self._period()

    @property
    def ranges(self) -> NDArray[np.float64]:
        """Calibrated ranges of Fx..Tz, (6,), N and N m; NaN where the box does not say."""
        return np.asarray(self._connected().ranges)

    @property
    def health(self) -> StreamHealth:
        """Counts of the stream since `start`."""
        malformed = 0 if self._socket is None else self._socket.malformed
        return replace(self._tracker.health, malformed=malformed)

    def connect(self) -> None:
        """Read the configuration, check the serial number, set the rate and read it back.

        Raises
        ------
        DeviceError
            No answer, no Net F/T box, another serial number, RDT switched off, a fault in the status word, or
            a rate that does not read back.
        """
        self.close()
        found = netft_network.read_configuration(self._host, self._http_port, self._timeout)
        self._check(found)
        self._configuration = self._with_rate()
        self._socket = RdtSocket(self._host, self._rdt_port)

    def start(self) -> None:
        """Ask for a stream and wait for its first record.

        Raises
        ------
        DeviceError
            Not connected, or no record within the time-out after three requests.
        """
        begin = Command.START_BUFFERED if self._mode == "buffered" else Command.START_REALTIME
        opened = self._opened()
        opened.receive()
        self._tracker, self._previous, self._waiting = SequenceTracker(), -math.inf, ForceBlock.empty()
        for _ in range(_START_ATTEMPTS):
            opened.send(begin)
            if wait_until(self._clock, self._has_come, self._timeout / _START_ATTEMPTS):
                return
        raise DeviceError(
            f"force sensor at {opened.where}: no record within {self._timeout:g} s of the request to stream; "
            "check rdt_port, the firewall (UDP) and that no other client streams"
        )

    def read(self) -> ForceBlock:
        """Give the records that have come since the last call, duplicates dropped.

        Raises
        ------
        DeviceError
            Not connected, or the box refuses datagrams (it is gone).
        """
        block = self._waiting.before(self._received())
        self._waiting = ForceBlock.empty()
        return block

    def bias(self) -> None:
        """Have the box take the present load as zero, and let the records from before pass."""
        self._opened().send(Command.BIAS)
        self._clock.sleep(max(_BIAS_SETTLES, 2.0 * self._period()))
        self.read()

    def reset_latch(self) -> None:
        """Clear the condition latch, which a threshold crossed once leaves set."""
        self._opened().send(Command.RESET_LATCH)

    def stop(self) -> None:
        """Ask the box to stop streaming; does nothing if not connected."""
        if self._socket is not None:
            self._socket.send(Command.STOP)

    def close(self) -> None:
        """Stop the stream and close the socket; may be repeated."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None

    def _check(self, found: NetFTConfiguration) -> None:
        where = self._where()
        if self._wanted_serial is not None and found.serial != self._wanted_serial:
            raise DeviceError(
                f"force sensor at {where}: serial {found.serial!r}; the rig asks for {self._wanted_serial!r}"
            )
        if not found.enabled:
            raise DeviceError(f"force sensor at {where}: RDT is disabled; enable it on the box's web page")
        if is_fault(found.status):
            raise DeviceError(f"force sensor at {where}: status {found.status:#010x} ({describe(found.status)})")

    def _with_rate(self) -> NetFTConfiguration:
        asked = round(self._wanted_rate)
        try:
            expected = rdt.rate_of(asked)
        except ValueError as error:
            raise DeviceError(f"force sensor at {self._where()}: {error}") from error
        buffer = _records_per_datagram(expected) if self._mode == "buffered" else None
        netft_network.set_rate(self._host, self._http_port, asked, self._timeout, buffer)
        found = netft_network.read_configuration(self._host, self._http_port, self._timeout)
        if found.rate != expected:
            raise DeviceError(
                f"force sensor at {self._where()}: rate reads back as {found.rate} Hz after asking for "
                f"{asked} Hz; expected {expected} Hz"
            )
        return found

    def _has_come(self) -> bool:
        self._waiting = self._received()
        return len(self._waiting) > 0

    def _received(self) -> ForceBlock:
        received = self._opened().receive()
        if not received:
            return ForceBlock.empty()
        return self._block(np.concatenate(received), self._clock.now())

    def _block(self, records: NDArray[np.void], now: float) -> ForceBlock:
        number = records["rdt_sequence"].astype(np.uint32)
        sample = records["ft_sequence"].astype(np.uint32)
        keep, sequence = self._tracker.accept(number, sample)
        if not keep.any():
            return ForceBlock.empty()
        time = back_dated(now, self._previous, sequence[keep], self._period())
        self._previous = float(time[-1])
        counts = records["counts"][keep].astype(np.int32)
        status = records["status"][keep].astype(np.uint32)
        return ForceBlock(time, self._scaled(counts), number[keep], sample[keep], status, counts)

    def _scaled(self, counts: NDArray[np.int32]) -> NDArray[np.float64]:
        found = self._connected()
        scale = np.repeat([found.newton_per_count, found.newton_metre_per_count], 3)
        scaled: NDArray[np.float64] = counts * scale
        return scaled

    def _period(self) -> float:
        return rdt.divider_of(self._connected().rate) / rdt.INTERNAL_RATE

    def _opened(self) -> RdtSocket:
        if self._socket is None:
            raise DeviceError(f"force sensor at {self._where()}: not connected")
        return self._socket

    def _connected(self) -> NetFTConfiguration:
        if self._configuration is None:
            raise DeviceError(f"force sensor at {self._where()}: not connected")
        return self._configuration

    def _where(self) -> str:
        return f"{self._host}:{self._rdt_port}"
