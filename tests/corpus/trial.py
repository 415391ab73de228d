"""One row of the table: alter the drive, run it, and compare what comes out with its truth."""

import dataclasses
import json
import pathlib
import re
import shutil
import subprocess

import carmen_drive
import look_alike
import picture
import process
import trajectories
import ways
from figures import at

KEPT = {"trajectory.tum", "online.tum", "report.json", "graph.g2o", "evaluation.json", "output.txt", "eval.txt", "trajectory.svg", "reference.txt"}
EVALUATED = ("online.tum", "trajectory.tum", "online_covariance.csv", "tracks.csv", "track_details.csv", "predictions.csv", "report.json")
PER_SCAN_STAGES = ("localization", "detection", "tracking", "mapping")
DRIFT_OVER_M = 10.0


@dataclasses.dataclass
class Outcome:
    """Figures are None where they could not be had."""
    state: str = "ended"          # ended, timeout, failed
    detail: str = ""
    scans: int = 0
    localized: int = None
    ate_m: float = None
    worst_m: float = None
    drift_m: float = None         # over 10 m
    wall_s: float = None
    cpu_s: float = None
    peak_mb: float = None
    scan_ms: float = None         # the worst stage's worst scan
    closing_ms: float = None      # the worst submap
    says_lost: bool = False
    says_way: bool = None         # whether what was altered is said
    first_off: tuple = None       # scan, metres, radians
    off_share: float = None       # of the scans, off by more than a metre after alignment
    joined: int = None            # pairs of places falsely put together
    joins_places: bool = True     # by closures, or by finding itself again in the map; else what lies upon another is drift
    look_alike: int = None        # pairs of places that look alike and are not the same
    figures: dict = dataclasses.field(default_factory=dict)  # of slammot eval
    words: str = ""

    def seconds(self):
        """The lesser of time passed and processor time: other work on the machine does not count, nor does a second core."""
        return None if self.wall_s is None else min(self.wall_s, self.cpu_s)


FIGURES = {
    "hota": ("tracking", "hota", "hota"),
    "idf1": ("tracking", "identity", "f1"),
    "velocity_mps": ("tracking", "all", "velocity_mps", "rmse"),
    "nees": ("relative_pose_nees", "mean"),
    "online_drift_m": ("online_trajectory", "over", "100_m", "drift_m", "mean"),
    "drift_without_loops_m": ("trajectory_without_loops", "over", "100_m", "drift_m", "mean"),
}


def figures_of(evaluation):
    figures = {}
    for name, path in FIGURES.items():
        value = at(evaluation, path)
        if value is not None:
            figures[name] = value
    return figures


@dataclasses.dataclass(frozen=True)
class Setup:
    binary: str
    output: pathlib.Path   # one folder a row
    timeout_s: float
    seed: int = 1
    repeat: int = 1        # runs of one row, of whose times the least count: outputs are the same


def folder_of_simulated(drive, setup):
    return setup.output.parent / "drives" / drive.name


def simulate(drive, setup):
    """The prefix of the drive's log and truth, simulated where it is not there yet. With --against both binaries take the same drive."""
    folder = folder_of_simulated(drive, setup)
    if not (folder / "done").exists():
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        command = [setup.binary, "simulate", drive.scenario, "--seed", str(drive.seed), "--output", str(folder)]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        (folder / "done").touch()
    return str(folder / drive.scenario)


@dataclasses.dataclass(frozen=True)
class Input:
    log: str
    truth: str               # prefix for slammot eval
    poses: list              # true pose of each scan; None where it is not known
    recorded_stamps: list    # of each scan, or None where the log's own stamps are right


def altered_input(prefix, way, folder, seed):
    """Writes the altered log into the folder."""
    read = carmen_drive.read_drive(prefix)
    copy = way.apply(read, seed)
    carmen_drive.write_drive(read, copy, prefix, str(folder / "drive"))
    poses = carmen_drive.true_poses(prefix, copy)
    has_other_stamps = [scan.recorded_stamp for scan in copy.scans()] != [carmen_drive.stamp_of(scan) for scan in copy.scans()]
    if has_other_stamps:
        return Input(str(folder / "drive.log"), prefix, poses, [scan.recorded_stamp for scan in copy.scans()])
    return Input(str(folder / "drive.log"), str(folder / "drive"), poses, None)


def input_of(row, prefix, folder, seed):
    if row.way:
        return altered_input(prefix, ways.BY_NAME[row.way], folder, seed)
    read = carmen_drive.read_drive(prefix)
    return Input(str(carmen_drive.log_of(prefix)), carmen_drive.prefix_of(prefix), carmen_drive.true_poses(prefix, read), None)


def tum_poses(path):
    return [pose for _, pose in carmen_drive.read_tum(path)]


def judge_trajectory(outcome, estimated, true):
    """The result has a pose for each scan of the log, in its order."""
    if outcome.state == "timeout":
        outcome.detail += f", {len(estimated)} of {len(true)} scans by then"
    elif len(estimated) != len(true):
        outcome.detail = f"{len(estimated)} poses for {len(true)} scans"
    outcome.ate_m, outcome.worst_m = trajectories.ate(estimated, true)
    outcome.drift_m = trajectories.drift(estimated, true, DRIFT_OVER_M)
    outcome.first_off = trajectories.first_off(estimated, true)
    outcome.off_share = trajectories.off_share(estimated, true)
    outcome.joined = trajectories.falsely_joined(estimated, true) if outcome.joins_places else 0


def least(*values):
    return min((value for value in values if value is not None), default=None)


