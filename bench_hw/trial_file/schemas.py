"""The channels of a trial file and their JSON schemas.

Pictures and events follow Foxglove's well-known schemas, so that Foxglove shows them; force and depth have
schemas of their own, raw counts beside SI values. Every message is one JSON object in UTF-8.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import Any

_INTEGER = {"type": "integer"}
_NUMBER = {"type": ["number", "null"]}
_TIME = {"type": "object", "title": "time", "properties": {"sec": _INTEGER, "nsec": _INTEGER}}
_AXES = {"type": "object", "properties": {"x": _NUMBER, "y": _NUMBER, "z": _NUMBER}}


@dataclass(frozen=True)
class ChannelInfo:
    """A channel as the file defines it.

    Parameters
    ----------
    topic : str
        Name of the channel in the file, `/force`.
    schema_name : str
        Name of its schema, `foxglove.Log`.
    schema_data : bytes
        The schema itself.
    schema_encoding, message_encoding : str
        `jsonschema` and `json` for everything this bench writes.
    metadata : tuple of (str, str)
        Whatever else a file says about the channel.
    """

    topic: str
    schema_name: str
    schema_data: bytes
    schema_encoding: str = "jsonschema"
    message_encoding: str = "json"
    metadata: tuple[tuple[str, str], ...] = field(default=())

    @property
    def name(self) -> str:
        """The channel's name in results: `force` for `/force`."""
        return self.topic.lstrip("/")


def _channel(topic: str, name: str, description: str, properties: dict[str, Any]) -> ChannelInfo:
    schema = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": name,
        "description": description,
        "type": "object",
        "properties": properties,
    }
    return ChannelInfo(topic, name, json.dumps(schema, separators=(",", ":")).encode())


FORCE = _channel(
    "/force",
    "tissuebench.ForceTorque",
    "One sample of the force/torque sensor in its own axes: N, N m, and raw counts (null if it has none).",
    {
        "rdt_sequence": _INTEGER,
        "ft_sequence": _INTEGER,
        "status": _INTEGER,
        "counts": {"type": ["array", "null"], "items": _INTEGER, "description": "Fx Fy Fz Tx Ty Tz"},
        "force": {**_AXES, "description": "N"},
        "torque": {**_AXES, "description": "N m"},
    },
)
DEPTH = _channel(
    "/depth",
    "tissuebench.Depth",
    "One position of the actuator, positive into the tissue.",
    {
        "depth": {**_NUMBER, "description": "m"},
        "counts": {"type": ["integer", "null"], "description": "the board's reading, 0 to 1023"},
        "target": {**_NUMBER, "description": "m, commanded"},
    },
)
CAMERA = _channel(
    "/camera",
    "foxglove.CompressedImage",
    "One picture as the camera encoded it.",
    {
        "timestamp": _TIME,
        "frame_id": {"type": "string"},
        "frame": {**_INTEGER, "description": "number of the frame"},
        "format": {"type": "string"},
        "data": {"type": "string", "contentEncoding": "base64"},
    },
)
EVENTS = _channel(
    "/events",
    "foxglove.Log",
    "Something that happened during the trial.",
    {
        "timestamp": _TIME,
        "level": {**_INTEGER, "description": "2 info, 3 warning, 4 error"},
        "message": {"type": "string"},
        "name": {"type": "string", "description": "the kind of event"},
        "file": {"type": "string"},
        "line": _INTEGER,
    },
)
CHANNELS: dict[int, ChannelInfo] = {1: FORCE, 2: DEPTH, 3: CAMERA, 4: EVENTS}
"""The channels of every trial this bench writes, by their number in the file."""
