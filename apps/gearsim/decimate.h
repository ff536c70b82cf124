/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * From samples to rows: a low-pass that keeps what the rows can show and removes what would fold back
 * into it, then every factor-th value.
 *
 * The filter has linear phase and is centred on the row's time: no delay. In terms of the rate of the
 * rows: flat within 0.01 % up to 0.4, and at least 90 dB down from 0.6 on (Kaiser window, 30 samples per
 * factor and one). What lies between folds to 0.4..0.5 of the rate and stays there.
 *
 * Ends: before the first sample its value is taken as held. A row needs the samples up to 15 rows after
 * it, so the run goes on that far beyond its end.
 */
#ifndef GEARSIM_DECIMATE_H
#define GEARSIM_DECIMATE_H

typedef struct decimator decimator;

/*
 * For samples of `channels` values each, of which those with filtered[channel] != 0 are filtered and the
 * others delayed alike. Factor 1: no filter, no delay. NULL: out of memory.
 */
decimator *decimator_create(int factor, int channels, const int filtered[]);
void decimator_free(decimator *filter);

/* How many samples after it a sample's filtered value is complete: a multiple of the factor. */
int decimator_delay(const decimator *filter);

void decimator_push(decimator *filter, const double values[]);

/* Values at the sample that was pushed decimator_delay() samples before the last one. */
void decimator_values(const decimator *filter, double values[]);

/* Weights of the filter, decimator_delay() on each side of the middle; their sum is 1. */
const double *decimator_weights(const decimator *filter);

#endif
