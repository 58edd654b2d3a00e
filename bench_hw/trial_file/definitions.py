"""Which channel a number in a file stands for, from every place that says so.

The first chunk defines the channels; where it is damaged, the summary or the trial's metadata still know.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from bench_hw.trial_file.metadata import TRIAL
from bench_hw.trial_file.parsing import Summary
from bench_hw.trial_file.schemas import CHANNELS, ChannelInfo
from bench_hw.trial_file.walk import Walk


def known_channels(walk: Walk, summary: Summary | None) -> dict[int, ChannelInfo]:
    """Give the channels by their numbers.

    Parameters
    ----------
    walk : Walk
        What was met in the data.
    summary : Summary or None
        The summary, where it is whole.
    """
    from mcap.records import Channel, Schema

    records = () if summary is None else summary.records
    schemas = {record.id: record for record in records if isinstance(record, Schema)} | walk.schemas
    channels = {record.id: record for record in records if isinstance(record, Channel)} | walk.channels
    known = _from_metadata(walk.metadata.get(TRIAL, {}))
    return known | {number: _info(channel, schemas) for number, channel in channels.items()}


def _from_metadata(entries: Mapping[str, str]) -> dict[int, ChannelInfo]:
    ours = {info.topic: info for info in CHANNELS.values()}
    topics = json.loads(entries.get("channels", "{}"))
    return {int(number): ours[topic] for number, topic in topics.items() if topic in ours}


def _info(channel: Any, schemas: Mapping[int, Any]) -> ChannelInfo:
    schema = schemas.get(channel.schema_id)
    return ChannelInfo(
        topic=channel.topic,
        schema_name="" if schema is None else schema.name,
        schema_data=b"" if schema is None else schema.data,
        schema_encoding="" if schema is None else schema.encoding,
        message_encoding=channel.message_encoding,
        metadata=tuple(channel.metadata.items()),
    )
