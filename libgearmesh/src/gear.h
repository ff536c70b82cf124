/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Geometry of one gear. ISO 21771 gives a ring a negative number of teeth, and with it negative radii and roll
 * lengths, centre distance and line of action: so the formulas of external gears hold for it as they are. What users see
 * has positive lengths; the sign of the gear turns them into those of the standard.
 */
#ifndef GEARMESH_GEAR_H
#define GEARMESH_GEAR_H

#include "internal.h"

double gmi_involute(double angle);
void gmi_gear_init(gm_gear *gear, int teeth, double transverse_module,
                   double transverse_pressure_angle);
void gmi_gear_set_root(gm_gear *gear, double normal_module);
void gmi_gear_set_tip(gm_gear *gear, double given_radius, double tip_alteration,
                      double normal_module);
void gmi_gear_set_start(gm_gear *gear, double start_radius);
void gmi_gear_set_start_roll_length(gm_gear *gear, double start_roll_length);
void gmi_gear_set_thickness(gm_gear *gear, double normal_thickness, double helix_angle,
                            double transverse_pressure_angle);
void gmi_gear_set_tip_thickness(gm_gear *gear, double helix_angle);

#endif
