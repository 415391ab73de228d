"""What can be done to a recorded drive: functions from a Drive to a Drive, each one fault of a log, a scanner, or wheels.

Times are seconds since the first scan (Drive.times). What is random is drawn by a seed and the scan's index, so that one alteration
draws the same whatever else is altered.
"""

import bisect
import dataclasses
import math
import random

import carmen_drive
from carmen_drive import Odom, Other, Scan, between, compound, inverse, number, stamp_of, with_pose, with_stamps

# ---- stamps ------------------------------------------------------------------------------------------------------------------


def with_stamps_by(drive, stamp_of_record):
    """stamp_of_record(record, scans before it, its stamp or logger's stamp): the new one, for both clocks."""
    scans, records = 0, []
    for record in drive.records:
        if not isinstance(record, Other):
            logger = number(record.stamps[2]) if len(record.stamps) > 2 else math.nan
            record = with_stamps(record, stamp_of_record(record, scans, number(record.stamps[0])), stamp_of_record(record, scans, logger))
            scans += isinstance(record, Scan)
        records.append(record)
    return dataclasses.replace(drive, records=tuple(records))


def stamps_zero(drive):
    return with_stamps_by(drive, lambda record, scans, stamp: "0.000000")


def stamps_index(drive):
    """Scans are counted; an ODOM line has the number of the scan before it."""
    return with_stamps_by(drive, lambda record, scans, stamp: str(scans if isinstance(record, Scan) else max(scans - 1, 0)))


def stamps_seconds(drive):
    return with_stamps_by(drive, lambda record, scans, stamp: f"{math.floor(stamp)}.000000" if math.isfinite(stamp) else "0")


def stamps_milliseconds(drive):
    return with_stamps_by(drive, lambda record, scans, stamp: f"{1000 * stamp:.3f}")


def stamps_jump(drive, seconds=3600.0):
    """From the middle of the drive on, stamps are later by so much."""
    middle = len(drive.scans()) // 2
    return with_stamps_by(drive, lambda record, scans, stamp: f"{stamp + (seconds if scans >= middle else 0.0):.6f}")


def stamps_backwards(drive):
    """Time runs from the last stamp to the first."""
    stamps = [stamp_of(scan) for scan in drive.scans()]
    ends = min(stamps) + max(stamps)
    return with_stamps_by(drive, lambda record, scans, stamp: f"{ends - stamp:.6f}")


def scan_stamps_noisy(drive, sigma_s, seed):
    """Stamps of scans by a computer that is busy: each with noise, none earlier than the one before. Those of ODOM lines are as they were."""
    last_s = -math.inf

    def noisy(record):
        nonlocal last_s
        if not isinstance(record, Scan):
            return record
        last_s = max(last_s, stamp_of(record) + generator(seed, "stamps", record).gauss(0.0, sigma_s))
        return with_stamps(record, f"{last_s:.6f}", f"{last_s:.6f}")
    return drive.replaced(noisy)


def in_another_order(drive, size, seed):
    """Each so many scans in any order, with their stamps and poses; other records stay where they are."""
    records = list(drive.records)
    places = [i for i, record in enumerate(records) if isinstance(record, Scan)]
    for first in range(0, len(places), size):
        some = places[first:first + size]
        scans = [records[i] for i in some]
        generator(seed, "order", scans[0]).shuffle(scans)
        for place, scan in zip(some, scans):
            records[place] = scan
    return dataclasses.replace(drive, records=tuple(records))


