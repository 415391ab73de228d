#!/usr/bin/env python3
"""Our metrics agree with independent programs to 1e-6: PyPI `evo` (trajectories), `trackeval` and `motmetrics` (tracks), SciPy
(assignment, chi-square, and GOSPA written with it), on random cases and on cases made by hand. Exit code 77 where these cannot
be had."""

import argparse
import json
import pathlib
import subprocess
import sys

SKIPPED = 77
TOLERANCE = 1e-6
PACKAGES = ("evo", "motmetrics", "trackeval", "scipy")


def run_where_packages_are(venv: pathlib.Path) -> None:
    """Goes on in an environment that has the packages: this one, else one made for it. Exits as skipped where neither."""
    try:
        for package in PACKAGES:
            __import__(package)
        return
    except ImportError:
        pass
    python = venv / "bin" / "python"
    if pathlib.Path(sys.prefix).resolve() == venv.resolve():
        print("skipped: the packages are installed but cannot be imported")
        sys.exit(SKIPPED)
    steps = ([sys.executable, "-m", "venv", str(venv)],
             [str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--retries", "1", *PACKAGES])
    for step in steps:
        made = subprocess.run(step, capture_output=True, text=True, check=False)
        if made.returncode != 0:
            reason = (made.stderr + made.stdout).strip().splitlines()[-1:]
            print("skipped:", ", ".join(PACKAGES), "of PyPI cannot be installed:", *reason)
            sys.exit(SKIPPED)
    sys.exit(subprocess.run([str(python), *sys.argv], check=False).returncode)


class Comparison:
    """Collects what differs."""

    def __init__(self):
        self.faults = []
        self.values = 0

    def near(self, what, ours, theirs):
        self.values += 1
        if ours is None or not abs(ours - theirs) <= TOLERANCE:
            self.faults.append(f"{what}: ours {ours}, theirs {theirs}")


# Trajectories

def random_trajectories(random):
    """A wandering vehicle, and an estimate of it that drifts, is noisy, and has lost some poses."""
    import numpy as np
    count = 300
    heading = np.cumsum(random.normal(0.0, 0.05, count))
    step = np.abs(random.normal(0.4, 0.2, count)) * (random.random(count) > 0.15)  # stands still now and then
    truth = np.stack([0.1 * np.arange(count), np.cumsum(step * np.cos(heading)), np.cumsum(step * np.sin(heading)), heading], 1)
    estimate = truth + random.normal(0.0, [0.001, 0.02, 0.02, 0.005], (count, 4))
    turn, shift = random.uniform(-3.0, 3.0), random.uniform(-50.0, 50.0, 2)
    x, y = 1.01 * estimate[:, 1], estimate[:, 2] + 1e-3 * estimate[:, 1] ** 2
    estimate[:, 1] = np.cos(turn) * x - np.sin(turn) * y + shift[0]
    estimate[:, 2] = np.sin(turn) * x + np.cos(turn) * y + shift[1]
    estimate[:, 3] += turn
    kept = random.random(count) > 0.1
    return {"truth": truth.tolist(), "estimate": estimate[kept].tolist(), "deltas": [1.0, 5.0, 20.0]}


def evo_trajectory(rows):
    import numpy as np
    from evo.core.trajectory import PoseTrajectory3D
    rows = np.array(rows)
    zero = np.zeros(len(rows))
    quaternions = np.stack([np.cos(rows[:, 3] / 2), zero, zero, np.sin(rows[:, 3] / 2)], 1)
    return PoseTrajectory3D(np.stack([rows[:, 1], rows[:, 2], zero], 1), quaternions, rows[:, 0])


def compare_trajectory(case, ours, comparison):
    import copy
    from evo.core import metrics, sync
    truth, estimate = sync.associate_trajectories(evo_trajectory(case["truth"]), evo_trajectory(case["estimate"]), max_diff=0.01)
    comparison.near("pairs", ours["pairs"], truth.num_poses)

    def compare(what, metric, reference, other, answer):
        metric.process_data((reference, other))
        for name in ("rmse", "mean", "median", "max"):
            comparison.near(f"{what} {name}", answer[name], metric.get_statistic(metrics.StatisticsType[name]))
        comparison.near(f"{what} count", answer["count"], len(metric.error))

    for name, align in (("ate", lambda t: t.align(truth)), ("ate_first_pose", lambda t: t.align_origin(truth))):
        aligned = copy.deepcopy(estimate)
        align(aligned)
        compare(name, metrics.APE(metrics.PoseRelation.translation_part), truth, aligned, ours[name])
    for index, delta in enumerate(case["deltas"]):
        for part, relation in (("translation", metrics.PoseRelation.translation_part), ("rotation", metrics.PoseRelation.rotation_angle_rad)):
            for name, every in (("consecutive", False), ("all", True)):
                metric = metrics.RPE(relation, delta, metrics.Unit.meters, all_pairs=every, pairs_from_reference=every)
                compare(f"rpe {delta} m {name} {part}", metric, truth, estimate, ours[name][index][part])


# Tracks

def places_as_similarity(objects, tracks):
    import numpy as np
    if not objects or not tracks:
        return [[] for _ in objects]
    distance = np.linalg.norm(np.array(objects)[:, None] - np.array(tracks)[None], axis=2)
    return np.maximum(0.0, 1.0 - distance / 4.0).tolist()


def random_tracking(random, spacing):
    """Objects on a plane with tracks that miss them, swap, split, and are false. The wider the spacing, the clearer who is whose."""
    object_count, frames, next_track = 6, 60, 6
    track_of = list(range(object_count))
    result = []
    for t in range(frames):
        objects = [(i, (spacing * i + 0.3 * random.normal(), 2.0 * random.random())) for i in range(object_count) if (t + 7 * i) % 40 < 32]
        if random.random() < 0.15:
            i, j = random.integers(object_count, size=2)
            track_of[i], track_of[j] = track_of[j], track_of[i]
        tracks = []
        for i, place in objects:
            if random.random() < 0.02:
                track_of[i], next_track = next_track, next_track + 1
            if random.random() < 0.85:
                tracks.append((track_of[i], (place[0] + 0.7 * random.normal(), place[1] + 0.7 * random.normal())))
        if random.random() < 0.3:
            tracks.append((next_track, (spacing * object_count * random.random(), 50.0 if spacing > 10.0 else 1.0)))
            next_track += 1
        result.append({"objects": [i for i, _ in objects], "tracks": [i for i, _ in tracks],
                       "similarity": places_as_similarity([p for _, p in objects], [p for _, p in tracks])})
    return {"objects": object_count, "tracks": next_track, "least_similarity": 0.5, "frames": result}


def tracking_by_hand():
    """An empty scan, a scan without tracks, one without objects, a pair exactly at the gate, and equal choices."""
    frame = lambda objects, tracks, similarity: {"objects": objects, "tracks": tracks, "similarity": similarity}
    return {"objects": 2, "tracks": 3, "least_similarity": 0.5, "frames": [
        frame([], [], []), frame([0, 1], [], [[], []]), frame([], [0], []), frame([0], [1], [[0.5]]), frame([0], [1], [[0.499]]),
        frame([0, 1], [0, 1], [[0.9, 0.8], [0.0, 0.7]]), frame([0, 1], [0, 1, 2], [[0.6, 0.95, 0.0], [0.0, 0.0, 1.0]]),
        frame([1], [2], [[1.0]])]}


def trackeval_answers(case):
    import numpy as np
    import trackeval
    frames = case["frames"]
    used = lambda key: sorted({i for frame in frames for i in frame[key]})
    object_of, track_of = ({i: n for n, i in enumerate(used(key))} for key in ("objects", "tracks"))
    data = {"num_gt_ids": len(object_of), "num_tracker_ids": len(track_of), "num_timesteps": len(frames),
            "num_gt_dets": sum(len(f["objects"]) for f in frames), "num_tracker_dets": sum(len(f["tracks"]) for f in frames),
            "gt_ids": [np.array([object_of[i] for i in f["objects"]], int) for f in frames],
            "tracker_ids": [np.array([track_of[i] for i in f["tracks"]], int) for f in frames],
            "similarity_scores": [np.array(f["similarity"], float).reshape(len(f["objects"]), len(f["tracks"])) for f in frames]}
    config = {"THRESHOLD": case["least_similarity"], "PRINT_CONFIG": False}
    hota = trackeval.metrics.HOTA().eval_sequence(data)
    clear = trackeval.metrics.CLEAR(config).eval_sequence(data)
    identity = trackeval.metrics.Identity(config).eval_sequence(data)
    answers = {"tp": clear["CLR_TP"], "fp": clear["CLR_FP"], "fn": clear["CLR_FN"], "switches": clear["IDSW"],
               "fragmentations": clear["Frag"], "mostly_tracked": clear["MT"], "mostly_lost": clear["ML"], "mota": clear["MOTA"],
               "motp": clear["MOTP"], "idtp": identity["IDTP"], "idfp": identity["IDFP"], "idfn": identity["IDFN"], "idf1": identity["IDF1"],
               "hota": hota["HOTA"].mean(), "deta": hota["DetA"].mean(), "assa": hota["AssA"].mean(), "detre": hota["DetRe"].mean(),
               "detpr": hota["DetPr"].mean(), "loca": hota["LocA"].mean()}
    return answers, hota["HOTA"]


def compare_tracking(case, ours, comparison):
    answers, hota_at = trackeval_answers(case)
    for name, theirs in answers.items():
        comparison.near(f"trackeval {name}", ours[name], float(theirs))
    for ours_at, theirs_at in zip(ours["hota_at"], hota_at):
        comparison.near("trackeval HOTA at a threshold", ours_at, float(theirs_at))


def compare_with_motmetrics(case, ours, comparison, is_clear):
    """motmetrics keeps old pairs through gaps, trackeval and we do not: CLEAR is only compared where nobody has a choice."""
    import motmetrics
    import numpy as np
    accumulator = motmetrics.MOTAccumulator(auto_id=True)
    for frame in case["frames"]:
        similarity = np.array(frame["similarity"], float).reshape(len(frame["objects"]), len(frame["tracks"]))
        distance = np.where(similarity >= case["least_similarity"], 1.0 - similarity, np.nan)
        accumulator.update(frame["objects"], frame["tracks"], distance)
    names = ["idf1", "idtp", "idfp", "idfn"] + (["mota", "motp", "num_switches", "num_misses", "num_false_positives"] if is_clear else [])
    theirs = motmetrics.metrics.create().compute(accumulator, metrics=names, name="case").iloc[0]
    for name in ("idf1", "idtp", "idfp", "idfn"):
        comparison.near(f"motmetrics {name}", ours[name], float(theirs[name]))
    if is_clear:
        comparison.near("motmetrics mota", ours["mota"], float(theirs["mota"]))
        comparison.near("motmetrics motp", 1.0 - ours["motp"], float(theirs["motp"]))
        comparison.near("motmetrics switches", ours["switches"], float(theirs["num_switches"]))
        comparison.near("motmetrics misses", ours["fn"], float(theirs["num_misses"]))
        comparison.near("motmetrics false", ours["fp"], float(theirs["num_false_positives"]))


# Assignment, GOSPA, chi-square

def random_gospa(random):
    rows, columns = int(random.integers(0, 8)), int(random.integers(0, 8))
    return {"rows": rows, "columns": columns, "distance": random.uniform(0.0, 8.0, (rows, columns)).tolist(), "cutoff": 4.0}


def compare_gospa(case, ours, comparison):
    import numpy as np
    from scipy.optimize import linear_sum_assignment
    cutoff2 = case["cutoff"] ** 2
    d2 = np.minimum(np.array(case["distance"], float).reshape(case["rows"], case["columns"]) ** 2, cutoff2)
    rows, columns = linear_sum_assignment(d2)
    costs = d2[rows, columns]
    near = costs < cutoff2
    parts = {"localization": costs[near].sum(), "missed": cutoff2 / 2 * (case["rows"] - near.sum()), "false": cutoff2 / 2 * (case["columns"] - near.sum())}
    for name, theirs in parts.items():
        comparison.near(f"GOSPA {name}", ours[name], float(theirs))
    comparison.near("GOSPA", ours["distance"], float(sum(parts.values()) ** 0.5))


def random_pairing(random):
    rows, columns = int(random.integers(1, 30)), int(random.integers(1, 30))
    return {"rows": rows, "columns": columns, "score": random.uniform(-1.0, 1.0, (rows, columns)).tolist()}


def compare_pairing(case, ours, comparison):
    import numpy as np
    from scipy.optimize import linear_sum_assignment
    score = np.maximum(0.0, np.array(case["score"]))
    comparison.near("greatest sum of scores", ours, float(score[linear_sum_assignment(-score)].sum()))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True, help="the program evaluate_cases")
    parser.add_argument("--venv", required=True, type=pathlib.Path, help="folder in which the packages are installed if need be")
    arguments = parser.parse_args()
    run_where_packages_are(arguments.venv)
    import numpy as np
    import scipy.stats
    random = np.random.default_rng(20041101)
    cases = {"trajectories": [random_trajectories(random) for _ in range(5)],
             "tracking": [tracking_by_hand()] + [random_tracking(random, 3.0) for _ in range(10)] + [random_tracking(random, 100.0) for _ in range(5)],
             "gospa": [random_gospa(random) for _ in range(50)],
             "pairings": [random_pairing(random) for _ in range(50)],
             "chi_square": [[share, degrees] for share in (0.025, 0.5, 0.975) for degrees in (1, 2, 3, 60, 909, 34608)]}
    done = subprocess.run([arguments.program], input=json.dumps(cases), capture_output=True, text=True, check=True)
    ours = json.loads(done.stdout)
    comparison = Comparison()
    for case, answer in zip(cases["trajectories"], ours["trajectories"]):
        compare_trajectory(case, answer, comparison)
    for index, (case, answer) in enumerate(zip(cases["tracking"], ours["tracking"])):
        compare_tracking(case, answer, comparison)
        compare_with_motmetrics(case, answer, comparison, is_clear=index > 10)
    for case, answer in zip(cases["gospa"], ours["gospa"]):
        compare_gospa(case, answer, comparison)
    for case, answer in zip(cases["pairings"], ours["pairings"]):
        compare_pairing(case, answer, comparison)
    for (share, degrees), answer in zip(cases["chi_square"], ours["chi_square"]):
        comparison.near(f"chi-square {share} {degrees}", answer / degrees, float(scipy.stats.chi2.ppf(share, degrees)) / degrees)
    print(f"{comparison.values} values compared, {len(comparison.faults)} differ")
    for fault in comparison.faults:
        print("FAULT:", fault)
    return 1 if comparison.faults else 0


if __name__ == "__main__":
    sys.exit(main())
