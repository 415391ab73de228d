"""Each alteration does what it says to a log and to its truth, and nothing else."""

import gzip
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

import alterations as alter
import carmen_drive
import ways
from carmen_drive import Odom, Scan, number, stamp_of

SCANS = 40
STEP_S = 0.5
SPEED_MPS = 1.0
TURN_RADPS = 0.1
NO_ECHO = "81.83"


def true_pose(time_s):
    """On a circle, from the origin ahead."""
    radius = SPEED_MPS / TURN_RADPS
    heading = TURN_RADPS * time_s
    return radius * math.sin(heading), radius * (1 - math.cos(heading)), heading


def words(pose):
    return " ".join(f"{value:.6f}" for value in pose)


def flaser_log(beams=8):
    """Indoors: a scan every half second, an ODOM line between two of them, every fourth beam without an echo."""
    lines = ["# a comment"]
    for scan in range(SCANS):
        time_s = STEP_S * scan
        ranges = " ".join(NO_ECHO if beam % 4 == 3 else f"{1 + beam}.5" for beam in range(beams))
        pose = words(true_pose(time_s))
        lines.append(f"FLASER {beams} {ranges} {pose} {pose} {100 + time_s:.6f} host {time_s:.6f}")
        lines.append(f"ODOM {words(true_pose(time_s + 0.25))} 1.0 0.1 0 {100.25 + time_s:.6f} host {time_s + 0.25:.6f}")
    return lines


def robotlaser_log():
    """A street: beams from -90 to 90 degrees, the laser 2 m ahead of the vehicle's centre."""
    lines = ["PARAM robot_frontlaser_offset 2.000"]
    for scan in range(SCANS):
        pose = true_pose(STEP_S * scan)
        laser = carmen_drive.compound(pose, (2.0, 0.0, 0.0))
        ranges = " ".join([*(f"{10 + beam}.00" for beam in range(6)), NO_ECHO if scan == 3 else "16.00"])
        lines.append(f"ROBOTLASER1 0 -1.570796 3.141593 0.523599 81.83 0.01 0 7 {ranges} 0 {words(laser)} {words(pose)} "
                     f"1.0 0.1 1.0 0.5 0 {100 + STEP_S * scan:.6f} host {STEP_S * scan:.6f}")
    return lines


def drive_of(lines):
    drive = carmen_drive.Drive(tuple(carmen_drive.parse(lines)), carmen_drive.NO_ECHO_M)
    return drive


FLASER, ROBOTLASER = drive_of(flaser_log()), drive_of(robotlaser_log())


def stamps(drive):
    return [stamp_of(scan) for scan in drive.scans()]


def poses(drive):
    return [record.wheel_from_base for record in drive.odometry()]


def readings(drive, scan=0):
    return [number(word) for word in drive.scans()[scan].ranges]


def motions(drive):
    known = poses(drive)
    return [carmen_drive.compound(carmen_drive.inverse(a), b) for a, b in zip(known, known[1:])]


class AlteredDrive(unittest.TestCase):
    def assert_poses_near(self, expected, actual, delta=1e-6):
        self.assertEqual(len(expected), len(actual))
        for a, b in zip(expected, actual):
            for first, second in zip(a, b):
                self.assertAlmostEqual(first, second, delta=delta)

    def assert_odometry_kept(self, before, after):
        self.assertEqual(poses(before), poses(after))

    def assert_scans_kept(self, before, after):
        self.assertEqual([scan.ranges for scan in before.scans()], [scan.ranges for scan in after.scans()])


class Reading(AlteredDrive):
    def test_writes_what_nobody_altered_as_it_was(self):
        for lines in (flaser_log(), robotlaser_log()):
            self.assertEqual(lines, [record.text() for record in drive_of(lines).records])

    def test_keeps_a_damaged_line_as_it_is(self):
        lines = flaser_log() + ["FLASER 8 1.0 2.0", "ODOM 1 x 3"]
        self.assertEqual(lines, [record.text() for record in drive_of(lines).records])

    def test_reads_a_record_without_the_count_of_remissions(self):
        line = robotlaser_log()[1].replace(" 16.00 0 ", " 16.00 ")
        scan = drive_of([line]).scans()[0]
        self.assertIsNone(scan.remissions)
        self.assertEqual(line, scan.text())

    def test_takes_the_largest_reading_that_repeats_for_no_echo(self):
        self.assertEqual(81.83, carmen_drive.no_echo_of(FLASER.scans()))
        self.assertEqual(81.83, carmen_drive.no_echo_of(ROBOTLASER.scans()))

    def test_goes_on_by_a_usual_step_where_a_stamp_is_far_off(self):
        lines = flaser_log()
        lines[21] = lines[21].replace(" 105.000000 host", " 4105.000000 host")
        lines[30] = lines[30].replace(" 107.250000 host", " 7.250000 host")
        for time_s, expected_s in zip(drive_of(lines).times(), FLASER.times()):
            self.assertAlmostEqual(expected_s, time_s, delta=0.51)

    def test_makes_time_from_the_way_where_stamps_stand_still(self):
        still = alter.stamps_zero(FLASER)
        self.assertFalse(still.has_clock())
        way_m = (2 * SCANS - 1) * 0.25 * SPEED_MPS
        self.assertAlmostEqual(way_m / carmen_drive.MADE_UP_SPEED_MPS, still.times()[-1], delta=0.5)


