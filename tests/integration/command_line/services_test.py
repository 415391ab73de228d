"""Commands that look at running services or start them: `live` says when a service is started again and when the drive has ended, `hz`
measures by the elapsed time, `collect` refuses a log that is missing before it waits for a drive.

Usage: services_test.py SLAMMOT
"""

import os
import queue
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

PROGRAM = Path(sys.argv.pop()).resolve()
PATIENCE_S = 60
DOMAIN = str(1 + os.getpid() % 200)

SCENARIO = """
duration_s: {duration_s}
city {{ blocks_east: 3 blocks_north: 3 block_pitch_m: 75 }}
route {{ junctions [{{ column: 0 row: 1 }}, {{ column: 2 row: 1 }}, {{ column: 2 row: 2 }}] start_m: 30 }}
"""


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def children_of(process):
    """{name of the program: process number}"""
    numbers = Path(f"/proc/{process}/task/{process}/children").read_text(encoding="utf-8").split()
    return {Path(os.readlink(f"/proc/{number}/exe")).name: int(number) for number in numbers}


class Live:
    """`slammot live` of a drive of so many seconds."""

    def __init__(self, folder, duration_s):
        self.bus = f"services-test-{os.getpid()}"
        scenario = Path(folder) / "drive.textproto"
        scenario.write_text(SCENARIO.format(duration_s=duration_s), encoding="utf-8")
        self.process = subprocess.Popen(
            [PROGRAM, "live", "--scenario", scenario, "--port", str(free_port()), "--domain", DOMAIN, "--bus", self.bus],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.lines = queue.Queue()
        self.reader = threading.Thread(target=lambda: [self.lines.put(line) for line in self.process.stdout])
        self.reader.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(PATIENCE_S)
        self.reader.join()
        self.process.stdout.close()

    def await_line(self, part):
        end = time.monotonic() + PATIENCE_S
        while True:
            line = self.lines.get(timeout=max(0.0, end - time.monotonic()))
            if part in line:
                return line


class Services(unittest.TestCase):
    def test_live_says_what_happens_to_its_services_and_its_drive(self):
        with tempfile.TemporaryDirectory() as folder, Live(folder, duration_s=4) as live:
            live.await_line("its services: ")
            os.kill(children_of(live.process.pid)["slammot-detection"], signal.SIGKILL)
            self.assertEqual(live.await_line("detection"), "slammot: detection ended unexpectedly and was started again\n")
            live.await_line("the drive has ended")

    def test_hz_divides_by_the_elapsed_time(self):
        with tempfile.TemporaryDirectory() as folder, Live(folder, duration_s=600) as live:
            live.await_line("its services: ")
            arguments = [PROGRAM, "hz", "laser_scan", "--domain", DOMAIN, "--bus", live.bus]
            one = subprocess.run([*arguments, "--count", "1", "--period", "2"], capture_output=True, text=True, timeout=PATIENCE_S, check=True)
            measuring = subprocess.Popen([*arguments, "--period", "100"], stdout=subprocess.PIPE, text=True)
            time.sleep(4)
            measuring.send_signal(signal.SIGINT)
            said = measuring.communicate(timeout=PATIENCE_S)[0]
            rates = [float(text.split(" samples, ")[1].split(" Hz")[0]) for text in (one.stdout, said)]
            self.assertGreater(rates[0], 10.0)
            self.assertAlmostEqual(rates[1] / rates[0], 1.0, delta=0.3)

    def test_collect_refuses_a_missing_log_before_the_drive(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([PROGRAM, "collect", "--output", f"{folder}/out", "--input", f"{folder}/nosuch", "--domain", DOMAIN],
                                  capture_output=True, text=True, timeout=PATIENCE_S, check=False)
            self.assertEqual(done.returncode, 1)
            self.assertEqual(done.stdout, "")
            self.assertIn("nosuch: No such file", done.stderr)


if __name__ == "__main__":
    unittest.main()
