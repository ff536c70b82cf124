#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/campbell and the modules it is made of, with signals of which everything is known."""
import errno
import os
import re
import resource
import subprocess
import sys
import tempfile
import tracemalloc
import unittest
from unittest import mock

sys.dont_write_bytecode = True
SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir, "scripts")
sys.path.insert(0, SCRIPTS)
import program  # noqa: E402

program.require("numpy", "scipy", "h5py")

import h5py  # noqa: E402
import numpy as np  # noqa: E402
from scipy import signal  # noqa: E402

import indicators  # noqa: E402
import runup  # noqa: E402
import script_case  # noqa: E402
import stored  # noqa: E402
import tracking  # noqa: E402

MEAN_N = 524.0
EIGENFREQUENCY_HZ = 1979.16


def run_up(force, start_rpm=600.0, end_rpm=6000.0, duration_s=10.0, rate_Hz=25600.0, pairs=None):
    """A run whose force is MEAN_N + force(time_s, angle_rad)."""
    time_s = np.arange(int(duration_s * rate_Hz)) / rate_Hz
    slope = (end_rpm - start_rpm) / duration_s
    angle_rad = (start_rpm * time_s + slope * time_s**2 / 2.0) * np.pi / 30.0
    force_N = MEAN_N + force(time_s, angle_rad) * np.ones_like(time_s)
    return runup.Run(time_s, start_rpm + slope * time_s, angle_rad, force_N, pairs)


def gears():
    return runup.Gears(45, 41, EIGENFREQUENCY_HZ)


def blocks_of(run):
    return runup.order_blocks(run, runup.block_turns(45, 41), 195)


def noise(time_s, seed=1, rms_N=120.0, damping=0.05):
    """White noise through the eigenfrequency: the response of a run with ideal flanks."""
    rate_Hz = 1.0 / (time_s[1] - time_s[0])
    pole = np.exp(2 * np.pi * EIGENFREQUENCY_HZ / rate_Hz * (-damping + 1j * np.sqrt(1 - damping**2)))
    white = np.random.default_rng(seed).standard_normal(len(time_s))
    force_N = signal.lfilter([1.0], [1.0, -2.0 * pole.real, abs(pole) ** 2], white)
    return rms_N * force_N / force_N.std()


