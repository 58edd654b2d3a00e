"""Simulated twins of the devices: real endpoints that speak the same bytes, with any fault on demand.

`VirtualBench` is the physics they share: a specimen under a tool on an actuator. `NetFTBox` (UDP and HTTP),
`LacUsbBackend` (pyusb) and `CameraServer` (HTTP MJPEG) are what drivers connect to. Import each from its own
module: this package loads none of them.
"""
