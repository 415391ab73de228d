"""A recording under the gateway: `slammot play` and `slammot-gateway` on a bus of their own."""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

from live import Live, free_port

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "recorder"))
from recorded_drive import record_drive


class Recorded(Live):
    """The vehicle is that of `slammot bench`."""

    def __init__(self, slammot, recording, *arguments):
        self.slammot, self.port = pathlib.Path(slammot), free_port()
        self.bus, self.domain = f"playback-test-{os.getpid()}", str(os.getpid() % 200)
        self.start_gateway()
        self.process = subprocess.Popen([slammot, "play", recording, "--linger", "--vehicle", "bench", *arguments, *self.on_bus()], stdout=subprocess.DEVNULL)

    def on_bus(self):
        return ["--bus", self.bus, "--domain", self.domain]

    def start_gateway(self):
        self.gateway = subprocess.Popen([self.slammot.parent / "slammot-gateway", "--vehicle", "bench", "--port", str(self.port), *self.on_bus()],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def kill_gateway(self):
        self.gateway.kill()
        self.gateway.wait(20)

    def __exit__(self, *_):
        for process in (self.process, self.gateway):
            process.send_signal(signal.SIGTERM)
        for process in (self.process, self.gateway):
            process.wait(20)


def recording_of(options, folder):
    """That of the options, or a short drive that is recorded now."""
    return options.recording or record_drive(options.slammot, pathlib.Path(folder), options.scenario)
