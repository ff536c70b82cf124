# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""A force as sound: as it is, or as a housing might pass it on."""
import importlib
import io
import math
from fractions import Fraction

import numpy as np
from scipy import signal
from scipy.io import wavfile

import program

RATE_HZ = 22050
LOUDNESS_RATE_HZ = 48000  # that of ISO 532-1
# A housing that is nobody's: three resonances (Hz, damping ratio, share).
HOUSING = ((650.0, 0.06, 1.0), (1400.0, 0.05, 0.7), (2600.0, 0.04, 0.5))
LOUDEST_SHARE = 99.9  # percentile of the amounts that becomes PEAK of full scale
PEAK = 0.9
TONE_S = 0.5  # of sound for each value of a tonality [ECMA-418-1]
AUDIBLE_SONE = 0.02  # weaker sounds have no sharpness
SETTLES_S = 0.2  # what a sudden beginning takes


def of_run(run, kind, rate_Hz=RATE_HZ):
    """Samples of the force without its mean, in N."""
    values = run.force_N - run.force_N.mean()

    # To the rate of sound; a ratio of small numbers is near enough: 1e-4 is a sixtieth of a semitone.
    ratio = Fraction(rate_Hz / run.rate_Hz).limit_denominator(1000)
    values = signal.resample_poly(values, ratio.numerator, ratio.denominator)
    if kind == "housing":
        values = sum(share * _resonance(values, frequency_Hz, damping, rate_Hz) for frequency_Hz, damping, share in HOUSING)
    return values


def full_scale_N(several):
    """The force that is full scale, the same for several sounds, so that they can be compared."""
    return max([float(np.percentile(np.abs(values), LOUDEST_SHARE)) / PEAK for values in several], default=0.0) or 1.0


def _resonance(values, frequency_Hz, damping, rate_Hz):
    """Of a single degree of freedom: acceleration of its mass, 1 far above the resonance."""
    omega = 2.0 * math.pi * frequency_Hz
    numerator, denominator = signal.bilinear([1.0, 0.0, 0.0], [1.0, 2.0 * damping * omega, omega**2], rate_Hz)
    return signal.lfilter(numerator, denominator, values)


def wav_bytes(values, full_N):
    """A WAV of 16 bits."""
    file = io.BytesIO()
    wavfile.write(file, RATE_HZ, np.round(32767.0 * np.clip(values / full_N, -1.0, 1.0)).astype("<i2"))
    return file.getvalue()


def load_mosqito():
    """What computes loudness; to be called before anything is printed or written."""
    program.optional("mosqito")
    try:
        return importlib.import_module("mosqito.sq_metrics")
    except ImportError as error:
        raise program.InputError(f"mosqito cannot be loaded: {program.first_line_of(error)}") from error


def loudness(run, kind, pascal_per_N):
    """(time in s, loudness in sone, sharpness in acum) of a run: ISO 532-1 for sounds that vary, free field; DIN 45692."""
    metrics = load_mosqito()
    pressure_Pa = pascal_per_N * of_run(run, kind, LOUDNESS_RATE_HZ)
    with np.errstate(all="ignore"):
        sone, specific, _, time_s = metrics.loudness_zwtv(pressure_Pa, LOUDNESS_RATE_HZ, field_type="free")
        acum = np.asarray(metrics.sharpness_din_from_loudness(sone, specific), dtype=float)
    time_s, sone = np.asarray(time_s), np.asarray(sone)

    # The sound begins of a sudden, which no run does.
    settled = time_s >= min(SETTLES_S, 0.5 * time_s[-1])
    return run.time_s[0] + time_s[settled], sone[settled], np.where(sone > AUDIBLE_SONE, acum, np.nan)[settled]


def tonality(run, kind, pascal_per_N):
    """(time in s, tone-to-noise ratio in dB) of all tones together, in pieces of TONE_S that overlap by half: ECMA-418-1.

    0 where no tone stands out. Tones that sweep through several bands in a piece are none.
    """
    pressure_Pa = pascal_per_N * of_run(run, kind, LOUDNESS_RATE_HZ)
    if len(pressure_Pa) <= TONE_S * LOUDNESS_RATE_HZ:
        return np.empty(0), np.empty(0)
    with np.errstate(all="ignore"):
        total_dB, _, _, _, time_s = load_mosqito().tnr_ecma_perseg(pressure_Pa, LOUDNESS_RATE_HZ, overlap=0.5)
    return run.time_s[0] + np.asarray(time_s), np.nan_to_num(np.asarray(total_dB, dtype=float))
