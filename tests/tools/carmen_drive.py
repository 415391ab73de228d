"""A recorded drive in memory: the records of a CARMEN log (FLASER, ROBOTLASER1, ODOM, PARAM, others as they are) and its truth.

Records keep the words of their line, so that what nobody alters is written as it was read. Poses are (x [m], y [m], heading [rad]).
"""

import bisect
import collections
import dataclasses
import gzip
import math
import pathlib

LOG_ENDINGS = (".log", ".log.gz", ".rawodom.log", ".rawodom.log.gz")
TRUTH_TABLES = (".objects.csv", ".hits.csv")  # rows with a scan's stamp in the first column
FIXED_TABLES = (".walls.csv",)
NO_ECHO_M = 81.83  # of SICK scanners; where a log has no value of its own
MADE_UP_SPEED_MPS = 0.5  # where stamps do not advance: time made from the way
MADE_UP_TURN_RATE_RADPS = 0.5
MADE_UP_LEAST_STEP_S = 0.02
FARTHEST_AHEAD_S = 60.0  # of stamps: beyond these from the latest they are not believed
FARTHEST_BEHIND_S = 5.0


def compound(a, b):
    """a_from_c = a_from_b * b_from_c."""
    cosine, sine = math.cos(a[2]), math.sin(a[2])
    return a[0] + cosine * b[0] - sine * b[1], a[1] + sine * b[0] + cosine * b[1], a[2] + b[2]


def inverse(a):
    cosine, sine = math.cos(a[2]), math.sin(a[2])
    return -cosine * a[0] - sine * a[1], sine * a[0] - cosine * a[1], -a[2]


def between(a, b, share):
    turn = math.remainder(b[2] - a[2], 2 * math.pi)
    return a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * turn


def pose_words(pose):
    return [f"{value:.6f}" for value in pose]


@dataclasses.dataclass(frozen=True)
class Other:
    """A line that holds neither a scan nor odometry."""
    words: tuple

    def text(self):
        return " ".join(self.words)


@dataclasses.dataclass(frozen=True)
class Odom:
    """keyword x y heading | speeds and acceleration | stamp host logger_stamp"""
    wheel_from_base: tuple
    speeds: tuple
    stamps: tuple
    words_of_pose: tuple = None  # as read; None: the pose was altered

    def text(self):
        pose = self.words_of_pose or pose_words(self.wheel_from_base)
        return " ".join(["ODOM", *pose, *self.speeds, *self.stamps])


@dataclasses.dataclass(frozen=True)
class Scan:
    """keyword, layout of the beams (ROBOTLASER1), ranges, poses of laser and base, stamps."""
    keyword: str
    layout: tuple          # ROBOTLASER1: type, first beam [rad], field [rad], step [rad], max range [m], accuracy, remission mode
    beams: int
    ranges_text: str       # kept in one piece: most alterations do not look at it
    remissions: tuple      # ROBOTLASER1: words; None: the record has no count of them
    wheel_from_base: tuple
    base_from_laser: tuple
    speeds: tuple          # ROBOTLASER1: five words between poses and stamps
    stamps: tuple          # stamp, host, logger's stamp
    index: int             # among the scans of the log that was read
    recorded_stamp: float  # of the log that was read
    words_of_poses: tuple = None

    @property
    def ranges(self):
        """Readings as words."""
        return tuple(self.ranges_text.split())

    def with_ranges(self, words):
        words = list(words)
        return dataclasses.replace(self, beams=len(words), ranges_text=" ".join(words))

    def text(self):
        words = [self.keyword, *self.layout, str(self.beams), self.ranges_text]
        if self.remissions is not None:
            words += [str(len(self.remissions)), *self.remissions]
        wheel_from_laser = compound(self.wheel_from_base, self.base_from_laser)
        words += self.words_of_poses or pose_words(wheel_from_laser) + pose_words(self.wheel_from_base)
        return " ".join([*words, *self.speeds, *self.stamps])


def number(word):
    try:
        return float(word)
    except ValueError:
        return math.nan


def stamp_of(record):
    return number(record.stamps[0])


def poses_of_scan(words):
    laser, base = (tuple(float(word) for word in words[first:first + 3]) for first in (0, 3))
    return compound(inverse(base), laser), base


def ranges_and_rest(line, words_before, words_after):
    """The words before the ranges, their text and the words after it, if there are so many; None where the line is made otherwise."""
    head = line.split(None, words_before)
    tail = head[-1].rsplit(None, words_after)
    ranges_text = " ".join(tail[0].split()) if "  " in tail[0] or "\t" in tail[0] else tail[0]
    if len(head) != words_before + 1 or len(tail) != words_after + 1 or ranges_text.count(" ") + 1 != int(head[-2]):
        return None
    return head[:-1], ranges_text, tail[1:]


