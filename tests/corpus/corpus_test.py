"""The figures, limits, pictures and tables of the corpus, on made-up drives, and the command on a made-up program."""

import json
import math
import os
import pathlib
import signal
import stat
import subprocess
import sys
import tempfile
import textwrap
import time
import unittest
import xml.etree.ElementTree

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "tools")]

import look_alike
import picture
import process
import rows
import table
import trajectories
import trial
import verdict


def circle(count=200, step_m=0.2, radius_m=6.0):
    angles = [index * step_m / radius_m for index in range(count)]
    return [(radius_m * math.sin(angle), radius_m * (1 - math.cos(angle)), angle) for angle in angles]


def seen_elsewhere(poses, motion=(3.0, -7.0, 1.2)):
    return [trajectories.moved(motion, pose) for pose in poses]


class Trajectories(unittest.TestCase):
    def test_are_the_same_wherever_the_frame_lies(self):
        rmse, worst = trajectories.ate(seen_elsewhere(circle()), circle())
        self.assertAlmostEqual(0.0, rmse, places=9)
        self.assertAlmostEqual(0.0, worst, places=9)

    def test_have_the_error_that_no_rigid_motion_removes(self):
        true = [(float(x), 0.0, 0.0) for x in range(4)]
        estimated = [(1.1 * x, 0.0, 0.0) for x in range(4)]
        self.assertAlmostEqual(0.1 * math.sqrt(1.25), trajectories.ate(seen_elsewhere(estimated), true)[0], places=9)

    def test_are_compared_where_truth_is_known(self):
        true = circle()
        true[3] = None
        estimated = circle()
        estimated[3] = (1e6, 0.0, 0.0)
        self.assertAlmostEqual(0.0, trajectories.ate(estimated, true)[0], places=9)
        self.assertTrue(math.isnan(trajectories.ate([], circle())[0]))

    def test_drift_is_that_of_the_motion_over_ten_metres(self):
        true = [(0.5 * x, 0.0, 0.0) for x in range(100)]
        estimated = [(1.02 * 0.5 * x, 0.0, 0.0) for x in range(100)]
        self.assertAlmostEqual(0.2, trajectories.drift(seen_elsewhere(estimated), true, 10.0), places=9)
        self.assertTrue(math.isnan(trajectories.drift(estimated[:5], true[:5], 10.0)))

    def test_say_at_which_scan_they_are_first_off_by_a_metre(self):
        estimated = circle()
        estimated[120:] = [(x + 1.5, y, heading) for x, y, heading in estimated[120:]]
        index, off_m, off_rad = trajectories.first_off(seen_elsewhere(estimated), circle())
        self.assertEqual(120, index)
        self.assertAlmostEqual(1.5, off_m, places=6)
        self.assertAlmostEqual(0.0, off_rad, places=6)

    def test_say_at_which_scan_they_are_first_turned(self):
        estimated = circle()
        estimated[50:] = [(x, y, heading + 0.3) for x, y, heading in estimated[50:]]
        index, _, off_rad = trajectories.first_off(seen_elsewhere(estimated), circle())
        self.assertEqual(50, index)
        self.assertAlmostEqual(0.3, off_rad, places=6)

    def test_say_nothing_where_all_is_well(self):
        self.assertIsNone(trajectories.first_off(seen_elsewhere(circle()), circle()))

    def test_are_falsely_joined_where_two_places_became_one(self):
        true = [(0.5 * x, 0.0, 0.0) for x in range(200)]
        estimated = [(0.5 * (x % 100), 0.0, 0.0) for x in range(200)]
        self.assertGreater(trajectories.falsely_joined(estimated, true), 20)

    def test_are_not_falsely_joined_by_coming_back(self):
        around = circle(count=400)
        self.assertEqual(0, trajectories.falsely_joined(seen_elsewhere(around), around))


class Joins(unittest.TestCase):
    """A trajectory that lies upon itself by drift alone is none."""

    def judged(self, report):
        true = [(0.5 * x, 0.0, 0.0) for x in range(200)]
        estimated = [(0.5 * (x % 100), 0.0, 0.0) for x in range(200)]
        found = trial.Outcome(scans=len(true), joins_places=trial.joins_places(report))
        trial.judge_trajectory(found, estimated, true)
        return found.joined

    def test_are_closures_that_last_and_vehicles_that_are_found_again(self):
        self.assertGreater(self.judged({"closures": [{"state": "withdrawn"}, {"state": "accepted"}]}), 20)
        self.assertGreater(self.judged({"counters": {"localization": {"found_again": 1}}}), 20)

    def test_are_not_drift(self):
        self.assertEqual(0, self.judged({"closures": [{"state": "withdrawn"}], "counters": {"localization": {"found_again": 0}}}))


