"""Drives of the length that a case wants."""

import gzip
import pathlib

import chaos


def open_text(path, mode):
    return gzip.open(path, mode + "t", encoding="utf-8", compresslevel=1) if str(path).endswith(".gz") and mode == "w" else \
        gzip.open(path, mode + "t", encoding="utf-8") if str(path).endswith(".gz") else open(path, mode, encoding="utf-8")


def to_and_fro(recorded, path, scans):
    """A CARMEN log with one scanner, there and back again and again, until it has so many scans; stamps go on at the recorded period.

    Poses are those of the log, so that odometry is smooth but for its sign at each turn."""
    with open_text(recorded, "r") as file:
        lines = file.read().splitlines()
    head = [line for line in lines if not line.startswith("ROBOTLASER1 ")]
    rows = [line.split() for line in lines if line.startswith("ROBOTLASER1 ")]
    stamps = [float(row[-1]) for row in rows]
    period_s = (stamps[-1] - stamps[0]) / (len(stamps) - 1)
    bodies = [(" ".join(row[:-3]), row[-2]) for row in rows]
    there_and_back = bodies + bodies[-2:0:-1]
    with open_text(path, "w") as file:
        file.write("\n".join(head) + "\n")
        for number in range(scans):
            body, host = there_and_back[number % len(there_and_back)]
            stamp = stamps[0] + number * period_s
            file.write(f"{body} {stamp:.6f} {host} {stamp:.6f}\n")
    return pathlib.Path(path)


def scenario_of(folder, name, duration_s):
    """A copy of a scenario that takes so long."""
    text = (chaos.ROOT / f"deploy/scenarios/{name}.textproto").read_text(encoding="utf-8")
    path = folder / "drive.textproto"
    path.write_text("".join(f"duration_s: {duration_s}\n" if line.startswith("duration_s:") else line + "\n" for line in text.splitlines()),
                    encoding="utf-8")
    return path
