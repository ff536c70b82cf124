# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
Two gears in Drake: bodies of a MultibodyPlant. The mesh is a system beside it, which takes the states of the bodies and
gives spatial forces.

    drake_gears.py [PICTURE.png]
"""
import numpy as np
from pydrake.common.value import Value
from pydrake.math import RigidTransform
from pydrake.multibody.math import SpatialForce, SpatialVelocity
from pydrake.multibody.plant import ExternallyAppliedSpatialForce, MultibodyPlant
from pydrake.multibody.tree import FixedOffsetFrame, RevoluteJoint, RevoluteSpring, RotationalInertia, SpatialInertia
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
from pydrake.systems.framework import DiagramBuilder, LeafSystem
from tilting_gears import DRIVE, INERTIA, LOAD, MASS, MESH, PLACE, columns, main, offset, start

STEP = 2e-6  # of a Runge-Kutta method of third order (s)


class GearMesh(LeafSystem):
    """The mesh between two bodies of a plant."""

    def __init__(self, bodies):
        super().__init__()
        self.bodies = bodies
        self.poses = self.DeclareAbstractInputPort("poses", Value([RigidTransform()]))
        self.velocities = self.DeclareAbstractInputPort("velocities", Value([SpatialVelocity()]))
        self.DeclareAbstractOutputPort("forces", lambda: Value([ExternallyAppliedSpatialForce()]), self.forces)

    def forces(self, context, output):
        poses, velocities = self.poses.Eval(context), self.velocities.Eval(context)
        found = MESH.evaluate_bodies(*(
            {"position": poses[body.index()].translation(), "rotation": poses[body.index()].rotation().matrix(),
             "velocity": velocities[body.index()].translational(),
             "angular_velocity": velocities[body.index()].rotational()} for body in self.bodies))
        applied = []
        for body, force, moment in zip(self.bodies, (found.pinion_force, found.wheel_force),
                                       (found.pinion_moment, found.wheel_moment)):
            applied.append(ExternallyAppliedSpatialForce())
            applied[-1].body_index = body.index()
            applied[-1].p_BoBq_B = np.zeros(3)
            applied[-1].F_Bq_W = SpatialForce(tau=moment, f=force)
        output.set_value(applied)


def revolute(plant, name, parent, child, axis, damping=0.0):
    return plant.AddJoint(RevoluteJoint(name, parent, child.body_frame(), axis, damping=damping))


def simulate(duration, tilt_stiffness=None, tilt_damping=0.0):
    """Columns by name, one row for each step; tilt_stiffness in N m/rad, None: the shaft is fixed."""
    builder = DiagramBuilder()
    plant = builder.AddSystem(MultibodyPlant(0.0))
    plant.mutable_gravity_field().set_gravity_vector(np.zeros(3))
    inertia = SpatialInertia.MakeFromCentralInertia(MASS, np.zeros(3), RotationalInertia(*INERTIA))
    bodies, shafts, tilts = [], [], []
    for name, place in PLACE.items():
        parent = plant.AddFrame(FixedOffsetFrame(f"{name}_place", plant.world_frame(), RigidTransform(place)))
        if name == "wheel" and tilt_stiffness is not None:
            for axis, direction in (("x", [1, 0, 0]), ("y", [0, 1, 0])):
                between = plant.AddRigidBody(f"tilted_{axis}", SpatialInertia.Zero())
                tilts.append(revolute(plant, f"tilt_{axis}", parent, between, direction, tilt_damping))
                plant.AddForceElement(RevoluteSpring(tilts[-1], 0.0, tilt_stiffness))
                parent = between.body_frame()
        bodies.append(plant.AddRigidBody(name, inertia))
        shafts.append(revolute(plant, name, parent, bodies[-1], [0, 0, 1]))
    plant.Finalize()

    mesh = builder.AddSystem(GearMesh(bodies))
    builder.Connect(plant.get_body_poses_output_port(), mesh.poses)
    builder.Connect(plant.get_body_spatial_velocities_output_port(), mesh.velocities)
    builder.Connect(mesh.get_output_port(), plant.get_applied_spatial_force_input_port())
    simulator = Simulator(builder.Build())
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())

    turn, pinion_speed, wheel_speed = start()
    torques = np.zeros(plant.num_velocities())
    for shaft, torque, speed in zip(shafts, (DRIVE, LOAD), (pinion_speed, wheel_speed)):
        torques[shaft.velocity_start()] = torque
        shaft.set_angular_rate(context, speed)
    shafts[1].set_angle(context, turn)
    plant.get_applied_generalized_force_input_port().FixValue(context, torques)

    ResetIntegratorFromFlags(simulator, "runge_kutta3", STEP)
    simulator.get_mutable_integrator().set_fixed_step_mode(True)
    simulator.Initialize()
    rows = []
    for step in range(round(duration / STEP)):
        rows.append([step * STEP, offset(*(shaft.get_angle(context) for shaft in shafts)),
                     *([tilt.get_angle(context) for tilt in tilts] or [0.0, 0.0])])
        simulator.AdvanceTo((step + 1) * STEP)
    return columns(rows)


if __name__ == "__main__":
    main("Drake", simulate)