def parse_flaser(line, index):
    parts = ranges_and_rest(line, 2, 9)
    if parts is None:
        words = line.split()
        at = 2 + int(words[1])
        parts = words[:2], " ".join(words[2:at]), words[at:]
    head, ranges_text, rest = parts
    base_from_laser, base = poses_of_scan(rest)
    stamps = tuple(rest[6:])
    return Scan("FLASER", (), int(head[1]), ranges_text, None, base, base_from_laser, (), stamps, index, number(stamps[0]), tuple(rest[:6]))


def parse_robotlaser1(line, index):
    parts = ranges_and_rest(line, 9, 15)
    remissions = ()
    if parts is not None and parts[2][0] == "0":
        head, ranges_text, rest = parts
        rest = rest[1:]
    else:
        words = line.split()
        at = 9 + int(words[8])
        head, ranges_text, rest, remissions = words[:9], " ".join(words[9:at]), words[at:], None
        if len(rest) > 14:
            remissions, rest = tuple(rest[1:1 + int(rest[0])]), rest[1 + int(rest[0]):]
    base_from_laser, base = poses_of_scan(rest)
    stamps = tuple(rest[11:])
    return Scan("ROBOTLASER1", tuple(head[1:8]), int(head[8]), ranges_text, remissions, base, base_from_laser, tuple(rest[6:11]), stamps, index,
                number(stamps[0]), tuple(rest[:6]))


def parse_odom(words):
    return Odom(tuple(float(word) for word in words[1:4]), tuple(words[4:7]), tuple(words[7:]), tuple(words[1:4]))


def parse(lines):
    """Records in the log's order. A line that is damaged stays as it is."""
    records, scans = [], 0
    for line in lines:
        keyword = line.split(None, 1)[0] if line.strip() else ""
        record = None
        try:
            if keyword == "ODOM":
                record = parse_odom(line.split())
            elif keyword in ("FLASER", "ROBOTLASER1"):
                record = (parse_flaser if keyword == "FLASER" else parse_robotlaser1)(line, scans)
                scans += 1
        except (ValueError, IndexError):
            pass
        records.append(record or Other(tuple(line.split())))
    return records


def no_echo_of(scans):
    """The value that says "no echo" [m]: the record's own maximum, or the largest reading if it repeats, or NO_ECHO_M."""
    recorded = [number(scan.layout[4]) for scan in scans if scan.layout]
    if recorded and recorded[0] > 0:
        return recorded[0]
    counts = collections.Counter(word for scan in scans for word in scan.ranges)
    readings = {value: count for word, count in counts.items() if math.isfinite(value := number(word))}
    largest = max(readings, default=NO_ECHO_M)
    return largest if readings.get(largest, 0) >= max(5, sum(readings.values()) / 1000) else NO_ECHO_M


@dataclasses.dataclass(frozen=True)
class Drive:
    """base_turn_rad: heading of the base that truth speaks of, in the altered log's base. removed: from, to [recorded stamp]."""
    records: tuple
    no_echo_m: float
    base_turn_rad: float = 0.0
    removed: tuple = ()

    def scans(self):
        return [record for record in self.records if isinstance(record, Scan)]

    def odometry(self):
        """Scans and ODOM lines in the log's order: each holds a pose by the wheels."""
        return [record for record in self.records if isinstance(record, (Scan, Odom))]

    def replaced(self, new_of_old):
        """With each scan and ODOM line replaced by what new_of_old says of it; None removes it."""
        changed = (record if isinstance(record, Other) else new_of_old(record) for record in self.records)
        return dataclasses.replace(self, records=tuple(record for record in changed if record is not None))

    def with_odometry(self, poses):
        """With these poses by the wheels, one for each of odometry()."""
        poses = iter(poses)
        return self.replaced(lambda record: with_pose(record, next(poses)))

    def has_clock(self):
        """Whether the stamps advance from scan to scan."""
        stamps = [stamp_of(scan) for scan in self.scans()]
        advancing = sum(b > a for a, b in zip(stamps, stamps[1:]))
        return advancing > 0.5 * (len(stamps) - 1)

    def times(self):
        """Seconds since the first scan, one for each of odometry(), never falling: by the stamps, or made from the way."""
        records = self.odometry()
        times = times_by_stamps(records) if self.has_clock() else times_by_way(records)
        first = next(time for time, record in zip(times, records) if isinstance(record, Scan))
        return [time - first for time in times]