def read_report(outcome, path):
    """Of a run that is repeated the least times count."""
    if not path.exists():
        return
    report = json.loads(path.read_text())
    stages = report.get("measured", {}).get("stage_latency", {})
    scan_ms = max((stages[name]["max_ms"] for name in PER_SCAN_STAGES if name in stages), default=None)
    outcome.scan_ms = least(outcome.scan_ms, scan_ms)
    outcome.closing_ms = least(outcome.closing_ms, stages.get("loop_closing", {}).get("max_ms"))
    outcome.localized = report.get("counts", {}).get("localized_scans")
    outcome.joins_places = joins_places(report)


def joins_places(report):
    """Whether anything says that two places are one: a closure that lasts, or a lost vehicle that found itself again in the map."""
    found_again = report.get("counters", {}).get("localization", {}).get("found_again", 0)
    return found_again > 0 or any(closure.get("state") == "accepted" for closure in report.get("closures", []))


def restamped(path, target, new_of_old):
    """Copies a result with the recorded stamps in its first column."""
    separator = "," if path.suffix == ".csv" else " "
    with open(path) as source, open(target, "w") as file:
        for line in source:
            stamp, found, rest = line.partition(separator)
            file.write(f"{new_of_old[stamp]}{found}{rest}" if stamp in new_of_old else line)


def evaluate(given, seen, result, setup):
    """Figures of slammot eval, judged with the drive's true stamps; seen: its options."""
    folder = result / "evaluated"
    folder.mkdir()
    new_of_old = {}
    if given.recorded_stamps:
        rows = [line.split(" ", 1)[0] for line in (result / "online.tum").read_text().splitlines()]
        new_of_old = {old: f"{stamp:.6f}" for old, stamp in zip(reversed(rows), reversed(given.recorded_stamps))}
    for name in EVALUATED:
        if (result / name).exists():
            if name != "report.json" and new_of_old:
                restamped(result / name, folder / name, new_of_old)
            else:
                (folder / name).symlink_to((result / name).resolve())
    for ending in (".tum", ".objects.csv"):
        if path := carmen_drive.find(given.truth, ending):
            (folder / f"truth{ending}{'.gz' if path.suffix == '.gz' else ''}").symlink_to(path.resolve())
    finished = process.run([setup.binary, "eval", "--result", folder, "--truth", folder / "truth", *seen], 120.0, result / "eval.txt")
    if finished.code != 0:
        return {}
    shutil.copy(folder / "evaluation.json", result / "evaluation.json")
    return figures_of(json.loads((folder / "evaluation.json").read_text()))


def tidy(folder):
    for path in folder.iterdir():
        if path.is_dir():
            shutil.rmtree(path)
        elif path.name not in KEPT:
            path.unlink()


def run_row(row, setup, binary=None, folder=None):
    """The outcome of a row; its folder holds the trajectories, report and words of the run, and a picture."""
    folder = folder or setup.output / row.name()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    prefix = row.drive.prefix or simulate(row.drive, setup)
    given = input_of(row, prefix, folder, setup.seed)
    outcome = Outcome(scans=len(given.poses))
    way = ways.BY_NAME.get(row.way)
    command = [binary or setup.binary, "run", "--input", given.log, "--output", folder]
    if row.config:
        (folder / "settings.textproto").write_text(row.config)
        command += ["--config", folder / "settings.textproto"]
    finished = process.run(command, setup.timeout_s, folder / "output.txt")
    read_report(outcome, folder / "report.json")
    outcome.wall_s, outcome.cpu_s, outcome.peak_mb = min(finished.wall_s, setup.timeout_s), finished.cpu_s, finished.peak_mb
    outcome.words = finished.text
    outcome.says_lost = re.search(r"\blost\b", finished.text) is not None
    if way and way.said:
        outcome.says_way = re.search(way.said, finished.text, re.IGNORECASE) is not None
    if finished.is_timeout or finished.code != 0:
        outcome.state = "timeout" if finished.is_timeout else "failed"
        outcome.detail = f"no end in {setup.timeout_s:g} s" if finished.is_timeout else f"exit code {finished.code}: {fault_in(finished.text)}"
    if (folder / "trajectory.tum").exists():
        estimated = tum_poses(folder / "trajectory.tum")
        judge_trajectory(outcome, estimated, given.poses)
        if row.drive.simulated and outcome.state == "ended":
            outcome.figures = evaluate(given, way.seen if way else (), folder, setup)
        off = outcome.first_off
        title = f"{row.name()}: ATE {outcome.ate_m:.3f} m" + (f", first off at scan {off[0]} ({off[1]:.2f} m, {off[2]:.2f} rad)" if off else "")
        (folder / "trajectory.svg").write_text(picture.picture(title, trajectories.aligned(estimated, given.poses), given.poses, off and off[0]))
    for _ in range(setup.repeat - 1 if outcome.state == "ended" else 0):
        again = process.run(command, setup.timeout_s, folder / "output.txt")
        read_report(outcome, folder / "report.json")
        outcome.wall_s, outcome.cpu_s = min(outcome.wall_s, again.wall_s), min(outcome.cpu_s, again.cpu_s)
    return outcome


def fault_in(text):
    """The line of the program's words that says why it ended."""
    lines = text.strip().splitlines() or [""]
    return next((line for line in lines if line.startswith("slammot: ")), lines[-1])


def count_look_alikes(row, setup):
    prefix = row.drive.prefix or simulate(row.drive, setup)
    drive = carmen_drive.read_drive(prefix)
    return look_alike.pairs(drive, carmen_drive.true_poses(prefix, drive))
