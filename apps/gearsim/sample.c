/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */
#include "sample.h"
#include "exit_code.h"
#include "gear_contact.h"

#include <math.h>
#include <stdio.h>

int sample_points(sampling *s, int count, const double times[], integrator_point points[]) {
    const int failed =
        integrator_advance_through(s->solver, count, times, s->shows_overlap, points);
    const double time = integrator_time(s->solver);

    if (failed == EXIT_INTERRUPTED) {
        snprintf(s->why, sizeof s->why, "interrupted at t = %.9g s", time);
    } else if (failed) {
        snprintf(s->why, sizeof s->why, "%s", integrator_failure(s->solver));
    }
    return failed;
}

int sample_motion(sampling *s, double time, gear_motion *motion) {
    integrator_point point;
    const int failed = sample_points(s, 1, &time, &point);

    if (!failed) {
        *motion = model_motion(s->model, time, point.state);
    }
    return failed;
}

static int look_at_status(sampling *s, int status) {
    if (status == GM_OK) {
        return 0;
    }
    snprintf(s->why, sizeof s->why, "no contact force at t = %.9g s; the gears: %s", s->sample.time,
             gm_status_text(status));
    return EXIT_RUN_FAILED;
}

int sample_mesh(sampling *s, enum column_need need) {
    dynamic_sample *sample = &s->sample;
    const int wanted = (need >= NEEDS_WRENCH ? GM_WANT_WRENCH : GM_WANT_FORCE) |
                       (need >= NEEDS_ENERGY ? GM_WANT_ENERGY : GM_WANT_FORCE);
    const int status = model_evaluate(s->model, &sample->motion, wanted, &sample->mesh);
    sample->apex = gear_contact_apex(s->model->gears);
    if (look_at_status(s, status) != 0) {
        return EXIT_RUN_FAILED;
    }

    /* Pairs are counted anyway, but by a cache. */
    if (s->model->cache == NULL) {
        sample->pairs = sample->mesh.contact.drive_pairs + sample->mesh.contact.coast_pairs;
    }
    if (s->conf->law == LAW_ELASTIC && fabs(sample->mesh.force) > s->hardest_force) {
        s->hardest = sample->motion;
        s->hardest_force = fabs(sample->mesh.force);
    }
    return 0;
}

int sample_row(sampling *s) {
    const int is_seen = s->row_need >= NEEDS_FORCE;
    const int failed = is_seen ? sample_mesh(s, s->row_need) : 0;

    if (failed || !s->counts_pairs || (is_seen && s->model->cache == NULL)) {
        return failed;
    }
    return look_at_status(s, model_count_pairs(s->model, &s->sample.motion, &s->sample.pairs));
}