def times_by_stamps(records):
    """Where a stamp is far from the one before it, ahead or behind, time goes on by a usual step."""
    stamps = [stamp_of(record) for record in records]
    steps = sorted(b - a for a, b in zip(stamps, stamps[1:]) if b > a)
    usual_s = steps[len(steps) // 2] if steps else MADE_UP_LEAST_STEP_S
    offset_s, times = stamps[0], []
    for stamp in stamps:
        latest = times[-1] if times else 0.0
        if not -FARTHEST_BEHIND_S < stamp - offset_s - latest < FARTHEST_AHEAD_S and math.isfinite(stamp):
            offset_s = stamp - latest - usual_s
        times.append(max(latest, stamp - offset_s))  # the former if the stamp is no number
    return times


def times_by_way(records):
    times = [0.0]
    for before, record in zip(records, records[1:]):
        dx, dy, turn = compound(inverse(before.wheel_from_base), record.wheel_from_base)
        turn = abs(math.remainder(turn, 2 * math.pi))
        times.append(times[-1] + max(math.hypot(dx, dy) / MADE_UP_SPEED_MPS, turn / MADE_UP_TURN_RATE_RADPS, MADE_UP_LEAST_STEP_S))
    return times


def with_pose(record, pose):
    if pose == record.wheel_from_base:
        return record
    as_read = "words_of_poses" if isinstance(record, Scan) else "words_of_pose"
    return dataclasses.replace(record, wheel_from_base=pose, **{as_read: None})


def with_stamps(record, stamp, logger_stamp):
    """Both clocks, in the log's form: a record may lack host and logger's stamp."""
    words = [stamp, *record.stamps[1:2], logger_stamp, *record.stamps[3:]]
    return dataclasses.replace(record, stamps=tuple(words[:max(1, len(record.stamps))]))


def lines_of(path):
    path = pathlib.Path(path)
    with gzip.open(path, "rt", errors="replace") if path.suffix == ".gz" else open(path, errors="replace") as file:
        return file.read().splitlines()


def find(prefix, *endings):
    """The first file that exists of PREFIX + ending, plain or .gz; None: there is none."""
    for ending in endings:
        for path in (f"{prefix}{ending}", f"{prefix}{ending}.gz"):
            if pathlib.Path(path).is_file():
                return pathlib.Path(path)
    return None


def log_of(prefix):
    """The log of a prefix, or the prefix itself if it is a log."""
    if pathlib.Path(prefix).is_file():
        return pathlib.Path(prefix)
    found = find(prefix, *LOG_ENDINGS)
    if found is None:
        raise FileNotFoundError(2, "No such log", f"{prefix}.log")
    return found


def prefix_of(prefix):
    """A log's path without its endings."""
    for ending in sorted(LOG_ENDINGS, key=len, reverse=True):
        if prefix.endswith(ending) and pathlib.Path(prefix).is_file():
            return prefix[:-len(ending)]
    return prefix


def read_drive(prefix):
    records = tuple(parse(lines_of(log_of(prefix))))
    drive = Drive(records, NO_ECHO_M)
    if not drive.scans():
        raise ValueError(f"{log_of(prefix)}: no laser scan")
    return dataclasses.replace(drive, no_echo_m=no_echo_of(drive.scans()))


def heading_of(qz, qw):
    return 2 * math.atan2(qz, qw)


def read_tum(path):
    """Rows (stamp, pose) in their order."""
    rows = []
    for line in lines_of(path):
        if line.strip() and not line.startswith("#"):
            words = [float(word) for word in line.split()]
            rows.append((words[0], (words[1], words[2], heading_of(words[6], words[7]))))
    return rows


def read_reference(path):
    """Poses by the scan's index."""
    rows = {}
    for line in lines_of(path):
        if line.strip() and not line.startswith("#"):
            words = [float(word) for word in line.split()]
            rows[int(words[0])] = tuple(words[2:5])
    return rows


def poses_at(rows, stamps, farthest_s=0.1):
    """Poses of rows (stamp, pose) at these stamps, interpolated; None where the nearest rows are farther than farthest_s."""
    rows = sorted(rows, key=lambda row: row[0])
    known = [row[0] for row in rows]
    poses = []
    for stamp in stamps:
        after = bisect.bisect_left(known, stamp - 1e-7)
        if after < len(known) and abs(known[after] - stamp) < 1e-6:
            poses.append(rows[after][1])
        elif 0 < after < len(known) and known[after] - known[after - 1] <= 2 * farthest_s:
            (before_s, before), (after_s, behind) = rows[after - 1], rows[after]
            poses.append(between(before, behind, (stamp - before_s) / (after_s - before_s)))
        else:
            poses.append(None)
    return poses


def true_poses(prefix, drive):
    """The true pose of each scan that is left, in the altered log's base; None where it is not known. Empty without truth."""
    prefix = prefix_of(prefix)
    reference = find(prefix, ".reference.txt")
    tum = find(prefix, ".tum", ".ego.tum")
    if reference:
        rows = read_reference(reference)
        poses = [rows.get(scan.index) for scan in drive.scans()]
    elif tum:
        poses = poses_at(read_tum(tum), [scan.recorded_stamp for scan in drive.scans()])
    else:
        return []
    base_from_old_base = (0.0, 0.0, drive.base_turn_rad)
    return [pose and compound(pose, base_from_old_base) for pose in poses]


class NewStamps:
    """Where a time of the log that was read is in the altered one; None: its scan was removed."""

    def __init__(self, read, altered):
        self.of_scan = {round(scan.recorded_stamp * 1e6): None for scan in read.scans()}
        kept = [(scan.recorded_stamp, stamp_of(scan)) for scan in altered.scans()]
        self.of_scan.update((round(before * 1e6), now) for before, now in kept)
        kept.sort()
        self.before, self.now = [pair[0] for pair in kept], [pair[1] for pair in kept]
        self.removed = altered.removed

    def at(self, stamp):
        key = round(stamp * 1e6)
        if key in self.of_scan:
            return self.of_scan[key]
        if any(from_s <= stamp < to_s for from_s, to_s in self.removed):
            return None
        after = min(max(bisect.bisect_left(self.before, stamp), 1), len(self.before) - 1)
        (a, b), (c, d) = self.before[after - 1:after + 1], self.now[after - 1:after + 1]
        return c + (stamp - a) * (d - c) / (b - a) if b > a else c


def write_lines(path, lines):
    pathlib.Path(path).write_text("\n".join(lines) + "\n")


def altered_tum(lines, new_stamps, turn_rad):
    for line in lines:
        if not line.strip() or line.startswith("#"):
            continue
        words = line.split()
        stamp = new_stamps.at(float(words[0]))
        if stamp is None:
            continue
        if stamp != float(words[0]):
            words[0] = f"{stamp:.6f}"
        if turn_rad:
            half = (heading_of(float(words[6]), float(words[7])) + turn_rad) / 2
            words[6:8] = f"{math.sin(half):.9f}", f"{math.cos(half):.9f}"
        yield " ".join(words)


def altered_table(lines, new_stamps):
    for number_of_line, line in enumerate(lines):
        stamp, comma, rest = line.partition(",")
        if number_of_line == 0:
            yield line
            continue
        altered = new_stamps.at(float(stamp))
        if altered is not None:
            yield line if altered == float(stamp) else f"{altered:.6f}{comma}{rest}"


def write_drive(read, altered, prefix, copy, zipped=False):
    """Writes COPY.log and what truth PREFIX has, for the scans that are left: .tum, .objects.csv, .hits.csv, .walls.csv, and
    COPY.reference.txt, which counts scans and so does not depend on stamps."""
    pathlib.Path(copy).parent.mkdir(parents=True, exist_ok=True)
    text = "\n".join(record.text() for record in altered.records) + "\n"
    if zipped:
        with gzip.GzipFile(f"{copy}.log.gz", "wb", compresslevel=1, mtime=0) as file:
            file.write(text.encode())
    else:
        pathlib.Path(f"{copy}.log").write_text(text)
    prefix = prefix_of(prefix)
    new_stamps = NewStamps(read, altered)
    for ending in (".tum", ".ego.tum", ".red.tum"):
        if path := find(prefix, ending):
            write_lines(f"{copy}{ending}", altered_tum(lines_of(path), new_stamps, altered.base_turn_rad if ending != ".red.tum" else 0.0))
    for ending in TRUTH_TABLES:
        if path := find(prefix, ending):
            write_lines(f"{copy}{ending}", altered_table(lines_of(path), new_stamps))
    for ending in FIXED_TABLES:
        if path := find(prefix, ending):
            write_lines(f"{copy}{ending}", lines_of(path))
    poses = true_poses(prefix, altered)
    rows = [f"{index} {scan.stamps[0]} " + " ".join(f"{value:.9g}" for value in pose)
            for index, (scan, pose) in enumerate(zip(altered.scans(), poses)) if pose]
    if rows:
        write_lines(f"{copy}.reference.txt", ["# scan_index stamp x y heading", *rows])
