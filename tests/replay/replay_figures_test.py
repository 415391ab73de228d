"""The comparison with golden.json fails for every figure that gets worse, and a known failure is said and kept apart."""

import json
import pathlib
import unittest

import replay_test


def evaluation(objects=2, **changes):
    """As slammot eval writes it, of a scenario in which everything is as it should be."""
    trajectory = {"ate_m": {"rmse": 0.006}, "over": {"10_m": {"drift_m": {"rmse": 0.006}, "drift_rad": {"rmse": 0.0005}}}}
    nees = {"samples": 20, "degrees_of_freedom": 2, "mean": 2.0}
    values = {
        "trajectory": trajectory, "online_trajectory": trajectory, "relative_pose_nees": {"samples": 20, "degrees_of_freedom": 3, "mean": 3.0},
        "tracking": {"objects": objects, "tracks": objects, "hota": {"hota": 0.9},
                     "clear_mot": {"mota": 0.9, "recall": 0.9, "precision": 0.9, "switches": 0, "false_positives": 0}, "identity": {"f1": 0.9},
                     "all": {"centre_m": {"rmse": 0.2}, "velocity_mps": {"rmse": 0.3}, "position_nees": nees}},
        "map": {"precision": 0.9, "recall": 0.9}}
    values["tracking"].update(changes)
    return values


GOOD = replay_test.figures_of(evaluation())


def faults_with(**figures):
    return replay_test.compare(GOOD, {**GOOD, **figures})[1]


class Figures(unittest.TestCase):
    def test_are_all_compared(self):
        self.assertEqual(set(replay_test.FIGURES), set(GOOD))

    def test_may_be_as_they_were_or_better(self):
        self.assertEqual([], faults_with())
        for name, figure in replay_test.FIGURES.items():
            better = 1.0 if isinstance(figure, replay_test.Consistency) else GOOD[name] * 1.1 if figure.more_is_better else GOOD[name] * 0.5
            self.assertEqual([], faults_with(**{name: better}), name)

    def test_may_not_be_half_as_good(self):
        for name, figure in replay_test.FIGURES.items():
            worse = GOOD[name] * 0.5 if figure.more_is_better else GOOD[name] * 2.0 if GOOD[name] else 1
            self.assertEqual([name], faults_with(**{name: worse}), name)

    def test_of_millimetres_may_not_be_half_a_centimetre_worse(self):
        for name in ("ate_m", "online_ate_m", "drift_over_10_m_m"):
            self.assertEqual([name], faults_with(**{name: GOOD[name] + 0.005}))

    def test_of_consistency_may_be_neither_too_sure_nor_too_unsure(self):
        for name in ("pose_nees_per_degree", "position_nees_per_degree"):
            self.assertEqual([name], faults_with(**{name: 1.5}))
            self.assertEqual([name], faults_with(**{name: 1.0 / 1.5}))
            self.assertEqual([name], replay_test.compare({name: 0.01}, {name: 2.0})[1])
            self.assertEqual([], replay_test.compare({name: 0.01}, {name: 0.5})[1])

    def test_may_not_be_missing(self):
        self.assertEqual(["hota"], replay_test.compare(GOOD, {name: value for name, value in GOOD.items() if name != "hota"})[1])

    def test_are_held_to_what_their_tolerance_can_miss(self):
        golden = json.loads(replay_test.GOLDEN.read_text())
        for scenario, figures in golden.items():
            for name, value in figures.items():
                figure = replay_test.FIGURES[name]
                worst = 0.0 if figure.more_is_better else 1e6 if isinstance(figure, replay_test.Consistency) else 2.0 * value + 1.0
                if not (figure.more_is_better and value <= figure.absolute):
                    self.assertGreater(figure.excess(value, worst), 0.0, f"{scenario} {name}")


class WhereNothingMoves(unittest.TestCase):
    def test_figures_of_objects_are_left_out_and_those_of_false_tracks_are_not(self):
        figures = replay_test.figures_of(evaluation(objects=0))
        self.assertNotIn("mota", figures)
        self.assertEqual(0, figures["tracks"])
        self.assertEqual(0, figures["false_rows"])

    def test_one_false_track_fails(self):
        golden = replay_test.figures_of(evaluation(objects=0))
        clear_mot = {"mota": 0.0, "recall": 0.0, "precision": 0.0, "switches": 0, "false_positives": 1}
        now = replay_test.figures_of(evaluation(objects=0, tracks=1, clear_mot=clear_mot))
        self.assertEqual(["false_rows", "tracks"], sorted(replay_test.compare(golden, now)[1]))


class Wanted(unittest.TestCase):
    def faults(self, is_reached, now):
        return replay_test.compare_with_wanted({"switches": {"at_most": 0, "is_reached": is_reached, "why": "it is hidden"}}, {"switches": now})

    def test_and_not_reached_is_said_and_passes(self):
        lines, faults = self.faults(False, 1)
        self.assertEqual([], faults)
        self.assertIn("known failure: it is hidden", lines[0])

    def test_and_reached_is_to_be_said_in_the_file(self):
        self.assertEqual(["wanted switches"], self.faults(False, 0)[1])

    def test_once_reached_is_held(self):
        self.assertEqual([], self.faults(True, 0)[1])
        self.assertEqual(["wanted switches"], self.faults(True, 1)[1])

    def test_names_scenarios_and_figures_that_there_are(self):
        golden = json.loads(replay_test.GOLDEN.read_text())
        for scenario, goals in json.loads(replay_test.WANTED.read_text()).items():
            for name in goals:
                self.assertIn(name, golden[scenario], scenario)

    def test_where_nothing_counts_is_that_nothing_is_tracked(self):
        wanted = json.loads(replay_test.WANTED.read_text())
        for scenario, figures in json.loads(replay_test.GOLDEN.read_text()).items():
            if "mota" not in figures:
                self.assertEqual(0, wanted[scenario]["tracks"]["at_most"], scenario)


class Files(unittest.TestCase):
    def test_of_scenarios_and_golden_figures_are_the_same(self):
        folder = pathlib.Path(replay_test.__file__).resolve().parents[2] / "deploy" / "scenarios"
        self.assertEqual({path.stem for path in folder.glob("*.textproto")}, set(json.loads(replay_test.GOLDEN.read_text())))


if __name__ == "__main__":
    unittest.main()
