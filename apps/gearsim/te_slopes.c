/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "te_slopes.h"
#include "gear_contact.h"
#include "modification_keys.h"
#include "modification_kinds.h"

#include <math.h>
#include <string.h>

/* The amount that a change is made with: large, so that the tolerance of its table is a small share of it (m). */
static const double change_amount = 100e-6;

/* Names of the columns, in the order of config.modifications. */
/* clang-format off */
#define NAME(flank, kind, name, shown, which, range_of_amount, size, range, shapes, text)          \
    [kind] = TE_SLOPE_PREFIX flank "_" name "_um",
static const char *const slope_names[2][MODIFICATION_PLACES][GM_MODIFICATION_KINDS] = {
    {{MODIFICATION_KINDS(NAME, "pinion")},
     {MODIFICATION_KINDS(NAME, "pinion_drive")},
     {MODIFICATION_KINDS(NAME, "pinion_coast")}},
    {{MODIFICATION_KINDS(NAME, "wheel")},
     {MODIFICATION_KINDS(NAME, "wheel_drive")},
     {MODIFICATION_KINDS(NAME, "wheel_coast")}}};
#undef NAME
/* clang-format on */

/* A key of [modifications] that is an amount. */
typedef struct amount_key {
    enum gm_role gear;
    int place, kind;
} amount_key;

/* Whether the name is one of those that `output.columns` lists. */
static int is_listed(const config *conf, const char *name) {
    const size_t length = strlen(name);
    const char *text = conf->columns;

    while ((text = strstr(text, name)) != NULL) {
        const int begins = text == conf->columns || strchr(", \t", text[-1]) != NULL;
        if (begins && (text[length] == '\0' || strchr(", \t", text[length]) != NULL)) {
            return 1;
        }
        text += length;
    }
    return 0;
}

/*
 * Where the load is a force that gm_mesh_force_by_flanks() knows: friction takes part of a torque, a pinion between two
 * halves floats, and under a tip corner of constant stiffness the library has no answer.
 */
static int has_slopes(const config *conf) {
    return conf->model == MODEL_3D && !config_has_friction(conf) && !config_has_corners(conf) &&
           isnan(conf->double_helical_gap);
}

/* The keys that are asked for; returns how many. */
static int find_keys(const config *conf, amount_key keys[TE_SLOPES_MAX]) {
    int count = 0;

    if (conf->columns == NULL || strstr(conf->columns, TE_SLOPE_PREFIX) == NULL ||
        !has_slopes(conf)) {
        return 0;
    }
    for (enum gm_role gear = GM_PINION; gear <= GM_WHEEL; ++gear) {
        for (int place = 0; place < MODIFICATION_PLACES; ++place) {
            for (int kind = 0; kind < GM_MODIFICATION_KINDS; ++kind) {
                if (count < TE_SLOPES_MAX && is_listed(conf, slope_names[gear][place][kind])) {
                    const amount_key key = {gear, place, kind};
                    keys[count++] = key;
                }
            }
        }
    }
    return count;
}

void te_slopes_add_names(const config *conf, column_names *names) {
    amount_key keys[TE_SLOPES_MAX];
    const int count = find_keys(conf, keys);

    for (int k = 0; k < count && names->count < COLUMNS_MAX; ++k) {
        names->name[names->count++] = slope_names[keys[k].gear][keys[k].place][keys[k].kind];
    }
}

/* The flanks of this key alone: where the file gives another one for a flank, that stays the one that counts there. */
static int make_change(gear_flanks *change, const config *conf, const gear_mesh *gears,
                       const amount_key *key) {
    message_sink errors_only = *conf->messages;
    const flank_files no_files = {0};
    config alone = *conf;

    errors_only.quiet = 1;
    alone.messages = &errors_only;
    alone.pinion_flanks = alone.wheel_flanks = no_files;
    for (int place = 0; place < MODIFICATION_PLACES; ++place) {
        for (int kind = 0; kind < GM_MODIFICATION_KINDS; ++kind) {
            double *amount =
                &alone.modifications[key->gear][place][kind].value[MODIFICATION_AMOUNT];
            *amount = isnan(*amount) ? *amount : 0.0;
        }
    }
    alone.modifications[key->gear][key->place][key->kind].value[MODIFICATION_AMOUNT] =
        change_amount;

    /* A relief needs its range. */
    if (modification_keys_check(&alone) != 0) {
        return EXIT_BAD_INPUT;
    }
    return gear_flanks_load(change, &alone, &gears->pair, key->gear, 0);
}

int te_slopes_open(te_slopes *slopes, const config *conf, const gear_mesh *gears) {
    amount_key keys[TE_SLOPES_MAX];
    const int count = find_keys(conf, keys);

    memset(slopes, 0, sizeof *slopes);
    for (; slopes->count < count; ++slopes->count) {
        const amount_key *key = &keys[slopes->count];
        const int status = make_change(&slopes->change[key->gear][slopes->count], conf, gears, key);
        if (status != 0) {
            return status;
        }
    }
    return 0;
}

void te_slopes_close(te_slopes *slopes) {
    for (int k = 0; k < TE_SLOPES_MAX; ++k) {
        gear_flanks_free(&slopes->change[GM_PINION][k]);
        gear_flanks_free(&slopes->change[GM_WHEEL][k]);
    }
    slopes->count = 0;
}

/*
 * dF/dx at a held pinion angle (N/m): of elastic teeth the stiffness that touches; with constant stiffness x moves the
 * places as well where the flanks meet.
 */
static int find_stiffness(const gear_mesh *gears, const gm_position *position,
                          const gm_mesh_result *at_rest, double *stiffness) {
    if (gears->workspace[0] != NULL) {
        *stiffness = gear_contact_touching_stiffness(gears, at_rest);
        return GM_OK;
    }
    gm_mesh_result result;
    const int status = gear_contact_evaluate(gears, position, GM_WANT_DERIVATIVES, &result);

    *stiffness = -result.force_by.wheel_angle / gears->pair.wheel.base_radius;
    return status;
}

/* te = -x, and at a given load dx = -(dF/da) / (dF/dx) da. */
int te_slopes_find(const te_slopes *slopes, const gear_mesh *gears, const gm_position *position,
                   const gm_mesh_result *at_rest, double *te_by) {
    const gm_flanks *change[2][TE_SLOPES_MAX];
    for (int k = 0; k < slopes->count; ++k) {
        change[GM_PINION][k] = slopes->change[GM_PINION][k].prepared;
        change[GM_WHEEL][k] = slopes->change[GM_WHEEL][k].prepared;
    }

    double stiffness;
    int status = find_stiffness(gears, position, at_rest, &stiffness);
    if (status == GM_OK) {
        status =
            gm_mesh_force_by_flanks(gears->prepared[0], position, change[GM_PINION],
                                    change[GM_WHEEL], slopes->count, gears->workspace[0], te_by);
    }
    for (int k = 0; k < slopes->count && status == GM_OK; ++k) {
        te_by[k] /= stiffness * change_amount;
    }
    return status;
}
