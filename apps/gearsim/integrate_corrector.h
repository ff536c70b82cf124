/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/*
 * CVODE's nonlinear solver, by its own extension point. Each evaluation of the model says how stiff the flanks are that
 * touch, so that Newton's iteration has a Jacobian of its own at every place, for nothing: mostly the first evaluation
 * is the last one.
 */
#ifndef GEARSIM_INTEGRATE_CORRECTOR_H
#define GEARSIM_INTEGRATE_CORRECTOR_H

#include "integrate_package.h"

#include <sundials/sundials_nonlinearsolver.h>

/* Both must stay where they are; `scratch` is a vector of its own. NULL: out of memory. */
SUNNonlinearSolver corrector_create(const integrator *solver, N_Vector scratch);

#endif