class Pictures(unittest.TestCase):
    def test_hold_both_trajectories_and_where_it_is_off(self):
        estimated = circle()
        estimated[120:] = [(x + 3.0, y, heading) for x, y, heading in estimated[120:]]
        text = picture.picture("a <name>", estimated, circle(), 120)
        colours = [line.get("stroke") for line in xml.etree.ElementTree.fromstring(text).iter("{http://www.w3.org/2000/svg}polyline")]
        self.assertEqual(["#aaaaaa", "#1f5fbf", "#d02020"], colours)
        self.assertIn("scan 120", text)
        self.assertIn("a &lt;name&gt;", text)

    def test_can_be_drawn_of_nothing(self):
        xml.etree.ElementTree.fromstring(picture.picture("nothing", [], []))


class LookAlikes(unittest.TestCase):
    def test_are_counted_where_scans_agree_and_places_do_not(self):
        lines = [f"FLASER 4 1.0 2.0 {3 if index != 1 else 9} 4.0 {index * 10} 0 0 {index * 10} 0 0 {index} host {index}" for index in range(3)]
        drive = trial.carmen_drive.Drive(tuple(trial.carmen_drive.parse(lines)), 81.83)
        poses = [(10.0 * index, 0.0, 0.0) for index in range(3)]
        self.assertEqual(1, look_alike.pairs(drive, poses))


class Processes(unittest.TestCase):
    def run_python(self, code, timeout_s=60.0):
        with tempfile.TemporaryDirectory() as folder:
            return process.run([sys.executable, "-c", code], timeout_s, pathlib.Path(folder) / "output.txt")

    def test_have_their_code_words_and_memory(self):
        finished = self.run_python("import sys; print('word'); block = bytearray(64 << 20); block[::4096] = b'x' * len(block[::4096]); sys.exit(3)")
        self.assertEqual((3, False, "word\n"), (finished.code, finished.is_timeout, finished.text))
        self.assertGreater(finished.peak_mb, 64)
        self.assertLess(finished.peak_mb, 200)

    def test_are_told_to_end_at_their_limit(self):
        finished = self.run_python("while True: pass", timeout_s=0.3)
        self.assertTrue(finished.is_timeout)
        self.assertEqual(-signal.SIGTERM, finished.code)

    def test_may_write_what_they_have_when_told_to_end(self):
        finished = self.run_python("import signal, sys\nsignal.signal(signal.SIGTERM, lambda *_: sys.exit('half'))\nwhile True: pass", timeout_s=1.0)
        self.assertEqual((True, "half\n"), (finished.is_timeout, finished.text))


def outcome(ate_m=0.05, seconds=1.0, **others):
    return trial.Outcome(scans=100, ate_m=ate_m, wall_s=seconds, cpu_s=seconds, **others)


DRIVE = rows.Drive("hall", prefix="hall", ate_m=0.06, best_ate_m=0.055, quick_ate_m=0.1)


