/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file mka_file.h
 * Text files of Klingelnberg gear measuring machines: docs/measured-flanks.md.
 */
#ifndef GEARMESH_MKA_FILE_H
#define GEARMESH_MKA_FILE_H

#include "gearmesh/gearmesh_io.h"

/** Whether a file begins as they do; 0 also where it cannot be read. */
int gmi_is_mka(const char *path);

/** All traces of the file, which must be of this gear. The caller frees them on an error. */
int gmi_mka_traces(gm_traces *traces, const char *path, const gm_pair *pair, int wheel, int style,
                   gm_io_error *error);

/** The pitch of both flanks. The caller frees it on an error. */
int gmi_mka_pitch(gm_measured_pitch *pitch, const char *path, int style, gm_io_error *error);

#endif /* GEARMESH_MKA_FILE_H */
