/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The oscillator by the GNU Scientific Library: implicit (Bulirsch-Stoer of Bader and Deuflhard) with the exact Jacobian. */
#include "oscillator.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

/* GSL takes a smaller step after any failure but this one, which ends the run. */
static int gsl_status(int status) {
    return status < 0 ? GSL_EBADFUNC : status;
}

static int motion(double time, const double *state, double *derivative, void *mesh) {
    return gsl_status(oscillator_motion(mesh, time, state, derivative));
}

static int jacobian(double time, const double *state, double *by_state, double *by_time,
                    void *mesh) {
    int status = oscillator_jacobian(mesh, time, state, by_state);

    /* At a given x, the wheel turns with the pinion: dphi_w = r_bp / r_bw dphi_p. */
    gm_mesh_result result;
    if (status == GM_OK) {
        status = oscillator_evaluate(mesh, time, state, GM_WANT_DERIVATIVES, &result);
    }
    if (status != GM_OK) {
        return gsl_status(status);
    }
    const gm_pair *pair = gm_mesh_pair(mesh);
    const gm_gradient *by = &result.wheel_torque_by;
    by_time[0] = 0.0;
    by_time[1] =
        -(by->pinion_angle * pair->wheel.base_radius + by->wheel_angle * pair->pinion.base_radius) *
        speed / inertia;
    return GSL_SUCCESS;
}

int main(void) {
    const gm_mesh *mesh = oscillator_mesh();
    if (mesh == NULL) {
        return 1;
    }

    gsl_odeiv2_system system = {motion, jacobian, 2, (void *)mesh};
    gsl_odeiv2_driver *driver =
        gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_bsimp, 1e-7, 1e-16, 1e-11);
    double time = 0.0;
    double state[2] = {start[0], start[1]};
    const int status = gsl_odeiv2_driver_apply(driver, &time, end_time, state);
    if (status == GSL_SUCCESS) {
        oscillator_print(state);
    }
    gsl_odeiv2_driver_free(driver);
    return status != GSL_SUCCESS;
}
