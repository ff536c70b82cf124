# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
Two gears in MuJoCo: bodies on hinges, the wheel's shaft free to tilt on springs if wanted. The mesh acts as a passive
force, from position, rotation and velocity of both bodies.
"""
import mujoco
import numpy as np

import gearmesh

PAIR = gearmesh.Pair(pinion_teeth=45, wheel_teeth=41, normal_module=1.65e-3, normal_pressure_angle=np.radians(16),
                     helix_angle=np.radians(33), center_distance=0.085, face_width=0.0175, backlash=100e-6)
MESH = gearmesh.Mesh(PAIR, stiffness=1.05e8, damping=844.361)
SPEED, DRIVE, LOAD = 1000 * np.pi / 30, 25.0, 20.0  # of the pinion at the start (rad/s), torques (N m)

# Bodies are at the middles of their faces; tilts are joints in front of that of the shaft.
MODEL = """
<mujoco>
  <option timestep="2e-6" integrator="RK4" gravity="0 0 0"/>
  <worldbody>
    <body name="pinion" pos="0 0 {middle}">
      <joint name="pinion" axis="0 0 1"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1.1e-3 1.1e-3 2.1e-3"/>
    </body>
    <body name="wheel" pos="{distance} 0 {middle}">
      {tilts}
      <joint name="wheel" axis="0 0 1"/>
      <inertial pos="0 0 0" mass="1" diaginertia="1.1e-3 1.1e-3 2.1e-3"/>
    </body>
  </worldbody>
</mujoco>"""
TILT = '<joint name="tilt_{axis}" axis="{direction}" stiffness="{stiffness}" damping="{damping}"/>'


def body(model, data, name):
    """Where MuJoCo has it, as gearmesh wants it."""
    number, velocity = model.body(name).id, np.zeros(6)
    mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, number, velocity, 0)
    return {"position": data.xpos[number], "rotation": data.xmat[number].reshape(3, 3),
            "velocity": velocity[3:], "angular_velocity": velocity[:3]}


def gear_mesh(model, data):
    """The passive force."""
    found = MESH.evaluate_bodies(body(model, data, "pinion"), body(model, data, "wheel"))
    for name, force, moment in (("pinion", found.pinion_force, found.pinion_moment),
                                ("wheel", found.wheel_force, found.wheel_moment)):
        number = model.body(name).id
        mujoco.mj_applyFT(model, data, force, moment, data.xpos[number], number, data.qfrc_passive)


def simulate(duration, tilt_stiffness=None, tilt_damping=0.0):
    """Columns by name, one row for each step; tilt_stiffness in N m/rad, None: the shaft is fixed."""
    tilts = "" if tilt_stiffness is None else "\n".join(
        TILT.format(axis=axis, direction=direction, stiffness=tilt_stiffness, damping=tilt_damping)
        for axis, direction in (("x", "1 0 0"), ("y", "0 1 0")))
    model = mujoco.MjModel.from_xml_string(
        MODEL.format(distance=PAIR.center_distance, middle=PAIR.face_width / 2, tilts=tilts))
    data = mujoco.MjData(model)
    joints = {name: model.joint(name) for name in ("pinion", "wheel")}
    pinion, wheel = (joints[name].qposadr[0] for name in joints)
    pinion_dof, wheel_dof = (joints[name].dofadr[0] for name in joints)

    # At rest against each other under the torques; the wheel's angles count clockwise. Both accelerate together.
    r_bp, r_bw = PAIR.pinion.base_radius, PAIR.wheel.base_radius
    torque = r_bw * (DRIVE * r_bp + LOAD * r_bw) / (r_bp**2 + r_bw**2)
    data.qpos[wheel] = MESH.static(0.0, torque).offset / r_bw
    data.qvel[pinion_dof], data.qvel[wheel_dof] = SPEED, -SPEED * r_bp / r_bw
    data.qfrc_applied[pinion_dof], data.qfrc_applied[wheel_dof] = DRIVE, LOAD

    mujoco.set_mjcb_passive(gear_mesh)
    rows = []
    try:
        for _ in range(round(duration / model.opt.timestep)):
            rows.append([data.time, r_bp * data.qpos[pinion] + r_bw * data.qpos[wheel],
                         *(data.joint(f"tilt_{axis}").qpos[0] if tilts else 0.0 for axis in "xy")])
            mujoco.mj_step(model, data)
    finally:
        mujoco.set_mjcb_passive(None)
    return dict(zip(("time", "offset", "tilt_x", "tilt_y"), np.array(rows).T))


if __name__ == "__main__":
    fixed, tilting = simulate(2e-3), simulate(2e-3, tilt_stiffness=2e4, tilt_damping=1.0)
    for title, run in (("fixed", fixed), ("tilting", tilting)):
        print(f"{title} shaft: transmission error {-1e6 * run['offset'].mean():.2f} um on average, "
              f"tilts {1e6 * run['tilt_x'].mean():.1f} and {1e6 * run['tilt_y'].mean():.1f} urad")
