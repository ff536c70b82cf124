/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * Where the lines of contact of elastic teeth and their points are. Each line is cut at the stations, at the ends of the
 * path, and where linear reliefs begin, as a load with a kink is no polynomial; every part has two Gauss points. At each
 * point the compliance of both teeth and the rate of the contact law come from the tables of the law.
 */
#include "elastic.h"
#include "hertz.h"
#include "internal.h"
#include "wide.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#define LEAST_FACTOR 1e-300
#define JUST_WITHIN  1e-10 /* part of the path: the tables begin there */

/* Gauss points of a part, as shares of it: (1 -+ 1/sqrt(3)) / 2. */
static const double gauss[2] = {0.21132486540518711775, 0.78867513459481288225};

/* ---------------------------------------------------------------------------------------------
 * Lines
 * ------------------------------------------------------------------------------------------- */

/* Part of the face on which one line lies within the path. */
typedef struct span {
    double from, to;
    int limited[2];
} span;

static span find_span(const gmi_elastic *law, const gmi_elastic_lines_at *at, double roll) {
    span part = {0.0, law->face_width, {0, 0}};

    /* A line of spur gears is within the path as a whole, or not at all. */
    if (at->climb == 0.0) {
        if (!(roll >= at->lower - at->below && roll <= at->upper + at->above)) {
            part.to = 0.0;
        }
        return part;
    }

    /* Where the line passes the ends of the path, and what edges carry it on by. */
    const double per_climb = 1.0 / at->climb;
    const double lower = (at->lower - at->below - roll) * per_climb;
    const double upper = (at->upper + at->above - roll) * per_climb;
    const int climbs = at->climb > 0.0;
    const double from = climbs ? lower : upper;
    const double to = climbs ? upper : lower;

    /* Within the face it ends there: at which end of the path, unless it goes on. */
    if (from > part.from) {
        part.from = from;
        part.limited[0] = at->goes_on ? 0 : climbs ? -1 : 1;
    }
    if (to < part.to) {
        part.to = to;
        part.limited[1] = at->goes_on ? 0 : climbs ? 1 : -1;
    }
    return part;
}

/* Element that holds z > 0; the one before where z is a station. */
static int last_element(double z, const gmi_elastic *law) {
    int element = (int)(z * law->per_spacing);
    if ((double)element * law->spacing >= z && element > 0) {
        --element;
    }
    return element < law->stations - 2 ? element : law->stations - 2;
}

static int first_element(double z, const gmi_elastic *law) {
    const int element = (int)(z * law->per_spacing);
    return element < law->stations - 2 ? element : law->stations - 2;
}

/* Weight and places of one part that is shorter than its element, which begins at `begin`. */
static inline void shorten_slot(const gmi_elastic *law, gmi_elastic_work *work, int slot,
                                double begin, double from, double length) {
    for (int half = 0; half < 2; ++half) {
        const int p = slot + half * work->slots;
        work->weight[p] = 0.5 * length;
        work->place[p] = (from - begin + gauss[half] * length) * law->per_spacing;
    }
}

/* That which an end of a line shortens, or both. */
static void cut_slot(const gmi_elastic *law, gmi_elastic_work *work, int slot, int element,
                     const span *part) {
    const double begin = (double)element * law->spacing;
    const double from = fmax(part->from, begin);
    const double to = fmin(part->to, begin + law->spacing);
    shorten_slot(law, work, slot, begin, from, fmax(to - from, 0.0));
}

/* Those on both sides of the cuts, each up to the next cut, station or end of the line. */
static void part_slots(const gmi_elastic *law, gmi_elastic_work *work, const span *parts) {
    double from = 0.0;
    int is_first = 1;
    for (int k = 0; k < work->cuts; ++k) {
        const gmi_elastic_cut *cut = &work->cut[k];
        const span *part = &parts[cut->row];
        const double begin = (double)cut->element * law->spacing;

        /* Before the cut: from the one before, or from where element or line begin. */
        if (is_first) {
            from = part->limited[0] != 0 && part->from > begin ? part->from : begin;
        }
        shorten_slot(law, work, cut->before, begin, from, cut->z - from);

        /* Behind the last one of an element: up to where element or line end. */
        if (cut->is_last) {
            const double end = begin + law->spacing;
            const double to = part->limited[1] != 0 && part->to < end ? part->to : end;
            shorten_slot(law, work, cut->after, begin, cut->z, to - cut->z);
        }
        is_first = cut->is_last;
        from = cut->z;
    }
}

