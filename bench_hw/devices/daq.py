"""`DaqForceSensor`: a transducer's six gauge voltages on a DAQ, turned into a wrench by its .cal file.

Where the volts come from is behind `VoltageSource`: NI hardware (`NidaqmxSource`, optional extra `daq`), or a
simulated source among the twins. The DAQ's clock paces the samples; they are stamped when read and dated back by
their number.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from bench_hw.clock import Clock, MonotonicClock, wait_until
from bench_hw.devices.ati_calibration import AtiCalibration, read_calibration
from bench_hw.devices.protocols import Connection, DeviceInfo, ForceBlock, StreamHealth
from bench_hw.devices.rdt import Status, back_dated
from bench_hw.errors import DeviceError

SATURATED_ABOVE = 0.98
"""Share of the full scale above which a gauge voltage counts as saturated."""
_BIAS_TIME = 0.1
MISSING = "nidaqmx is not installed: pip install 'tissuebench[daq]', and install NI's NI-DAQmx driver"
_BUFFERED_SECONDS = 10


class VoltageSource(Protocol):
    """Six gauge voltages, sampled by hardware."""

    @property
    def name(self) -> str:
        """Where the voltages come from, for messages."""
        ...

    def start(self, rate: float) -> float:
        """Begin to sample at about `rate` Hz; give the rate it really has."""
        ...

    def available(self) -> int:
        """Give the number of samples waiting to be read."""
        ...

    def read(self, n: int) -> NDArray[np.float64]:
        """Take the n oldest samples, (n, 6), V; n must be available."""
        ...

    def close(self) -> None:
        """Stop and let go of the hardware; may be repeated."""
        ...


class DaqForceSensor(Connection):
    """A transducer read through a DAQ.

    Parameters
    ----------
    source : VoltageSource
        Where the voltages come from.
    calibration : pathlib.Path
        The transducer's .cal file.
    rate : float
        Samples per second wanted, Hz.
    serial : str, optional
        Serial number the calibration must have; another is refused.
    clock : Clock, optional
        The bench's clock.
    timeout : float
        Longest wait for the first sample, s.
    """

    def __init__(
        self,
        source: VoltageSource,
        calibration: Path,
        *,
        rate: float = 1000.0,
        serial: str | None = None,
        clock: Clock | None = None,
        timeout: float = 2.0,
    ) -> None:
        self._source, self._path, self._serial = source, calibration, serial
        self._wanted_rate, self._timeout = rate, timeout
        self._clock = clock or MonotonicClock()
        self._calibration: AtiCalibration | None = None
        self._rate = 0.0
        self._bias = np.zeros(6)
        self._count = 0
        self._previous = -math.inf

    @property
    def info(self) -> DeviceInfo:
        """Serial number and fingerprint of the calibration, and the rate.

        Raises
        ------
        DeviceError
            Not connected.
        """
        found = self._connected()
        settings = {"rate": f"{self.rate:g} Hz", "source": self._source.name, "calibration": str(self._path)}
        return DeviceInfo("ATI transducer on a DAQ", found.serial, found.fingerprint, settings)

    @property
    def rate(self) -> float:
        """Samples per second: what the hardware gave once started, else what was asked for, Hz."""
        return self._rate or self._wanted_rate

    @property
    def latency(self) -> float:
        """Time between two samples, s: each can be read as it comes."""
        return 1.0 / self.rate

    @property
    def ranges(self) -> NDArray[np.float64]:
        """Calibrated ranges of Fx..Tz, (6,), N and N m."""
        return self._connected().ranges

    @property
    def health(self) -> StreamHealth:
        """Samples received; a DAQ that loses samples raises in `read` instead of counting."""
        return StreamHealth(received=self._count)

    def connect(self) -> None:
        """Read the calibration and check its serial number; the hardware is first touched by `start`.

        Raises
        ------
        DeviceError
            The calibration is unusable or of another transducer.
        """
        found = read_calibration(self._path)
        if self._serial is not None and found.serial != self._serial:
            raise DeviceError(f"calibration {self._path}: serial {found.serial!r}; the rig asks for {self._serial!r}")
        self._calibration = found

    def start(self) -> None:
        """Begin to sample and wait for the first sample.

        Raises
        ------
        DeviceError
            Not connected, no hardware, or no sample in time.
        """
        self._connected()
        self._count, self._previous = 0, -math.inf
        self._rate = self._source.start(self._wanted_rate)
        if not wait_until(self._clock, lambda: self._source.available() > 0, self._timeout):
            raise DeviceError(f"{self._source.name}: no sample within {self._timeout:g} s of starting")

    def read(self) -> ForceBlock:
        """Give the samples that have come since the last call."""
        n = self._source.available()
        if n == 0:
            return ForceBlock.empty()
        volts = self._source.read(n)
        sequence = np.arange(self._count, self._count + n)
        self._count += n
        time = back_dated(self._clock.now(), self._previous, sequence, 1.0 / self.rate)
        self._previous = float(time[-1])
        counter = np.remainder(sequence, 2**32).astype(np.uint32)
        wrench = self._connected().wrench(volts, self._bias)
        return ForceBlock(time, wrench, counter, counter, self._status(volts))

    def bias(self) -> None:
        """Take the mean voltages of the next 0.1 s as zero.

        Raises
        ------
        DeviceError
            No sample came in that time.
        """
        self.read()
        self._clock.sleep(_BIAS_TIME)
        n = self._source.available()
        if n == 0:
            raise DeviceError(f"{self._source.name}: no sample within {_BIAS_TIME:g} s to take the bias from")
        self._bias = self._source.read(n).mean(axis=0)
        self._count += n

    def stop(self) -> None:
        """Stop the hardware."""
        self._source.close()

    def close(self) -> None:
        """Stop the hardware and let go of it; may be repeated."""
        self._source.close()

    def _status(self, volts: NDArray[np.float64]) -> NDArray[np.uint32]:
        over = np.any(np.abs(volts) > SATURATED_ABOVE * self._connected().full_scale, axis=1)
        return np.where(over, np.uint32(Status.ERROR | Status.SATURATED), np.uint32(0))

    def _connected(self) -> AtiCalibration:
        if self._calibration is None:
            raise DeviceError(f"{self._source.name}: not connected")
        return self._calibration


class NidaqmxSource:
    """Six differential analogue inputs, sampled on the board's clock.

    Parameters
    ----------
    channels : str
        NI's name of the inputs, for instance `Dev1/ai0:5`.
    full_scale : float
        Largest voltage, V.
    """

    def __init__(self, channels: str, full_scale: float = 10.0) -> None:
        self._channels = channels
        self._full_scale = full_scale
        self._task: Any = None

    @property
    def name(self) -> str:
        """NI's name of the inputs."""
        return f"DAQ {self._channels}"

    def start(self, rate: float) -> float:
        """Set the task up and start it; give the rate (Hz) the board can really do.

        Raises
        ------
        DeviceError
            nidaqmx or NI's driver is not installed, there is no such device, or it has not six inputs.
        """
        self.close()
        try:
            import nidaqmx
            from nidaqmx.constants import AcquisitionType, TerminalConfiguration
        except ImportError as error:
            raise DeviceError(MISSING) from error
        try:
            self._task = nidaqmx.Task()
            self._task.ai_channels.add_ai_voltage_chan(
                self._channels,
                terminal_config=TerminalConfiguration.DIFF,
                min_val=-self._full_scale,
                max_val=self._full_scale,
            )
            self._task.timing.cfg_samp_clk_timing(
                rate, sample_mode=AcquisitionType.CONTINUOUS, samps_per_chan=int(rate * _BUFFERED_SECONDS)
            )
            self._task.start()
            count, actual = len(self._task.ai_channels), float(self._task.timing.samp_clk_rate)
        except Exception as error:  # nidaqmx raises its own errors, whose type needs the driver
            self.close()
            raise DeviceError(f"{self.name}: {error}") from error
        if count != 6:
            self.close()
            raise DeviceError(f"{self.name}: {count} inputs; a transducer needs six, for instance Dev1/ai0:5")
        return actual

    def available(self) -> int:
        """Give the number of samples waiting in the board's buffer.

        Raises
        ------
        DeviceError
            Not started, or the board lost samples or was unplugged.
        """
        try:
            return int(self._started().in_stream.avail_samp_per_chan)
        except DeviceError:
            raise
        except Exception as error:
            raise DeviceError(f"{self.name}: {error}") from error

    def read(self, n: int) -> NDArray[np.float64]:
        """Take the n oldest samples, (n, 6), V.

        Raises
        ------
        DeviceError
            Not started, or the board lost samples or was unplugged.
        """
        task = self._started()
        try:
            return np.asarray(task.read(number_of_samples_per_channel=n, timeout=1.0), float).T.reshape(n, 6)
        except Exception as error:
            raise DeviceError(f"{self.name}: {error}") from error

    def close(self) -> None:
        """Stop and release the task; may be repeated."""
        task, self._task = self._task, None
        if task is not None:
            task.close()

    def _started(self) -> Any:
        if self._task is None:
            raise DeviceError(f"{self.name}: not started")
        return self._task
