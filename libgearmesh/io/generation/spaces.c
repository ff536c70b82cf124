/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "spaces.h"
#include "shared.h"

#include "random.h"

gmi_spaces gmi_spaces_begin(int teeth, double *work, double phase) {
    double *sine = work + teeth;
    for (int i = 0; i < teeth; ++i) {
        const double turns = (double)i / teeth + phase;
        work[i] = gmi_sine_of_turns(turns + 0.25);
        sine[i] = gmi_sine_of_turns(turns);
    }
    return (gmi_spaces){.teeth = teeth, .cosine = work, .sine = sine, .error = sine + teeth};
}

double gmi_spaces_first_order(const gmi_spaces *of, int space, double side) {
    return side * of->radial * of->cosine[space] - of->tangential * of->sine[space];
}

void gmi_spaces_to_pitch(const gmi_spaces *of, gm_pitch *pitch, const gm_gear *gear, int wheel) {
    const int teeth = of->teeth;
    const double ahead = wheel ? -1.0 : 1.0;
    const double cosine_of_angle = gear->base_radius / gear->reference_radius;
    for (int i = 0; i < teeth; ++i) {
        const int neighbour = (i + (wheel ? teeth - 1 : 1)) % teeth;
        const double error = of->factor * of->error[i];
        const double drive = gmi_spaces_first_order(of, i, ahead) + error;
        const double coast = gmi_spaces_first_order(of, i, -ahead) + error;
        pitch->drive[i] = gmi_rounded(ahead * cosine_of_angle * drive);
        pitch->coast[neighbour] = gmi_rounded(-ahead * cosine_of_angle * coast);
        pitch->drive_set[i] = pitch->coast_set[i] = 1;
    }
}