class Verdicts(unittest.TestCase):
    def test_hold_a_drive_to_its_limits(self):
        row = rows.Row(DRIVE)
        self.assertEqual([], verdict.faults("real", row, None, outcome()))
        self.assertEqual(["ATE over 0.060 m"], verdict.faults("real", row, None, outcome(0.07)))
        self.assertEqual(["over 1.1 s"], verdict.faults("real", row, None, outcome(seconds=1.3)))
        self.assertEqual(["a scan over 20 ms", "a closing over 200 ms"], verdict.faults("real", row, None, outcome(scan_ms=21.0, closing_ms=300.0)))

    def test_hold_an_altered_drive_to_the_unaltered_one(self):
        row, base = rows.Row(DRIVE, "third"), outcome(0.05)
        self.assertEqual([], verdict.faults("indoor-ways", row, base, outcome(0.10, 2.4)))
        self.assertEqual(["ATE over 0.100 m", "over 2.5 s"], verdict.faults("indoor-ways", row, base, outcome(0.11, 2.6)))
        self.assertEqual(["ATE over 0.075 m"], verdict.faults("real-stamps", row, base, outcome(0.08)))

    def test_miss_what_did_not_end_or_has_no_pose(self):
        row = rows.Row(DRIVE)
        self.assertEqual(["no end in 20 s"], verdict.faults("real", row, None, outcome(state="timeout", detail="no end in 20 s")))
        self.assertEqual(["ATE over 0.060 m"], verdict.faults("real", row, None, outcome(math.nan)))

    def test_accept_the_loss_that_is_said_without_odometry(self):
        row, base = rows.Row(DRIVE, "none"), outcome(0.05)
        self.assertEqual(["ATE over 0.060 m"], verdict.faults("real-no-odometry", row, base, outcome(9.0)))
        self.assertEqual([], verdict.faults("real-no-odometry", row, base, outcome(9.0, says_lost=True)))

    def test_count_how_many_are_as_good_without_odometry(self):
        results = []
        for index in range(7):
            drive = rows.Drive(f"hall{index}", prefix="x", ate_m=0.06)
            results.append((rows.Row(drive, is_base=True), outcome(), None))
            results.append((rows.Row(drive, "none"), outcome(0.05 if index < 4 else 9.0, says_lost=True), None))
        missed = {row.name(): [] for row, _, _ in results}
        sentences, fails = verdict.summary("real-no-odometry", results, missed)
        self.assertIn("as good as with odometry on 4 of 7, wanted 5", sentences)
        self.assertTrue(fails)

    def test_hold_simulated_drives_to_their_hota_and_places(self):
        row, base = rows.Row(DRIVE, "third"), outcome(figures={"hota": 0.6})
        self.assertEqual([], verdict.faults("simulated-ways", row, base, outcome(figures={"hota": 0.55}, joined=0)))
        self.assertEqual(["HOTA under 0.540", "2 pairs of places falsely joined"],
                         verdict.faults("simulated-ways", row, base, outcome(figures={"hota": 0.5}, joined=2)))

    def simulated_row(self, way, ate_m, **others):
        nees = others.pop("nees", 3.0)
        return rows.Row(DRIVE, way), outcome(ate_m, figures={"hota": 0.6, "nees": nees}, **others)

    def test_accept_what_the_covariance_says_where_information_is_gone(self):
        base = outcome(figures={"hota": 0.6})
        faults = lambda row, altered: verdict.faults("simulated-ways", row, base, altered)
        self.assertEqual([], faults(*self.simulated_row("range-8m", 1.5, nees=5.9)))
        self.assertEqual(["ATE over 0.100 m"], faults(*self.simulated_row("range-8m", 1.5, nees=6.1)))
        self.assertEqual(["ATE over 0.100 m"], faults(*self.simulated_row("range-8m", 1.5, nees=1.9)))
        self.assertEqual(["ATE over 0.100 m"], faults(*self.simulated_row("range-8m", 1.5, nees=None)))
        self.assertEqual(["ATE over 0.100 m"], faults(*self.simulated_row("range-8m", math.nan)))

    def test_hold_the_quick_street_to_its_covariance(self):
        faults = lambda nees: verdict.faults("quick-ways", rows.Row(DRIVE, "frozen-6s"), outcome(), outcome(0.02, figures={"nees": nees}))
        self.assertEqual([], faults(4.0))
        self.assertEqual(["NEES outside 1.5 to 8"], faults(17.7))
        self.assertEqual(["NEES outside 1.5 to 8"], faults(None))

    def test_accept_no_covariance_where_the_scans_say_all_or_places_are_joined(self):
        base = outcome(figures={"hota": 0.6})
        faults = lambda row, altered: verdict.faults("simulated-ways", row, base, altered)
        self.assertEqual(["ATE over 0.100 m"], faults(*self.simulated_row("turns-1.15", 1.5)))
        self.assertEqual(["ATE over 0.100 m"], faults(*self.simulated_row("beams-reversed", 1.5)))
        self.assertEqual(["ATE over 0.100 m", "3 pairs of places falsely joined"], faults(*self.simulated_row("range-8m", 1.5, joined=3)))
        row, altered = self.simulated_row("range-8m", 1.5)
        self.assertEqual(["ATE over 0.100 m"], verdict.faults("indoor-ways", row, base, altered))

    def test_count_the_rows_that_pass_by_their_covariance(self):
        base = rows.Row(DRIVE, is_base=True), outcome(figures={"hota": 0.6}), None
        altered = [(*self.simulated_row("range-8m", 1.5), None), (*self.simulated_row("third", 0.06), None)]
        sentences, _ = verdict.summary("simulated-ways", [base, *altered], {row.name(): [] for row, _, _ in [base, *altered]})
        self.assertEqual("2 of 2 rows as wanted, 1 of them by their covariance", sentences[0])

    def test_compare_two_binaries_in_pairs(self):
        results = [(rows.Row(rows.simulated("city", seed)), outcome(0.050 + 0.001 * seed, figures={"nees": 3.0}),
                    outcome(0.040 + 0.001 * seed)) for seed in range(5)]
        sentences, fails = verdict.summary("seeds", results, {row.name(): [] for row, _, _ in results})
        self.assertTrue(any("ATE [m] +0.0100 ± 0.0000 (worse)" in sentence for sentence in sentences), sentences)
        self.assertTrue(fails)


