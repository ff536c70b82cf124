/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "geometry_listing.h"
#include "gear_contact.h"
#include "json.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* Where it goes, in one of two forms. */
typedef struct listing {
    FILE *stream;
    json_object *object; /* NULL = lines */
} listing;

/* Nothing is printed of a quantity whose inputs are missing (NaN), or that no number holds. */
static void print_value(const listing *to, const char *name, double value) {
    if (!isfinite(value)) {
        return;
    }
    if (to->object != NULL) {
        json_number(to->object, name, value);
    } else {
        fprintf(to->stream, "%s = %.17g\n", name, value);
    }
}

/* Mean, smallest and largest: one line, or three members. */
static void print_spread(const listing *to, const char *name, const double spread[3]) {
    static const char *const of[] = {"", "_smallest", "_largest"};

    if (to->object == NULL) {
        fprintf(to->stream, "%s = %.17g, %.17g, %.17g\n", name, spread[0], spread[1], spread[2]);
        return;
    }
    for (int i = 0; i < 3; ++i) {
        char member[64];
        snprintf(member, sizeof member, "%s%s", name, of[i]);
        print_value(to, member, spread[i]);
    }
}

static double degrees(double angle) {
    return angle * (180 / pi);
}

static double millimetres(double length) {
    return length * 1e3;
}

static void print_pair(const gm_pair *pair, const listing *to) {
    print_value(to, "transverse_module_mm", millimetres(pair->transverse_module));
    print_value(to, "transverse_pressure_angle_deg", degrees(pair->transverse_pressure_angle));
    print_value(to, "working_pressure_angle_deg", degrees(pair->working_pressure_angle));
    print_value(to, "base_helix_angle_deg", degrees(pair->base_helix_angle));
    print_value(to, "reference_center_distance_mm", millimetres(pair->reference_center_distance));
    print_value(to, "pinion_profile_shift", pair->pinion.profile_shift);
    print_value(to, "wheel_profile_shift", pair->wheel.profile_shift);

    /* Of each gear. */
    print_value(to, "pinion_base_radius_mm", millimetres(pair->pinion.base_radius));
    print_value(to, "wheel_base_radius_mm", millimetres(pair->wheel.base_radius));
    print_value(to, "pinion_tip_radius_mm", millimetres(pair->pinion.tip_radius));
    print_value(to, "wheel_tip_radius_mm", millimetres(pair->wheel.tip_radius));
    print_value(to, "pinion_start_radius_mm", millimetres(pair->pinion.start_radius));
    print_value(to, "wheel_start_radius_mm", millimetres(pair->wheel.start_radius));

    /* Along the line of action. */
    print_value(to, "transverse_base_pitch_mm", millimetres(pair->transverse_base_pitch));
    print_value(to, "line_of_action_mm", millimetres(pair->line_of_action));
    print_value(to, "path_start_mm", millimetres(pair->path_start));
    print_value(to, "path_end_mm", millimetres(pair->path_end));
    print_value(to, "transverse_contact_ratio", pair->transverse_contact_ratio);
    print_value(to, "overlap_ratio", pair->overlap_ratio);
    print_value(to, "total_contact_ratio", pair->total_contact_ratio);
    print_value(to, "backlash_um", 1e6 * pair->backlash);
}

static void print_teeth(const gear_mesh *mesh, const listing *to) {
    const gm_pair *pair = &mesh->pair;
    const gm_gear *pinion = &pair->pinion;
    const gm_gear *wheel = &pair->wheel;

    print_value(to, "pinion_working_pitch_radius_mm",
                millimetres(pair->pinion_working_pitch_radius));
    print_value(to, "wheel_working_pitch_radius_mm", millimetres(pair->wheel_working_pitch_radius));
    print_value(to, "pinion_tip_clearance_mm", millimetres(pair->pinion_tip_clearance));
    print_value(to, "wheel_tip_clearance_mm", millimetres(pair->wheel_tip_clearance));
    print_value(to, "pinion_root_radius_mm", millimetres(pinion->root_radius));
    print_value(to, "wheel_root_radius_mm", millimetres(wheel->root_radius));
    print_value(to, "pinion_tip_thickness_mm", millimetres(pinion->tip_thickness));
    print_value(to, "wheel_tip_thickness_mm", millimetres(wheel->tip_thickness));
    print_value(to, "pinion_tip_alteration", pinion->tip_alteration);
    print_value(to, "wheel_tip_alteration", wheel->tip_alteration);
    print_value(to, "gear_ratio", wheel->sign * wheel->teeth / pinion->teeth);
    print_value(to, "face_width_mm", millimetres(mesh->halves * pair->face_width + mesh->gap));
    if (mesh->halves > 1) {
        print_value(to, "half_face_width_mm", millimetres(pair->face_width));
    }
}

/* What the law derived from the gears; 1 N/(mm um) is 1e9 N/m2. */
static void print_law(const gear_mesh *mesh, const config *conf, const listing *to) {
    const gm_pair *pair = &mesh->pair;

    if (conf->law == LAW_ISO6336) {
        const double factor = conf->iso_blank_factor;
        print_value(to, "iso_single_stiffness_N_per_mm_um",
                    1e-9 * gm_iso6336_single_stiffness(pair, factor));
        print_value(to, "iso_mesh_stiffness_N_per_mm_um",
                    1e-9 * gm_iso6336_mesh_stiffness(pair, factor));
    }

    /* Elastic teeth, at the mean load; of both halves together. */
    gm_mesh_stiffness elastic;
    if (gm_mesh_elastic_stiffness(mesh->prepared[0], &elastic) == GM_OK) {
        const double per_um = 1e-6 * mesh->halves;
        const double single[] = {per_um * elastic.single_mean, per_um * elastic.single_smallest,
                                 per_um * elastic.single_largest};
        const double all[] = {per_um * elastic.mesh_mean, per_um * elastic.mesh_smallest,
                              per_um * elastic.mesh_largest};
        print_spread(to, "single_stiffness_N_per_um", single);
        print_spread(to, "mesh_stiffness_N_per_um", all);
        print_value(to, "stations", gear_mesh_stations(mesh, conf));
    }
}

static void print_all(const gear_mesh *mesh, const config *conf, const listing *to) {
    print_pair(&mesh->pair, to);
    print_teeth(mesh, to);
    print_law(mesh, conf, to);
    print_value(to, "mean_mesh_stiffness_N_per_um", 1e-6 * gear_contact_mean_stiffness(mesh));
    print_value(to, "eigenfrequency_Hz", gear_mesh_eigenfrequency(mesh, conf));
    print_value(to, "mesh_frequency_per_rpm_Hz", mesh->pair.pinion.teeth / 60.0);
}

void geometry_print(const gear_mesh *mesh, const config *conf, int as_json, FILE *stream) {
    if (!as_json) {
        print_all(mesh, conf, &(listing){stream, NULL});
        return;
    }

    json_object object = json_begin(stream);
    print_all(mesh, conf, &(listing){stream, &object});
    json_end(&object);
}
