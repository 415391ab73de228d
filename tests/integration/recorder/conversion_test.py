#!/usr/bin/env python3
"""A recorded drive is converted to Foxglove's schemas, and PyPI's `mcap` and protobuf read every message by the schemas in the file
alone. Exit code 77 where the packages cannot be installed.

Usage: conversion_test.py --slammot SLAMMOT --venv FOLDER"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import python_environment
from recorded_drive import record_drive

ALWAYS = {"/scan", "/scan/points", "/tracks", "/pose", "/trajectory", "/tf", "/map/stationary", "/map/moving", "/slammot/tracks",
          "/slammot/pose", "/slammot/graph"}


class Schemas:
    """Message classes made of nothing but a file's schemas."""

    def __init__(self):
        self.classes = {}

    def decode(self, schema, message):
        if schema.encoding == "jsonschema":
            return json.loads(message.data)
        if schema.id not in self.classes:
            pool = descriptor_pool.DescriptorPool()
            for file in descriptor_pb2.FileDescriptorSet.FromString(schema.data).file:
                pool.Add(file)
            self.classes[schema.id] = message_factory.GetMessageClass(pool.FindMessageTypeByName(schema.name))
        return self.classes[schema.id].FromString(message.data)


class Conversion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="slammot-conversion-")
        cls.work = pathlib.Path(cls.folder.name)
        cls.recording = record_drive(ARGUMENTS.slammot, cls.work)
        cls.converted = cls.work / "viewers.mcap"
        subprocess.run([ARGUMENTS.slammot, "bag", "convert", cls.recording, "--output", cls.converted], check=True)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_every_message_is_decoded_by_the_schemas_in_the_file(self):
        schemas, messages, times = Schemas(), {}, []
        with open(self.converted, "rb") as file:
            for schema, channel, message in make_reader(file, validate_crcs=True).iter_messages():
                messages.setdefault(channel.topic, []).append(schemas.decode(schema, message))
                times.append(message.log_time)
        self.assertLessEqual(ALWAYS, messages.keys())
        self.assertEqual(sorted(times), times)
        scans = len((self.work / "result" / "online.tum").read_text(encoding="utf-8").splitlines())
        for topic in ("/pose", "/tf", "/tracks", "/scan/points"):
            self.assertAlmostEqual(scans, len(messages[topic]), delta=0.02 * scans, msg=topic)
        points = messages["/scan/points"][-1]
        self.assertEqual(0, len(points.data) % points.point_stride)
        grid = messages["/map/stationary"][-1]
        self.assertEqual(0, len(grid.data) % grid.row_stride)
        self.assertGreater(max(len(scene.entities) for scene in messages["/tracks"]), 0)
        print({topic: len(values) for topic, values in sorted(messages.items())}, self.recording.stat().st_size, self.converted.stat().st_size)

    def test_an_existing_file_and_a_file_without_drive_are_refused_in_one_line(self):
        for path, words in [(self.recording, "File exists"), (self.work / "nothing.mcap", "no topic that viewers know")]:
            source = self.recording if path.exists() else self.converted
            done = subprocess.run([ARGUMENTS.slammot, "bag", "convert", source, "--output", path], capture_output=True, text=True, check=False)
            self.assertEqual((1, 1), (done.returncode, len(done.stderr.splitlines())), done.stderr)
            self.assertIn(words, done.stderr)
        self.assertFalse((self.work / "nothing.mcap").exists())


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--slammot", required=True)
    parser.add_argument("--venv", type=pathlib.Path, required=True)
    ARGUMENTS = parser.parse_args()
    python_environment.enter(ARGUMENTS.venv)
    from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
    from mcap.reader import make_reader
    unittest.main(argv=sys.argv[:1])