class Tables(unittest.TestCase):
    def test_have_a_cell_for_each_column(self):
        results = [(rows.Row(DRIVE), outcome(), None), (rows.Row(DRIVE, "third"), outcome(9.0, first_off=(30, 1.2, 0.1), off_share=0.5), outcome())]
        faults = {"hall": [], "hall-third": ["ATE over 0.100 m"]}
        lines = table.text("indoor-ways", results, faults).splitlines()
        self.assertEqual(1, len({line.count("|") for line in lines}))
        self.assertIn("first off at scan 30 (1.20 m, 0.10 rad), 50 % of the scans off by a metre", lines[3])

    def test_say_which_row_passes_by_its_covariance(self):
        results = [(rows.Row(DRIVE, is_base=True), outcome(figures={"nees": 3.0}), None),
                   (rows.Row(DRIVE, "fov-90"), outcome(0.3, figures={"nees": 3.0}), None)]
        lines = table.text("simulated-ways", results, {"hall": [], "hall-fov-90": []}).splitlines()
        self.assertIn("| yes | ATE over 0.100 m, as its covariance says |", lines[3])

    def test_replace_what_stood_between_their_markers(self):
        page = "# Results\n\n## The corpus\n\ntext\n\n## Other\n\nmore\n"
        once = table.page_with(page, "real", "old")
        self.assertLess(once.index("old"), once.index("## Other"))
        twice = table.page_with(table.page_with(once, "real", "new"), "real-stamps", "stamps")
        self.assertNotIn("old", twice)
        self.assertEqual(1, twice.count("new"))
        self.assertTrue(twice.startswith("# Results\n\n## The corpus\n\ntext\n") and twice.endswith("## Other\n\nmore\n"))
        self.assertLess(twice.index("stamps\n"), twice.index("## Other"))

    def test_go_to_the_end_of_a_page_without_a_section(self):
        self.assertIn("## The corpus", table.page_with("# Results\n", "real", "new"))


class Sets(unittest.TestCase):
    def test_hold_the_rows_that_they_are_named_after(self):
        drives = rows.read_drives(HERE / "corpus.toml", pathlib.Path("nowhere"))
        count = lambda name: len([row for row in rows.SETS[name](drives) if not row.is_base])
        self.assertEqual({"real": 7, "real-stamps": 21, "real-no-odometry": 7, "indoor-ways": 75, "simulated-ways": 275, "mean-of-8": 16, "seeds": 60},
                         {name: count(name) for name in ("real", "real-stamps", "real-no-odometry", "indoor-ways", "simulated-ways", "mean-of-8", "seeds")})
        for name, make in rows.SETS.items():
            names = [row.name() for row in make(drives)]
            self.assertEqual(len(names), len(set(names)), name)

    def test_hold_no_drive_that_is_absent(self):
        self.assertFalse(rows.Drive("hall", prefix="nowhere/hall").is_present())
        self.assertTrue(rows.simulated("office", 3).is_present())


# A program that takes "run --input LOG --output DIR" and gives back the log's odometry as its trajectory.
PROGRAM = '''\
#!{python}
import json, math, pathlib, sys
sys.path.insert(0, {tools!r})
import carmen_drive
options = dict(zip(sys.argv[2::2], sys.argv[3::2]))
folder = pathlib.Path(options["--output"])
lines = []
for scan in carmen_drive.read_drive(options["--input"]).scans():
    x, y, heading = scan.wheel_from_base
    lines.append(f"{{scan.stamps[0]}} {{x}} {{y}} 0 0 0 {{math.sin(heading / 2)}} {{math.cos(heading / 2)}}")
for name in ("trajectory.tum", "online.tum"):
    (folder / name).write_text("\\n".join(lines) + "\\n")
latency = {{"localization": {{"max_ms": 3.0}}, "loop_closing": {{"max_ms": 7.0}}}}
(folder / "report.json").write_text(json.dumps({{"counts": {{"localized_scans": len(lines)}}, "measured": {{"stage_latency": latency}}}}))
(folder / "map.pgm").write_text("large")
print("odometry: believed")
'''


