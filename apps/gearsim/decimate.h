/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * From samples to rows: a low-pass that keeps what the rows can show and removes what would fold back
 * into it, then every factor-th value.
 *
 * The filter has linear phase and is centred on the row's time: no delay. In terms of the rate of the
 * rows: flat within 0.01 % up to 0.4 (SAMPLE_HAT with factor 2: 0.03 %), and at least 90 dB down from 0.6 on (Kaiser
 * window, 30 samples per factor and one). What lies between folds to 0.4..0.5 of the rate and stays there.
 *
 * Samples may be values at their time or half a period behind it, or means around it: then the filter lifts what the mean
 * has taken off, so that rows are the same for a slow signal, but what lies beyond the rate of the samples does not fold
 * into them.
 *
 * Ends: before the first sample its value is taken as held, or what is given. A row needs the samples up to 15 rows after
 * it, so the run goes on that far beyond its end.
 */
#ifndef GEARSIM_DECIMATE_H
#define GEARSIM_DECIMATE_H

typedef struct decimator decimator;

/* What the samples of a channel are. */
enum sample_kind {
    SAMPLE_PLAIN,  /* not to be filtered: delayed alike */
    SAMPLE_VALUES, /* values at the sample's time */
    SAMPLE_BEHIND, /* values half a period behind it; not with factor 1 */
    SAMPLE_BOX,    /* means over the sample's period, from half of it before to half of it after */
    SAMPLE_HAT,    /* means under a triangle, from one period before to one after */
    SAMPLE_KINDS
};

/*
 * For samples of `channels` values each, of the kinds given. Factor 1: no filter, no delay. NULL: out of memory.
 */
decimator *decimator_create(int factor, int channels, const enum sample_kind kinds[]);
void decimator_free(decimator *filter);

/* How many samples after it a sample's filtered value is complete: a multiple of the factor. */
int decimator_delay(const decimator *filter);

/* Before the first sample, if other values than its own have been there. */
void decimator_hold(decimator *filter, const double values[]);

void decimator_push(decimator *filter, const double values[]);

/* Some samples at a time: value n of a channel is values[channel * stride + n]. */
void decimator_push_all(decimator *filter, int count, const double values[], int stride);

/* Values at the sample that was pushed decimator_delay() samples before the last one. */
void decimator_values(const decimator *filter, double values[]);

/* Weights for a kind that a channel has, but the plain one, decimator_delay() on each side of the middle; their sum is 1. Of
 * SAMPLE_BEHIND the last one is 0. */
const double *decimator_weights(const decimator *filter, enum sample_kind kind);

#endif
