# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
# %% [markdown]
# # A gear pair from Python
#
# Cells as of a notebook: run the file as a whole, or cell by cell in an editor that knows `# %%`. SI units and radians
# everywhere. It needs gearmesh, numpy and scipy.

# %%
import numpy as np
from scipy.integrate import solve_ivp

import gearmesh

# %% [markdown]
# ## What the drawing says, and what follows

# %%
pair = gearmesh.Pair(pinion_teeth=45, wheel_teeth=41, normal_module=1.65e-3, normal_pressure_angle=np.radians(16),
                     helix_angle=np.radians(33), center_distance=0.085, face_width=0.0175, backlash=100e-6)
print(f"contact ratios {pair.transverse_contact_ratio:.3f} + {pair.overlap_ratio:.3f}, "
      f"base radius of the pinion {1e3 * pair.pinion.base_radius:.3f} mm")
for warning in pair.warnings:
    print("worth a look:", warning)

# %% [markdown]
# ## Flanks
#
# From files (`Flanks(pair, "pinion", "flanks.csv", "pitch.csv")`), or from arrays: here the pinion has run-out, as its
# pitch shows it, and the wheel a designed tip relief.

# %%
teeth = np.arange(pair.pinion.teeth)
run_out = 5e-6 * np.cos(2 * np.pi * teeth / pair.pinion.teeth)
pinion = gearmesh.Flanks(pair, "pinion", pitch=np.stack([run_out, -run_out], axis=1))
relief = gearmesh.Modification("tip_relief", 10e-6, profile_range=0.3, profile_range_by="share")
wheel = gearmesh.Flanks(pair, "wheel", drive=[relief], coast=[relief])

mesh = gearmesh.Mesh(pair, pinion, wheel, stiffness=1.05e8, damping=844)

# %% [markdown]
# ## Transmission error under load
#
# Over one turn of the pinion, under three torques at once: arguments broadcast.

# %%
angle = np.linspace(0, 2 * np.pi, 46 * 20)
torque = np.array([5.0, 20.0, 80.0])
te = -mesh.static(angle[:, None], torque).offset
for load, peak_to_peak in zip(torque, np.ptp(te, axis=0)):
    print(f"{load:4.0f} N m: transmission error {1e6 * peak_to_peak:.2f} um peak to peak")

# %% [markdown]
# ## Any states at once
#
# Force over the mesh coordinate at 200 places: backlash in the middle, drive flanks to the right.

# %%
offset = np.linspace(-70e-6, 70e-6, 200)
force = mesh.evaluate_offset(0.1, offset).force
print(f"force from {force.min():.0f} to {force.max():.0f} N; none at {np.sum(force == 0)} of {force.size} places")

# %% [markdown]
# ## Dynamics by scipy, with the exact Jacobian
#
# The pinion turns at a constant speed, a torque loads the wheel. With x = r_bp phi_p - r_bw phi_w as coordinate,
# I_w phi_w'' = F r_bw - M_w becomes x'' = (M_w - F r_bw) r_bw / I_w.

# %%
speed, inertia, load = 2 * np.pi * 1000 / pair.pinion.teeth, 2.1e-3, 20.0
r_bw = pair.wheel.base_radius


def motion(time, state):
    result = mesh.evaluate_offset(speed * time, *state)
    return state[1], (load - result.wheel_torque) * r_bw / inertia


def jacobian(time, state):
    by = mesh.evaluate_offset(speed * time, *state, want="derivatives").wheel_torque_by
    return np.array([[0.0, 1.0], np.array([by.wheel_angle, by.wheel_speed]) / inertia])


start = mesh.static(0.0, load).offset, 0.0
for method in ("LSODA", "Radau"):
    run = solve_ivp(motion, (0.0, 0.02), start, method, jac=jacobian, rtol=1e-6, atol=1e-12)
    forces = mesh.evaluate_offset(speed * run.t, *run.y).force
    print(f"{method}: {run.t.size} steps, {run.nfev} right-hand sides, {run.njev} Jacobians, "
          f"force {forces.min():.0f} .. {forces.max():.0f} N")
