#!/usr/bin/env python3
"""The stock DDS tools see everything: `cyclonedds ls|ps|typeof|subscribe` (PyPI `cyclonedds`) list, type and echo every
topic by its real name. Exit code 77 where the tools cannot be installed."""

import argparse
import concurrent.futures
import os
import pathlib
import re
import select
import signal
import subprocess
import sys
import time

SKIPPED = 77
DOMAIN = str(1 + os.getpid() % 200)
TAG = f"stock-tools-{os.getpid()}"
PATIENCE_S = 30.0
KEY = "vehicle_id='test-car'"


def installed_tool(venv: pathlib.Path) -> pathlib.Path:
    """Path of the `cyclonedds` command in an environment made for it. Exits as skipped where that cannot be made."""
    tool = venv / "bin" / "cyclonedds"
    if tool.exists():
        return tool
    steps = (
        [sys.executable, "-m", "venv", str(venv)],
        [str(venv / "bin" / "pip"), "install", "--quiet", "--disable-pip-version-check", "--retries", "1", "cyclonedds"],
    )
    for step in steps:
        made = subprocess.run(step, capture_output=True, text=True, check=False)
        if made.returncode != 0:
            reason = (made.stderr + made.stdout).strip().splitlines()[-1:]
            print("skipped: the stock tools (PyPI cyclonedds) cannot be installed:", *reason)
            sys.exit(SKIPPED)
    return tool


class Publisher:
    """Writes to every topic of the table until it is left."""

    def __init__(self, program: str):
        self.process = subprocess.Popen([program, DOMAIN, TAG], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def __enter__(self):
        self.config = self.process.stdout.readline().strip()
        self.types = {}
        for line in self.process.stdout:
            if line == "ready\n":
                return self
            _, topic, type_name = line.split()
            self.types[topic] = type_name
        raise RuntimeError("the publisher ended before it was ready")

    def __exit__(self, *_):
        self.process.stdin.close()
        self.process.wait(timeout=PATIENCE_S)


class Tool:
    def __init__(self, path: pathlib.Path, config: str):
        self.path = str(path)
        # A wide terminal: names are not cut.
        self.environment = {**os.environ, "CYCLONEDDS_URI": config, "COLUMNS": "400", "PYTHONUNBUFFERED": "1"}

    def command(self, name: str, *arguments: str) -> list:
        return [self.path, name, "--id", DOMAIN, "--suppress-progress-bar", "--color", "none", *arguments]

    def output(self, name: str, *arguments: str) -> str:
        done = subprocess.run(self.command(name, *arguments), env=self.environment, capture_output=True, text=True,
                              timeout=PATIENCE_S, check=True)
        return done.stdout

    def first_sample(self, topic: str) -> str:
        """What `subscribe` prints of the first sample; all that it said where none came in time."""
        process = subprocess.Popen(self.command("subscribe", topic, "--runtime", "1"), env=self.environment, bufsize=0,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   start_new_session=True)
        said = b""
        deadline = time.monotonic() + PATIENCE_S
        while KEY.encode() not in said and time.monotonic() < deadline:
            if select.select([process.stdout], [], [], deadline - time.monotonic())[0]:
                more = process.stdout.read(65536)
                if not more:
                    break
                said += more
        # It ends on Ctrl-C only, and waits for input where it wants to ask something.
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        return said.decode(errors="replace")


def faults_of_topic(tool: Tool, topic: str, full_type: str) -> list:
    """One line for each way in which the tools do not type or echo the topic."""
    type_name = full_type.rsplit("::", maxsplit=1)[-1]
    found = []
    idl = tool.output("typeof", topic, "--runtime", "1")
    if f"struct {type_name} " not in idl or "@key string<32>  vehicle_id" not in idl:
        found.append(f"typeof {topic} does not show struct {type_name} and its key:\n{idl}")
    said = tool.first_sample(topic)
    if f"{type_name}(" not in said or KEY not in said:
        found.append(f"subscribe {topic} shows no sample:\n{said}")
    return found


def faults(tool: Tool, types: dict) -> list:
    """One line for everything that the tools do not show."""
    found = []
    listed = tool.output("ls")
    applications = tool.output("ps")
    if "publish-every-topic" not in applications:
        found.append("ps does not show the participant's name")
    for topic, full_type in types.items():
        name = rf"\s{re.escape(topic)}\s"
        if not re.search(name, listed) or full_type not in listed:
            found.append(f"ls does not show {topic} of type {full_type}")
        if not re.search(name, applications):
            found.append(f"ps does not show {topic}")
    # The tools mostly wait for discovery, so several at once.
    with concurrent.futures.ThreadPoolExecutor(max_workers=5) as pool:
        for of_topic in pool.map(lambda row: faults_of_topic(tool, *row), types.items()):
            found += of_topic
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--publisher", required=True, help="the program publish_every_topic")
    parser.add_argument("--venv", required=True, type=pathlib.Path, help="folder in which the tools are installed")
    arguments = parser.parse_args()
    path = installed_tool(arguments.venv)
    with Publisher(arguments.publisher) as publisher:
        found = faults(Tool(path, publisher.config), publisher.types)
        print(f"{len(publisher.types)} topics, {len(found)} faults")
    for fault in found:
        print("FAULT:", fault)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