static void place_slots(const gmi_elastic *law, gmi_elastic_work *work, const span *parts) {
    /* Whole elements have two points each. */
    for (int half = 0; half < 2; ++half) {
        double *restrict weight = work->weight + half * work->slots;
        double *restrict place = work->place + half * work->slots;
        for (int s = 0; s < work->slots; ++s) {
            weight[s] = 0.5 * law->spacing;
            place[s] = gauss[half];
        }
    }

    /* The first and the last one of a line may be cut, and others where lines go on beyond the path. */
    for (int row = 0; row < work->count && !work->at.goes_on; ++row) {
        const gmi_elastic_line *line = &work->line[row];
        const int last = line->elements - 1;
        if (line->limited[0] != 0) {
            cut_slot(law, work, line->slot, line->element, &parts[row]);
        }
        if (line->limited[1] != 0) {
            cut_slot(law, work, line->slot + last, line->element + last, &parts[row]);
        }
    }
    part_slots(law, work, parts);
}

/* ---------------------------------------------------------------------------------------------
 * Teeth
 * ------------------------------------------------------------------------------------------- */

/* Cells of the points, and places 0 .. 1 within them; the cell that holds the value of the begin first. */
APART void find_cells(int count, double first, double per_cell, double last,
                      const double *restrict roll, double *restrict cell, double *restrict place) {
    for (int p = 0; p < count; ++p) {
        const double u = first + roll[p] * per_cell;
        const double number = gmi_cell_of(u, last);
        cell[p] = number;
        place[p] = u - number;
    }
}

/* Both columns of a table, and their slopes by the place, at one point after the other: arrays [count][2]. */
APART void read_cells(const gmi_elastic_cell *restrict cells, int count,
                      const double *restrict cell, const double *restrict place,
                      double *restrict values, double *restrict slopes) {
    for (int p = 0; p < count; ++p) {
        const double t = place[p];
        const double *restrict c = &cells[(int)cell[p]].value[0][0];
        for (int k = 0; k < 2; ++k) {
            const double third = c[6 + k];
            const double second = c[4 + k] + t * third;
            const double first = c[2 + k] + t * second;
            values[2 * p + k] = c[k] + t * first;
            slopes[2 * p + k] = first + t * (second + t * third);
        }
    }
}

static void read_table(const gmi_elastic_gear *gear, int count, const double *roll, double *cell,
                       double *place, double *values, double *slopes) {
    const double first = 1.0 - gear->start * gear->per_cell;
    find_cells(count, first, gear->per_cell, gear->last, roll, cell, place);
    read_cells(gear->cell, count, cell, place, values, slopes);
}

/* Where a point is in a table, and what is found there. */
typedef struct pair_table {
    double first, per_cell, last;
    const gmi_elastic_cell *cells;
} pair_table;

typedef struct pair_columns {
    double *tooth, *rate, *tooth_by_roll, *rate_by_roll;
} pair_columns;

/* Of both whole teeth: s, 1 / (B e^L) and their slopes, that of the rate logarithmic. */
static void read_point(const pair_table *table, const double *roll, int p, const pair_columns *to) {
    const double u = table->first + roll[p] * table->per_cell;
    const double number = gmi_cell_of(u, table->last), t = u - number;
    const double(*c)[2] = table->cells[(int)number].value;

    /* s ... */
    const double second = c[2][0] + t * c[3][0], slope = c[1][0] + t * second;
    to->tooth[p] = c[0][0] + t * slope;
    to->tooth_by_roll[p] = (slope + t * (second + t * c[3][0])) * table->per_cell;

    /* ... and the rate; at rho = 0 it is 0. */
    const double rate_second = c[2][1] + t * c[3][1], rate_slope = c[1][1] + t * rate_second;
    const double rate = c[0][1] + t * rate_slope;
    const double rise = (rate_slope + t * (rate_second + t * c[3][1])) * table->per_cell;
    to->rate[p] = rate;
    to->rate_by_roll[p] = rise / (rate + LEAST_FACTOR);
}

