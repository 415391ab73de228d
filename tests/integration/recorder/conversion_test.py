#!/usr/bin/env python3
"""A recorded drive is converted to Foxglove's schemas, and PyPI's `mcap` and protobuf read every message by the schemas in the file
alone; converted to messages of ROS 2, PyPI's `rosbags` reads every one by the definitions in the file. Exit code 77 where the packages cannot be installed.

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
          "/slammot/pose", "/slammot/graph", "/map/ways", "/slammot/ways"}


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

    def test_rosbags_reads_every_message_of_ros_2(self):
        bag = self.work / "ros2.mcap"
        subprocess.run([ARGUMENTS.slammot, "bag", "convert", self.recording, "--output", bag, "--format", "ros2"], check=True)
        messages = {}
        with AnyReader([bag]) as reader:
            for connection, _, data in reader.messages():
                messages.setdefault(connection.topic, []).append(reader.deserialize(data, connection.msgtype))
        rows = [list(map(float, row.split())) for row in (self.work / "result" / "online.tum").read_text(encoding="utf-8").splitlines()]
        for topic in ("/scan", "/pose", "/odom", "/tf", "/tracks", "/scan/points"):
            self.assertAlmostEqual(len(rows), len(messages[topic]), delta=0.02 * len(rows), msg=topic)
        pose = messages["/pose"][-1]
        row = min(rows, key=lambda row: abs(row[0] - pose.header.stamp.sec - 1e-9 * pose.header.stamp.nanosec))
        for own, other in [(pose.pose.position.x, row[1]), (pose.pose.position.y, row[2]), (abs(pose.pose.orientation.w), abs(row[7]))]:
            self.assertAlmostEqual(own, other, delta=2e-3)
        scan = messages["/scan"][-1]
        self.assertAlmostEqual(scan.angle_max, scan.angle_min + scan.angle_increment * (len(scan.ranges) - 1), places=4)
        echoes = [value for value in scan.ranges if value < float("inf")]
        self.assertTrue(0 < max(echoes) < scan.range_max, (max(echoes), scan.range_max))
        odometry = messages["/odom"][-1]
        self.assertEqual(("odom", "base"), (odometry.header.frame_id, odometry.child_frame_id))
        covariance = odometry.pose.covariance.reshape(6, 6)
        self.assertLess(abs(covariance - covariance.T).max(), 1e-9)
        self.assertTrue(all(covariance[i, i] > 0.0 for i in (0, 1, 5)))
        self.assertEqual([("map", "odom"), ("odom", "base"), ("base", "laser_" + scan.header.frame_id.removeprefix("laser_"))],
                         [(part.header.frame_id, part.child_frame_id) for part in messages["/tf"][-1].transforms])
        self.assertEqual({"box", "label"}, {marker.ns for array in messages["/tracks"] for marker in array.markers})
        grid = messages["/map/stationary"][-1]
        self.assertEqual(grid.info.width * grid.info.height, len(grid.data))
        self.assertEqual({-1, 0, 100}, set(grid.data.tolist()))
        # the scans and poses of the bag are a log like any other
        done = subprocess.run([ARGUMENTS.slammot, "check", bag], capture_output=True, text=True, check=False)
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        self.assertNotIn("are left out", done.stdout)

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
    from rosbags.highlevel import AnyReader
    unittest.main(argv=sys.argv[:1])
