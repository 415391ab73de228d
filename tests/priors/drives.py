"""Simulated drives with GNSS and compass, disturbances of both, and comparison of results with the truth."""

import dataclasses
import gzip
import json
import math
import random
import subprocess

SCENARIO = """seed: {seed}
duration_s: {duration_s}
city {{ blocks_east: 5 blocks_north: 4 signalled_share: 0.1 }}
traffic {{ cars: 12 bicycles: 4 }}
walkers {{ pedestrians: 20 }}
route {{ junctions [{junctions}] start_m: 30 }}
gnss {{ rate_hz: 2 }}
compass {{ rate_hz: 5 }}
"""
ORIGIN_DEG = (40.4406, -79.9959)  # of the simulated world, the default of scenarios
STREET_ERROR_M = 1.5              # of each junction of the street graph, one sigma an axis


@dataclasses.dataclass(frozen=True)
class Drive:
    seed: int
    folder: object
    scenario: object
    truth: list     # (stamp in s, x in m, y in m, heading in rad) in world


def route_of(seed):
    """Around a rectangle of blocks, then half of it again and on to another street."""
    dice = random.Random(seed)
    west, south = dice.randint(0, 2), dice.randint(0, 2)
    east, north = west + dice.randint(1, 2), south + dice.randint(1, 2)
    corners = [(west, south), (east, south), (east, north), (west, north)]
    first = dice.randrange(4)
    corners = corners[first:] + corners[:first]
    if dice.random() < 0.5:
        corners.reverse()
    return corners + corners[:2]


def poses_of(path):
    poses = []
    for line in path.read_text(encoding="utf-8").splitlines():
        stamp, x, y, _, _, _, qz, qw = map(float, line.split())
        poses.append((stamp, x, y, 2.0 * math.atan2(qz, qw)))
    return poses


def simulate(slammot, seed, folder, duration_s):
    """Simulates the drive where that was not done yet."""
    output = folder / f"drive-{seed}"
    output.mkdir(parents=True, exist_ok=True)
    scenario = output / "drive.textproto"
    junctions = ", ".join(f"{{ column: {column} row: {row} }}" for column, row in route_of(seed))
    scenario.write_text(SCENARIO.format(seed=seed, duration_s=duration_s, junctions=junctions))
    if not (output / "drive.walls.csv").exists() or not (output / "done").exists():
        subprocess.run([slammot, "simulate", scenario, "--output", output], check=True, stdout=subprocess.DEVNULL)
        (output / "done").touch()
    return Drive(seed, output, scenario, poses_of(output / "drive.tum"))


def way_at(truth):
    """Way in m at each stamp in us of the truth."""
    way, travelled, before = {}, 0.0, truth[0]
    for pose in truth:
        travelled += math.dist(pose[1:3], before[1:3])
        way[round(pose[0] * 1e6)] = travelled
        before = pose
    return way


def stretches(dice, total_m, lengths_m, sizes):
    """Three stretches of the way with an offset each: (begin in m, end in m, size, direction)."""
    found = []
    for _ in range(3):
        length = dice.uniform(*lengths_m)
        begin = dice.uniform(0.0, max(1.0, total_m - length))
        found.append((begin, begin + length, dice.uniform(*sizes), dice.uniform(-math.pi, math.pi)))
    return found


def offset_at(where_m, disturbed):
    return next(((size, direction) for begin, end, size, direction in disturbed if begin <= where_m < end), None)


def shifted_gga(line, size_m, direction):
    words = line.split(" ")
    north_min = size_m * math.sin(direction) / 1852.0
    east_min = size_m * math.cos(direction) / (1852.0 * math.cos(math.radians(ORIGIN_DEG[0])))
    words[3] = f"{float(words[3]) + north_min:.6f}"
    words[5] = f"{float(words[5]) + (east_min if words[6] == 'E' else -east_min):.6f}"
    return " ".join(words)


def turned_hdt(line, turn_rad):
    words = line.split(" ")
    words[2] = f"{(float(words[2]) + math.degrees(turn_rad)) % 360.0:.3f}"
    return " ".join(words)