class Stamps(AlteredDrive):
    def test_zero_in_both_clocks_of_scans_and_odom_lines(self):
        altered = alter.stamps_zero(FLASER)
        self.assertEqual({0.0}, {number(word) for record in altered.odometry() for word in (record.stamps[0], record.stamps[2])})
        self.assert_odometry_kept(FLASER, altered)
        self.assert_scans_kept(FLASER, altered)

    def test_of_scans_may_be_noisy_but_never_run_backwards(self):
        altered = alter.scan_stamps_noisy(FLASER, 0.3, 1)
        errors_s = [noisy - true for noisy, true in zip(stamps(altered), stamps(FLASER))]
        self.assertTrue(0.15 < (sum(error_s**2 for error_s in errors_s) / len(errors_s))**0.5 < 0.6, errors_s)
        self.assertEqual(sorted(stamps(altered)), stamps(altered))
        self.assertEqual([stamp_of(r) for r in FLASER.records if isinstance(r, Odom)], [stamp_of(r) for r in altered.records if isinstance(r, Odom)])
        self.assert_odometry_kept(FLASER, altered)

    def test_another_order_changes_places_among_neighbours(self):
        altered, before = stamps(alter.in_another_order(FLASER, 5, 1)), stamps(FLASER)
        self.assertNotEqual(altered, before)
        for first in range(0, len(before), 5):
            self.assertEqual(sorted(altered[first:first + 5]), before[first:first + 5])

    def test_of_batches_are_those_of_their_last_scans(self):
        altered, before = stamps(alter.scan_stamps_of_batches(FLASER, 4)), stamps(FLASER)
        for place, stamp in enumerate(altered):
            last = min(place // 4 * 4 + 4, len(before)) - 1
            self.assertAlmostEqual(before[last] + 0.0002 * (place % 4), stamp, places=5)

    def test_index_counts_scans(self):
        altered = alter.stamps_index(FLASER)
        self.assertEqual(list(range(SCANS)), stamps(altered))
        self.assertEqual([float(scan) for scan in range(SCANS)], [stamp_of(r) for r in altered.records if isinstance(r, Odom)])

    def test_seconds_are_whole(self):
        self.assertEqual([math.floor(stamp) for stamp in stamps(FLASER)], stamps(alter.stamps_seconds(FLASER)))

    def test_milliseconds_are_a_thousand_times_as_many(self):
        self.assertEqual([1000 * stamp for stamp in stamps(FLASER)], stamps(alter.stamps_milliseconds(FLASER)))

    def test_jump_by_an_hour_in_the_middle_only(self):
        differences = [after - before for before, after in zip(stamps(FLASER), stamps(alter.stamps_jump(FLASER)))]
        self.assertEqual([0.0] * (SCANS // 2) + [3600.0] * (SCANS // 2), differences)

    def test_backwards_fall_over_the_same_time(self):
        self.assertEqual(sorted(stamps(FLASER), reverse=True), stamps(alter.stamps_backwards(FLASER)))


class DrivenBackwards(AlteredDrive):
    def test_has_the_last_scan_first_and_time_runs_forwards(self):
        altered = alter.driven_backwards(FLASER)
        self.assertEqual([scan.index for scan in reversed(FLASER.scans())], [scan.index for scan in altered.scans()])
        self.assertEqual(sorted(stamps(altered)), stamps(altered))
        self.assertEqual(("#", "a", "comment"), altered.records[0].words)

    def test_takes_every_motion_back(self):
        back = [carmen_drive.inverse(motion) for motion in reversed(motions(FLASER))]
        self.assert_poses_near(back, motions(alter.driven_backwards(FLASER)), 1e-5)


class FewerScans(AlteredDrive):
    def test_every_third_leaves_the_first_of_three_and_all_odom_lines(self):
        altered = alter.every_nth(FLASER, 3)
        self.assertEqual(list(range(0, SCANS, 3)), [scan.index for scan in altered.scans()])
        self.assertEqual(SCANS, sum(isinstance(record, Odom) for record in altered.records))

    def test_cut_joins_the_poses_and_says_what_is_gone(self):
        altered = alter.cut(ROBOTLASER, 5.0, 10.0, no_time_passes=True)
        self.assertEqual([*range(10), *range(20, SCANS)], [scan.index for scan in altered.scans()])
        self.assertEqual(altered.scans()[9].wheel_from_base, ROBOTLASER.scans()[9].wheel_from_base)
        self.assert_poses_near([(0.0, 0.0, 0.0)], [motions(altered)[9]])
        self.assert_poses_near(motions(ROBOTLASER)[20:], motions(altered)[10:])
        self.assertAlmostEqual(STEP_S, stamps(altered)[10] - stamps(altered)[9])

    def test_cut_lets_time_pass_unless_told(self):
        altered = alter.cut(ROBOTLASER, 5.0, 10.0, no_time_passes=False)
        self.assertAlmostEqual(5.5, stamps(altered)[10] - stamps(altered)[9])


class Ranges(AlteredDrive):
    def test_are_limited_to_the_range_and_no_echo_beyond(self):
        self.assertEqual([1.5, 2.5, 3.5, 81.83, 81.83, 81.83, 81.83, 81.83], readings(alter.no_farther(FLASER, 4.0)))

    def test_dropouts_take_their_share_of_beams(self):
        lost = sum(number(after) > 80 > number(before) for b, a in zip(FLASER.scans(), alter.dropouts(FLASER, 0.3, 1).scans())
                   for before, after in zip(b.ranges, a.ranges))
        echoes = SCANS * 6
        self.assertAlmostEqual(0.3, lost / echoes, delta=4 * math.sqrt(0.3 * 0.7 / echoes))

    def test_noise_has_its_sigma_and_spares_no_echo(self):
        altered = alter.noise(FLASER, 0.05, 1)
        errors = [number(a) - number(b) for before, after in zip(FLASER.scans(), altered.scans())
                  for b, a in zip(before.ranges, after.ranges) if b != NO_ECHO]
        self.assertAlmostEqual(0.05, math.sqrt(sum(error * error for error in errors) / len(errors)), delta=0.01)
        self.assertTrue(all(scan.ranges[3] == NO_ECHO for scan in altered.scans()))

    def test_false_echoes_lie_before_what_the_beam_would_have_met(self):
        altered = alter.false_echoes(FLASER, 0.5, 1)
        changed = [(number(b), number(a)) for before, after in zip(FLASER.scans(), altered.scans())
                   for b, a in zip(before.ranges, after.ranges) if a != b]
        self.assertAlmostEqual(0.5, len(changed) / (8 * SCANS), delta=0.12)
        self.assertTrue(all(0.2 <= a <= b for b, a in changed))

    def test_rain_is_near_and_takes_echoes(self):
        altered = alter.rain(FLASER, 0.3, 1)
        nearer = sum(number(a) < number(b) for before, after in zip(FLASER.scans(), altered.scans()) for b, a in zip(before.ranges, after.ranges))
        lost = sum(a == NO_ECHO != b for before, after in zip(FLASER.scans(), altered.scans()) for b, a in zip(before.ranges, after.ranges))
        self.assertGreater(nearer, 0.1 * 8 * SCANS)
        self.assertGreater(lost, 0)

    def test_nan_fills_every_seventh_scan_and_no_other(self):
        altered = alter.nan_in_every_nth(FLASER, 7)
        self.assertEqual(list(range(6, SCANS, 7)), [scan.index for scan in altered.scans() if set(scan.ranges) == {"nan"}])
        self.assertEqual(SCANS - SCANS // 7, sum("nan" not in scan.ranges for scan in altered.scans()))

    def test_no_echo_is_written_as_told(self):
        for word in ("0.000", "inf", "nan"):
            self.assertEqual(("1.5", "2.5", "3.5", word, "5.5", "6.5", "7.5", word), alter.no_echo_as(FLASER, word).scans()[0].ranges)

    def test_millimetres_scale_readings_and_recorded_maximum(self):
        altered = alter.ranges_scaled(ROBOTLASER, 1000.0)
        self.assertEqual([1000 * value for value in readings(ROBOTLASER)], readings(altered))
        self.assertEqual("81830", altered.scans()[0].layout[4])

    def test_are_drawn_alike_by_the_same_seed_and_otherwise_by_another(self):
        for way in ("dropouts-30", "noise-5cm", "false-5", "rain"):
            drawn = [[scan.ranges for scan in ways.BY_NAME[way].apply(FLASER, seed).scans()] for seed in (1, 1, 2)]
            self.assertEqual(drawn[0], drawn[1], way)
            self.assertNotEqual(drawn[0], drawn[2], way)


class Beams(AlteredDrive):
    def test_in_the_middle_are_left_by_a_narrow_field_and_the_record_says_how_they_lie(self):
        scan = alter.field_of_view(ROBOTLASER, 90.0).scans()[0]
        self.assertEqual(("12.00", "13.00", "14.00"), scan.ranges)
        self.assertAlmostEqual(math.radians(-30), number(scan.layout[1]), delta=1e-5)
        self.assertAlmostEqual(math.radians(60), number(scan.layout[2]), delta=1e-5)

    def test_of_a_flaser_record_lie_by_convention(self):
        self.assertEqual(5, len(alter.field_of_view(FLASER, 90.0).scans()[0].ranges))

    def test_every_second_is_left_and_the_step_is_double(self):
        scan = alter.every_nth_beam(ROBOTLASER, 2).scans()[0]
        self.assertEqual(("10.00", "12.00", "14.00", "16.00"), scan.ranges)
        self.assertAlmostEqual(2 * 0.523599, number(scan.layout[3]), delta=1e-5)
        self.assertAlmostEqual(math.pi, number(scan.layout[2]), delta=1e-5)

    def test_reversed_come_last_first_unsaid(self):
        altered = alter.beams_reversed(ROBOTLASER)
        self.assertEqual(list(reversed(readings(ROBOTLASER))), readings(altered))
        self.assertEqual(ROBOTLASER.scans()[0].layout, altered.scans()[0].layout)

    def test_of_a_turned_scanner_are_moved_and_have_no_echo_where_it_did_not_look(self):
        before = FLASER.scans()[0].ranges  # 22.5 degrees a beam
        self.assertEqual((*before[2:], NO_ECHO, NO_ECHO), alter.scanner_turned(FLASER, 45.0).scans()[0].ranges)
        self.assertEqual((NO_ECHO, *before[:-1]), alter.scanner_turned(FLASER, -22.5).scans()[0].ranges)

    def test_of_the_vehicle_itself_are_near_in_every_scan(self):
        altered = alter.own_body(carmen_drive.Drive(tuple(carmen_drive.parse(flaser_log(beams=100))), carmen_drive.NO_ECHO_M), 1)
        near = [sum(number(word) < 0.5 for word in scan.ranges) for scan in altered.scans()]
        self.assertEqual([19] * SCANS, near)

    def test_ahead_are_hidden_for_a_scanner_that_is_blind_there(self):
        drive = carmen_drive.Drive(tuple(carmen_drive.parse(flaser_log(beams=100))), carmen_drive.NO_ECHO_M)
        before, after = drive.scans()[0].ranges, alter.blind_ahead(drive, 35.0).scans()[0].ranges
        self.assertEqual(before[:41] + (NO_ECHO,) * 19 + before[60:], after)

    def test_of_somebody_ahead_are_a_metre_away_wherever_the_vehicle_is(self):
        drive = carmen_drive.Drive(tuple(carmen_drive.parse(flaser_log(beams=100))), carmen_drive.NO_ECHO_M)
        for scan, as_read in zip(alter.walks_ahead(drive, 1).scans(), drive.scans()):
            hidden = [beam for beam in range(100) if scan.ranges[beam] != as_read.ranges[beam]]
            self.assertTrue(10 <= len(hidden) <= 20 and 30 < min(hidden) and max(hidden) < 70, hidden)
            self.assertTrue(all(0.8 < number(scan.ranges[beam]) < 1.6 for beam in hidden), scan.ranges)

    def test_of_a_scanner_that_hangs_repeat_the_last_ones(self):
        numbered = iter(range(SCANS))
        drive = FLASER.replaced(lambda record: record.with_ranges([str(next(numbered))] * 4) if isinstance(record, Scan) else record)
        hung = [int(scan.ranges[0]) for scan in alter.hung(drive, 5.0, 8.0).scans()]
        self.assertEqual([*range(11), *[10] * 6, *range(17, SCANS)], hung)

    def test_of_a_scanner_upside_down_have_left_and_right_changed(self):
        self.assertEqual(list(reversed(readings(ROBOTLASER))), readings(alter.upside_down(ROBOTLASER)))

    def test_upside_down_have_no_echo_where_the_scanner_did_not_look(self):
        ranges = alter.upside_down(FLASER).scans()[0].ranges  # at -90, -67.5, ... 67.5 degrees
        self.assertEqual(NO_ECHO, ranges[0])
        self.assertEqual(tuple(reversed(FLASER.scans()[0].ranges[1:])), ranges[1:])

    def test_upside_down_twice_are_as_before_for_a_scanner_that_sees_all_round(self):
        lines = [line.replace("-1.570796 3.141593 0.523599", "-3.141593 5.385587 0.897598") for line in robotlaser_log()]
        drive = drive_of(lines)
        altered = alter.upside_down(drive)
        self.assertEqual(("10.00", "16.00", "15.00"), altered.scans()[0].ranges[:3])
        self.assert_scans_kept(drive, alter.upside_down(altered))


class Mounting(AlteredDrive):
    def test_backwards_is_in_the_laser_pose_and_the_vehicle_drives_backwards(self):
        altered = alter.mounted_backwards(ROBOTLASER)
        scan = altered.scans()[4]
        self.assert_poses_near([(-2.0, 0.0, math.pi)], [scan.base_from_laser])
        self.assert_scans_kept(ROBOTLASER, altered)
        self.assertLess(motions(altered)[0][0], 0.0)
        self.assertAlmostEqual(motions(ROBOTLASER)[0][2], motions(altered)[0][2], places=6)

    def test_backwards_leaves_the_laser_on_its_way(self):
        laser = [carmen_drive.compound(scan.wheel_from_base, scan.base_from_laser) for scan in ROBOTLASER.scans()]
        turned = [carmen_drive.compound(scan.wheel_from_base, scan.base_from_laser) for scan in alter.mounted_backwards(ROBOTLASER).scans()]
        between = [carmen_drive.compound(carmen_drive.inverse(laser[0]), pose) for pose in laser]
        self.assert_poses_near(between, [carmen_drive.compound(carmen_drive.inverse(turned[0]), pose) for pose in turned], 1e-5)

    def test_backwards_is_said_by_parameters_where_the_log_has_them(self):
        said = [record.words for record in alter.mounted_backwards(ROBOTLASER).records if not isinstance(record, (Scan, Odom))]
        self.assertIn(("PARAM", "robot_frontlaser_offset", "-2.000"), said)
        self.assertIn(("PARAM", "robot_frontlaser_angular_offset", "3.141593"), said)


class Odometry(AlteredDrive):
    def test_scales_of_way_and_turns_count_for_scans_and_odom_lines(self):
        for before, way, turns in zip(motions(FLASER), motions(alter.way_scaled(FLASER, 1.3)), motions(alter.turns_scaled(FLASER, 1.15))):
            self.assert_poses_near([(1.3 * before[0], 1.3 * before[1], before[2])], [way])
            self.assert_poses_near([(before[0], before[1], 1.15 * before[2])], [turns])

    def test_mirrored_turns_have_the_other_sign(self):
        self.assertAlmostEqual(-poses(FLASER)[-1][2], poses(alter.turns_scaled(FLASER, -1.0))[-1][2], places=6)

    def test_none_is_all_zero_and_leaves_the_laser_on_the_vehicle(self):
        altered = alter.no_odometry(ROBOTLASER)
        self.assertEqual({(0.0, 0.0, 0.0)}, set(poses(altered)))
        laser, base = ([float(word) for word in altered.scans()[7].text().split()[first:first + 3]] for first in (-14, -11))
        self.assert_poses_near([(2.0, 0.0, 0.0), (0.0, 0.0, 0.0)], [laser, base], 2e-6)

    def test_axes_are_swapped(self):
        self.assertEqual([(y, x, heading) for x, y, heading in poses(FLASER)], poses(alter.axes_swapped(FLASER)))

    def test_bias_grows_with_time(self):
        altered = alter.yaw_bias(FLASER, 0.01)
        self.assertAlmostEqual(0.01 * FLASER.times()[-1], poses(altered)[-1][2] - poses(FLASER)[-1][2], places=6)

    def test_turns_are_noisy_while_the_vehicle_moves_and_ways_are_kept(self):
        altered = motions(alter.turns_noisy(FLASER, 0.01, 1))
        added = [after[2] - before[2] for before, after in zip(motions(FLASER), altered)]
        expected = 0.01 * math.sqrt(FLASER.times()[-1] / len(added))
        self.assertTrue(0.5 * expected < math.sqrt(sum(turn * turn for turn in added) / len(added)) < 2.0 * expected)
        self.assertTrue(all(abs(before[0] - after[0]) < 1e-9 for before, after in zip(motions(FLASER), altered)))

    def test_ticks_are_whole_and_no_error_grows(self):
        altered = alter.counted(FLASER, 0.05, 1.0)
        for ahead, _, turn in motions(altered):
            for wheel in (ahead - 0.5 * turn, ahead + 0.5 * turn):
                self.assertAlmostEqual(round(wheel / 0.05), wheel / 0.05, places=6)
        driven, counted = (sum(motion[0] for motion in motions(drive)) for drive in (FLASER, altered))
        self.assertLess(abs(counted - driven), 0.051)

    def test_frozen_loses_what_was_driven_meanwhile(self):
        altered = alter.frozen(FLASER, 5.0, 8.0)
        moved = [way > 1e-9 for way in (math.hypot(*motion[:2]) for motion in motions(altered))]
        self.assertEqual([not 5.0 < time <= 8.0 for time in FLASER.times()[1:]], moved)

    def test_slip_adds_its_speed_within_the_window(self):
        added = [after[0] - before[0] for before, after in zip(motions(FLASER), motions(alter.slipped(FLASER, 5.0, 8.0, 1.0)))]
        self.assertAlmostEqual(3.0, sum(added), places=6)

    def test_jump_moves_all_that_follows(self):
        moved = [after[0] - before[0] for before, after in zip(poses(FLASER), poses(alter.jumped(FLASER, 40.0, 5.0)))]
        self.assertEqual([40.0 if time >= 5.0 else 0.0 for time in FLASER.times()], [round(value, 9) for value in moved])

    def test_missing_repeats_the_last_pose_drops_odom_lines_and_catches_up(self):
        altered = alter.missing(FLASER, 5.0, 8.0)
        during = [record for record in altered.odometry() if 5.0 < stamp_of(record) - 100.0 <= 8.0]
        self.assertTrue(during and all(isinstance(record, Scan) for record in during))
        self.assertEqual(1, len({record.wheel_from_base for record in during}))
        self.assertEqual(poses(FLASER)[-1], poses(altered)[-1])
        self.assertEqual(SCANS, len(altered.scans()))

    def test_late_has_the_pose_of_before(self):
        altered = alter.late(FLASER, 0.5)
        self.assert_poses_near(poses(FLASER)[2:-2], poses(altered)[4:])
        self.assertEqual(stamps(FLASER), stamps(altered))

    def test_units_are_scaled(self):
        self.assertAlmostEqual(1000 * poses(FLASER)[-1][0], poses(alter.odometry_scaled(FLASER, 1000.0))[-1][0], places=6)
        line = alter.headings_in_degrees(ROBOTLASER).scans()[20].text().split()
        self.assertAlmostEqual(math.degrees(1.0), float(line[-9]), places=3)
        self.assertAlmostEqual(math.degrees(1.0), float(line[-12]), places=3)

    def test_headings_of_a_compass_keep_positions(self):
        for (x, y, heading), altered in zip(poses(FLASER), poses(alter.headings_of_a_compass(FLASER))):
            self.assertEqual((x, y), altered[:2])
            self.assertAlmostEqual(0.0, math.remainder(altered[2] + heading - math.pi / 2, 2 * math.pi), places=6)

    def test_recorded_twice_has_each_scan_again(self):
        altered = alter.recorded_twice(FLASER).scans()
        self.assertEqual(2 * SCANS, len(altered))
        self.assertEqual(altered[4], altered[5])

    def test_standing_wheels_stand_again_and_again(self):
        altered = alter.standing(FLASER, 1.0, 5.0)
        stood = sum(math.hypot(*motion[:2]) < 1e-9 for motion in motions(altered))
        self.assertEqual(sum(time % 5.0 < 1.0 and time >= 5.0 for time in FLASER.times()), stood)
        self.assertEqual(12, stood)

    def test_second_source_differs_in_odom_lines_only(self):
        for drive in (FLASER, ROBOTLASER):
            altered = alter.second_source(drive, 1.1)
            self.assertEqual([scan.wheel_from_base for scan in drive.scans()], [scan.wheel_from_base for scan in altered.scans()])
            lines = [record for record in altered.records if isinstance(record, Odom)]
            self.assertEqual(SCANS, len(lines))
            self.assertGreater(lines[10].wheel_from_base[0], 1.05 * true_pose(STEP_S * 10)[0])

    def test_held_changes_once_a_period(self):
        altered = poses(alter.held(FLASER, 2.0))
        times = FLASER.times()
        for time_s, pose in zip(times, altered):
            since_s = max(time for time in times if time <= time_s + 1e-9 and abs((time - times[0]) / 2.0 - round((time - times[0]) / 2.0)) < 1e-6)
            self.assertEqual(poses(FLASER)[times.index(since_s)], pose)

    def test_begun_anew_keeps_all_motions_but_one_each(self):
        changed = [math.dist(before, after) > 1e-6 for before, after in zip(motions(FLASER), motions(alter.begun_anew(FLASER, 3)))]
        self.assertEqual(3, sum(changed))
        self.assertIn((0.0, 0.0, 0.0), poses(alter.begun_anew(FLASER, 3)))

    def test_clocks_drift_from_nothing_to_all(self):
        drifted = poses(alter.clocks_drift(FLASER, 1.0))
        times = FLASER.times()
        for time_s, pose in zip(times, drifted):
            self.assertAlmostEqual(true_pose(time_s * (1 - 1.0 / times[-1]))[2], pose[2], places=3)

    def test_headings_late_keep_positions(self):
        for time_s, before, after in zip(FLASER.times()[4:], poses(FLASER)[4:], poses(alter.headings_late(FLASER, 0.5))[4:]):
            self.assertEqual(before[:2], after[:2])
            self.assertAlmostEqual(true_pose(time_s - 0.5)[2], after[2], places=5)

    def test_halves_swapped_begin_anew_and_go_on_in_time(self):
        swapped = alter.halves_swapped(FLASER)
        self.assertEqual([*range(SCANS // 2, SCANS), *range(SCANS // 2)], [scan.index for scan in swapped.scans()])
        for stamp, scan in enumerate(swapped.scans()):
            self.assertAlmostEqual(100 + STEP_S * (SCANS // 2 + stamp), stamp_of(scan), places=5)
        self.assertEqual((0.0, 0.0, 0.0), swapped.scans()[SCANS // 2].wheel_from_base)
        self.assertAlmostEqual(true_pose(1.0)[0], swapped.scans()[SCANS // 2 + 2].wheel_from_base[0], places=5)

    def test_stray_poses_come_again_and_again(self):
        sound = poses(FLASER)
        zero = poses(alter.zero_poses(FLASER, 10, 2))
        self.assertEqual([place % 10 >= 8 for place in range(len(sound))], [before != after for before, after in zip(sound, zero)])
        self.assertEqual((0.0, 0.0, 0.0), zero[9])
        spikes = poses(alter.spikes(FLASER, 10, 2.0, 60.0, 1))
        self.assertEqual([place % 10 == 9 for place in range(len(sound))], [before != after for before, after in zip(sound, spikes)])
        self.assertAlmostEqual(2.0, math.dist(sound[9][:2], spikes[9][:2]))
        self.assertAlmostEqual(math.radians(60), abs(spikes[9][2] - sound[9][2]))
        old = poses(alter.old_poses(FLASER, 10, 7))
        self.assertEqual(sound[2], old[9])
        self.assertEqual(sound[8], old[8])

    def test_another_point_is_where_it_says(self):
        for before, after in zip(poses(FLASER), poses(alter.of_another_point(FLASER, 1.0, 0.5))):
            self.assertAlmostEqual(math.hypot(1.0, 0.5), math.dist(before[:2], after[:2]), places=6)
            self.assertEqual(before[2], after[2])

    def test_window_is_where_the_vehicle_moves(self):
        standing = alter.frozen(FLASER, 6.0, 14.0)
        from_s, to_s = alter.moving_window(standing, 4.0)
        self.assertAlmostEqual(4.0, to_s - from_s)
        self.assertLessEqual(alter.overlap_s(from_s, to_s, 6.0, 14.0), 2.1)


class Copy(unittest.TestCase):
    """COPY.log and its truth, written by the script."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.prefix = str(self.folder / "drive")
        times = [STEP_S * scan for scan in range(SCANS)]
        (self.folder / "drive.log").write_text("\n".join(robotlaser_log()) + "\n")
        (self.folder / "drive.tum").write_text("".join(
            f"{100 + time:.6f} {x:.6f} {y:.6f} 0 0 0 {math.sin(heading / 2):.9f} {math.cos(heading / 2):.9f}\n"
            for time, (x, y, heading) in ((time, true_pose(time)) for time in times)))
        with gzip.open(self.folder / "drive.objects.csv.gz", "wt") as file:
            file.write("timestamp,id\n" + "".join(f"{100 + time:.6f},1\n" for time in times))
        with gzip.open(self.folder / "rooms.rawodom.log.gz", "wt") as file:
            file.write("\n".join(flaser_log()) + "\n")
        (self.folder / "rooms.reference.txt").write_text("# index stamp x y heading\n" + "".join(
            f"{scan} {100 + time} {words(true_pose(time))}\n" for scan, time in enumerate(times)))

    def alter(self, prefix, *options):
        script = pathlib.Path(__file__).with_name("alter_drive.py")
        return subprocess.run([sys.executable, script, prefix, str(self.folder / "copy"), *options], capture_output=True, text=True)

    def copied(self, ending):
        return [line for line in (self.folder / f"copy{ending}").read_text().splitlines() if not line.startswith("#")]

    def test_has_truth_for_the_scans_that_are_left(self):
        self.assertEqual("", self.alter(self.prefix, "--every", "4").stderr)
        self.assertEqual(10, sum(line.startswith("ROBOTLASER1") for line in self.copied(".log")))
        self.assertEqual([f"{100 + 2 * scan:.6f}" for scan in range(10)], [line.split()[0] for line in self.copied(".tum")])
        self.assertEqual(11, len(self.copied(".objects.csv")))
        rows = [line.split() for line in self.copied(".reference.txt")]
        self.assertEqual([str(scan) for scan in range(10)], [row[0] for row in rows])
        self.assertAlmostEqual(true_pose(18.0)[0], float(rows[9][2]), places=5)

    def test_counts_the_scans_of_a_reference_anew(self):
        self.assertEqual("", self.alter(str(self.folder / "rooms"), "--way", "third").stderr)
        rows = [line.split() for line in self.copied(".reference.txt")]
        self.assertEqual(SCANS // 3 + 1, len(rows))
        self.assertAlmostEqual(true_pose(3 * STEP_S)[0], float(rows[1][2]), places=5)

    def test_takes_the_path_of_a_log(self):
        self.assertEqual("", self.alter(str(self.folder / "rooms.rawodom.log.gz"), "--no-odometry").stderr)
        self.assertEqual(SCANS, len(self.copied(".reference.txt")))

    def test_has_truth_with_its_stamps(self):
        self.assertEqual("", self.alter(self.prefix, "--stamps", "milliseconds").stderr)
        self.assertEqual("100500.000000", self.copied(".tum")[1].split()[0])
        self.assertEqual("100500.000000,1", self.copied(".objects.csv")[2])

    def test_has_truth_of_the_turned_vehicle(self):
        self.alter(self.prefix, "--backwards")
        qz, qw = map(float, self.copied(".tum")[10].split()[6:8])
        self.assertAlmostEqual(0.0, math.remainder(2 * math.atan2(qz, qw) - true_pose(5.0)[2] - math.pi, 2 * math.pi), places=5)
        self.assertAlmostEqual(0.0, math.remainder(float(self.copied(".reference.txt")[10].split()[4]) - true_pose(5.0)[2] - math.pi, 2 * math.pi), places=5)

    def test_has_no_truth_of_what_was_cut_out(self):
        self.alter(self.prefix, "--cut", "5", "10", "--no-time-passes")
        self.assertEqual(SCANS - 10, len(self.copied(".tum")))
        self.assertEqual("105.000000", self.copied(".tum")[10].split()[0])

    def test_is_the_same_bytes_for_the_same_seed(self):
        logs = []
        for seed in ("7", "7", "8"):
            self.alter(self.prefix, "--noise", "0.05", "--dropouts", "0.1", "--seed", seed)
            logs.append(self.copied(".log"))
        self.assertEqual(logs[0], logs[1])
        self.assertNotEqual(logs[0], logs[2])

    def test_is_refused_in_one_line_without_a_log_or_an_alteration(self):
        self.assertIn("No such log", self.alter(str(self.folder / "nowhere"), "--no-odometry").stderr)
        self.assertEqual(2, self.alter(self.prefix).returncode)

    def test_of_every_way_has_scans_and_their_truth(self):
        for prefix in ("drive", "rooms"):
            read = carmen_drive.read_drive(str(self.folder / prefix))
            for way in ways.STANDARD + ways.FURTHER:
                altered = way.apply(read, 1)
                carmen_drive.write_drive(read, altered, str(self.folder / prefix), str(self.folder / "way"))
                written = carmen_drive.read_drive(str(self.folder / "way"))
                truth = carmen_drive.read_reference(self.folder / "way.reference.txt")
                self.assertEqual(len(altered.scans()), len(written.scans()), way.name)
                self.assertEqual(list(range(len(altered.scans()))), sorted(truth), way.name)
                text = [record.text() for record in read.records]
                without_effect = {"rooms": ("range-8m", "standing-wheels", "turned-5", "hung-6s"), "drive": ("standing-wheels", "turned-5", "hung-6s")}[prefix]  # they are small, short, and of few beams
                self.assertTrue(way.name in without_effect or text != [record.text() for record in written.records], way.name)


class Standard(unittest.TestCase):
    def test_ways_are_25_indoors_and_outdoors(self):
        self.assertEqual(25, len(ways.standard_names(indoors=True)))
        self.assertEqual(25, len(ways.standard_names(indoors=False)))
        self.assertEqual({"range-5m", "range-8m"}, set(ways.standard_names(True)) ^ set(ways.standard_names(False)))


if __name__ == "__main__":
    unittest.main()
