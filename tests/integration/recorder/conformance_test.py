#!/usr/bin/env python3
"""PyPI's `mcap`, which shares nothing with our code, reads our files by every way it has, all checksums compared; and it
writes the same content as the same bytes. Exit code 77 where it cannot be installed.

Usage: conformance_test.py MCAP_EXAMPLE --venv FOLDER"""

import argparse
import io
import pathlib
import subprocess
import sys
import tempfile
import unittest

import python_environment

CHUNK_BYTES = 20_000  # as tests/support/mcap_example.hpp has it
MESSAGES = 200


def written_by_us(compression):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "example.mcap"
        subprocess.run([ARGUMENTS.mcap_example, str(path), compression], check=True)
        return path.read_bytes()


class Conformance(unittest.TestCase):
    def test_every_reader_finds_every_message(self):
        for compression in ("none", "lz4", "zstd"):
            data = written_by_us(compression)
            for kind in (NonSeekingReader, SeekingReader):
                reader = kind(io.BytesIO(data), validate_crcs=True)
                messages = list(reader.iter_messages())
                self.assertEqual(MESSAGES, len(messages), (compression, kind))
                self.assertEqual(sorted(m.log_time for _, _, m in messages), [m.log_time for _, _, m in messages])
                self.assertEqual({"scans", "poses"}, {channel.topic for _, channel, _ in messages})
                self.assertEqual({"omgidl"}, {schema.encoding for schema, _, _ in messages})

    def test_seeks_by_our_index(self):
        reader = SeekingReader(io.BytesIO(written_by_us("zstd")))
        some = list(reader.iter_messages(topics=["poses"], starting_at=1_500_000_000, ending_at=1_700_000_000))
        self.assertEqual(10, len(some))

    def test_checksums_of_data_and_summary_are_right(self):
        data = written_by_us("zstd")
        records = list(StreamReader(io.BytesIO(data), emit_chunks=True, validate_crcs=True).records)
        data_end = next(record for record in records if isinstance(record, DataEnd))
        footer = records[-1]
        place_of_data_end = footer.summary_start - 13  # opcode, length, checksum
        self.assertEqual(zlib.crc32(data[:place_of_data_end]), data_end.data_section_crc)
        self.assertEqual(zlib.crc32(data[footer.summary_start:-12]), footer.summary_crc)

    def test_the_same_content_gives_the_same_bytes(self):
        data = written_by_us("none")
        out = io.BytesIO()
        writer = Writer(out, chunk_size=CHUNK_BYTES, compression=CompressionType.NONE, enable_data_crcs=True)
        attachments = []
        reader = StreamReader(io.BytesIO(data), validate_crcs=True)
        in_data_section = True
        for record in reader.records:
            in_data_section = in_data_section and not isinstance(record, DataEnd)
            if isinstance(record, Header):
                writer.start(record.profile, record.library)
            elif not in_data_section:
                continue
            elif isinstance(record, Metadata):
                writer.add_metadata(record.name, record.metadata)
            elif isinstance(record, Schema):
                writer.register_schema(record.name, record.encoding, record.data)
            elif isinstance(record, Channel):
                writer.register_channel(record.topic, record.message_encoding, record.schema_id, record.metadata)
            elif isinstance(record, Message):
                writer.add_message(record.channel_id, record.log_time, record.data, record.publish_time, record.sequence)
                if len(attachments) == 0 and record.sequence == MESSAGES // 2 - 1 and record.channel_id == 2:
                    attachments.append(True)
                    writer.add_attachment(6, 5, "settings", "text/plain", b"hi")
        writer.finish()
        self.assertEqual(len(data), len(out.getvalue()))
        self.assertEqual(data, out.getvalue())


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("mcap_example")
    parser.add_argument("--venv", type=pathlib.Path, required=True)
    ARGUMENTS = parser.parse_args()
    python_environment.enter(ARGUMENTS.venv)
    import zlib
    from mcap.reader import NonSeekingReader, SeekingReader
    from mcap.records import Channel, DataEnd, Header, Message, Metadata, Schema
    from mcap.stream_reader import StreamReader
    from mcap.writer import CompressionType, Writer
    unittest.main(argv=sys.argv[:1])