#ifdef GMI_IN_WIDE
/* value + t slope, slope = first + t second, second = square + t cube; the slope along the table. */
static inline __m256d cubic(__m256d t, __m256d value, __m256d first, __m256d square, __m256d cube,
                            __m256d per_cell, __m256d *rise) {
    const __m256d second = _mm256_add_pd(square, _mm256_mul_pd(t, cube));
    const __m256d slope = _mm256_add_pd(first, _mm256_mul_pd(t, second));
    const __m256d twice = _mm256_add_pd(second, _mm256_mul_pd(t, cube));
    *rise = _mm256_mul_pd(_mm256_add_pd(slope, _mm256_mul_pd(t, twice)), per_cell);
    return _mm256_add_pd(value, _mm256_mul_pd(t, slope));
}

/* Four points from p on: the same operations. */
static inline void read_four(const pair_table *table, const double *roll, int p,
                             const pair_columns *to) {
    const __m256d per_cell = _mm256_set1_pd(table->per_cell);
    const __m256d u = _mm256_add_pd(_mm256_set1_pd(table->first),
                                    _mm256_mul_pd(_mm256_loadu_pd(roll + p), per_cell));

    GMI_CELLS_OF_FOUR(u, table->last, number);
    const __m256d t = _mm256_sub_pd(u, number);
    GMI_PLACES_OF_FOUR(number, (double)(sizeof(gmi_elastic_cell) / sizeof(double)), place);
    const double *row[4];
    for (int k = 0; k < 4; ++k) {
        row[k] = &table->cells[0].value[0][0] + place[k];
    }
    GMI_TWO_OF_FOUR(row, 0, tooth, rate);
    GMI_TWO_OF_FOUR(row, 2, tooth_first, rate_first);
    GMI_TWO_OF_FOUR(row, 4, tooth_square, rate_square);
    GMI_TWO_OF_FOUR(row, 6, tooth_cube, rate_cube);
    __m256d rise;
    _mm256_storeu_pd(to->tooth + p,
                     cubic(t, tooth, tooth_first, tooth_square, tooth_cube, per_cell, &rise));
    _mm256_storeu_pd(to->tooth_by_roll + p, rise);
    const __m256d found = cubic(t, rate, rate_first, rate_square, rate_cube, per_cell, &rise);
    _mm256_storeu_pd(to->rate + p, found);
    _mm256_storeu_pd(to->rate_by_roll + p,
                     _mm256_div_pd(rise, _mm256_add_pd(found, _mm256_set1_pd(LEAST_FACTOR))));
}
#endif

static void read_pair(const gmi_elastic_gear *pair, const gmi_elastic_work *work) {
    const pair_table table = {1.0 - pair->start * pair->per_cell, pair->per_cell, pair->last,
                              pair->cell};
    const pair_columns to = {work->tooth, work->rate, work->tooth_by_roll, work->rate_by_roll};
    const int count = 2 * work->slots;
    int p = 0;
#ifdef GMI_IN_WIDE
    for (; p + 4 <= count; p += 4) {
        read_four(&table, work->roll, p, &to);
    }
#endif
    for (; p < count; ++p) {
        read_point(&table, work->roll, p, &to);
    }
}

/* Where the points of one half of a line are. */
APART void place_points(int count, double first, double spacing, double origin, double climb,
                        double action, const double *restrict place, double *restrict z,
                        double *restrict roll, double *restrict wheel_roll) {
    for (int k = 0; k < count; ++k) {
        const double at = ((double)k + first + place[k]) * spacing;
        const double rho = origin + climb * at;
        z[k] = at;
        roll[k] = rho;
        wheel_roll[k] = action - rho;
    }
}

