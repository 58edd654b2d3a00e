"""`NidaqmxSource`: gauge voltages from National Instruments hardware (optional extra `daq`)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import DeviceError

MISSING = "nidaqmx is not installed: pip install 'tissuebench[daq]', and install NI's NI-DAQmx driver"
_BUFFERED_SECONDS = 10


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