def scan_stamps_of_batches(drive, size, between_s=0.0002):
    """Scans come so many at a time and are stamped as they come, right after one another. Stamps of ODOM lines are as they were."""
    scans = drive.scans()
    places = {id(scan): place for place, scan in enumerate(scans)}

    def late(record):
        if not isinstance(record, Scan):
            return record
        place = places[id(record)]
        last = scans[min(place // size * size + size, len(scans)) - 1]
        stamp = f"{stamp_of(last) + between_s * (place % size):.6f}"
        return with_stamps(record, stamp, stamp)
    return drive.replaced(late)


# ---- which scans -------------------------------------------------------------------------------------------------------------


def every_nth(drive, n):
    """Every nth scan is left, from the first on. ODOM lines stay."""
    order = iter(range(len(drive.scans())))
    return drive.replaced(lambda record: record if isinstance(record, Odom) or next(order) % n == 0 else None)


def cut(drive, from_s, to_s, no_time_passes):
    """Carried away: what lies between is missing, the wheels stand meanwhile."""
    start = drive.scans()[0].recorded_stamp
    before = [scan for scan in drive.scans() if scan.recorded_stamp < start + from_s]
    after = [scan for scan in drive.scans() if scan.recorded_stamp >= start + to_s]
    if not before or not after:
        raise ValueError("nothing is left before or after the cut")
    usual_step_s = before[-1].recorded_stamp - before[-2].recorded_stamp if len(before) > 1 else 0.0
    sooner_s = after[0].recorded_stamp - before[-1].recorded_stamp - usual_step_s if no_time_passes else 0.0
    old_from_new = compound(before[-1].wheel_from_base, inverse(after[0].wheel_from_base))
    places = {id(record): place for place, record in enumerate(drive.records)}
    first, last = places[id(before[-1])], places[id(after[0])]

    def moved(record):
        if not (places[id(record)] <= first or places[id(record)] >= last):
            return None
        if places[id(record)] <= first:
            return record
        record = with_pose(record, compound(old_from_new, record.wheel_from_base))
        if not sooner_s:
            return record
        words = [f"{number(word) - sooner_s:.6f}" for word in (record.stamps[0], record.stamps[-1])]
        return with_stamps(record, *words)
    return dataclasses.replace(drive.replaced(moved), removed=drive.removed + ((start + from_s, start + to_s),))


def halves_swapped(drive):
    """Two recordings in one log: the second half of the drive, then the first one, for which odometry begins anew at zero. Stamps go on."""
    scans = drive.scans()
    middle = next(place for place, record in enumerate(drive.records) if record is scans[len(scans) // 2])
    then, first = drive.records[:middle], drive.records[middle:]
    start = next(record for record in then if not isinstance(record, Other))
    usual_step_s = scans[-1].recorded_stamp - scans[-2].recorded_stamp
    later_s = scans[-1].recorded_stamp + usual_step_s - scans[0].recorded_stamp

    def begun_anew(record):
        if isinstance(record, Other):
            return record
        record = with_pose(record, compound(inverse(start.wheel_from_base), record.wheel_from_base))
        return with_stamps(record, *(f"{number(word) + later_s:.6f}" for word in (record.stamps[0], record.stamps[-1])))
    return dataclasses.replace(drive, records=(*first, *map(begun_anew, then)))


def driven_backwards(drive):
    """From its end to its start: the vehicle backs away from what the scanner sees. Lines that are neither scans nor odometry come first."""
    mirrored = stamps_backwards(drive).records
    others = [record for record in mirrored if isinstance(record, Other)]
    return dataclasses.replace(drive, records=(*others, *(record for record in reversed(mirrored) if not isinstance(record, Other))))


# ---- what a scan says --------------------------------------------------------------------------------------------------------


def is_echo(drive, reading_m):
    return 0.0 < reading_m < 0.99 * drive.no_echo_m  # false for NaN


def no_echo_word(drive):
    return f"{drive.no_echo_m:.2f}" if round(drive.no_echo_m, 2) == drive.no_echo_m else repr(drive.no_echo_m)


def with_readings(drive, new_words):
    """new_words(scan, its readings as words, a generator of its own): the new words."""
    def changed(record):
        return record.with_ranges(new_words(record, record.ranges)) if isinstance(record, Scan) else record
    return drive.replaced(changed)


def generator(seed, what, scan):
    return random.Random(f"{seed} {what} {scan.index}")


def no_farther(drive, most_m):
    """Echoes from farther than this are missing; "no echo" is written as before."""
    none = no_echo_word(drive)
    return with_readings(drive, lambda scan, words: [none if number(word) > most_m else word for word in words])


def dropouts(drive, share, seed):
    none = no_echo_word(drive)

    def lossy(scan, words):
        draw = generator(seed, "dropouts", scan).random
        return [none if draw() < share else word for word in words]
    return with_readings(drive, lossy)


def noise(drive, sigma_m, seed):
    def noisy(scan, words):
        draw = generator(seed, "noise", scan).gauss
        return [f"{max(0.01, number(word) + draw(0.0, sigma_m)):.3f}" if is_echo(drive, number(word)) else word for word in words]
    return with_readings(drive, noisy)


def own_body(drive, seed, noise_m=0.01):
    """Three parts of the vehicle hide a fifth of the view: at both ends and in the middle, 0.30 to 0.42 m away."""
    parts = ((0.0, 0.08, 0.35), (0.48, 0.52, 0.42), (0.93, 1.0, 0.30))

    def hidden(scan, words):
        draw, words = generator(seed, "own body", scan).gauss, list(words)
        for first, end, range_m in parts:
            for beam in range(int(first * len(words)), int(end * len(words))):
                words[beam] = f"{range_m + draw(0.0, noise_m):.3f}"
        return words
    return with_readings(drive, hidden)


def blind_ahead(drive, degrees):
    """Something close hides the middle of the view, and gives no echo."""
    none = no_echo_word(drive)

    def hidden(scan, words):
        first_rad, step_rad = beams_of(scan)
        return [none if abs(first_rad + beam * step_rad) <= math.radians(degrees) / 2 else word for beam, word in enumerate(words)]
    return with_readings(drive, hidden)


def walks_ahead(drive, seed, half_width_m=0.3, noise_m=0.02):
    """Somebody walks ahead of the vehicle all the way, 1.0 to 1.4 m away and up to 0.1 m off its middle: 27 degrees of the view."""
    def hidden(scan, words):
        draw = generator(seed, "walks ahead", scan).gauss
        ahead_m = 1.2 + 0.2 * math.sin(0.11 * scan.index)
        left_m = 0.1 * math.sin(0.07 * scan.index)
        first_rad, step_rad = beams_of(scan)
        changed = []
        for beam, word in enumerate(words):
            bearing_rad = first_rad + beam * step_rad
            side_m = ahead_m * math.tan(bearing_rad) - left_m if abs(bearing_rad) < 1.0 else math.inf
            inside = abs(side_m) <= half_width_m
            nearer_m = (ahead_m - 0.1 * math.sqrt(1.0 - (side_m / half_width_m)**2)) / math.cos(bearing_rad) if inside else math.inf
            read_m = number(word)
            changed.append(f"{nearer_m + draw(0.0, noise_m):.3f}" if inside and not 0.0 < read_m < nearer_m else word)
        return changed
    return with_readings(drive, hidden)


def hung(drive, from_s, to_s):
    """The scanner gives its last readings again and again; stamps and odometry go on."""
    times = {id(record): time_s for record, time_s in zip(drive.odometry(), drive.times())}
    last = [None]

    def repeated(record):
        if not isinstance(record, Scan):
            return record
        if last[0] is not None and from_s < times[id(record)] <= to_s:
            return record.with_ranges(last[0])
        last[0] = record.ranges
        return record
    return drive.replaced(repeated)


def false_echoes(drive, share, seed, farthest_m=20.0):
    """So many beams end somewhere before what they would have met, evenly distributed."""
    def mistaken(scan, words):
        generate = generator(seed, "false echoes", scan)
        draw, between_m = generate.random, generate.uniform
        return [f"{between_m(0.2, max(0.2, min(number(word), farthest_m))):.3f}" if draw() < share and number(word) > 0.2 else word
                for word in words]
    return with_readings(drive, mistaken)


def rain(drive, share, seed, mean_m=3.0):
    """So many beams meet a drop on their way, the more the nearer; what is far comes back less often (Beer-Lambert)."""
    none = no_echo_word(drive)

    def wet(scan, words):
        draw = generator(seed, "rain", scan)
        changed = []
        for word in words:
            drop_m = draw.expovariate(1.0 / mean_m) + 0.3
            hit, lost = draw.random() < share, draw.random()
            if hit and not number(word) <= drop_m:
                changed.append(f"{drop_m:.3f}")
            elif is_echo(drive, number(word)) and lost < 1.0 - math.exp(-share * number(word) / 10.0):
                changed.append(none)
            else:
                changed.append(word)
        return changed
    return with_readings(drive, wet)


def nan_in_every_nth(drive, n):
    """No reading of every nth scan is a number."""
    return with_readings(drive, lambda scan, words: ["nan"] * len(words) if scan.index % n == n - 1 else words)


def no_echo_as(drive, word):
    return with_readings(drive, lambda scan, words: [old if is_echo(drive, number(old)) else word for old in words])


def ranges_scaled(drive, factor):
    """Another unit than the format's metre, the record's maximum included."""
    def scaled(record):
        if not isinstance(record, Scan):
            return record
        ranges = (f"{factor * number(word):.0f}" for word in record.ranges)
        layout = (*record.layout[:4], f"{factor * number(record.layout[4]):.0f}", *record.layout[5:]) if record.layout else ()
        return dataclasses.replace(record.with_ranges(ranges), layout=layout)
    return dataclasses.replace(drive.replaced(scaled), no_echo_m=factor * drive.no_echo_m)


# ---- how beams lie -----------------------------------------------------------------------------------------------------------


def beams_of(scan):
    """First beam and step [rad], by the record or else by convention: 180 degrees; with both ends if there are oddly many."""
    count = scan.beams
    if scan.layout:
        return number(scan.layout[1]), number(scan.layout[3])
    return -math.pi / 2, math.pi / (count if count % 2 == 0 else count - 1)


def with_beams(scan, chosen):
    """Only these beams: indices of a constant step. ROBOTLASER1 says how they lie, FLASER cannot."""
    ranges, remissions = scan.ranges, scan.remissions
    if remissions and len(remissions) == len(ranges):
        remissions = tuple(remissions[beam] for beam in chosen)
    narrowed = scan.with_ranges(ranges[beam] for beam in chosen)
    if not scan.layout:
        return narrowed
    first_rad, step_rad = beams_of(scan)
    every = chosen[1] - chosen[0] if len(chosen) > 1 else 1
    new_step_rad = every * step_rad
    layout = (scan.layout[0], f"{first_rad + chosen[0] * step_rad:.6f}", f"{new_step_rad * (len(chosen) - 1):.6f}", f"{new_step_rad:.6f}",
              *scan.layout[4:])
    return dataclasses.replace(narrowed, remissions=remissions, layout=layout)


def field_of_view(drive, degrees):
    """The beams in the middle are left, evenly to both sides of straight ahead of the scanner."""
    half_rad = math.radians(degrees) / 2 + 1e-4

    def narrowed(record):
        if not isinstance(record, Scan):
            return record
        first_rad, step_rad = beams_of(record)
        chosen = [beam for beam in range(record.beams) if abs(first_rad + beam * step_rad) <= half_rad]
        return with_beams(record, chosen) if len(chosen) > 1 else record
    return drive.replaced(narrowed)


def every_nth_beam(drive, n):
    return drive.replaced(lambda record: with_beams(record, range(0, record.beams, n)) if isinstance(record, Scan) else record)


def beams_reversed(drive):
    """The last beam is written first, and the record does not say so."""
    return with_readings(drive, lambda scan, words: reversed(words))


def upside_down(drive):
    """The scanner hangs: what it has to the left it writes where it would be to the right. A direction that was not measured has no echo."""
    none = no_echo_word(drive)

    def hung(scan, words):
        first_rad, step_rad = beams_of(scan)
        mirrored = [round(-(first_rad + beam * step_rad + first_rad) / step_rad) for beam in range(len(words))]
        turn = round(2 * math.pi / step_rad)
        mirrored = [beam % turn if len(words) >= turn - 1 else beam for beam in mirrored]
        return [words[beam] if 0 <= beam < len(words) else none for beam in mirrored]
    return with_readings(drive, hung)


def mounted_backwards(drive):
    """The vehicle's front is where its rear was. The laser's pose says so, and PARAM where the log has such lines."""
    half_turn = (0.0, 0.0, math.pi)

    def turned(record):
        x, y, heading = record.wheel_from_base
        record = with_pose(record, (-x, -y, heading))
        if not isinstance(record, Scan):
            return record
        laser = compound(half_turn, record.base_from_laser)
        return dataclasses.replace(record, base_from_laser=(*laser[:2], math.remainder(laser[2], 2 * math.pi)), words_of_poses=None)

    records, says_offset = [], False
    for record in drive.replaced(turned).records:
        if isinstance(record, Other) and record.words[:1] == ("PARAM",) and record.words[1:2] in (
                ("robot_frontlaser_offset",), ("robot_frontlaser_side_offset",)):
            says_offset = True
            record = Other((*record.words[:2], f"{-number(record.words[2]):.3f}", *record.words[3:]))
        records.append(record)
    if says_offset:
        records.insert(0, Other(("PARAM", "robot_frontlaser_angular_offset", f"{math.pi:.6f}")))
    return dataclasses.replace(drive, records=tuple(records), base_turn_rad=drive.base_turn_rad + math.pi)


def scanner_turned(drive, degrees):
    """The scanner looks so far to the left, unsaid, to a whole beam. Where it did not look there is no echo."""
    none = no_echo_word(drive)

    def turned(scan, words):
        words = list(words)
        beams = round(math.radians(degrees) / beams_of(scan)[1])
        if beams >= 0:
            return words[beams:] + [none] * min(beams, len(words))
        return [none] * min(-beams, len(words)) + words[:beams]
    return with_readings(drive, turned)


# ---- odometry ----------------------------------------------------------------------------------------------------------------


def with_motions(drive, new_motion):
    """new_motion(motion in the base before, time before, time): the motion that the wheels then say, from pose to pose."""
    records, times = drive.odometry(), drive.times()
    poses = [records[0].wheel_from_base]
    for place in range(1, len(records)):
        dx, dy, turn = compound(inverse(records[place - 1].wheel_from_base), records[place].wheel_from_base)
        motion = new_motion((dx, dy, math.remainder(turn, 2 * math.pi)), times[place - 1], times[place])
        x, y, heading = compound(poses[-1], motion)
        poses.append((x, y, math.remainder(heading, 2 * math.pi)))
    return drive.with_odometry(poses)


def way_scaled(drive, factor):
    return with_motions(drive, lambda motion, before_s, now_s: (factor * motion[0], factor * motion[1], motion[2]))


def turns_scaled(drive, factor):
    """-1: turns have the wrong sign."""
    return with_motions(drive, lambda motion, before_s, now_s: (motion[0], motion[1], factor * motion[2]))


def turns_slipping(drive, spread, seed):
    """Wheels that slip in turns: another factor on the turn every two seconds, within 1 - spread and 1 + spread."""
    drawn = random.Random(seed)
    factors = {}

    def factor(now_s):
        stretch = now_s // 2.0
        if stretch not in factors:
            factors[stretch] = drawn.uniform(1.0 - spread, 1.0 + spread)
        return factors[stretch]

    return with_motions(drive, lambda motion, before_s, now_s: (*motion[:2], factor(now_s) * motion[2]))


def yaw_bias(drive, radps):
    return with_motions(drive, lambda motion, before_s, now_s: (*motion[:2], motion[2] + radps * (now_s - before_s)))


def turns_noisy(drive, sigma_rad, seed):
    """Noise on the turns while the vehicle moves; sigma_rad: after one second."""
    drawn = random.Random(seed)

    def noisy(motion, before_s, now_s):
        moves = abs(motion[0]) > 1e-4 or abs(motion[2]) > 1e-5
        noise_rad = drawn.gauss(0.0, sigma_rad * math.sqrt(max(0.0, now_s - before_s))) if moves else 0.0
        return (*motion[:2], motion[2] + noise_rad)

    return with_motions(drive, noisy)


def counted(drive, tick_m, track_m):
    """Two wheels track_m apart whose ways are counted in whole ticks; no error grows."""
    ways_m, ticks = [0.0, 0.0], [0, 0]

    def motion_of_ticks(motion, before_s, now_s):
        steps_m = []
        for wheel, side in enumerate((-0.5, 0.5)):
            ways_m[wheel] += motion[0] + side * track_m * motion[2]
            before, ticks[wheel] = ticks[wheel], math.floor(ways_m[wheel] / tick_m)
            steps_m.append(tick_m * (ticks[wheel] - before))
        return 0.5 * sum(steps_m), motion[1], (steps_m[1] - steps_m[0]) / track_m

    return with_motions(drive, motion_of_ticks)


def axes_swapped(drive):
    """x is written where y should be, and y where x should be."""
    return drive.with_odometry([(y, x, heading) for x, y, heading in (record.wheel_from_base for record in drive.odometry())])


def no_odometry(drive):
    """All poses zero."""
    return drive.with_odometry([(0.0, 0.0, 0.0)] * len(drive.odometry()))


def overlap_s(before_s, now_s, from_s, to_s):
    return max(0.0, min(now_s, to_s) - max(before_s, from_s))


def frozen(drive, from_s, to_s):
    """The wheels stand while the vehicle goes on: what they would have counted is lost."""
    return with_motions(drive, lambda motion, before_s, now_s: (0.0, 0.0, 0.0) if from_s < now_s <= to_s else motion)


def slipped(drive, from_s, to_s, mps):
    """The wheels turn faster than the vehicle goes: so much is added ahead."""
    return with_motions(drive, lambda motion, before_s, now_s: (motion[0] + mps * overlap_s(before_s, now_s, from_s, to_s), *motion[1:]))


def jumped(drive, metres, at_s):
    """From then on the poses by the wheels are elsewhere, so far along x."""
    return drive.with_odometry([(x + metres if time_s >= at_s else x, y, heading)
                                for time_s, (x, y, heading) in zip(drive.times(), (record.wheel_from_base for record in drive.odometry()))])


def missing(drive, from_s, to_s):
    """No odometry comes: ODOM lines are missing, scans repeat the last pose; then it is again what it would have been."""
    last, kept = None, []
    times = iter(drive.times())
    for record in drive.records:
        if not isinstance(record, Other):
            time_s = next(times)
            is_missing = last is not None and from_s < time_s <= to_s
            if is_missing and isinstance(record, Odom):
                continue
            if is_missing:
                record = with_pose(record, last)
            last = record.wheel_from_base
        kept.append(record)
    return dataclasses.replace(drive, records=tuple(kept))


def pose_at(records, times, wanted_s):
    """Interpolated; before the first and after the last, that one's."""
    wanted_s = min(max(wanted_s, times[0]), times[-1])
    after = min(max(bisect.bisect_left(times, wanted_s), 1), len(times) - 1)
    before_s, after_s = times[after - 1], times[after]
    share = (wanted_s - before_s) / (after_s - before_s) if after_s > before_s else 1.0
    return between(records[after - 1].wheel_from_base, records[after].wheel_from_base, share)


def late(drive, lateness_s):
    """Each scan and ODOM line has the odometry of so much before it (< 0: after it)."""
    records, times = drive.odometry(), drive.times()
    return drive.with_odometry([pose_at(records, times, time_s - lateness_s) for time_s in times])


def clocks_drift(drive, lateness_s):
    """The clock of odometry is slow: it is right at the first scan and so much late at the last record."""
    records, times = drive.odometry(), drive.times()
    return drive.with_odometry([pose_at(records, times, time_s - lateness_s * time_s / times[-1]) for time_s in times])


def headings_late(drive, lateness_s):
    """Each pose by the wheels has the heading of so much before it."""
    records, times = drive.odometry(), drive.times()
    return drive.with_odometry([(*record.wheel_from_base[:2], pose_at(records, times, time_s - lateness_s)[2])
                                for record, time_s in zip(records, times)])


def recorded_twice(drive):
    """Each line again."""
    return dataclasses.replace(drive, records=tuple(record for record in drive.records for _ in range(1 if isinstance(record, Other) else 2)))


def held(drive, period_s):
    """Odometry comes once in so many seconds; what is between has the pose that came last."""
    kept, since_s, poses = None, -math.inf, []
    for record, time_s in zip(drive.odometry(), drive.times()):
        if time_s - since_s >= period_s - 1e-6:
            kept, since_s = record.wheel_from_base, time_s
        poses.append(kept)
    return drive.with_odometry(poses)


def begun_anew(drive, times):
    """The source of the odometry is started again so many times, evenly over the drive, and counts from zero."""
    records = drive.odometry()
    part = -(-len(records) // (times + 1))
    return drive.with_odometry([record.wheel_from_base if i < part else compound(inverse(records[i // part * part].wheel_from_base), record.wheel_from_base)
                                for i, record in enumerate(records)])


def with_stray_poses(drive, every, run, stray):
    """Of each `every` poses by the wheels, scans' and ODOM lines' alike, the last `run` are stray(place of the record, place in the run)."""
    poses = [record.wheel_from_base for record in drive.odometry()]
    every, run = round(every), round(run)
    return drive.with_odometry([stray(place, place % every - (every - run)) if place % every >= every - run else pose
                                for place, pose in enumerate(poses)])


def zero_poses(drive, every, run):
    """Again and again poses by the wheels are zero."""
    return with_stray_poses(drive, every, run, lambda place, place_in_run: (0.0, 0.0, 0.0))


def spikes(drive, every, metres, degrees, seed):
    """Each so many poses one lies so far from where it should, to any side, and is turned by so much to the left or right."""
    records, drawn = drive.odometry(), random.Random(seed)

    def elsewhere(place, place_in_run):
        x, y, heading = records[place].wheel_from_base
        direction = drawn.uniform(-math.pi, math.pi)
        turned = math.radians(degrees) * drawn.choice((-1.0, 1.0))
        return x + metres * math.cos(direction), y + metres * math.sin(direction), math.remainder(heading + turned, 2 * math.pi)
    return with_stray_poses(drive, every, 1, elsewhere)


def old_poses(drive, every, ago):
    """Each so many poses one is that of so many records before."""
    records = drive.odometry()
    return with_stray_poses(drive, every, 1, lambda place, place_in_run: records[max(place - round(ago), 0)].wheel_from_base)


def of_another_point(drive, ahead_m, left_m):
    """The poses are those of a point so far ahead and to the left of the vehicle's, unsaid: the laser's stay relative to them."""
    return drive.with_odometry([compound(record.wheel_from_base, (ahead_m, left_m, 0.0)) for record in drive.odometry()])


def odometry_scaled(drive, factor):
    """Another unit than the format's metre."""
    return drive.with_odometry([(factor * x, factor * y, heading) for x, y, heading in (record.wheel_from_base for record in drive.odometry())])


def headings_in_degrees(drive):
    """Of the base as of the laser."""
    def in_degrees(record):
        words = carmen_drive.pose_words(record.wheel_from_base)
        if isinstance(record, Odom):
            return dataclasses.replace(record, words_of_pose=tuple(pose_words_in_degrees(words)))
        laser = carmen_drive.pose_words(compound(record.wheel_from_base, record.base_from_laser))
        return dataclasses.replace(record, words_of_poses=tuple(pose_words_in_degrees(laser) + pose_words_in_degrees(words)))
    return drive.replaced(in_degrees)


def headings_of_a_compass(drive):
    """Clockwise from north, with positions to the east and north."""
    return drive.with_odometry([(x, y, math.remainder(math.pi / 2 - heading, 2 * math.pi))
                                for x, y, heading in (record.wheel_from_base for record in drive.odometry())])


def pose_words_in_degrees(words):
    return [*words[:2], f"{math.degrees(math.remainder(number(words[2]), 2 * math.pi)):.4f}"]


def standing(drive, for_s, every_s):
    """Again and again the wheels stand for a moment while the vehicle goes on."""
    return with_motions(drive, lambda motion, before_s, now_s: (0.0, 0.0, 0.0) if now_s % every_s < for_s and now_s >= every_s else motion)


def second_source(drive, factor):
    """ODOM lines count the way by another scale than the scans' own poses; where there are none, one is put before each scan."""
    if not any(isinstance(record, Odom) for record in drive.records):
        records = []
        for record in drive.records:
            if isinstance(record, Scan):
                records.append(Odom(record.wheel_from_base, ("0", "0", "0"), record.stamps))
            records.append(record)
        drive = dataclasses.replace(drive, records=tuple(records))
    scaled = iter(way_scaled(drive, factor).odometry())

    def differing(record):
        by_scale = next(scaled)
        return by_scale if isinstance(record, Odom) else record
    return drive.replaced(differing)


def moving_window(drive, length_s, near_share=0.4, share_of_mean=0.8):
    """From and to of a window of this length in which the vehicle moves, the nearest to this share of the drive: at least this share
    of what it goes on average. Altering odometry where the vehicle stands anyway would alter nothing."""
    records, times = drive.odometry(), drive.times()
    ways = [0.0]
    for before, record in zip(records, records[1:]):
        ways.append(ways[-1] + math.dist(before.wheel_from_base[:2], record.wheel_from_base[:2]))
    duration_s = max(times[-1], 1e-9)
    wanted_m = share_of_mean * ways[-1] * min(1.0, length_s / duration_s)
    best = None
    for place, from_s in enumerate(times):
        end = bisect.bisect_right(times, from_s + length_s) - 1
        if from_s < 0.0 or times[-1] - from_s < length_s or ways[end] - ways[place] < wanted_m:
            continue
        off_s = abs(from_s - near_share * duration_s)
        if best is None or off_s < best[0]:
            best = off_s, from_s
    from_s = best[1] if best else near_share * duration_s
    return from_s, from_s + length_s