/* Points beyond the path are read at its end, just within. */
APART void keep_within(int count, double lower, double upper, double action, double *restrict roll,
                       double *restrict wheel_roll, double *restrict beyond) {
    for (int p = 0; p < count; ++p) {
        const double rho = roll[p];
        const double above = rho > lower ? rho : lower;
        const double within = above < upper ? above : upper;
        roll[p] = within;
        wheel_roll[p] = action - within;
        beyond[p] = rho - within;
    }
}

/* Lists of points, while they are filled. */
typedef struct outer_lists {
    const double *beyond;
    int *next[2];
} outer_lists;

/* Adds a point to those beyond the path if it is one. */
static inline int is_outer(outer_lists *lists, int p) {
    if (lists->beyond[p] == 0.0) {
        return 0;
    }
    *lists->next[lists->beyond[p] > 0.0]++ = p;
    return 1;
}

/* They are at both ends of each line, and behind the cuts. */
static void list_outer(gmi_elastic_work *work) {
    outer_lists lists = {work->beyond, {work->outer[0], work->outer[1]}};
    for (int k = 0; k < 2 * work->count; ++k) {
        const gmi_elastic_line *line = &work->line[k / 2];
        const int begin = line->slot + k % 2 * work->slots;
        const int cut = begin + line->elements, end = begin + line->slots;

        /* Inwards from both ends, until one lies on the path. */
        int first = begin, last = cut - 1;
        while (first < cut && is_outer(&lists, first)) {
            ++first;
        }
        while (last > first && is_outer(&lists, last)) {
            --last;
        }

        for (int p = cut; p < end; ++p) {
            (void)is_outer(&lists, p);
        }
    }
    work->outer_count[0] = (int)(lists.next[0] - work->outer[0]);
    work->outer_count[1] = (int)(lists.next[1] - work->outer[1]);
}

/* Their teeth: on from the end as the slope there says, for a while. */
static void hold_teeth(gmi_elastic_work *work) {
    for (int which = 0; which < 2; ++which) {
        for (int k = 0; k < work->outer_count[which]; ++k) {
            const int p = work->outer[which][k];
            const gmi_elastic_hold hold = gmi_elastic_hold_at(&work->at, work->beyond[p]);
            const double growth = 1.0 + hold.moved * work->rate_by_roll[p];
            work->tooth[p] += hold.moved * work->tooth_by_roll[p];
            work->tooth_by_roll[p] *= hold.by_roll;
            work->rate[p] *= growth;
            work->rate_by_roll[p] *= hold.by_roll / growth;
        }
    }
}

/* What teeth are made of. */
typedef struct tooth_pair {
    double softness[2]; /* of pinion and wheel */
    double rim;         /* r^2 */
    double action;      /* T */
    double per_cell[2]; /* of their tables */
} tooth_pair;

/* s^2 = c_p + c_w - r^2 and 1 / (B e^L) = 4 h_p h_w / T. */
APART void join_teeth(int count, const tooth_pair *teeth, const double *restrict pinion,
                      const double *restrict wheel, double *restrict tooth, double *restrict rate) {
    const double per_action = 4.0 / teeth->action;
    for (int k = 0; k < count; ++k) {
        tooth[k] = sqrt(teeth->softness[0] * pinion[2 * k] + teeth->softness[1] * wheel[2 * k] -
                        teeth->rim);
        rate[k] = per_action * (pinion[2 * k + 1] * wheel[2 * k + 1]);
    }
}

