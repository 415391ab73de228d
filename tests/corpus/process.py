"""A child process with a time limit and what it used.

The child is started by a small process of its own (this file as a program): the largest resident set that the kernel keeps for a child
begins with that of whoever starts it. SIGINT or SIGTERM to that process end the child.
"""

import dataclasses
import json
import os
import signal
import subprocess
import sys
import threading
import time

TO_WRITE_S = 5.0  # after the limit, for a program that writes what it has when it is told to end


@dataclasses.dataclass(frozen=True)
class Finished:
    code: int          # < 0: ended by this signal
    is_timeout: bool
    wall_s: float
    cpu_s: float
    peak_mb: float     # largest resident set
    text: str          # of stdout and stderr


class Ended(Exception):
    """No child runs any more."""


class _Starters:
    def __init__(self):
        self.lock = threading.Lock()
        self.running = set()
        self.has_ended = False

    def start(self, command):
        with self.lock:
            if self.has_ended:
                raise Ended
            starter = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
            self.running.add(starter)
        return starter

    def wait_for(self, starter):
        said, _ = starter.communicate()
        with self.lock:
            self.running.discard(starter)
        return said

    def end(self):
        with self.lock:
            self.has_ended = True
            for starter in self.running:
                starter.terminate()


_starters = _Starters()


def run(command, timeout_s, log_path):
    starter = _starters.start([sys.executable, "-I", "-S", __file__, str(timeout_s), str(log_path), *map(str, command)])
    said = _starters.wait_for(starter)
    if starter.returncode != 0:
        raise Ended
    with open(log_path, errors="replace") as log:
        return Finished(**json.loads(said), text=log.read())


def end_all():
    """Ends the children that run; later ones are not started."""
    _starters.end()


def start(timeout_s, log_path, command):
    begin = time.monotonic()
    with open(log_path, "wb") as log:
        child = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT, start_new_session=True)
    timed_out = threading.Event()

    def end_it(by):
        timed_out.set()
        try:
            os.killpg(child.pid, by)
        except ProcessLookupError:
            pass

    def interrupted(*_):
        end_it(signal.SIGTERM)
        kill = threading.Timer(TO_WRITE_S, end_it, [signal.SIGKILL])
        kill.daemon = True
        kill.start()

    for by in (signal.SIGINT, signal.SIGTERM):
        signal.signal(by, interrupted)
    timers = [threading.Timer(timeout_s, end_it, [signal.SIGTERM]), threading.Timer(timeout_s + TO_WRITE_S, end_it, [signal.SIGKILL])]
    for timer in timers:
        timer.start()
    _, status, usage = os.wait4(child.pid, 0)
    for timer in timers:
        timer.cancel()
    child.returncode = os.waitstatus_to_exitcode(status)
    return {"code": child.returncode, "is_timeout": timed_out.is_set(), "wall_s": time.monotonic() - begin,
            "cpu_s": usage.ru_utime + usage.ru_stime, "peak_mb": usage.ru_maxrss / 1024}


if __name__ == "__main__":
    print(json.dumps(start(float(sys.argv[1]), sys.argv[2], sys.argv[3:])))
