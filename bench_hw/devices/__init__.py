"""Drivers of the bench's devices behind three small protocols; their simulated twins are in `simulated`.

Import a driver from its own module (`devices.netft`, `devices.lac`, ...): only the protocols are re-exported,
so that importing this package loads no device library.
"""

from bench_hw.devices.protocols import (
    Actuator,
    CameraDriver,
    CameraFrame,
    CameraHealth,
    DeviceInfo,
    ForceBlock,
    ForceSensor,
    StreamHealth,
)

__all__ = [
    "Actuator",
    "CameraDriver",
    "CameraFrame",
    "CameraHealth",
    "DeviceInfo",
    "ForceBlock",
    "ForceSensor",
    "StreamHealth",
]
