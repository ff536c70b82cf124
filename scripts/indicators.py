# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Numbers for what one sees in a Campbell map: is the eigenfrequency there, are tooth orders, sidebands?

Their meaning, in the order of INDICATORS:

    rms_N         rms of the contact force, 20 Hz to 5 kHz
    loss_percent  share of the time without contact
    E0            share of that energy within 10 % of the eigenfrequency f0
    Em            share of that energy within 2 % of the tooth orders 1..4
    V1 .. V4      share of the frames where tooth order k stands 10 dB out of what is beside it
    L1 .. L4_dB   tooth order k over the noise floor
    A1 .. A4_N    amplitude of tooth order k
    car1 .. car4  share of tooth order k in the power of itself and its sidebands, if it stands out at all
    S_N           all sidebands of the tooth orders 1..4, each line once: 10 of each gear on each side, or up to
                  half-way to the next tooth order where a gear has fewer than 20 teeth
    O_N           orders of pinion and wheel from 3 up to the sidebands of tooth order 1
    EO            share of the energy in these orders
    B             share of the map below 2 kHz that is 6 dB louder than a reference run
    HF_N          rms from 1.5 f0 to 10 kHz without tooth orders

Amplitudes are peak values, rms over the speed, with the noise floor taken off. Lines over the eigenfrequency
(V from 1.25 f0; L, A from 1.2 f0) are looked at only, as below it a displacement excites little force.
"""
import math
from fractions import Fraction

import numpy as np

import stored

TOOTH_ORDERS = (1, 2, 3, 4)
SIDEBANDS = 10
LOW_HZ, HIGH_HZ = 20.0, 5000.0  # band of the energies
LINE_TOP_HZ = 8000.0
HF_TOP_HZ = 10000.0
CELL_HZ, CELL_RPM = 100.0, 250.0  # cells of B, up to:
CELL_TOP_HZ = 2000.0
LOUDER = 10.0 ** (6.0 / 10.0)  # 6 dB in power
LINES_ABOVE = 1.2  # times the eigenfrequency, for L and A
UNRESOLVED, RESOLVED = 2, 12  # distances of a sideband from a smeared tooth order, in widths of the smear
OUTSTANDING = 10.0  # 10 dB in power: seen in a single frame
STANDS_OUT = 10.0 ** (2.0 / 10.0)  # 2 dB: more than noise, in the mean

INDICATORS = (
    ["rms_N", "loss_percent", "E0", "Em"]
    + [f"V{k}" for k in TOOTH_ORDERS]
    + [f"L{k}_dB" for k in TOOTH_ORDERS]
    + [f"A{k}_N" for k in TOOTH_ORDERS]
    + [f"car{k}" for k in TOOTH_ORDERS]
    + ["S_N", "O_N", "EO", "B", "HF_N"]
)


def loss_of_contact(run):
    """Share of the rows without a touching pair; without that column, with under 1 % of the mean force."""
    if run.pairs is not None:
        return sum(np.count_nonzero(pairs == 0) for _, pairs in stored.blocks(run.pairs)) / len(run.pairs)
    least_N = 0.01 * abs(run.force_N.mean())
    return sum(np.count_nonzero(np.abs(force_N) < least_N) for _, force_N in stored.blocks(run.force_N)) / len(run.force_N)


def near_tooth_orders(spectra, gears, tooth_orders, width):
    """[frame, bin]: within a share `width` of the frequency of a tooth order."""
    bins = len(spectra.frequency_Hz)
    mesh_bin = gears.pinion_teeth * spectra.speed_rpm / 60.0 / spectra.frequency_Hz[1]
    frame = np.arange(len(mesh_bin))

    # + 1 where the neighbourhood of an order begins, - 1 behind its end: the sum along a frame counts those around a bin.
    change = np.zeros((len(mesh_bin), bins + 1), dtype=np.int8)
    for k in tooth_orders:
        first = np.ceil(mesh_bin * k * (1.0 - width)).astype(int)
        behind = np.floor(mesh_bin * k * (1.0 + width)).astype(int) + 1
        change[frame, np.minimum(first, bins)] += 1
        change[frame, np.minimum(behind, bins)] -= 1
    return np.cumsum(change[:, :bins], axis=1, dtype=np.int8) > 0


def energy_shares(spectra, gears):
    """(E0, Em): shares of the energy near the eigenfrequency and near the tooth orders."""
    f0 = gears.eigenfrequency_Hz
    band = spectra.band(LOW_HZ, HIGH_HZ)
    total = spectra.mean_square(band)
    return (
        spectra.mean_square(band & spectra.band(0.9 * f0, 1.1 * f0)) / total,
        spectra.mean_square(band, lambda piece: near_tooth_orders(piece, gears, TOOTH_ORDERS, 0.02)) / total,
    )


def visibility(spectra, gears, k):
    """V_k: share of frames where the peak within 0.8 % of the line is 10 dB over the median of 1.5 .. 8 %."""
    seen, step_Hz = [], spectra.frequency_Hz[1]
    for piece in spectra.pieces():
        for speed_rpm, power in zip(piece.speed_rpm, piece.power):
            line_Hz = k * gears.pinion_teeth * speed_rpm / 60.0
            if not 1.25 * gears.eigenfrequency_Hz < line_Hz < LINE_TOP_HZ:
                continue

            # Bins that may be within 8 %, and of them the line and what is beside it.
            bins = slice(max(0, int(0.92 * line_Hz / step_Hz) - 1), int(1.08 * line_Hz / step_Hz) + 3)
            distance = np.abs(spectra.frequency_Hz[bins] / line_Hz - 1.0)
            peak = power[bins][distance <= 0.008]
            beside = np.sort(power[bins][(distance >= 0.015) & (distance <= 0.08)])
            if len(peak) and len(beside):
                median = 0.5 * (beside[(len(beside) - 1) // 2] + beside[len(beside) // 2])
                seen.append(peak.max() > OUTSTANDING * median)
    return np.mean(seen) if seen else np.nan


class LineSums:
    """Sums over the blocks in which a line counts."""

    def __init__(self):
        self.blocks, self.power, self.over_floor = 0, 0.0, 0.0

    def add(self, line, floor):
        self.blocks += len(line)
        self.power += (line - floor).sum(dtype=float)
        self.over_floor += (line / floor).sum(dtype=float)

    @property
    def mean_power(self):
        """Squared amplitude, floor taken off; 0 where no block counts."""
        return self.power / self.blocks if self.blocks else 0.0


def power_of_lines(lines):
    """Squared amplitude of all lines together, floor taken off, mean over the blocks (N^2).

    Noise leaves a remainder of either sign, so it is not cut off at zero before the end.
    """
    return sum(line.mean_power for line in lines)


def sidebands_of(teeth):
    """How many sidebands by the turns of a gear stand on either side: up to half-way to the next tooth order."""
    return min(SIDEBANDS, teeth // 2)


def sideband_orders(gears, k):
    """Orders of the first sidebands of tooth order k by the turns of pinion and wheel, each once.

    Both gears may have a sideband at the same order. What is a tooth order is no sideband.
    """
    carrier = k * gears.pinion_teeth
    orders = {
        carrier + side * n * Fraction(gears.pinion_teeth, teeth)
        for teeth in (gears.pinion_teeth, gears.wheel_teeth)
        for side in (-1, 1)
        for n in range(1, sidebands_of(teeth) + 1)
    }
    return sorted(order for order in orders if order > 0 and order % gears.pinion_teeth != 0)


def highest_order(gears):
    """Up to which order blocks are needed: tooth order 4 and its sidebands, with some bins beside them."""
    reach = max(sidebands_of(teeth) * gears.pinion_teeth / teeth for teeth in (gears.pinion_teeth, gears.wheel_teeth))
    return max(TOOTH_ORDERS) * gears.pinion_teeth + max(15, math.ceil(reach) + 2)


def sideband_line(blocks, gears, k, order):
    """(line, floor) of a sideband of tooth order k: as blocks.line(), but where a run hurries through the resonance.

    A resonance of 5 % damping is as wide as 10 % of the speed. A tooth order that passes it within N turns is smeared
    over some 1 / N orders. A sideband nearer than that cannot be told from it; one not far from it stands on its slope.
    """
    f0, tooth_order = gears.eigenfrequency_Hz, k * gears.pinion_teeth
    resonance_rpm = 60.0 * f0 / tooth_order
    turns = 0.1 * resonance_rpm**2 / (60.0 * max(blocks.sweep_rpm_per_s, 1e-9))
    smears = turns * abs(float(order) - tooth_order)
    return blocks.line(
        float(order),
        left_out=(smears < UNRESOLVED) & blocks.passes(tooth_order, f0 / LINES_ABOVE, f0 * LINES_ABOVE),
        on_slope=(smears < RESOLVED) & blocks.passes(tooth_order, f0 / 2.0, f0 * 2.0),
    )


def rotation_orders(gears):
    """Orders of pinion and wheel from 3 up to the first sideband of tooth order 1, each once."""
    pinion = range(3, gears.pinion_teeth - sidebands_of(gears.pinion_teeth) + 1)
    wheel = range(3, gears.wheel_teeth - sidebands_of(gears.wheel_teeth) + 2)
    orders = {Fraction(n) for n in pinion} | {n * Fraction(gears.pinion_teeth, gears.wheel_teeth) for n in wheel}
    return sorted(order for order in orders if order % gears.pinion_teeth != 0)


def amplitude(power):
    return np.sqrt(max(0.0, power))


def line_sums(blocks, gears):
    """LineSums by (tooth order, None), (tooth order, sideband of it) and (None, order of the rotation)."""
    above_Hz = LINES_ABOVE * gears.eigenfrequency_Hz
    sums = {(k, None): LineSums() for k in TOOTH_ORDERS}
    sums.update({(k, order): LineSums() for k in TOOTH_ORDERS for order in sideband_orders(gears, k)})
    sums.update({(None, order): LineSums() for order in rotation_orders(gears)})
    for piece in blocks.pieces():
        for (k, order), line in sums.items():
            if order is None:
                line.add(*piece.line(k * gears.pinion_teeth, above_Hz))
            elif k is None:
                line.add(*piece.line(float(order)))
            else:
                line.add(*sideband_line(piece, gears, k, order))
    return sums


def order_indicators(blocks, gears):
    sums = line_sums(blocks, gears)
    values, sidebands = {}, {}
    for k in TOOTH_ORDERS:
        line = sums[k, None]
        carrier = max(0.0, line.mean_power) if line.blocks else np.nan
        over_floor = line.over_floor / line.blocks if line.blocks else np.nan
        own = {order: sums[k, order] for order in sideband_orders(gears, k)}
        sidebands = {**own, **sidebands}  # each once: those of the lowest tooth order
        values[f"L{k}_dB"] = 10.0 * np.log10(over_floor)
        values[f"A{k}_N"] = np.sqrt(carrier)
        if over_floor > STANDS_OUT:
            values[f"car{k}"] = carrier / (carrier + max(0.0, power_of_lines(own.values())))
    values["S_N"] = amplitude(power_of_lines(sidebands.values()))
    values["O_N"] = amplitude(power_of_lines(sums[None, order] for order in rotation_orders(gears)))
    return values


def cell_powers(spectra):
    """Mean power of the cells of B: [speed, frequency] (N^2), NaN for a cell without a frame."""
    f_Hz = spectra.frequency_Hz
    columns = [(f_Hz >= low) & (f_Hz < low + CELL_HZ) for low in np.arange(CELL_HZ, CELL_TOP_HZ, CELL_HZ)]
    bottoms_rpm = np.arange(100.0, spectra.speed_rpm.max(), CELL_RPM)
    total, frames = np.zeros((len(bottoms_rpm), len(columns))), np.zeros((len(bottoms_rpm), 1))
    for piece in spectra.pieces():
        of_columns = np.array([piece.power.sum(axis=1, dtype=float, where=column) for column in columns]).T
        for row, low in enumerate(bottoms_rpm):
            inside = (piece.speed_rpm >= low) & (piece.speed_rpm < low + CELL_RPM)
            total[row] += of_columns[inside].sum(axis=0)
            frames[row] += inside.sum()
    with np.errstate(invalid="ignore"):
        return total / (frames * [column.sum() for column in columns])


def louder_share(spectra, reference):
    """B: share of the cells that are 6 dB louder than those of the reference run."""
    cells, before = cell_powers(spectra), cell_powers(reference)
    rows = min(len(cells), len(before))
    cells, before = cells[:rows], before[:rows]
    both = np.isfinite(cells) & np.isfinite(before)
    return np.mean(cells[both] >= LOUDER * before[both]) if both.any() else np.nan


def high_frequency_rms(spectra, gears):
    """HF: rms above the eigenfrequency, tooth orders 1..8 (2 % wide) left out."""
    band = spectra.band(1.5 * gears.eigenfrequency_Hz, HF_TOP_HZ)
    return np.sqrt(spectra.mean_square(band, lambda piece: ~near_tooth_orders(piece, gears, range(1, 9), 0.02)))


def all_indicators(run, spectra, blocks, gears, reference=None):
    """Dictionary of INDICATORS; NaN for what the run cannot tell (too short, no reference)."""
    with np.errstate(divide="ignore", invalid="ignore"):  # a force of 0 has no shares, which are NaN then
        return _all_indicators(run, spectra, blocks, gears, reference)


def _all_indicators(run, spectra, blocks, gears, reference):
    values = dict.fromkeys(INDICATORS, np.nan)
    values["rms_N"] = np.sqrt(spectra.mean_square(spectra.band(LOW_HZ, HIGH_HZ)))
    values["loss_percent"] = 100.0 * loss_of_contact(run)
    values["E0"], values["Em"] = energy_shares(spectra, gears)
    for k in TOOTH_ORDERS:
        values[f"V{k}"] = visibility(spectra, gears, k)
    values["HF_N"] = high_frequency_rms(spectra, gears)
    if blocks is not None:
        values.update(order_indicators(blocks, gears))
        values["EO"] = values["O_N"] ** 2 / (2.0 * values["rms_N"] ** 2)
    if reference is not None:
        values["B"] = louder_share(spectra, reference)
    return values