class Command(unittest.TestCase):
    """run, with a list of one drive and a program that believes odometry."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        lines, reference = [], []
        for index, pose in enumerate(circle()):
            text = " ".join(f"{value:.6f}" for value in pose)
            lines.append(f"FLASER 4 1.0 2.0 3.0 4.0 {text} {text} {index / 10:.6f} host {index / 10:.6f}")
            reference.append(f"{index} {index / 10} {text}")
        (self.folder / "hall.log").write_text("\n".join(lines) + "\n")
        (self.folder / "hall.reference.txt").write_text("\n".join(reference) + "\n")
        (self.folder / "corpus.toml").write_text(textwrap.dedent("""
            [[drive]]
            name = "hall"
            log = "hall"
            ate_m = 0.05
            [[drive]]
            name = "elsewhere"
            log = "elsewhere"
            ate_m = 0.05
            """))
        self.program = self.folder / "program"
        self.program.write_text(PROGRAM.format(python=sys.executable, tools=str(HERE.parent / "tools")))
        self.program.chmod(self.program.stat().st_mode | stat.S_IXUSR)

    def start_corpus(self, *options):
        environment = dict(os.environ, SLAMMOT_DATA=str(self.folder))
        return subprocess.Popen([sys.executable, HERE / "run", "--corpus", self.folder / "corpus.toml", "--binary", self.program, "--output",
                                 self.folder / "out", *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment)

    def run_corpus(self, *options):
        with self.start_corpus(*options) as command:
            stdout, stderr = command.communicate()
        return subprocess.CompletedProcess(command.args, command.returncode, stdout, stderr)

    def test_passes_what_is_as_wanted_and_skips_what_is_absent(self):
        done = self.run_corpus("--set", "real")
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        self.assertIn("skipped, not in", done.stdout)
        self.assertIn("| hall |  | 0.000 | 0.050 |", done.stdout)
        self.assertIn("1 of 1 rows as wanted", done.stdout)
        result = self.folder / "out/now/hall"
        self.assertTrue((result / "trajectory.tum").exists())
        self.assertFalse((result / "map.pgm").exists() or (result / "trajectory.svg").exists())

    def test_fails_what_an_altered_drive_makes_worse_and_leaves_its_picture(self):
        done = self.run_corpus("--ways", "turns-1.15,dropouts-30")
        self.assertEqual(1, done.returncode, done.stdout + done.stderr)
        self.assertIn("FAILS hall-turns-1.15: ATE over 0.000 m; first off at scan", done.stdout)
        self.assertNotIn("FAILS hall-dropouts-30", done.stdout)
        result = self.folder / "out/now/hall-turns-1.15"
        self.assertTrue((result / "trajectory.svg").exists())
        self.assertFalse((result / "drive.log").exists())
        figures = {entry["row"]: entry for entry in json.loads((self.folder / "out/ways.json").read_text())}
        self.assertGreater(figures["hall-turns-1.15"]["ate_m"], 0.1)
        self.assertTrue(figures["hall-turns-1.15"]["says_way"])

    def test_compares_with_another_program(self):
        done = self.run_corpus("--set", "real", "--against", str(self.program))
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        self.assertIn("ATE, other", done.stdout)

    def test_lists_rows_without_running_them(self):
        self.assertEqual("hall\nhall-third\n", self.run_corpus("--ways", "third", "--only", "hall", "--list").stdout)

    def test_is_refused_without_a_program_and_skipped_without_drives(self):
        self.assertEqual(2, self.run_corpus("--binary", str(self.folder / "nothing")).returncode)
        done = self.run_corpus("--only", "elsewhere")
        self.assertEqual(77, done.returncode)
        self.assertIn("skipped", done.stdout)

    def test_ends_its_programs_when_it_is_interrupted(self):
        for by in (signal.SIGINT, signal.SIGTERM):
            pid_file = self.folder / f"pid_{by.name}"
            self.program.write_text(f"#!/bin/sh\necho $$ > {pid_file}.new\nmv {pid_file}.new {pid_file}\nexec sleep 60\n")
            with self.start_corpus("--ways", "third,fifth") as command:
                wait_until(pid_file.exists)
                command.send_signal(by)
                _, said = command.communicate(timeout=20)
            self.assertEqual(130, command.returncode, said)
            self.assertEqual("interrupted: no table is written\n", said)
            self.assertFalse(is_alive(int(pid_file.read_text())))


def wait_until(condition, timeout_s=20.0):
    end = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError
        time.sleep(0.02)


def is_alive(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


if __name__ == "__main__":
    unittest.main()