/* Slopes along rho_p, and by the line of action. That of the rate is logarithmic: none at rho = 0. */
APART void join_slopes(int count, const tooth_pair *teeth, const double *restrict pinion,
                       const double *restrict wheel, const double *restrict pinion_slope,
                       const double *restrict wheel_slope, const double *restrict tooth,
                       double *restrict tooth_by_roll, double *restrict tooth_by_action,
                       double *restrict rate_by_roll, double *restrict rate_by_action) {
    const double per_action = 1.0 / teeth->action;
    const double pinion_rate = teeth->per_cell[0], wheel_rate = teeth->per_cell[1];
    const double pinion_half = 0.5 * teeth->softness[0] * pinion_rate;
    const double wheel_half = 0.5 * teeth->softness[1] * wheel_rate;
    for (int k = 0; k < count; ++k) {
        /* s is the root of the compliances of both teeth, less what the rim takes. */
        const double per_tooth = 1.0 / tooth[k];
        const double by_pinion = pinion_half * pinion_slope[2 * k] * per_tooth;
        const double by_wheel = wheel_half * wheel_slope[2 * k] * per_tooth;

        /* The rate is the product of both curvature factors over the line of action. */
        const double factor = pinion[2 * k + 1] * wheel[2 * k + 1] + LEAST_FACTOR;
        const double per_factor = 1.0 / factor;
        const double of_pinion =
            pinion_rate * pinion_slope[2 * k + 1] * wheel[2 * k + 1] * per_factor;
        const double of_wheel =
            wheel_rate * wheel_slope[2 * k + 1] * pinion[2 * k + 1] * per_factor;

        /* The wheel's roll length is the line of action less rho_p. */
        tooth_by_roll[k] = by_pinion - by_wheel;
        tooth_by_action[k] = by_wheel;
        rate_by_roll[k] = of_pinion - of_wheel;
        rate_by_action[k] = of_wheel - per_action;
    }
}

/* Points of all lines, and their teeth. Returns whether all have a compliance. */
static int place_teeth(const gmi_elastic *law, gmi_elastic_work *work) {
    const gmi_elastic_lines_at *at = &work->at;
    const int slots = work->slots, count = 2 * slots;
    double *wheel_roll = work->scratch, *cell = work->force, *place = work->stiffness;

    /* Where the points of all lines are, ... */
    for (int row = 0; row < work->count; ++row) {
        const gmi_elastic_line *line = &work->line[row];
        const double origin = at->origin + (double)line->index * at->pitch;
        for (int half = 0; half < 2; ++half) {
            const int p = line->slot + half * slots;
            place_points(line->elements, (double)line->element, law->spacing, origin, at->climb,
                         at->line_of_action, work->place + p, work->z + p, work->roll + p,
                         wheel_roll + p);
        }
    }

    /* ... and those behind a cut. */
    for (int k = 0; k < work->cuts; ++k) {
        const gmi_elastic_cut *cut = &work->cut[k];
        const double origin = at->origin + (double)work->line[cut->row].index * at->pitch;
        for (int half = 0; half < 2; ++half) {
            const int p = cut->after + half * slots;
            const double z = ((double)cut->element + work->place[p]) * law->spacing;
            work->z[p] = z;
            work->roll[p] = origin + at->climb * z;
            wheel_roll[p] = at->line_of_action - work->roll[p];
        }
    }

    /* Beyond the path teeth are read as at its end. */
    if (at->goes_on) {
        const double inside = JUST_WITHIN * (at->upper - at->lower);
        keep_within(count, at->lower + inside, at->upper - inside, at->line_of_action, work->roll,
                    wheel_roll, work->beyond);
    }

    /* Whole teeth as drawn: the table of the pair has both in one. Else the table of each gear. */
    if (at->pinion_softness == NULL && at->wheel_softness == NULL && at->slopes < 2 &&
        at->line_of_action == law->line_of_action) {
        read_pair(&law->pair, work);
        return 1;
    }

    read_table(&law->gear[0], count, work->roll, cell, place, work->table[0], work->table[2]);
    read_table(&law->gear[1], count, wheel_roll, cell, place, work->table[1], work->table[3]);

    /* Lines of whole teeth are the same to all that follows. */
    tooth_pair teeth = {{1.0, 1.0},
                        law->rim_compliance,
                        at->line_of_action,
                        {law->gear[0].per_cell, law->gear[1].per_cell}};
    const int whole = at->pinion_softness == NULL && at->wheel_softness == NULL;
    const int groups = whole ? 2 : 2 * work->count;
    int good = 1;
    for (int g = 0; g < groups; ++g) {
        const gmi_elastic_line *line = &work->line[g / 2];
        const int p = (whole ? 0 : line->slot) + g % 2 * slots;
        const int n = whole ? slots : line->slots;

        if (!whole) {
            const int number = line->index - at->first;
            teeth.softness[0] = at->pinion_softness != NULL ? at->pinion_softness[number] : 1.0;
            teeth.softness[1] = at->wheel_softness != NULL ? at->wheel_softness[number] : 1.0;
            good = good && teeth.softness[0] * law->least_compliance[0] +
                                   teeth.softness[1] * law->least_compliance[1] >
                               law->rim_compliance;
        }

        join_teeth(n, &teeth, work->table[0] + 2 * p, work->table[1] + 2 * p, work->tooth + p,
                   work->rate + p);
        if (at->slopes || at->goes_on) {
            join_slopes(n, &teeth, work->table[0] + 2 * p, work->table[1] + 2 * p,
                        work->table[2] + 2 * p, work->table[3] + 2 * p, work->tooth + p,
                        work->tooth_by_roll + p, work->tooth_by_action + p, work->rate_by_roll + p,
                        work->rate_by_action + p);
        }
    }
    return good;
}

