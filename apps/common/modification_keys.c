/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "modification_keys.h"
#include "modification_kinds.h"

#include <math.h>
#include <string.h>

/* Places in config.modifications[gear]: a flank with GM_DRIVE or GM_COAST stands at 1 + side. */
enum { BOTH_FLANKS = 0, PLACES = MODIFICATION_PLACES, KEY_SIZE = MODIFICATION_KEY_SIZE };

static const char *const place_names[2][PLACES] = {{"pinion", "pinion_drive", "pinion_coast"},
                                                   {"wheel", "wheel_drive", "wheel_coast"}};

/* What the keys of a kind are called, and which of them there are: see modification_kinds.h. */
#define NO_FACE_SIZE_SUFFIX     NULL
#define FACE_LENGTH_SUFFIX      "_length_mm"
#define FACE_WIDTH_SUFFIX       "_width_mm"
#define NO_PROFILE_RANGE_EXISTS 0
#define PROFILE_RANGE_EXISTS    1
#define NO_SHAPE_FIRST          GM_SHAPE_LINEAR
#define CURVED_SHAPES_FIRST     GM_SHAPE_PARABOLIC
#define ALL_SHAPES_FIRST        GM_SHAPE_LINEAR

#define KIND_TRAITS(unused, kind, name, shown, which, range_of_amount, size, range, shapes, text)  \
    [kind] = {(name), size##_SUFFIX, range##_EXISTS, shapes##_FIRST},

static const struct {
    const char *name;
    const char *width; /* suffix of its length along the face, NULL = none */
    int has_range;     /* along the profile */
    int first_shape;   /* of those to choose from */
} kinds[GM_MODIFICATION_KINDS] = {MODIFICATION_KINDS(KIND_TRAITS, )};

/* The keys of one modification in one place. */
typedef struct key_place {
    const config *conf;
    enum gm_role gear;
    int place, kind;
} key_place;

static const modification_values *values_of(const key_place *at) {
    return &at->conf->modifications[at->gear][at->place][at->kind];
}

static int is_given(const key_place *at, int field) {
    const modification_values *values = values_of(at);

    return field == MODIFICATION_SHAPE ? values->shape >= 0 : !isnan(values->value[field]);
}

/* "modifications.pinion_drive_tip_relief_um" */
static const char *key_name(char name[KEY_SIZE], const key_place *at, int field) {
    static const char *const suffixes[] = {
        [MODIFICATION_AMOUNT] = "_um",        [MODIFICATION_WIDTH] = "",
        [MODIFICATION_LENGTH] = "_length_mm", [MODIFICATION_RADIUS] = "_diameter_mm",
        [MODIFICATION_SHARE] = "_share",      [MODIFICATION_SHAPE] = "_shape"};
    const char *suffix = field == MODIFICATION_WIDTH ? kinds[at->kind].width : suffixes[field];

    snprintf(name, KEY_SIZE, "modifications.%s_%s%s", place_names[at->gear][at->place],
             kinds[at->kind].name, suffix != NULL ? suffix : "");
    return name;
}

const char *modification_key_name(char name[MODIFICATION_KEY_SIZE], enum gm_role gear, int place,
                                  int kind, int field) {
    const key_place at = {NULL, gear, place, kind};

    return key_name(name, &at, field);
}

void modification_keys_clear(config *conf) {
    const double missing = (double)NAN;
    const modification_values none = {{missing, missing, missing, missing, missing}, -1};

    for (enum gm_role gear = GM_PINION; gear <= GM_WHEEL; ++gear) {
        for (int place = 0; place < PLACES; ++place) {
            for (int kind = 0; kind < GM_MODIFICATION_KINDS; ++kind) {
                conf->modifications[gear][place][kind] = none;
            }
        }
    }
}

static int is_range(int field) {
    return field == MODIFICATION_LENGTH || field == MODIFICATION_RADIUS ||
           field == MODIFICATION_SHARE;
}

/* The range key that is given, or -1. */
static int given_range(const key_place *at) {
    for (int field = 0; field < MODIFICATION_FIELDS; ++field) {
        if (is_range(field) && is_given(at, field)) {
            return field;
        }
    }
    return -1;
}

/* Where a key that counts for a flank stands: with the flank, else without. */
static key_place source_of(const config *conf, enum gm_role gear, int side, int kind, int field) {
    const key_place own = {conf, gear, 1 + side, kind};
    const key_place both = {conf, gear, BOTH_FLANKS, kind};
    const int has_own = is_range(field) ? given_range(&own) >= 0 : is_given(&own, field);

    return has_own ? own : both;
}

/* The amount that counts for a flank, 0 = no modification (m). */
static double amount_of(const config *conf, enum gm_role gear, int side, int kind) {
    const key_place at = source_of(conf, gear, side, kind, MODIFICATION_AMOUNT);

    return is_given(&at, MODIFICATION_AMOUNT) ? values_of(&at)->value[MODIFICATION_AMOUNT] : 0;
}

/* ---------------------------------------------------------------------------------------------
 * What must fit together
 * ------------------------------------------------------------------------------------------- */

static int check_one_range(const key_place *at) {
    const int first = given_range(at);
    char name[KEY_SIZE];
    char other[KEY_SIZE];
    int faults = 0;

    for (int field = first + 1; first >= 0 && field < MODIFICATION_FIELDS; ++field) {
        if (!is_range(field) || !is_given(at, field)) {
            continue;
        }
        config_complain(at->conf, key_name(name, at, field),
                        "must not be given beside %s: give one of the two",
                        key_name(other, at, first));
        ++faults;
    }
    return faults;
}

/* Tells of a range that the amount at `amount` lacks. */
static int complain_of_missing(const key_place *amount, int field) {
    char name[KEY_SIZE];
    char wanted[KEY_SIZE];

    config_complain(amount->conf, key_name(name, amount, MODIFICATION_AMOUNT),
                    "must have a range: add %s%s", key_name(wanted, amount, field),
                    is_range(field) ? ", or _diameter_mm or _share in place of _length_mm" : "");
    return 1;
}

static int check_flank(const config *conf, enum gm_role gear, int side, int kind) {
    const key_place amount = source_of(conf, gear, side, kind, MODIFICATION_AMOUNT);
    const key_place range = source_of(conf, gear, side, kind, MODIFICATION_LENGTH);
    const key_place width = source_of(conf, gear, side, kind, MODIFICATION_WIDTH);
    int faults = 0;

    if (amount_of(conf, gear, side, kind) == 0) {
        return 0;
    }
    if (kinds[kind].has_range && given_range(&range) < 0) {
        faults += complain_of_missing(&amount, MODIFICATION_LENGTH);
    }
    if (kinds[kind].width != NULL && !is_given(&width, MODIFICATION_WIDTH)) {
        faults += complain_of_missing(&amount, MODIFICATION_WIDTH);
    }
    return faults;
}

/* Once for both flanks where the same key is at fault. */
static int check_kind(const config *conf, enum gm_role gear, int kind) {
    int faults = 0;

    for (int place = 0; place < PLACES; ++place) {
        const key_place at = {conf, gear, place, kind};
        faults += check_one_range(&at);
    }
    if (faults > 0) {
        return faults;
    }
    faults = check_flank(conf, gear, GM_DRIVE, kind);
    return faults > 0 ? faults : check_flank(conf, gear, GM_COAST, kind);
}

int modification_keys_check(const config *conf) {
    int faults = 0;

    for (enum gm_role gear = GM_PINION; gear <= GM_WHEEL; ++gear) {
        for (int kind = 0; kind < GM_MODIFICATION_KINDS; ++kind) {
            faults += check_kind(conf, gear, kind);
        }
    }
    return faults;
}

/* ---------------------------------------------------------------------------------------------
 * Keys that change nothing
 * ------------------------------------------------------------------------------------------- */

/* Does a flank take its key from this place? */
static int serves(const key_place *at, int side, int field) {
    return source_of(at->conf, at->gear, side, at->kind, field).place == at->place;
}

static void warn_of_key(const key_place *at, int field) {
    int active = 0;
    int used = 0;
    char name[KEY_SIZE];

    for (int side = GM_DRIVE; side <= GM_COAST; ++side) {
        const int is_active =
            field == MODIFICATION_AMOUNT || amount_of(at->conf, at->gear, side, at->kind) != 0;
        const int is_of_place = at->place == BOTH_FLANKS || at->place == 1 + side;
        active |= is_active && is_of_place;
        used |= is_active && serves(at, side, field);
    }
    if (used) {
        return;
    }
    config_warn(at->conf, key_name(name, at, field), "not used %s",
                active ? "as the keys of both flanks replace it" : "without an amount");
}

void modification_keys_warn(const config *conf) {
    for (enum gm_role gear = GM_PINION; gear <= GM_WHEEL; ++gear) {
        for (int place = 0; place < PLACES; ++place) {
            for (int kind = 0; kind < GM_MODIFICATION_KINDS; ++kind) {
                const key_place at = {conf, gear, place, kind};
                for (int field = 0; field < MODIFICATION_FIELDS; ++field) {
                    if (is_given(&at, field)) {
                        warn_of_key(&at, field);
                    }
                }
            }
        }
    }
}

/* ---------------------------------------------------------------------------------------------
 * The designs
 * ------------------------------------------------------------------------------------------- */

static gm_modification modification_of(const config *conf, enum gm_role gear, int side, int kind) {
    static const int range_by[] = {[MODIFICATION_LENGTH] = GM_RANGE_LENGTH,
                                   [MODIFICATION_RADIUS] = GM_RANGE_RADIUS,
                                   [MODIFICATION_SHARE] = GM_RANGE_SHARE};
    const key_place range = source_of(conf, gear, side, kind, MODIFICATION_LENGTH);
    const key_place width = source_of(conf, gear, side, kind, MODIFICATION_WIDTH);
    const key_place shape = source_of(conf, gear, side, kind, MODIFICATION_SHAPE);
    const int field = given_range(&range);
    gm_modification modification = {.kind = kind};

    modification.amount = amount_of(conf, gear, side, kind);
    modification.shape = kinds[kind].first_shape;
    if (is_given(&shape, MODIFICATION_SHAPE)) {
        modification.shape += values_of(&shape)->shape;
    }
    modification.face_range = values_of(&width)->value[MODIFICATION_WIDTH];
    if (field >= 0) {
        modification.profile_range_by = range_by[field];
        modification.profile_range = values_of(&range)->value[field];
    }
    return modification;
}

/* The key that a field of gm_modification comes from. */
static int field_of(const key_place *range, const char *field) {
    if (strcmp(field, "face_range") == 0) {
        return MODIFICATION_WIDTH;
    }
    return strcmp(field, "profile_range") == 0 ? given_range(range) : MODIFICATION_AMOUNT;
}

/* What would be right, with the measures of this gear (mm). */
static void describe_limit(char *text, size_t size, int field, const char *requirement,
                           const gm_gear *gear) {
    const double roll_length = gear->tip_roll_length - gear->start_roll_length;

    if (field == MODIFICATION_WIDTH) {
        snprintf(text, size, "at most the face width, %.9g mm", 1e3 * gear->face_width);
    } else if (field == MODIFICATION_LENGTH) {
        snprintf(text, size, "at most the roll length of the active profile, %.9g mm",
                 1e3 * roll_length);
    } else if (field == MODIFICATION_RADIUS) {
        snprintf(text, size, "within the active profile, from %.9g to %.9g mm, and leave a range",
                 2e3 * gear->start_radius, 2e3 * gear->tip_radius);
    } else if (field == MODIFICATION_SHARE) {
        snprintf(text, size, "at most 1");
    } else {
        snprintf(text, size, "%s", requirement);
    }
}

static int refuse(const config *conf, enum gm_role gear, int side, const gm_modifications *design) {
    int index = -1;
    const char *field_name = NULL;
    const char *requirement = NULL;
    char limit[160];
    char name[KEY_SIZE];

    (void)gm_modifications_check(design, &index, &field_name, &requirement);
    if (index < 0) { /* of the flank itself, which is that of a pair */
        message_error(conf->messages, "%s: [modifications]: cannot be used with these gears",
                      conf->path);
        return EXIT_BAD_INPUT;
    }
    const int kind = design->list[index].kind;
    const key_place range = source_of(conf, gear, side, kind, MODIFICATION_LENGTH);
    const int field = field_of(&range, field_name);
    const key_place at = source_of(conf, gear, side, kind, field);
    key_name(name, &at, field);
    describe_limit(limit, sizeof limit, field, requirement, design->gear);
    config_complain(conf, name, "must be %s (got %.80s)", limit, config_text(conf, name));
    return EXIT_BAD_INPUT;
}

static int make_side(gear_design *design, const config *conf, const gm_pair *pair,
                     enum gm_role gear, int side) {
    gm_modifications *of = &design->of[side];

    of->list = design->list[side];
    of->gear = gear == GM_PINION ? &pair->pinion : &pair->wheel;
    of->face_width = of->gear->face_width;
    for (int kind = 0; kind < GM_MODIFICATION_KINDS; ++kind) {
        if (amount_of(conf, gear, side, kind) != 0) {
            design->list[side][of->count++] = modification_of(conf, gear, side, kind);
        }
    }
    if (gm_modifications_check(of, NULL, NULL, NULL) == GM_OK) {
        return 0;
    }
    return refuse(conf, gear, side, of);
}

int gear_design_make(gear_design *design, const config *conf, const gm_pair *pair,
                     enum gm_role gear) {
    memset(design, 0, sizeof *design);

    const int status = make_side(design, conf, pair, gear, GM_DRIVE);
    return status != 0 ? status : make_side(design, conf, pair, gear, GM_COAST);
}
