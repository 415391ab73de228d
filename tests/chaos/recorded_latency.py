"""Latencies from a recording of the bus (slammot record --compression none): from the writing of a scan to the reception of what
was made of it."""

import struct
from pathlib import Path

CHUNK, SCHEMA, CHANNEL, MESSAGE = 6, 3, 4, 5


def records(data, begin=0):
    """(operation, content) of each record of MCAP."""
    while begin + 9 <= len(data):
        operation, length = struct.unpack_from("<BQ", data, begin)
        yield operation, data[begin + 9:begin + 9 + length]
        begin += 9 + length


def text_at(data, begin):
    (length,) = struct.unpack_from("<I", data, begin)
    return data[begin + 4:begin + 4 + length].decode(), begin + 4 + length


def messages(path):
    """(topic, reception [ns], writing [ns], CDR) of each message."""
    topics = {}
    data = Path(path).read_bytes()

    def walk(content, begin):
        for operation, record in records(content, begin):
            if operation == CHUNK:
                compression, at = text_at(record, 28)
                assert not compression, f"compressed with {compression}"
                yield from walk(record, at + 8)
            elif operation == CHANNEL:
                topics[struct.unpack_from("<H", record)[0]] = text_at(record, 4)[0]
            elif operation == MESSAGE:
                channel, _, received, written = struct.unpack_from("<HIQQ", record)
                yield topics[channel], received, written, record[22:]

    yield from walk(data, 8)


def stamp_of(cdr, names):
    """The stamp that follows so many names. Types are @appendable in XCDR1 or XCDR2: the latter begins with a length."""
    begin = 4 if cdr[1] in (0, 1) else 8
    at = begin
    for _ in range(names):
        at = 4 + (at - 4 + 3) // 4 * 4
        (length,) = struct.unpack_from("<I", cdr, at)
        at += 4 + length
    alignment = 8 if begin == 4 else 4
    at = 4 + (at - 4 + alignment - 1) // alignment * alignment
    return struct.unpack_from("<q", cdr, at)[0]


def latencies_ms(path, source="slammot/laser_scan", result="slammot/tracked_objects", names=(2, 1)):
    """Of each result: since the writing of the scan that has its stamp. names: those before the stamp of each."""
    written, found = {}, []
    for topic, received_ns, written_ns, cdr in messages(path):
        if topic == source:
            written[stamp_of(cdr, names[0])] = written_ns
        elif topic == result:
            begin = written.get(stamp_of(cdr, names[1]))
            if begin is not None:
                found.append((received_ns - begin) / 1e6)
    return sorted(found)
