"""The UDP end of a Net F/T client: requests out, datagrams of whole records in, never waiting."""

from __future__ import annotations

import socket

from bench_hw.devices import netft_wire
from bench_hw.devices.netft_wire import Command
from bench_hw.errors import DeviceError

_LARGEST_DATAGRAM = 65_536
_RECEIVE_BUFFER = 4 * 1024 * 1024
_MOST_DATAGRAMS = 8192


class RdtSocket:
    """A socket connected to one box: the kernel drops what other hosts send.

    Parameters
    ----------
    host : str
        Address of the box.
    port : int
        Its RDT port.

    Raises
    ------
    DeviceError
        The address means nothing or cannot be reached.
    """

    def __init__(self, host: str, port: int) -> None:
        self.where = f"{host}:{port}"
        self.malformed = 0
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _RECEIVE_BUFFER)
            self._socket.connect((host, port))
            self._socket.setblocking(False)
        except OSError as error:
            self._socket.close()
            raise self._failed(error) from error

    def send(self, command: Command) -> None:
        """Send one request.

        Raises
        ------
        DeviceError
            The box or the network refuses it.
        """
        try:
            self._socket.send(netft_wire.request(command))
        except OSError as error:
            raise self._failed(error) from error

    def receive(self) -> list[bytes]:
        """Give every datagram of whole records that has come, oldest first; others are counted `malformed`.

        Raises
        ------
        DeviceError
            The box refuses datagrams, or the network is down.
        """
        received: list[bytes] = []
        for _ in range(_MOST_DATAGRAMS):
            try:
                datagram = self._socket.recv(_LARGEST_DATAGRAM)
            except BlockingIOError:
                break
            except OSError as error:
                raise self._failed(error) from error
            if datagram and len(datagram) % netft_wire.RECORD.itemsize == 0:
                received.append(datagram)
            else:
                self.malformed += 1
        return received

    def close(self) -> None:
        """Ask the box to stop, if it still listens, and close."""
        try:
            self._socket.send(netft_wire.request(Command.STOP))
        except OSError:
            pass  # gone already: there is nobody to stop
        finally:
            self._socket.close()

    def _failed(self, error: OSError) -> DeviceError:
        if isinstance(error, ConnectionRefusedError):
            return DeviceError(f"force sensor at {self.where}: refuses datagrams; check rdt_port and power")
        return DeviceError(f"force sensor at {self.where}: {error.strerror or error}")
