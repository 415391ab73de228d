"""A short drive, processed by all services and recorded from their bus."""

import os
import pathlib
import signal
import subprocess
import time

PATIENCE_S = 240


def record_drive(slammot, folder: pathlib.Path, scenario="block"):
    """Path of the recording. `slammot bench` runs the services."""
    path = folder / "drive.mcap"
    bus = ["--bus", f"recorded-{os.getpid()}", "--domain", str(os.getpid() % 200)]
    recorder = subprocess.Popen([slammot, "record", "--output", path, *bus], stdout=subprocess.PIPE, text=True)
    while not path.exists():
        assert recorder.poll() is None, "the recorder does not start"
        time.sleep(0.05)
    subprocess.run([slammot, "bench", "--scenario", scenario, "--speed", "max", "--quiet", "--output", folder / "result", *bus], check=True,
                   timeout=PATIENCE_S)
    recorder.send_signal(signal.SIGINT)
    said = recorder.communicate(timeout=PATIENCE_S)[0]
    assert recorder.returncode == 0 and " 0 dropped" in said, said
    return path