/* ---------------------------------------------------------------------------------------------
 * All of it
 * ------------------------------------------------------------------------------------------- */

/* Row 0 is the line that begins first along the face: the last one if lines climb. */
static int row_step(const gmi_elastic_lines_at *at) {
    return at->climb > 0.0 ? -1 : 1;
}

/* Moves rows of an array over stations up by `shift`, and clears those that come in. */
static void shift_rows(const gmi_elastic_work *work, int shift, double *rows) {
    const size_t row = (size_t)work->stations;
    const size_t moved = (size_t)(shift > 0 ? shift : -shift) * row;
    const size_t kept = (size_t)work->lines_max * row - moved;
    memmove(shift > 0 ? rows : rows + moved, shift > 0 ? rows + moved : rows, kept * sizeof *rows);
    memset(shift > 0 ? rows + kept : rows, 0, moved * sizeof *rows);
}

/* Moves the last solutions to the rows of the teeth they belong to. */
static void follow_teeth(gmi_elastic_work *work) {
    const gmi_elastic_lines_at *at = &work->at;
    if (work->count == 0) {
        return;
    }

    /* How many rows the teeth have moved by, the short way round the gear. */
    const int direction = at->step * row_step(at);
    const int tooth = (at->tooth + at->step * (work->line[0].index - at->first)) % at->teeth;
    int shift = direction * (tooth - work->warm_tooth) % at->teeth;
    if (2 * shift > at->teeth) {
        shift -= at->teeth;
    } else if (2 * shift < -at->teeth) {
        shift += at->teeth;
    }
    work->warm_tooth = tooth;

    /* Far off, the last solution tells nothing. */
    if (shift == 0 || work->warm == 0) {
        return;
    }
    if (shift >= work->lines_max || -shift >= work->lines_max) {
        gmi_elastic_work_reset(work);
        return;
    }

    work->warm_place += (double)(row_step(at) * shift) * at->pitch;
    shift_rows(work, shift, work->state);
    shift_rows(work, shift, work->adjoint);
    shift_rows(work, shift, work->by_place);
    shift_rows(work, shift, work->place_curve);
}

/* A cut of a line at z among those before, if that is within one of its elements and not at a station. */
static void add_cut(const gmi_elastic *law, const gmi_elastic_cut *wanted, int first,
                    gmi_elastic_work *work) {
    const gmi_elastic_line *line = &work->line[wanted->row];
    const double place = wanted->z * law->per_spacing - (double)line->element;
    if (!(place > 0.0 && place < (double)line->elements)) {
        return;
    }
    const int element = line->element + (int)place;
    const double begin = (double)element * law->spacing;
    if (!(wanted->z > begin && wanted->z < begin + law->spacing) ||
        work->cuts == gmi_elastic_cuts_of(work->lines_max, work->creases_max)) {
        return;
    }

    /* In the order of z. */
    int k = work->cuts++;
    for (; k > first && work->cut[k - 1].z > wanted->z; --k) {
        work->cut[k] = work->cut[k - 1];
    }
    work->cut[k] = *wanted;
    work->cut[k].element = element;
}