def altered(drive, case):
    """The drive's log with what the case disturbs: lasting multipath of 20 to 60 m, iron of 0.3 to 1.2 rad; 'without' has neither sensor."""
    dice = random.Random(1000 + drive.seed)
    way = way_at(drive.truth)
    total_m = max(way.values())
    multipath = stretches(dice, total_m, (60.0, 150.0), (20.0, 60.0))
    iron = stretches(dice, total_m, (40.0, 120.0), (0.3, 1.2))
    path = drive.folder / f"{case}.log.gz"
    if path.exists():
        return path
    with open(drive.folder / "drive.log", encoding="utf-8") as log, gzip.open(path, "wt", compresslevel=1) as out:
        for line in log:
            is_gga, is_hdt = line.startswith("NMEAGGA"), line.startswith("NMEAHDT")
            if case == "without" and (is_gga or is_hdt):
                continue
            if is_gga or is_hdt:
                where_m = way.get(round(float(line.split()[-3]) * 1e6), 0.0)
                has_fix = is_gga and line.split()[7] != "0"
                if has_fix and case in ("multipath", "both") and (offset := offset_at(where_m, multipath)):
                    line = shifted_gga(line, *offset)
                if is_hdt and case in ("iron", "both") and (offset := offset_at(where_m, iron)):
                    line = turned_hdt(line, math.copysign(offset[0], offset[1]))
            out.write(line)
    return path


def run(slammot, drive, case):
    """The folder with the results of a case; processes it where that was not done yet."""
    output = drive.folder / case
    if not (output / "settings.textproto").exists():
        subprocess.run([slammot, "run", "--input", altered(drive, case), "--no-report", "--quiet", "--output", output], check=True)
    return output


def aligned(estimated, true):
    """Least squares rotation and shift of pairs of points: (cosine, sine, x, y)."""
    count = len(estimated)
    ax, ay = sum(p[0] for p in estimated) / count, sum(p[1] for p in estimated) / count
    bx, by = sum(p[0] for p in true) / count, sum(p[1] for p in true) / count
    along = sum((p[0] - ax) * (q[0] - bx) + (p[1] - ay) * (q[1] - by) for p, q in zip(estimated, true))
    across = sum((p[0] - ax) * (q[1] - by) - (p[1] - ay) * (q[0] - bx) for p, q in zip(estimated, true))
    turn = math.atan2(across, along)
    cosine, sine = math.cos(turn), math.sin(turn)
    return cosine, sine, bx - cosine * ax + sine * ay, by - sine * ax - cosine * ay


def ate_m(drive, output):
    """Root mean square error of the corrected trajectory after alignment."""
    true = {round(pose[0] * 1e6): pose[1:3] for pose in drive.truth}
    pairs = [(pose[1:3], true[stamp]) for pose in poses_of(output / "trajectory.tum")[::8] if (stamp := round(pose[0] * 1e6)) in true]
    cosine, sine, x, y = aligned([a for a, _ in pairs], [b for _, b in pairs])
    errors = [math.hypot(cosine * a[0] - sine * a[1] + x - b[0], sine * a[0] + cosine * a[1] + y - b[1]) for a, b in pairs]
    return math.sqrt(sum(error * error for error in errors) / len(errors))


def metres_per_degree():
    """Of longitude and latitude at the origin, WGS 84 as in common/geometry/geodetic.cpp."""
    sine = math.sin(math.radians(ORIGIN_DEG[0]))
    shape = 1.0 - 6.69437999014e-3 * sine * sine
    across = 6378137.0 / math.sqrt(shape)
    return (math.radians(across * math.cos(math.radians(ORIGIN_DEG[0]))), math.radians(across * (1.0 - 6.69437999014e-3) / shape))


def metres_of(latitude_deg, longitude_deg):
    """East and north of the world's origin."""
    east, north = metres_per_degree()
    return (longitude_deg - ORIGIN_DEG[1]) * east, (latitude_deg - ORIGIN_DEG[0]) * north


def degrees_of(x_m, y_m):
    east, north = metres_per_degree()
    return ORIGIN_DEG[0] + y_m / north, ORIGIN_DEG[1] + x_m / east


def placed(latitude_deg, longitude_deg, turn_rad, point):
    """A point of map in world."""
    x, y = metres_of(latitude_deg, longitude_deg)
    cosine, sine = math.cos(turn_rad), math.sin(turn_rad)
    return x + cosine * point[0] - sine * point[1], y + sine * point[0] + cosine * point[1]


