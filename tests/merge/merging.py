"""Two drives through one simulated town, and what `slammot map merge` makes of their maps.

The second drive begins and ends elsewhere, at another time and among other traffic; three streets are driven by both.
"""

import dataclasses
import json
import math
import sqlite3
import subprocess

EXIT_NOT_JOINED = 4
SCENARIO = """seed: {seed}
duration_s: {duration_s}
city {{ blocks_east: 3 blocks_north: 3 block_pitch_m: 75 signalled_share: 0 }}
traffic {{ cars: {cars} bicycles: 3 }}
walkers {{ pedestrians: {pedestrians} }}
route {{
  junctions [{junctions}]
  start_m: {start_m}
}}
"""
DRIVES = {
    "first": {"duration_s": 75, "start_m": 30, "cars": 10, "pedestrians": 20, "route": [(0, 1), (2, 1), (2, 2), (1, 2), (1, 1), (2, 1)]},
    "second": {"duration_s": 85, "start_m": 15, "cars": 14, "pedestrians": 30, "route": [(3, 3), (3, 2), (1, 2), (1, 1), (2, 1), (2, 0)]},
}


@dataclasses.dataclass(frozen=True)
class Merged:
    is_joined: bool
    text: str
    counters: dict        # of the merge
    first_m: list         # error of each submap of the first map, in the frame of its first one
    second_m: list        # the same of the second map's
    join_rad: float       # error of the heading of the second map's first submap


def drive(slammot, name, seed, folder):
    """The folder with the results of a drive; drives it where that was not done yet."""
    output = folder / f"{name}-{seed}"
    if (output / "map.sqlite").exists():
        return output
    output.mkdir(parents=True, exist_ok=True)
    settings = dict(DRIVES[name])
    settings["junctions"] = ", ".join(f"{{ column: {column} row: {row} }}" for column, row in settings.pop("route"))
    scenario = output / "scenario.textproto"
    scenario.write_text(SCENARIO.format(seed=seed, **settings))
    subprocess.run([slammot, "run", "--scenario", scenario, "--store-map", "--output", output], check=True, stdout=subprocess.DEVNULL)
    return output


def poses_of(path):
    """{stamp in us: (x in m, y in m, heading in rad)} of a TUM file."""
    poses = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        stamp, x, y, _, _, _, qz, qw = map(float, line.split())
        poses[round(stamp * 1e6)] = (x, y, 2.0 * math.atan2(qz, qw))
    return poses


def nodes_of(path):
    """Poses of the submaps of a graph.g2o in map, in their order."""
    lines = [line.split() for line in path.read_text(encoding="utf-8").splitlines() if line.startswith("VERTEX_SE2")]
    return [tuple(map(float, fields[2:5])) for fields in lines]


def first_stamps_of(folder):
    """Stamps in us at which the submaps of a stored map begin: their frames are the vehicle's poses then."""
    with sqlite3.connect(f"file:{folder / 'map.sqlite'}?mode=ro", uri=True) as database:
        return [round(stamp / 1e3) for stamp, in database.execute("SELECT first_stamp_ns FROM submap ORDER BY submap_id")]


def seen_from(origin, pose):
    dx, dy = pose[0] - origin[0], pose[1] - origin[1]
    cosine, sine = math.cos(origin[2]), math.sin(origin[2])
    return cosine * dx + sine * dy, cosine * dy - sine * dx, math.remainder(pose[2] - origin[2], 2.0 * math.pi)


def true_nodes(folder):
    """True poses of the vehicle in the world where the submaps of a drive begin."""
    truth = poses_of(folder / "truth.tum")
    stamps = sorted(truth)
    return [truth[min(stamps, key=lambda one, wanted=wanted: abs(one - wanted))] for wanted in first_stamps_of(folder)]


def points_of_ways(folder, kind="lane"):
    """Points of the lines of a kind in lanes.geojson, in map."""
    features = json.loads((folder / "lanes.geojson").read_text(encoding="utf-8"))["features"]
    return [tuple(point) for feature in features if feature["properties"]["kind"] == kind for point in feature["geometry"]["coordinates"]]


def placed(pose, point):
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    return pose[0] + cosine * point[0] - sine * point[1], pose[1] + sine * point[0] + cosine * point[1]


def share_found(points, among, within_m=1.0):
    """Share of points that have one of the others near."""
    return sum(any(math.dist(point, other) <= within_m for other in among) for point in points) / len(points)


def merge(slammot, first, second, output):
    """Merges the maps in two folders and compares the joint map with the truth, which lies beside each of them."""
    command = [slammot, "map", "merge", first, second, "--output", output]
    finished = subprocess.run(command, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if finished.returncode not in (0, EXIT_NOT_JOINED):
        raise RuntimeError(f"{first} and {second}: exit code {finished.returncode}: {finished.stdout}")
    text = finished.stdout.strip().splitlines()
    if finished.returncode == EXIT_NOT_JOINED:
        return Merged(False, text[-1], {}, [], [], math.nan)
    of_first, of_second = true_nodes(first), true_nodes(second)
    true = [seen_from(of_first[0], pose) for pose in of_first + of_second]
    estimated = nodes_of(output / "graph.g2o")
    errors = [math.dist(a[:2], b[:2]) for a, b in zip(estimated, true, strict=True)]
    join = len(of_first)
    return Merged(True, next(line for line in text if "joined" in line), json.loads((output / "report.json").read_text())["counters"]["merge"],
                  errors[:join], errors[join:], abs(math.remainder(estimated[join][2] - true[join][2], 2.0 * math.pi)))