class Maps(unittest.TestCase):
    def amplitude(self, frequency_Hz, window):
        """What the map shows of a sine of 1 N, at its strongest bin."""
        run = run_up(lambda t, angle: np.sin(2 * np.pi * frequency_Hz * t), duration_s=2.0)
        map_ = runup.speed_map(run, window)
        peak = map_.amplitude_N.argmax(axis=1)
        self.assertTrue((np.abs(map_.frequency_Hz[peak] - frequency_Hz) <= 12.5).all())
        return map_.amplitude_N.max(axis=1)

    def test_sine_of_1_N_is_1_N_on_a_bin(self):
        np.testing.assert_allclose(self.amplitude(1000.0, "hann"), 1.0, rtol=1e-5)
        np.testing.assert_allclose(self.amplitude(1000.0, "flattop"), 1.0, rtol=5e-4)  # its top is flat to 0.002 dB

    def test_sine_of_1_N_is_1_N_between_bins_too(self):
        """Bins of a padded window are 1/8 of 12.5 Hz apart."""
        hann = np.sinc(1 / 16) / (1 - 1 / 256)  # its spectrum a sixteenth of 1 / length beside the line
        np.testing.assert_allclose(self.amplitude(1000.78125, "flattop"), 1.0, rtol=1e-3)
        np.testing.assert_allclose(self.amplitude(1000.78125, "hann"), hann, rtol=2e-4)

    def test_mean_force_leaves_nothing(self):
        map_ = runup.speed_map(run_up(lambda t, angle: 0.0, duration_s=1.0))
        self.assertLess(map_.amplitude_N.max(), 1e-6)

    def test_rows_hold_the_frames_of_their_speed(self):
        """Amplitude grows with the speed: each row of the map shows the one of its own speed."""
        run = run_up(lambda t, angle: (1.0 + t) * np.sin(2 * np.pi * 1000.0 * t), duration_s=20.0)
        map_ = runup.speed_map(run, rows=50)
        expected_N = 1.0 + (map_.row - 600.0) / 270.0
        np.testing.assert_allclose(map_.amplitude_N.max(axis=1)[1:-1], expected_N[1:-1], rtol=5e-3)

    def test_short_runs_get_fewer_rows_and_no_holes(self):
        map_ = runup.speed_map(run_up(lambda t, angle: np.sin(angle), duration_s=1.0))
        self.assertLess(len(map_.row), 20)
        self.assertTrue(np.isfinite(map_.amplitude_N).all())

    def test_sweeping_orders_have_their_amplitude_in_the_map(self):
        """Slow and fast run-ups, run-downs and reversals: the window that the sweep wants shows all to 1 %."""
        for start_rpm, end_rpm, duration_s in ((100, 3000, 18), (5000, 300, 2), (500, 3000, 0.5), (-3000, 3000, 4)):
            for order in (45, 180):
                run = run_up(lambda t, angle: np.cos(order * angle), start_rpm, end_rpm, duration_s)
                length = runup.window_length(run, 180)
                map_ = runup.speed_map(run, length=length, hop=length // 4)
                line_Hz = order * map_.row / 60.0
                # Away from 0 Hz, from what is not trusted, and from the ends, whose rows are of other speeds.
                counts = (line_Hz > 4 * run.rate_Hz / length) & (line_Hz < run.trusted_Hz)
                counts[[0, -1]] = False
                self.assertGreater(counts.sum(), 2)
                found_N = map_.amplitude_N.max(axis=1)[counts]
                np.testing.assert_allclose(found_N, 1.0, atol=0.012, err_msg=f"{order} {start_rpm} {duration_s}")
                self.assertAlmostEqual(np.median(found_N), 1.0, delta=0.01)

    def test_the_loss_of_a_long_window_is_what_is_told(self):
        """A window chosen too long shows order 180 too low by as much as sweep_gain() says."""
        run = run_up(lambda t, angle: np.cos(180 * angle), 600.0, 3000.0, 5.0)
        for length in (1024, 2048):
            gain = runup.sweep_gain(run, 180, "hann", length)
            found_N = runup.speed_map(run, length=length, hop=length // 4, rows=40).amplitude_N.max(axis=1)
            self.assertLess(gain, 0.97)
            np.testing.assert_allclose(np.median(found_N), gain, rtol=0.01)

    def test_run_down_is_mapped_like_a_run_up(self):
        up = runup.speed_map(run_up(lambda t, a: np.sin(45 * a)), rows=40)
        down = runup.speed_map(run_up(lambda t, a: np.sin(45 * a), 6000.0, 600.0), rows=40)
        backwards = runup.speed_map(run_up(lambda t, a: np.sin(45 * a), -600.0, -6000.0), rows=40)
        for other in (down, backwards):
            np.testing.assert_allclose(up.row, other.row, rtol=1e-4)
            np.testing.assert_allclose(up.amplitude_N.max(axis=1), other.amplitude_N.max(axis=1), rtol=0.02)

    def test_at_constant_speed_rows_are_times(self):
        run = run_up(lambda t, angle: np.where(t < 1, 1.0, 2.0) * np.sin(45 * angle), 1000.0, 1000.0, 2.0)
        map_ = runup.speed_map(run)
        self.assertTrue(map_.over_time)
        np.testing.assert_allclose(map_.row_range, (0.0, 2.0), atol=1e-3)
        loudest_N = map_.amplitude_N.max(axis=1)
        np.testing.assert_allclose(loudest_N[map_.row < 0.9], 1.0, rtol=0.01)
        np.testing.assert_allclose(loudest_N[map_.row > 1.1], 2.0, rtol=0.01)

    def test_noise_is_not_louder_than_it_is(self):
        """Reading at the same frequency and at the same order must not make noise much louder than its rms."""
        run = run_up(lambda t, angle: np.random.default_rng(1).normal(size=len(t)), duration_s=20.0)
        map_ = runup.speed_map(run, rows=100)
        bins = (map_.frequency_Hz > 1000) & (map_.frequency_Hz < 10000)
        expected_N2 = 4.0 * 1.5 / 2048  # squared peak amplitude of white noise of variance 1 under a Hann window
        level_dB = 10 * np.log10((map_.amplitude_N[:, bins] ** 2).mean() / expected_N2)
        self.assertGreater(level_dB, -0.1)
        self.assertLess(level_dB, 1.0)

    def test_mean_square_is_that_of_the_signal(self):
        spectra = runup.short_time_spectra(run_up(lambda t, angle: noise(t), duration_s=20.0))
        self.assertAlmostEqual(np.sqrt(spectra.mean_square(spectra.band(0, 1e9))), 120.0, delta=1.0)


class Speeds(unittest.TestCase):
    def test_orders_do_not_depend_on_the_direction(self):
        for start_rpm, end_rpm in ((600, 6000), (6000, 600), (-600, -6000), (3000, -3000)):
            run = run_up(lambda t, angle: 2.0 * np.cos(45 * angle), start_rpm, end_rpm)
            self.assertTrue((np.diff(run.angle_rad) >= 0).all())
            middle, (found_N,) = runup.order_cuts(run, 45, [1], 45)
            counts = run.speed_rpm[middle] > 300
            np.testing.assert_allclose(found_N[counts], 2.0, rtol=0.01)
            line, _ = blocks_of(run).line(45)
            np.testing.assert_allclose(np.sqrt(line), 2.0, rtol=0.02)

    def test_sweep_rate_is_that_of_the_run(self):
        for start_rpm, end_rpm, expected in ((600, 6000, 540), (6000, 600, 540), (-6000, 600, 660), (1000, 1000, 0)):
            run = run_up(lambda t, angle: 0.0, start_rpm, end_rpm)
            self.assertAlmostEqual(run.sweep_rpm_per_s(), expected, delta=1.0)

    def test_faster_sweeps_get_shorter_windows(self):
        lengths = [runup.window_length(run_up(lambda t, a: 0.0, 600, 6000, duration_s), 180) for duration_s in (40, 10, 2)]
        # c T^2 = 1/2, c = 180 / 60 * 5400 rpm / duration
        expected = [25600 * np.sqrt(0.5 * duration_s / (3.0 * 5400)) for duration_s in (40, 10, 2)]
        np.testing.assert_allclose(lengths, expected, atol=1.0)


class Orders(unittest.TestCase):
    def test_order_stands_where_its_frequency_is(self):
        run = run_up(lambda t, angle: np.cos(45 * angle))
        map_ = runup.speed_map(run)
        ridge_Hz = map_.frequency_Hz[map_.amplitude_N.argmax(axis=1)]
        np.testing.assert_allclose(ridge_Hz, 0.75 * map_.row, atol=25.0)

    def test_cut_shows_the_amplitude_of_its_order_alone(self):
        run = run_up(lambda t, angle: 3.0 * np.cos(45 * angle + 1.0) + 0.5 * np.sin(90 * angle))
        for order, amplitude_N in ((45, 3.0), (90, 0.5), (135, 0.0)):
            _, (found_N,) = runup.order_cuts(run, order, [1], 45)
            np.testing.assert_allclose(found_N[np.isfinite(found_N)], amplitude_N, atol=0.01)

        # Several at once: phases of their own, one left out between two, and each trusted as far as its frequency goes.
        middle, found_N = runup.order_cuts(run, 45, (1, 2, 4), 45)
        for multiple, amplitude_N, amplitudes_N in zip((1, 2, 4), (3.0, 0.5, 0.0), found_N):
            trusted = multiple * 45 * run.speed_rpm[middle] / 60.0 <= run.trusted_Hz
            np.testing.assert_array_equal(np.isfinite(amplitudes_N), trusted)
            np.testing.assert_allclose(amplitudes_N[trusted], amplitude_N, atol=0.01)

    def test_cut_follows_an_amplitude_over_the_speed(self):
        run = run_up(lambda t, angle: (1.0 + t) * np.cos(45 * angle))
        middle, (found_N,) = runup.order_cuts(run, 45, [1], 45)
        np.testing.assert_allclose(found_N, 1.0 + (run.speed_rpm[middle] - 600.0) / 540.0, rtol=0.01)

    def test_cut_shows_a_resonance_that_a_fast_run_up_passes(self):
        """Peak of 1 / (1 - r^2 + 2 i D r) at any rate of the speed: 1 / (2 D sqrt(1 - D^2)) to 1 %."""

        def response(ratio, damping):
            return 1.0 / (1.0 - ratio**2 + 2j * damping * ratio)

        for damping in (0.02, 0.05, 0.1):
            for order, duration_s in ((45, 20.0), (45, 2.0), (45, 1.0), (90, 2.0), (180, 5.0)):
                start_rpm, slope = 300.0, 8700.0 / duration_s

                def force(t, angle):
                    ratio = order * (start_rpm + slope * t) / 60.0 / EIGENFREQUENCY_HZ
                    return (response(ratio, damping) * np.exp(1j * order * angle)).real

                run = run_up(force, start_rpm, 9000.0, duration_s)
                middle, (found_N,) = runup.order_cuts(run, order, [1], 45)
                ratio = order * run.speed_rpm[middle] / 60.0 / EIGENFREQUENCY_HZ
                near = (ratio > 0.7) & (ratio < 1.5)
                expected_N = np.abs(response(ratio, damping))[near]
                told = runup.least_damping(run, 60.0 * EIGENFREQUENCY_HZ / order, 45)
                if told <= damping * 1.001:
                    np.testing.assert_allclose(
                        found_N[near], expected_N, atol=0.012 * expected_N.max(), err_msg=f"{damping} {order} {duration_s}"
                    )
                else:
                    self.assertLess(found_N[near].max(), 0.99 * expected_N.max())

    def test_cut_ends_where_the_rate_ends(self):
        run = run_up(lambda t, angle: 0.0)
        middle, (found_N,) = runup.order_cuts(run, 180, [1], 45)
        np.testing.assert_array_equal(np.isnan(found_N), 3.0 * run.speed_rpm[middle] > 0.4 * 25600)
        self.assertTrue(np.isnan(found_N).any())

    def test_lines_of_both_gears_have_their_amplitude(self):
        wheel = 45.0 / 41.0
        lines = {1.0: 2.0, 7.0: 1.5, 7 * wheel: 0.7, 45.0: 3.0, 45.0 + wheel: 0.4, 180.0: 1.0}
        run = run_up(lambda t, angle: sum(a * np.cos(o * angle + o) for o, a in lines.items()))
        blocks = blocks_of(run)
        self.assertEqual(blocks.turns, 82)
        for order in list(lines) + [6.0, 44.0, 135.0]:
            line, floor = blocks.line(order)
            expected = lines.get(order, 0.0)
            self.assertGreater(len(line), 2)
            np.testing.assert_allclose(np.sqrt(line), expected, rtol=0.01, atol=0.01)
            self.assertLess(np.sqrt(floor).max(), 0.01)

    def test_lines_in_noise_have_their_amplitude_and_floor(self):
        """White noise of variance s^2 puts 2 * 1.5 * 2 s^2 / (samples of a block) on each bin."""
        run = run_up(lambda t, angle: 0.5 * np.cos(45 * angle) + np.random.default_rng(1).normal(size=len(t)),
                     3000.0, 3100.0, 60.0)
        line, floor = blocks_of(run).line(45)
        rows = 82 / (3050 / 60) * run.rate_Hz
        self.assertAlmostEqual(floor.mean() / (2.0 * 6.0 / rows), 1.0, delta=0.1)
        self.assertAlmostEqual(np.sqrt((line - floor).mean()), 0.5, delta=0.01)

    def test_high_orders_are_not_folded_onto_low_ones(self):
        run = run_up(lambda t, angle: 10.0 * np.cos(400 * angle), 900.0, 1500.0, 15.0)
        amplitude_N = blocks_of(run).mean_amplitude_N()
        self.assertLess(np.nanmax(amplitude_N[82:]), 0.01)

    def test_only_trusted_frequencies_count(self):
        blocks = blocks_of(run_up(lambda t, angle: np.cos(180 * angle), 600.0, 9000.0))
        line, _ = blocks.line(180)
        self.assertEqual(len(line), (3.0 * blocks.speed_rpm < 0.4 * 25600).sum())
        self.assertLess(len(line), len(blocks.speed_rpm))
        self.assertAlmostEqual(blocks.mean_amplitude_N()[180 * 82], 1.0, delta=0.02)

    def test_blocks_are_whole_turns_of_the_wheel(self):
        self.assertEqual(runup.block_turns(45, 41), 82)
        self.assertEqual(runup.block_turns(20, 40), 82)
        self.assertEqual(runup.block_turns(21, 77) % 11, 0)
        for pinion, wheel in ((45, 41), (8, 42), (8, 400), (5, 199), (17, 1001), (10, 10)):
            # Four bins or more from an order of the wheel to the next.
            self.assertGreaterEqual(runup.block_turns(pinion, wheel) * pinion / wheel, 4)

    def test_short_run_has_no_blocks(self):
        self.assertIsNone(blocks_of(run_up(lambda t, angle: 0.0, duration_s=1.0)))


class Indicators(unittest.TestCase):
    def order_indicators(self, force, **arguments):
        return indicators.order_indicators(blocks_of(run_up(force, **arguments)), gears())

    def test_pure_tooth_order(self):
        values = self.order_indicators(lambda t, a: 4.0 * np.cos(90 * a) + 0.02 * noise(t))
        self.assertAlmostEqual(values["A2_N"], 4.0, delta=0.05)
        self.assertGreater(values["L2_dB"], 30.0)
        self.assertGreater(values["car2"], 0.99)
        self.assertLess(values["S_N"], 0.3)
        self.assertLess(values["O_N"], 0.6)

    def test_modulation_gives_sidebands(self):
        """cos(c)(1 + m cos(a)) has sidebands of m/2 on either side, here by the turns of each gear."""
        wheel = 45.0 / 41.0
        values = self.order_indicators(
            lambda t, a: 2.0 * np.cos(90 * a) * (1.0 + 0.8 * np.cos(a) + 0.6 * np.cos(3 * wheel * a))
            + 0.7 * np.cos((90 - 10 * wheel) * a)
            + 0.9 * np.cos((90 - 12) * a)  # too far off to count
        )
        self.assertAlmostEqual(values["A2_N"], 2.0, delta=0.02)
        sidebands = 2 * 0.8**2 + 2 * 0.6**2 + 0.7**2
        self.assertAlmostEqual(values["S_N"], np.sqrt(sidebands), delta=0.02)
        self.assertAlmostEqual(values["car2"], 4.0 / (4.0 + sidebands), delta=0.01)

    def test_tooth_orders_of_small_gears_are_no_sidebands(self):
        """Any number of teeth: tooth orders leave S at 0 and car at 1, also where the run hurries through a resonance."""
        for pinion, wheel in ((5, 42), (6, 31), (7, 50), (8, 42), (9, 120), (10, 10), (10, 43), (20, 20), (30, 8)):
            some = runup.Gears(pinion, wheel, EIGENFREQUENCY_HZ)
            turns = runup.block_turns(pinion, wheel)

            def force(t, angle):
                speed_Hz = (500.0 + 11500.0 / 6.0 * t) / 60.0
                ratios = [k * pinion * speed_Hz / EIGENFREQUENCY_HZ for k in (1, 2, 3, 4)]
                parts = [
                    (np.exp(1j * k * pinion * angle) / (1 - ratio**2 + 0.1j * ratio)).real / k
                    for k, ratio in zip((1, 2, 3, 4), ratios)
                ]
                return 30.0 * sum(parts)

            blocks = runup.order_blocks(run_up(force, 500.0, 12000.0, 6.0), turns, indicators.highest_order(some))
            values = indicators.order_indicators(blocks, some)
            self.assertLess(values["S_N"], 1.5, (pinion, wheel))  # of 300 N in the resonance
            for k in indicators.TOOTH_ORDERS:
                if f"car{k}" in values:
                    self.assertGreater(values[f"car{k}"], 0.99, (pinion, wheel, k))

    def test_sidebands_of_small_gears_are_counted_once(self):
        """8/42 teeth: lines of either gear, one of them half-way between tooth orders, where those of both gears meet."""
        some = runup.Gears(8, 42, 100.0)
        wheel = 8.0 / 42.0
        lines = {16.0: 5.0, 17.0: 1.0, 12.0: 2.0, 24.0 - 3 * wheel: 0.5, 28.0: 0.7}
        run = run_up(lambda t, a: sum(n * np.cos(o * a + o) for o, n in lines.items()), 3000.0, 4000.0, 20.0)
        blocks = runup.order_blocks(run, runup.block_turns(8, 42), 47)
        values = indicators.order_indicators(blocks, some)
        self.assertAlmostEqual(values["S_N"], np.sqrt(1.0 + 4.0 + 0.25 + 0.49), delta=0.02)
        self.assertAlmostEqual(values["car2"], 25.0 / (25.0 + 1.0 + 4.0), delta=0.01)

    def test_sidebands_stay_where_a_run_hurries(self):
        some = runup.Gears(8, 42, 1030.0)
        run = run_up(lambda t, a: 5.0 * np.cos(16 * a) + np.cos(17 * a) + np.cos((16 - 2 * 8 / 42) * a), 500.0, 12000.0, 4.0)
        blocks = runup.order_blocks(run, runup.block_turns(8, 42), 47)
        self.assertAlmostEqual(indicators.order_indicators(blocks, some)["S_N"], np.sqrt(2.0), delta=0.03)

    def test_equal_teeth_do_not_count_twice(self):
        some = runup.Gears(20, 20, 100.0)
        run = run_up(lambda t, a: 3.0 * np.cos(21 * a) + 2.0 * np.cos(5 * a), 3000.0, 4000.0, 20.0)
        blocks = runup.order_blocks(run, runup.block_turns(20, 20), 95)
        values = indicators.order_indicators(blocks, some)
        self.assertAlmostEqual(values["S_N"], 3.0, delta=0.02)
        self.assertAlmostEqual(values["O_N"], 2.0, delta=0.02)

    def test_orders_of_the_rotation(self):
        wheel = 45.0 / 41.0
        values = self.order_indicators(
            lambda t, a: 3.0 * np.cos(5 * a) + 4.0 * np.cos(32 * wheel * a) + 9.0 * np.cos(2 * a + 1.0)
        )
        self.assertAlmostEqual(values["O_N"], 5.0, delta=0.05)

    def test_noise_has_neither_orders_nor_sidebands(self):
        """Limits as for Fig. 12 of the paper; O is what noise leaves of the lines through the resonance."""
        run = run_up(lambda t, angle: noise(t), 100.0, 10000.0, 60.0)
        spectra = runup.short_time_spectra(run)
        values = indicators.all_indicators(run, spectra, blocks_of(run), gears(), spectra)
        self.assertLess(values["S_N"], 3.0)
        self.assertLess(values["O_N"], 20.0)
        for k in indicators.TOOTH_ORDERS:
            self.assertLess(values[f"V{k}"], 0.05)
            self.assertLess(abs(values[f"L{k}_dB"]), 2.0)
            self.assertTrue(np.isnan(values[f"car{k}"]))
        self.assertEqual(values["B"], 0.0)
        # A resonance with 5 % damping has atan(2) / pi * 2 of its energy within 10 %, less beyond 5 kHz.
        self.assertAlmostEqual(values["E0"], 0.705, delta=0.02)

    def test_energy_shares(self):
        run = run_up(lambda t, a: np.sin(2 * np.pi * 1979 * t) + np.sqrt(2) * np.sin(2 * np.pi * 1000 * t)
                     + 9 * np.sin(2 * np.pi * 6000 * t))
        share, _ = indicators.energy_shares(runup.short_time_spectra(run), gears())
        self.assertAlmostEqual(share, 1 / 3, delta=0.01)
        # A tooth order next to two lines that are none, at speeds where it stays under 5 kHz.
        run = run_up(lambda t, a: np.cos(45 * a) + np.cos(20 * a) + np.cos(70 * a), 2000.0, 4000.0)
        _, share = indicators.energy_shares(runup.short_time_spectra(run), gears())
        self.assertAlmostEqual(share, 1 / 3, delta=0.02)

    def test_visibility_is_1_of_a_line_and_0_of_noise(self):
        def visible(amplitude_N):
            run = run_up(lambda t, a: amplitude_N * np.cos(45 * a) + np.random.default_rng(1).normal(size=len(t)),
                         2000.0, 10000.0)
            return indicators.visibility(runup.short_time_spectra(run), gears(), 1)

        self.assertEqual(visible(1.0), 1.0)
        self.assertLess(visible(0.0), 0.05)

    def test_louder_cells(self):
        quiet = runup.short_time_spectra(run_up(lambda t, a: noise(t), duration_s=30.0))
        for factor, share in ((1.9, 0.0), (2.1, 1.0)):
            loud = runup.short_time_spectra(run_up(lambda t, a: factor * noise(t), duration_s=30.0))
            self.assertEqual(indicators.louder_share(loud, quiet), share)

    def test_high_frequencies_without_tooth_orders(self):
        run = run_up(lambda t, a: np.sin(2 * np.pi * 9000 * t) + 5 * np.cos(90 * a), 3100.0, 3900.0)
        value_N = indicators.high_frequency_rms(runup.short_time_spectra(run), gears())
        self.assertAlmostEqual(value_N, np.sqrt(0.5), delta=0.03)

    def test_loss_of_contact_is_the_share_of_rows_without(self):
        pairs = np.ones(256000)
        pairs[:2560] = 0
        self.assertEqual(indicators.loss_of_contact(run_up(lambda t, a: 0.0, pairs=pairs)), 0.01)
        run = run_up(lambda t, a: np.where(t < 0.1, -MEAN_N, MEAN_N))
        self.assertEqual(indicators.loss_of_contact(run), 0.01)


class Stored(unittest.TestCase):
    def column(self, values):
        column = stored.Column()
        for part in np.array_split(values, 7):
            column.append(part)
        return column

    def test_a_column_is_as_its_array(self):
        values = np.cumsum(np.random.default_rng(1).uniform(0.0, 1.0, 5000))
        with mock.patch.object(stored, "BLOCK_ROWS", 300), mock.patch.object(stored, "INDEX_STEP", 64):
            column = self.column(values)
            self.assertEqual((len(column), column.min(), column.max()), (5000, values[0], values[-1]))
            self.assertAlmostEqual(column.mean(), values.mean(), delta=1e-9)
            self.assertEqual((column[0], column[4711], column[-1]), (values[0], values[4711], values[-1]))
            for part in (slice(0, 0), slice(7, 3), slice(10, 20), slice(4990, 6000), slice(None)):
                np.testing.assert_array_equal(column[part], values[part])
            rows = np.array([0, 3, 299, 300, 301, 302, 2000, 4999])
            np.testing.assert_array_equal(column[rows], values[rows])
            for before in (0, 1):
                for (first, part), expected in zip(stored.blocks(column, before), range(0, 5000, 300)):
                    np.testing.assert_array_equal(part, values[max(0, expected - before) : expected + 300])
                    self.assertEqual(first, max(0, expected - before))

            # At values themselves, between them, and beyond both ends.
            wanted = np.concatenate([values[::37], values[::41] + 1e-3, [-1.0, values[64], values[128], 1e9]])
            np.testing.assert_array_equal(np.searchsorted(column, wanted), np.searchsorted(values, wanted))
            np.testing.assert_array_equal(np.searchsorted(column, wanted, "right"), np.searchsorted(values, wanted, "right"))

    def test_a_number_that_is_none_is_seen(self):
        for bad in (np.nan, np.inf, -np.inf):
            values = np.arange(100.0)
            values[50] = bad
            column = self.column(values)
            self.assertFalse(np.isfinite(column.min()) and np.isfinite(column.max()))

    def test_rows_of_several_numbers(self):
        rows = stored.Rows(3, np.float32)
        rows.append(np.arange(6).reshape(2, 3))
        rows.append(np.arange(6, 12).reshape(2, 3))
        np.testing.assert_array_equal(rows[1:3], [[3, 4, 5], [6, 7, 8]])
        np.testing.assert_array_equal(rows[3], [9, 10, 11])

    def test_analysis_of_columns_is_that_of_arrays(self):
        """Backwards and reversing, in small blocks."""
        for start_rpm, end_rpm in ((-2000.0, -6000.0), (3000.0, -3000.0)):
            whole = run_up(lambda t, a: np.cos(45 * a) + noise(t), start_rpm, end_rpm)
            slope = (end_rpm - start_rpm) / 10.0
            angle_rad = (start_rpm * whole.time_s + slope * whole.time_s**2 / 2.0) * np.pi / 30.0
            with mock.patch.object(stored, "BLOCK_ROWS", 5000):
                columns = [self.column(values) for values in (whole.time_s, start_rpm + slope * whole.time_s, angle_rad,
                                                              whole.force_N)]
                run = runup.Run(*columns)
                np.testing.assert_allclose(run.speed_rpm[:], whole.speed_rpm, rtol=1e-12)
                np.testing.assert_allclose(run.angle_rad[:], whole.angle_rad, rtol=1e-9, atol=1e-7)
                for one, other in ((runup.speed_map(run, rows=40).amplitude_N, runup.speed_map(whole, rows=40).amplitude_N),
                                   (blocks_of(run).power[:], blocks_of(whole).power[:]),
                                   *zip(runup.order_cuts(run, 45, (1, 2), 45), runup.order_cuts(whole, 45, (1, 2), 45))):
                    np.testing.assert_allclose(one, other, rtol=1e-5, atol=1e-6)
                self.assertEqual(indicators.loss_of_contact(run), indicators.loss_of_contact(whole))

    def test_blocks_in_pieces_say_the_same(self):
        blocks = blocks_of(run_up(lambda t, a: np.cos(45 * a) + 0.1 * np.cos(46 * a) + noise(t), 3000.0, 6000.0))
        self.assertGreater(len(blocks.speed_rpm), 10)
        whole = indicators.order_indicators(blocks, gears()), blocks.mean_amplitude_N(2000.0)
        with mock.patch.object(runup, "PIECE_BLOCKS", 3):
            in_pieces = indicators.order_indicators(blocks, gears()), blocks.mean_amplitude_N(2000.0)
        self.assertEqual(in_pieces[0].keys(), whole[0].keys())
        np.testing.assert_allclose(list(in_pieces[0].values()), list(whole[0].values()), rtol=1e-6)
        np.testing.assert_allclose(in_pieces[1], whole[1], rtol=1e-6)

    def test_memory_does_not_grow_with_the_run(self):
        """A million rows, 32 MB, and their spectra: some blocks of them."""
        rows = 1 << 20
        time_s = np.arange(rows) / 25600.0
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "run.h5")
            with h5py.File(path, "w") as file:
                for name, values in zip(COLUMNS.split(","), (time_s, 1000.0 + time_s, 110.0 * time_s, np.sin(time_s))):
                    file[name] = values
            tracemalloc.start()
            try:
                run = runup.read_run(path)
                spectra = runup.short_time_spectra(run)
                indicators.energy_shares(spectra, gears())
                peak = tracemalloc.get_traced_memory()[1]
            finally:
                tracemalloc.stop()
        self.assertEqual(len(run.force_N), rows)
        self.assertLess(peak, 12e6)


class Signals(unittest.TestCase):
    """What tracking.py does itself, as loading scipy.signal takes longer: against scipy."""

    def test_windows_are_those_of_scipy(self):
        for name in ("hann", "flattop"):
            for length in (16, 17, 2048):
                np.testing.assert_allclose(tracking.window_of(name, length), signal.get_window(name, length), atol=1e-15)

    def test_twice_the_rate_is_that_of_scipy(self):
        for rows in (1, 5, 40, 41, 1000):
            values = np.random.default_rng(rows).normal(size=rows)
            np.testing.assert_allclose(tracking.doubled(values), signal.resample_poly(values, 2, 1), atol=1e-14)

    def test_even_weight_has_no_second_moment(self):
        for length in (8, 9, 1000, 1001):
            weight = tracking.even_weight(length)
            place = (np.arange(length) + 0.5) / length - 0.5
            np.testing.assert_allclose(weight, weight[::-1], atol=1e-16)
            self.assertAlmostEqual(weight.sum(), 1.0, delta=1e-14)
            self.assertAlmostEqual((weight * place**2).sum(), 0.0, delta=1e-15)

    def test_pieces_that_overlap_are_those_alone(self):
        run = run_up(lambda t, a: np.cos(45 * a) + noise(t))
        together, alone = tracking.OverAngle(run), tracking.OverAngle(run)
        for start, samples in ((20.0, 5000), (25.0, 5001), (30.0, 4500), (47.0, 5000), (52.0, 5003)):
            np.testing.assert_allclose(together.overlapping_piece(start, 10.0, samples), alone.piece(start, 10.0, samples),
                                       rtol=0.0, atol=1e-7)


HEAD = "# gearsim\n# gears.pinion_teeth = 45\n# gears.wheel_teeth = 41\n# output.oversampling = 4\n"
COLUMNS = "time_s,pinion_speed_rpm,pinion_angle_rad,contact_force_N"


class CommandLine(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.run = run_up(lambda t, angle: np.cos(45 * angle) + noise(t), duration_s=4.0, rate_Hz=8192.0)

    def write(self, head=HEAD, columns=COLUMNS, tail=""):
        table = np.column_stack([self.run.time_s, self.run.speed_rpm, self.run.angle_rad, self.run.force_N])
        path = os.path.join(self.folder, "run.csv")
        with open(path, "w", encoding="ascii") as file:
            file.write(head + columns + "\n")
            np.savetxt(file, table, "%.10g", ",")
            file.write(tail)
        return path

    def write_hdf5(self, names=COLUMNS.split(","), **attributes):
        """The run as gearsim writes it: texts of variable length, but for `incomplete`."""
        table = [self.run.time_s, self.run.speed_rpm, self.run.angle_rad, self.run.force_N]
        path = os.path.join(self.folder, "run.h5")
        with h5py.File(path, "w") as file:
            for name, data in zip(names, table):
                file.create_dataset(name, data=data, chunks=(4096,), maxshape=(None,))
            for line in HEAD.splitlines()[1:]:
                name, value = line[2:].split(" = ")
                file.attrs[name] = value
            for name, value in attributes.items():
                file.attrs[name] = value
        return path

    def campbell(self, *arguments):
        return script_case.call("campbell", *arguments, folder=self.folder)

    def campbell_without(self, package, *arguments):
        """As a process that cannot import a package."""
        with open(os.path.join(self.folder, package + ".py"), "w", encoding="ascii") as file:
            file.write("raise ImportError('as if it were not installed')\n")
        return subprocess.run(
            [sys.executable, os.path.join(SCRIPTS, "campbell"), *arguments],
            cwd=self.folder,
            env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1", "PYTHONPATH": self.folder},
            capture_output=True,
            text=True,
        )

    def assert_input_error(self, result, *words):
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertNotIn("Traceback", result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)

    def test_draws_both_pictures_and_writes_the_numbers(self):
        result = self.campbell(self.write(), "--eigenfrequency", "1979.16", "--title", "it's a \"test\" \\n")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        for name in ("run.png", "run_orders.png"):
            with open(os.path.join(self.folder, name), "rb") as file:
                self.assertEqual(file.read(8), b"\x89PNG\r\n\x1a\n")
        with open(os.path.join(self.folder, "run.svg"), encoding="utf-8") as file:
            map_svg = file.read()
        self.assertIn("<image", map_svg)
        self.assertIn("it's a \"test\" \\n", map_svg)
        self.assertIn("log10 contact force amplitude / N", map_svg)
        self.assertLess(len(map_svg), 2e6)
        with open(os.path.join(self.folder, "run_orders.svg"), encoding="utf-8") as file:
            self.assertIn("order 180", file.read())
        with open(os.path.join(self.folder, "run_indicators.csv"), encoding="ascii") as file:
            names = [line.split(",")[0] for line in file]
        self.assertEqual(names, ["indicator"] + indicators.INDICATORS)

    def test_eigenfrequency_comes_from_the_head_lines(self):
        asked = self.campbell(self.write(), "--eigenfrequency", "1979.16", "--output", "asked")
        noted = self.campbell(self.write(head=HEAD + "# eigenfrequency_Hz = 1979.16\n"), "--output", "noted")
        self.assertEqual((asked.returncode, noted.returncode, noted.stderr), (0, 0, ""))
        with open(os.path.join(self.folder, "asked_indicators.csv"), "rb") as file:
            indicators_asked = file.read()
        with open(os.path.join(self.folder, "noted_indicators.csv"), "rb") as file:
            self.assertEqual(file.read(), indicators_asked)

    def test_columns_go_by_name(self):
        self.run.time_s, self.run.force_N = self.run.force_N, self.run.time_s
        path = self.write(columns="contact_force_N,pinion_speed_rpm,pinion_angle_rad,time_s")
        read = runup.read_run(path)
        self.assertAlmostEqual(read.rate_Hz, 8192.0, delta=1e-3)
        self.assertAlmostEqual(read.force_N.mean(), MEAN_N, delta=1.0)

    def test_hdf5_is_the_same_as_csv(self):
        options = ("--eigenfrequency", "1979.16", "--no-pictures", "--output")
        for path, stem in ((self.write(), "from_csv"), (self.write_hdf5(), "from_hdf5")):
            result = self.campbell(path, *options, stem)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
        for name in ("map.bin", "cuts.dat", "spectrum.dat"):
            one, other = (np.fromfile(path, "<f4") if name == "map.bin" else np.loadtxt(path)
                          for path in (os.path.join(self.folder, f"{stem}_{name}") for stem in ("from_csv", "from_hdf5")))
            # CSV has ten digits of forces of 1 kN: 1e-7 N of noise, on logarithms of some mN.
            np.testing.assert_allclose(one, other, rtol=1e-4, atol=1e-4)

    def test_hdf5_is_known_by_its_content_and_says_what_it_is(self):
        path = self.write_hdf5(incomplete=np.bytes_(b"interrupted"), eigenfrequency_Hz="1979.16")
        os.rename(path, path + ".part")
        run = runup.read_run(path + ".part")
        np.testing.assert_array_equal(run.force_N, self.run.force_N)
        self.assertEqual((run.provenance["gears.wheel_teeth"], run.incomplete), ("41", "interrupted"))
        self.assertIsNone(run.pairs)
        result = self.campbell(path + ".part", "--no-pictures")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("ended early (interrupted)", result.stderr)
        self.assertNotIn("eigenfrequency", result.stderr)

    def test_bad_hdf5_is_said_in_a_line(self):
        path = self.write_hdf5(names=COLUMNS.replace("pinion_angle_rad", "other").split(","))
        self.assert_input_error(self.campbell(path), "pinion_angle_rad", "output.columns")
        path = self.write_hdf5()
        os.truncate(path, 3000)
        self.assert_input_error(self.campbell(path), "run.h5")

    def test_missing_h5py_is_said_in_a_line(self):
        result = self.campbell_without("h5py", self.write_hdf5())
        self.assert_input_error(result, "run.h5", "python3-h5py")
        result = self.campbell_without("h5py", self.write(), "--no-pictures")
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_no_room_for_temporary_files_is_said_in_a_line(self):
        limit = 100000  # bytes of a file: half of a column
        result = subprocess.run(
            [sys.executable, os.path.join(SCRIPTS, "campbell"), self.write(), "--no-pictures"],
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
            cwd=self.folder, env={**os.environ, "TMPDIR": self.folder}, capture_output=True, text=True,
        )
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr, f"campbell: {self.folder}: {os.strerror(errno.EFBIG)}\n")

    def test_missing_column_is_named(self):
        path = self.write(columns=COLUMNS.replace("pinion_angle_rad", "wheel_angle_rad"))
        self.assert_input_error(self.campbell(path), "pinion_angle_rad", "output.columns")

    def test_rows_with_other_numbers_of_fields_are_named(self):
        """Also where a row has as many too many as the next one lacks; comments and empty lines are no rows."""
        good = ",".join("1" * (COLUMNS.count(",") + 1))
        for tail, line in ((f"{good},7\n{good.rpartition(',')[0]}\n", 0), (f"\n# a note, of two, or three\n{good},7\n", 2)):
            path = self.write(tail=tail)
            with open(path, encoding="utf-8") as file:
                rows = len(file.read().splitlines()) - len(tail.splitlines())
            self.assert_input_error(self.campbell(path), f":{rows + line + 1}: must have {COLUMNS.count(',') + 1} columns")

    def test_rows_that_all_lack_a_field_are_named(self):
        """Beside a column that is read, and beside one that is not."""
        for name in ("pairs_in_contact", "other"):
            self.assert_input_error(self.campbell(self.write(columns=f"{COLUMNS},{name}")), ":6: must have 5 columns")

    def test_columns_that_are_not_read_may_stand_between(self):
        path = self.write(columns="other,pinion_speed_rpm,time_s,contact_force_N")
        with open(path, encoding="ascii") as file:
            lines = file.read().splitlines()
        with open(path, "w", encoding="ascii") as file:
            file.write(lines[0] + "\n" + ",".join(("other", *COLUMNS.split(",")[::-1])) + "\n")
            file.writelines(f"text,{','.join(line.split(',')[::-1])}\n" for line in lines[5:])
        run = runup.read_run(path)
        np.testing.assert_allclose(run.force_N[:], self.run.force_N, rtol=1e-9)
        np.testing.assert_allclose(run.time_s[:], self.run.time_s, rtol=1e-9)

    def test_incomplete_run_is_drawn_with_a_warning(self):
        path = self.write(tail="# incomplete: interrupted\n")
        result = self.campbell(path, "--no-pictures")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("ended early (interrupted)", result.stderr)

    def test_run_without_filter_is_drawn_with_a_warning(self):
        path = self.write(head=HEAD.replace("oversampling = 4", "oversampling = 1"))
        result = self.campbell(path, "--no-pictures")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("folded", result.stderr)
        self.assertNotIn("folded", self.campbell(self.write(), "--no-pictures").stderr)

    def test_teeth_come_from_the_head_or_from_options(self):
        path = self.write(head="")
        self.assert_input_error(self.campbell(path, "--no-pictures"), "--pinion-teeth")
        options = ("--pinion-teeth", "45", "--wheel-teeth", "41", "--no-pictures")
        self.assertEqual(self.campbell(path, *options).returncode, 0)

    def test_bad_rows_are_named(self):
        self.run = run_up(lambda t, angle: 0.0, duration_s=0.01, rate_Hz=1000.0)
        for row, message in (
            ("1,2,3", "run.csv.* columns"),
            ("0.01,6000,1e4,text", "text"),
            ("0.01,6000,nan,1", "finite"),
            ("0.02,6000,1e4,1", "evenly spaced"),
            ("0.01,6000,0,1", "does not grow"),
        ):
            with self.assertRaisesRegex(runup.RunError, message):
                runup.read_run(self.write(tail=row + "\n"))
        runup.read_run(self.write(tail="0.01,6000,1e4,1\n"))

    def test_bad_input_is_said_in_a_line(self):
        self.assert_input_error(self.campbell("nowhere.csv"), "nowhere.csv")
        self.assert_input_error(self.campbell(self.write(), "--length", "99999"), "99999")
        self.assert_input_error(self.campbell("run.csv", "--range", "2", "1"), "--range")
        self.assert_input_error(self.campbell("run.csv", "--eigenfrequency", "-1"), "positive")


class Palette(unittest.TestCase):
    def test_lightness_rises_in_equal_steps(self):
        with open(os.path.join(SCRIPTS, "style.gp"), encoding="utf-8") as file:
            colours = re.findall(r"\d '#([0-9a-f]{6})'", file.read())
        self.assertGreater(len(colours), 8)
        rgb = np.array([[int(c[i : i + 2], 16) / 255 for i in (0, 2, 4)] for c in colours])
        linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
        luminance = linear @ [0.2126, 0.7152, 0.0722]
        lightness = np.where(luminance > 216 / 24389, 116 * np.cbrt(luminance) - 16, luminance * 24389 / 27)
        np.testing.assert_allclose(lightness, np.linspace(5.0, 97.0, len(colours)), atol=0.6)


class Claims(unittest.TestCase):
    """scripts/check_paper_figures holds what it should and fails what it should."""

    def setUp(self):
        self.script = script_case.module_of("check_paper_figures")
        # Values that fit every claim: the limit of each, passed by a little.
        self.values = {figure: dict.fromkeys(indicators.INDICATORS, 1.0) for figure in self.script.FIGURES}
        self.values["13"]["HF_N"], self.values["14"]["HF_N"] = 10.0, 50.0
        self.values["14"].update(S_N=30.0, O_N=300.0)
        self.values["15"].update(S_N=20.0, O_N=150.0, HF_N=12.0)
        self.values["16"].update(S_N=8.0, O_N=80.0, HF_N=11.0)
        for claim in self.script.CLAIMS:
            figure, _, names, relation, limit, divisor = claim
            if divisor is None and not (figure == "14" and names == ["S_N"]):
                factor = 1.01 if relation == self.script.AT_LEAST else 0.99
                self.values[figure].update(dict.fromkeys(names, factor * limit))

    def test_fitting_values_hold(self):
        for claim in self.script.CLAIMS:
            self.assertTrue(self.script.judge(self.values, claim)[0], claim)

    def test_each_indicator_of_each_claim_can_fail(self):
        for claim in self.script.CLAIMS:
            figure, _, names, relation, limit, divisor = claim
            scale = self.values[divisor][names[0]] if divisor else 1.0
            for name in names:
                kept = self.values[figure][name]
                for wrong in (limit * scale * (0.98 if relation == ">=" else 1.02), np.nan):
                    self.values[figure][name] = wrong
                    self.assertFalse(self.script.judge(self.values, claim)[0], (claim, wrong))
                self.values[figure][name] = kept

    def test_status_and_table(self):
        with tempfile.TemporaryDirectory() as folder:
            command = [sys.executable, os.path.join(SCRIPTS, "check_paper_figures"), folder]
            self.assertEqual(subprocess.run(command, capture_output=True).returncode, 2)
            for expected in (0, 1):
                for figure, values in self.values.items():
                    with open(os.path.join(folder, f"fig{figure}_indicators.csv"), "w") as file:
                        file.write("indicator,value\n")
                        file.writelines(f"{name},{value:.6g}\n" for name, value in values.items())
                result = subprocess.run(command, capture_output=True, text=True)
                self.assertEqual(result.returncode, expected, result.stdout)
                self.assertEqual(result.stdout.count("FAIL"), expected)
                self.values["13"]["V4"] = 0.1
            with open(os.path.join(folder, "indicators.csv")) as file:
                self.assertEqual(file.readline(), "indicator,fig12,fig13,fig14,fig15,fig16\n")


if __name__ == "__main__":
    unittest.main()
