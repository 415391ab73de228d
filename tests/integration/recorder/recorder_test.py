#!/usr/bin/env python3
"""Recorded, played and recorded again every topic has the same messages, byte for byte, as PyPI's `mcap` reads them; a recorder that
is killed leaves a file that is recovered; a full disk ends a recording with a readable file. Exit code 77 where `mcap` cannot be
installed.

Usage: recorder_test.py --slammot SLAMMOT --publisher PUBLISH_EVERY_TOPIC --venv FOLDER"""

import argparse
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import python_environment

PATIENCE_S = 60
DOMAIN = str(1 + os.getpid() % 200)
VEHICLE = "test-car"  # of the publisher


class Publisher:
    """Writes to every topic of the table until it is left."""

    def __enter__(self):
        self.process = subprocess.Popen([ARGUMENTS.publisher, DOMAIN, f"recorder-{os.getpid()}"], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, text=True)
        os.environ["CYCLONEDDS_URI"] = self.process.stdout.readline().strip()
        self.topics = set()
        for line in self.process.stdout:
            if line == "ready\n":
                return self
            self.topics.add(line.split()[1])
        raise RuntimeError("the publisher ended before it was ready")

    def __exit__(self, *_):
        self.process.stdin.close()
        self.process.stdout.close()
        self.process.wait(PATIENCE_S)


def run(*arguments, **options):
    return subprocess.run([ARGUMENTS.slammot, *map(str, arguments)], capture_output=True, text=True, check=False,
                          timeout=PATIENCE_S, **options)


def start_recording(path, *arguments, **options):
    recording = subprocess.Popen([ARGUMENTS.slammot, "record", "--output", str(path), "--domain", DOMAIN, *arguments],
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)
    end = time.monotonic() + PATIENCE_S
    while not path.exists() and time.monotonic() < end:
        time.sleep(0.01)
    return recording


def messages_of(path):
    """{topic: [(source time, bytes)]}, all checksums compared."""
    messages = {}
    with open(path, "rb") as file:
        for schema, channel, message in make_reader(file, validate_crcs=True).iter_messages():
            assert schema.encoding == "omgidl" and channel.message_encoding == "cdr"
            messages.setdefault(channel.topic, []).append((message.publish_time, message.data))
    return messages


class Recorder(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        self.addCleanup(self.temporary.cleanup)

    def record_every_topic(self, name="first.mcap", seconds="3"):
        path = self.folder / name
        with Publisher() as publisher:
            recording = start_recording(path, "--duration", seconds)
            said = recording.communicate(timeout=PATIENCE_S)
        self.assertEqual(0, recording.returncode, said)
        self.assertIn(" 0 dropped", said[0])
        return path, publisher.topics

    def test_records_plays_and_records_the_same_messages(self):
        first, topics = self.record_every_topic()
        recorded = messages_of(first)
        self.assertEqual(topics, topics & recorded.keys())
        second = self.folder / "second.mcap"
        recording = start_recording(second)
        played = run("play", first, "--domain", DOMAIN, "--wait", "3")
        self.assertEqual(0, played.returncode, played.stderr)
        time.sleep(1)  # what was played reaches the recorder before it is stopped
        recording.send_signal(signal.SIGTERM)
        recording.communicate(timeout=PATIENCE_S)
        again = messages_of(second)
        for topic in topics:
            own = {"slammot/heartbeat", "slammot/status"}  # the recorders write these two, too
            if topic in own:
                self.assertLessEqual(set(recorded[topic]), set(again[topic]), topic)
            else:
                self.assertEqual(recorded[topic], again[topic], topic)

    def test_is_not_played_to_a_vehicle_whose_services_run(self):
        path, _ = self.record_every_topic()
        tracking = subprocess.Popen([pathlib.Path(ARGUMENTS.slammot).parent / "slammot-tracking", "--vehicle", VEHICLE, "--domain", DOMAIN,
                                     "--state-dir", self.folder / "state"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            self.assertIn(run("health", "tracking", "--vehicle", VEHICLE, "--domain", DOMAIN).returncode, (0, 3))
            refused = run("play", path, "--domain", DOMAIN)
            self.assertEqual(1, refused.returncode)
            self.assertIn(f"tracking of vehicle {VEHICLE} runs on this bus", refused.stderr)
            rest = run("play", path, "--domain", DOMAIN, "--topics", "slammot/laser_scan,slammot/localized_scan")
            self.assertEqual(0, rest.returncode, rest.stderr)
            self.assertIsNone(tracking.poll())
        finally:
            tracking.terminate()
            tracking.wait(PATIENCE_S)

    def test_a_part_without_a_message_is_not_played(self):
        path, _ = self.record_every_topic()
        for part in (("--from", "1000"), ("--topics", "slammot/laser_scan", "--from", "1000")):
            refused = run("play", path, "--domain", DOMAIN, "--loop", *part)
            self.assertEqual(1, refused.returncode)
            self.assertIn("no message to play in that time", refused.stderr)

    def test_a_killed_recorder_leaves_a_file_that_is_recovered(self):
        path = self.folder / "killed.mcap"
        with Publisher():
            recording = start_recording(path)
            time.sleep(4)
            recording.kill()
            recording.communicate()
        self.assertEqual(3, run("bag", "verify", path).returncode)
        recovered = self.folder / "recovered.mcap"
        self.assertEqual(0, run("bag", "recover", path, "--output", recovered).returncode)
        self.assertEqual(0, run("bag", "verify", recovered).returncode)
        self.assertGreater(sum(map(len, messages_of(recovered).values())), 20)

    def test_a_full_disk_ends_the_recording_with_a_readable_file(self):
        path = self.folder / "full.mcap"
        limit = 100_000
        with Publisher():
            recording = start_recording(path, "--compression", "none",
                                        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
            said = recording.communicate(timeout=PATIENCE_S)
        self.assertEqual(1, recording.returncode)
        self.assertIn("recording has stopped", said[1])
        self.assertLessEqual(path.stat().st_size, limit)
        self.assertNotEqual(1, run("bag", "info", path).returncode)

    def test_parts_are_cut_and_merged(self):
        path, _ = self.record_every_topic()
        parts = [self.folder / "scans.mcap", self.folder / "rest.mcap"]
        cut = run("bag", "cut", path, "--output", parts[0], "--topics", "slammot/laser_scan")
        self.assertEqual(0, cut.returncode, cut.stderr)
        self.assertEqual({"slammot/laser_scan"}, messages_of(parts[0]).keys())
        others = ",".join(messages_of(path).keys() - {"slammot/laser_scan"})
        self.assertEqual(0, run("bag", "cut", path, "--output", parts[1], "--topics", others).returncode)
        merged = self.folder / "merged.mcap"
        self.assertEqual(0, run("bag", "merge", *parts, "--output", merged).returncode)
        self.assertEqual(messages_of(path), messages_of(merged))
        self.assertEqual(0, run("bag", "verify", merged).returncode)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--slammot", required=True)
    parser.add_argument("--publisher", required=True)
    parser.add_argument("--venv", type=pathlib.Path, required=True)
    ARGUMENTS = parser.parse_args()
    python_environment.enter(ARGUMENTS.venv)
    from mcap.reader import make_reader
    unittest.main(argv=sys.argv[:1])
