# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""A force as sound: as it is, or as a housing might pass it on."""
import io
import math
from fractions import Fraction

import numpy as np
from scipy import signal
from scipy.io import wavfile

RATE_HZ = 22050
# A housing that is nobody's: three resonances (Hz, damping ratio, share).
HOUSING = ((650.0, 0.06, 1.0), (1400.0, 0.05, 0.7), (2600.0, 0.04, 0.5))
LOUDEST_SHARE = 99.9  # percentile of the amounts that becomes PEAK of full scale
PEAK = 0.9


def of_run(run, kind):
    """Samples of the force without its mean at RATE_HZ, in N."""
    values = run.force_N - run.force_N.mean()

    # To the rate of sound; a ratio of small numbers is near enough: 1e-4 is a sixtieth of a semitone.
    ratio = Fraction(RATE_HZ / run.rate_Hz).limit_denominator(1000)
    values = signal.resample_poly(values, ratio.numerator, ratio.denominator)
    if kind == "housing":
        values = sum(share * _resonance(values, frequency_Hz, damping) for frequency_Hz, damping, share in HOUSING)
    return values


def full_scale_N(several):
    """The force that is full scale, the same for several sounds, so that they can be compared."""
    return max([float(np.percentile(np.abs(values), LOUDEST_SHARE)) / PEAK for values in several], default=0.0) or 1.0


def _resonance(values, frequency_Hz, damping):
    """Of a single degree of freedom: acceleration of its mass, 1 far above the resonance."""
    omega = 2.0 * math.pi * frequency_Hz
    numerator, denominator = signal.bilinear([1.0, 0.0, 0.0], [1.0, 2.0 * damping * omega, omega**2], RATE_HZ)
    return signal.lfilter(numerator, denominator, values)


def wav_bytes(values, full_N):
    """A WAV of 16 bits."""
    file = io.BytesIO()
    wavfile.write(file, RATE_HZ, np.round(32767.0 * np.clip(values / full_N, -1.0, 1.0)).astype("<i2"))
    return file.getvalue()