def georeference_of(output):
    return json.loads((output / "report.json").read_text(encoding="utf-8")).get("georeference")


def streets_of(slammot, drive, without=None):
    """Street graph as a rough digital map: every junction off by STREET_ERROR_M, the streets between them with it."""
    name = "streets" if without is None else "streets-without-" + without.replace(",", "_")
    folder = drive.folder / name
    path = folder / "rough.geojson"
    if path.exists():
        return path
    command = [slammot, "simulate", drive.scenario, "--streets", "--output", folder] + (["--without-street", without] if without else [])
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    graph = json.loads((folder / "drive.streets.geojson").read_text(encoding="utf-8"))
    for feature in graph["features"]:
        points = feature["geometry"]["coordinates"]
        ends = [random.Random(f"{drive.seed} {lon:.6f} {lat:.6f}") for lon, lat in (points[0], points[-1])]
        (east_0, north_0), (east_1, north_1) = [(end.gauss(0.0, STREET_ERROR_M), end.gauss(0.0, STREET_ERROR_M)) for end in ends]
        for index, point in enumerate(points):
            share = index / (len(points) - 1)
            x, y = metres_of(point[1], point[0])
            latitude, longitude = degrees_of(x + east_0 + share * (east_1 - east_0), y + north_0 + share * (north_1 - north_0))
            point[0], point[1] = longitude, latitude
    path.write_text(json.dumps(graph), encoding="utf-8")
    return path


def starts_of(trajectory, spacing_m, least_m):
    """Indices of poses, spacing_m of way apart, with at least least_m of way after them."""
    ways, travelled = [0.0], 0.0
    for before, pose in zip(trajectory, trajectory[1:]):
        travelled += math.dist(before[1:3], pose[1:3])
        ways.append(travelled)
    starts, due = [], 0.0
    for index, way in enumerate(ways):
        if way >= due and travelled - way >= least_m:
            starts.append(index)
            due = way + spacing_m
    return starts, ways


def street_driven(drive, graph, pose):
    """Name of the street nearest to a true position."""
    def distance(feature):
        points = [metres_of(lat, lon) for lon, lat in feature["geometry"]["coordinates"]]
        return min(math.dist(pose, point) for point in points[1:-1])
    return min(graph["features"], key=distance)["properties"]["name"]


def direction_of(drive, output):
    """True direction of a result's x axis from east."""
    true = {round(pose[0] * 1e6): pose[1:3] for pose in drive.truth}
    pairs = [(pose[1:3], true[stamp]) for pose in poses_of(output / "trajectory.tum")[::8] if (stamp := round(pose[0] * 1e6)) in true]
    cosine, sine, _, _ = aligned([a for a, _ in pairs], [b for _, b in pairs])
    return math.atan2(sine, cosine)


def find(slammot, drive, output, start, end, graph, near, within_m, direction=None):
    """Verdict, way needed in m, and error in m of a piece of the trajectory. direction: of its x axis from east, if it is known."""
    trajectory = (output / "trajectory.tum").read_text(encoding="utf-8").splitlines()
    piece = drive.folder / "piece.tum"
    piece.write_text("\n".join(trajectory[start:end]) + "\n", encoding="utf-8")
    latitude, longitude = degrees_of(*near)
    text = subprocess.run([slammot, "streets", "--trajectory", piece, "--map", output / "map.yaml", "--streets", graph, f"--near={latitude:.9f},{longitude:.9f}",
                           "--near-within", str(within_m)] + ([] if direction is None else [f"--x-from-east={direction:.4f}"]), check=True, stdout=subprocess.PIPE, text=True).stdout
    found = json.loads(text)
    if found["verdict"] != "located":
        return found["verdict"], math.inf, math.inf
    place = found["places"][0]
    first = poses_of(piece)[0]
    estimated = placed(place["map_origin_latitude_deg"], place["map_origin_longitude_deg"], place["x_from_east_rad"], first[1:3])
    true = {round(pose[0] * 1e6): pose[1:3] for pose in drive.truth}
    return "located", found["located_after_m"], math.dist(estimated, true[round(first[0] * 1e6)])
