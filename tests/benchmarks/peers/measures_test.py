# SPDX-License-Identifier: Apache-2.0
"""Figures of ./dev peers for pictures and series with known answers."""
import math
import pathlib
import unittest

import measures

PEERS = pathlib.Path(__file__).resolve().parent.parent.parent / "data" / "peers"


class ErrorOfAPicture(unittest.TestCase):
    def test_a_picture_that_is_a_tenth_too_bright_has_error_and_bias_of_a_tenth(self):
        error, bias = measures.error_of([1.1] * 8, [1.0] * 8, 0.0)
        self.assertAlmostEqual(error, 0.1)
        self.assertAlmostEqual(bias, 0.1)

    def test_the_references_own_noise_is_taken_off_quadratically(self):
        # Differences of 0.5 about a mean of 1; minus independent noise of 0.3: sqrt(0.25 - 0.09).
        error, bias = measures.error_of([1.5, 0.5], [1.0, 1.0], 0.3)
        self.assertAlmostEqual(error, 0.4)
        self.assertAlmostEqual(bias, 0.0)

    def test_pixels_left_out_count_neither_in_the_error_nor_in_the_mean(self):
        error, _ = measures.error_of([1.2, 50.0], [1.0, 100.0], 0.0, {1})
        self.assertAlmostEqual(error, 0.2)

    def test_widening_takes_the_eight_neighbours_inside_the_picture(self):
        self.assertEqual(measures.widened({0}, 3, 3), {0, 1, 3, 4})
        self.assertEqual(len(measures.widened({4}, 3, 3)), 9)

    def test_the_references_have_the_means_stated_with_them(self):
        stated = {"bay": 1183.32, "cornell": 0.0623386, "furnace": 1.20911}
        for name, mean in stated.items():
            _, _, values = measures.read_pfm(PEERS / name / "reference-256.pfm")
            kept = [y for y in values if name != "cornell" or y <= 0.5]
            self.assertAlmostEqual(sum(kept) / len(kept) / mean, 1.0, delta=1e-5)

    def test_the_first_row_of_a_picture_is_its_top(self):
        # The Cornell box's lamp is at the ceiling.
        width, _, values = measures.read_pfm(PEERS / "cornell" / "reference-256.pfm")
        brightest = max(range(len(values)), key=lambda k: values[k])
        self.assertLess(brightest // width, 64)


class SecondsToAnError(unittest.TestCase):
    # Pure noise: error = 0.1 / sqrt(seconds).
    SERIES = [(t, 0.1 / math.sqrt(t), 0.0) for t in (1.0, 4.0, 16.0)]

    def test_between_two_settings_a_power_law_is_met_exactly(self):
        seconds, how = measures.seconds_to(self.SERIES, 0.04)
        self.assertAlmostEqual(seconds, 6.25)
        self.assertEqual(how, "measured")

    def test_beyond_the_best_setting_noise_falls_as_the_root_of_seconds(self):
        seconds, how = measures.seconds_to(self.SERIES, 0.01)
        self.assertAlmostEqual(seconds, 100.0)
        self.assertEqual(how, "extrapolated")

    def test_the_cheapest_setting_bounds_an_error_that_it_has_already(self):
        self.assertEqual(measures.seconds_to(self.SERIES, 0.2), (1.0, "at most"))

    def test_no_number_of_seconds_takes_a_bias_away(self):
        self.assertEqual(measures.seconds_to([(1.0, 0.05, -0.03)], 0.02), (math.inf, "never"))

    def test_a_setting_that_costs_more_and_gains_nothing_changes_nothing(self):
        worse = self.SERIES + [(5.0, 0.09, 0.0)]
        self.assertEqual(measures.seconds_to(worse, 0.04), measures.seconds_to(self.SERIES, 0.04))


if __name__ == "__main__":
    unittest.main()