/* Those at the ends of the path, of a line that goes on. */
static void cut_ends(const gmi_elastic *law, int row, int first, gmi_elastic_work *work) {
    const gmi_elastic_lines_at *at = &work->at;
    const double rolls[4] = {at->lower - at->cut[0], at->lower, at->upper, at->upper + at->cut[1]};
    const double origin = at->origin + (double)work->line[row].index * at->pitch;
    const double per_climb = 1.0 / at->climb;
    const int step = at->climb > 0.0 ? 1 : -1;
    gmi_elastic_cut cut = {.by_roll = -per_climb, .row = row};
    for (int k = 0; k < 4; ++k) {
        const int which = step > 0 ? k : 3 - k;
        cut.z = (rolls[which] - origin) * per_climb;
        cut.limit = which < 2 ? -1 : 1;
        add_cut(law, &cut, first, work);
    }
}

/* Those at creases, within the part of the line that is there: offset + per_z z + per_roll (origin + climb z) = 0. */
static void cut_creases(const gmi_elastic *law, int row, int first, const span *part,
                        gmi_elastic_work *work) {
    const gmi_elastic_lines_at *at = &work->at;
    const double origin = at->origin + (double)work->line[row].index * at->pitch;
    gmi_elastic_cut cut = {.row = row, .limit = 0};
    for (int k = 0; k < at->creases; ++k) {
        const gmi_elastic_crease *crease = &at->crease[k];
        const double along = crease->per_z + at->climb * crease->per_roll;

        /* Along a crease a line has no kink, and z is no number. */
        cut.z = -(crease->offset + crease->per_roll * origin) / along;
        cut.by_roll = -crease->per_roll / along;
        if (cut.z > part->from && cut.z < part->to) {
            add_cut(law, &cut, first, work);
        }
    }
}

/* Slots of the cuts from `first` on, those of one line: each divides what follows the last one, or a whole element. */
static void divide_line(int first, gmi_elastic_work *work) {
    for (int k = first; k < work->cuts; ++k) {
        gmi_elastic_cut *cut = &work->cut[k];
        gmi_elastic_line *line = &work->line[cut->row];
        const int number = cut->element - line->element;
        const int shares = k > first && cut[-1].element == cut->element;
        cut->whole = line->slot + number;
        cut->before = shares ? cut[-1].after : cut->whole;
        cut->after = line->slot + line->slots++;
        cut->is_last = 1;
        if (shares) {
            cut[-1].is_last = 0;
        }
        line->end = number == line->elements - 1 ? cut->after : line->end;
    }
}

/* Line k and its part of the face, if there is any. */
static void add_line(const gmi_elastic *law, gmi_elastic_work *work, int k, const span *part) {
    if (!(part->from < part->to)) {
        return;
    }

    /* The elements that it passes, a slot for each. */
    gmi_elastic_line *line = &work->line[work->count++];
    const int element = first_element(part->from, law);
    const int last = last_element(part->to, law);
    line->index = k;
    line->slot = work->slots;
    line->element = element;
    line->elements = last >= element ? last - element + 1 : 1;
    line->limited[0] = part->limited[0];
    line->limited[1] = part->limited[1];
    line->slots = line->elements;
    line->end = line->slot + line->elements - 1;

    /* Its cuts, of which each needs one slot more. */
    const int row = work->count - 1, first = work->cuts;
    if (work->at.goes_on && work->at.climb != 0.0) {
        cut_ends(law, row, first, work);
    }
    if (work->at.creases > 0) {
        cut_creases(law, row, first, part, work);
    }
    divide_line(first, work);
    work->slots += line->slots;
}

