"""The live view on a free port: `slammot live` with all its services, on a bus of its own."""

import os
import signal
import socket
import subprocess
import time
import urllib.error
import urllib.request


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Live:
    def __init__(self, slammot, scenario="block", speed="1"):
        self.port = free_port()
        self.bus, self.domain = f"live-test-{os.getpid()}", str(os.getpid() % 200)
        self.process = subprocess.Popen(
            [slammot, "live", "--scenario", scenario, "--speed", speed, "--port", str(self.port), "--domain", self.domain, "--bus", self.bus],
            stdout=subprocess.DEVNULL)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(20)

    def get(self, path, headers=None):
        """(status, body)"""
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}{path}", headers=headers or {})
        try:
            with urllib.request.urlopen(request, timeout=20) as answer:
                return answer.status, answer.read()
        except urllib.error.HTTPError as fault:
            return fault.code, fault.read()

    def wait_until_ready(self, within_s=60):
        """Until a scan was localized."""
        end = time.monotonic() + within_s
        while time.monotonic() < end:
            try:
                if self.get("/readyz")[0] == 200:
                    return
            except OSError:
                pass
            time.sleep(0.1)
        raise TimeoutError("no scan was localized")
