# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
Two gears in MuJoCo: bodies on hinges. The mesh acts as a passive force.

    mujoco_gears.py [PICTURE.png]
"""
import mujoco
import numpy as np
from tilting_gears import DRIVE, INERTIA, LOAD, MASS, MESH, PLACE, columns, main, offset, start

# Tilts are joints in front of that of the shaft.
BODY = """
    <body name="{name}" pos="{place[0]} {place[1]} {place[2]}">
      {tilts}
      <joint name="{name}" axis="0 0 1"/>
      <inertial pos="0 0 0" mass="{mass}" diaginertia="{inertia[0]} {inertia[1]} {inertia[2]}"/>
    </body>"""
MODEL = """
<mujoco>
  <option timestep="2e-6" integrator="RK4" gravity="0 0 0"/>
  <worldbody>{bodies}</worldbody>
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
    bodies = "".join(BODY.format(name=name, place=place, mass=MASS, inertia=INERTIA, tilts=tilts if name == "wheel" else "")
                     for name, place in PLACE.items())
    model = mujoco.MjModel.from_xml_string(MODEL.format(bodies=bodies))
    data = mujoco.MjData(model)
    joints = {name: model.joint(name) for name in ("pinion", "wheel")}
    pinion, wheel = (joints[name].qposadr[0] for name in joints)
    pinion_dof, wheel_dof = (joints[name].dofadr[0] for name in joints)
    data.qpos[wheel], data.qvel[pinion_dof], data.qvel[wheel_dof] = start()
    data.qfrc_applied[pinion_dof], data.qfrc_applied[wheel_dof] = DRIVE, LOAD

    mujoco.set_mjcb_passive(gear_mesh)
    rows = []
    try:
        for _ in range(round(duration / model.opt.timestep)):
            rows.append([data.time, offset(data.qpos[pinion], data.qpos[wheel]),
                         *(data.joint(f"tilt_{axis}").qpos[0] if tilts else 0.0 for axis in "xy")])
            mujoco.mj_step(model, data)
    finally:
        mujoco.set_mjcb_passive(None)
    return columns(rows)


if __name__ == "__main__":
    main("MuJoCo", simulate)
