/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* The oscillator by Boost.Odeint: Runge-Kutta-Fehlberg 7(8), with control of the step. */
#include "oscillator.h"

#include <array>
#include <boost/numeric/odeint.hpp>
#include <stdexcept>

using state_type = std::array<double, 2>;
namespace odeint = boost::numeric::odeint;

int main() {
    const gm_mesh *mesh = oscillator_mesh();
    if (mesh == nullptr) {
        return 1;
    }

    /* Odeint has no sign for a step that is too long: whatever is refused ends the run. */
    const auto motion = [mesh](const state_type &state, state_type &derivative, double time) {
        const int status = oscillator_motion(mesh, time, state.data(), derivative.data());
        if (status != GM_OK) {
            throw std::runtime_error(gm_status_text(status));
        }
    };
    state_type state = {start[0], start[1]};
    try {
        odeint::integrate_adaptive(
            odeint::make_controlled<odeint::runge_kutta_fehlberg78<state_type>>(1e-16, 1e-11),
            motion, state, 0.0, end_time, 1e-7);
    } catch (const std::runtime_error &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    oscillator_print(state.data());
    return 0;
}