int gmi_elastic_place(const gmi_elastic *law, const gmi_elastic_lines_at *at,
                      gmi_elastic_work *work) {
    GMI_RETURN_WIDE(law, gmi_wide_place(law, at, work))
    span parts[GMI_ELASTIC_LINES_MAX + 1];
    work->at = *at;
    work->count = 0;
    work->slots = 0;
    work->cuts = 0;

    /* The lines that lie within the path somewhere, in the order of the pinion's teeth. */
    const int lines = at->last - at->first + 1;
    for (int i = 0; i < lines; ++i) {
        const int k = row_step(at) > 0 ? at->first + i : at->last - i;
        const span part = find_span(law, at, at->origin + (double)k * at->pitch);
        if (part.from < part.to && work->count == work->lines_max) {
            work->count = 0;
            return GM_STATE_OUT_OF_RANGE;
        }
        parts[work->count] = part;
        add_line(law, work, k, &part);
    }

    /* Their points, and what teeth there give way by. */
    place_slots(law, work, parts);
    const int good = place_teeth(law, work);
    if (at->goes_on) {
        list_outer(work);
        hold_teeth(work);
    }

    /* For the elimination, and where each line's last solution lies. */
    gmi_elastic_find_runs(work);
    follow_teeth(work);
    return good ? GM_OK : GM_ERR_PARAMETER;
}

/* ---------------------------------------------------------------------------------------------
 * Between the points
 * ------------------------------------------------------------------------------------------- */

/* One at a time, which is no work for vectors. */
#ifndef GMI_IN_WIDE
double gmi_elastic_load_at(const gmi_elastic *law, const gmi_elastic_work *work, int row, double z,
                           double deviation, double rate_factor, double *gamma) {
    const gmi_elastic_lines_at *at = &work->at;
    const gmi_elastic_line *line = &work->line[row];

    /* Both teeth there; beyond the path as far as they are read. */
    const double on_line = at->origin + (double)line->index * at->pitch + at->climb * z;
    const double inside = JUST_WITHIN * (at->upper - at->lower);
    const double kept = fmin(fmax(on_line, at->lower + inside), at->upper - inside);
    const double roll = at->goes_on ? kept : on_line;
    const double wheel_roll = at->line_of_action - roll;

    const int number = line->index - at->first;
    const tooth_pair teeth = {{at->pinion_softness != NULL ? at->pinion_softness[number] : 1.0,
                               at->wheel_softness != NULL ? at->wheel_softness[number] : 1.0},
                              law->rim_compliance,
                              at->line_of_action,
                              {law->gear[0].per_cell, law->gear[1].per_cell}};

    double pinion[2], wheel[2], pinion_slope[2], wheel_slope[2], tooth, rate;
    double cell, within, tooth_by_roll, rate_by_roll, by_action[2];
    read_table(&law->gear[0], 1, &roll, &cell, &within, pinion, pinion_slope);
    read_table(&law->gear[1], 1, &wheel_roll, &cell, &within, wheel, wheel_slope);
    join_teeth(1, &teeth, pinion, wheel, &tooth, &rate);

    /* Beyond the path they go on as they sloped at its end. */
    if (roll != on_line) {
        const double moved = gmi_elastic_hold_at(at, on_line - roll).moved;
        join_slopes(1, &teeth, pinion, wheel, pinion_slope, wheel_slope, &tooth, &tooth_by_roll,
                    &by_action[0], &rate_by_roll, &by_action[1]);
        tooth += moved * tooth_by_roll;
        rate *= 1.0 + moved * rate_by_roll;
    }

    /* Deflections of the element that holds z. */
    const int last = line->element + line->elements - 1;
    const int element = first_element(z, law);
    const int e = element < line->element ? line->element : element > last ? last : element;
    const double place = z * law->per_spacing - (double)e;
    const double *phi = work->state + row * work->stations + e;
    const double *psi = work->state + work->lines_max * work->stations + e;
    *gamma = work->approach + deviation - tooth * (phi[0] + place * (phi[1] - phi[0])) -
             (psi[0] + place * (psi[1] - psi[0]));
    gmi_hertz_state contact;
    gmi_hertz_evaluate(law->hertz_compliance, rate * rate_factor, *gamma, &contact);
    return contact.load;
}
#endif
