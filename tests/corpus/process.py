"""A child process with a time limit and what it used.

The child is started by a small process of its own (this file as a program): the largest resident set that the kernel keeps for a child
begins with that of whoever starts it.
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


def run(command, timeout_s, log_path):
    starter = [sys.executable, "-I", "-S", __file__, str(timeout_s), str(log_path), *map(str, command)]
    said = subprocess.run(starter, stdout=subprocess.PIPE, check=True, text=True).stdout
    with open(log_path, errors="replace") as log:
        return Finished(**json.loads(said), text=log.read())


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
