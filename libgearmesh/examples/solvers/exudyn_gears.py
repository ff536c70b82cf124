# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
Two gears in Exudyn: rigid bodies on joints. The mesh acts as forces and torques at the middles of both faces.

    exudyn_gears.py [PICTURE.png]
"""
import exudyn as exu
import numpy as np
from exudyn.utilities import (GenericJoint, LoadForceVector, LoadTorqueVector, MarkerBodyRigid, RigidBodyInertia)
from tilting_gears import DRIVE, INERTIA, LOAD, MASS, MESH, PLACE, columns, main, offset, start

STEP = 2e-6  # of the trapezoidal rule, of second order (s)


def body_of(mbs, number):
    """Where Exudyn has it, as gearmesh wants it."""
    values = {name: mbs.GetObjectOutputBody(number, kind, [0, 0, 0], exu.ConfigurationType.Current)
              for name, kind in (("position", exu.OutputVariableType.Position),
                                 ("rotation", exu.OutputVariableType.RotationMatrix),
                                 ("velocity", exu.OutputVariableType.Velocity),
                                 ("angular_velocity", exu.OutputVariableType.AngularVelocity))}
    values["rotation"] = values["rotation"].reshape(3, 3)
    return values


def simulate(duration, tilt_stiffness=None, tilt_damping=0.0):
    """Columns by name, one row for each step; tilt_stiffness in N m/rad, None: the shaft is fixed."""
    system = exu.SystemContainer()
    mbs = system.AddSystem()
    ground = mbs.CreateGround()
    turn, *speeds = start()
    bodies = {}
    for (name, place), angle, speed in zip(PLACE.items(), (0.0, turn), speeds):
        rotation = [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
        bodies[name] = mbs.CreateRigidBody(
            referencePosition=list(place), initialRotationMatrix=np.array(rotation), initialAngularVelocity=[0, 0, speed],
            inertia=RigidBodyInertia(mass=MASS, com=[0, 0, 0], inertiaTensor=np.diag(INERTIA)))
        markers = [mbs.AddMarker(MarkerBodyRigid(bodyNumber=number, localPosition=list(at)))
                   for number, at in ((ground, place), (bodies[name], [0, 0, 0]))]
        tilts = name == "wheel" and tilt_stiffness is not None
        free = [1, 1, 1, 0, 0, 0] if tilts else [1, 1, 1, 1, 1, 0]
        mbs.AddObject(GenericJoint(markerNumbers=markers, constrainedAxes=free))

        # What the mesh does to it, the torque from outside, and the springs of its bearings.
        def force(mbs, time, load, name=name):
            return getattr(mesh(mbs), f"{name}_force")

        def moment(mbs, time, load, name=name, tilts=tilts):
            found = getattr(mesh(mbs), f"{name}_moment") + [0, 0, DRIVE if name == "pinion" else LOAD]
            return found + bearing(body_of(mbs, bodies[name])) if tilts else found

        mbs.AddLoad(LoadForceVector(markerNumber=markers[1], loadVectorUserFunction=force))
        mbs.AddLoad(LoadTorqueVector(markerNumber=markers[1], loadVectorUserFunction=moment))

    def bearing(body):
        """Acts against the tilt of the axis, not against the spin about it."""
        axis = body["rotation"][:, 2]
        rate = np.cross(body["angular_velocity"], axis)
        return np.array([tilt_stiffness * axis[1] + tilt_damping * rate[1],
                         -tilt_stiffness * axis[0] - tilt_damping * rate[0], 0])

    def mesh(mbs):
        return MESH.evaluate_bodies(*(body_of(mbs, number) for number in bodies.values()))

    rows = []

    def record(mbs, time):
        """Before a step; the time is that of its end."""
        turns, matrices = [], {name: body_of(mbs, number)["rotation"] for name, number in bodies.items()}
        for matrix in matrices.values():
            turns.append(np.arctan2(matrix[1, 0], matrix[0, 0]))
        axis = matrices["wheel"][:, 2]
        rows.append([time - STEP, offset(*turns), -axis[1], axis[0]])
        return True

    mbs.SetPreStepUserFunction(record)
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = round(duration / STEP)
    settings.timeIntegration.endTime = duration
    settings.timeIntegration.generalizedAlpha.spectralRadius = 1
    settings.timeIntegration.newton.relativeTolerance = 1e-12
    settings.timeIntegration.newton.absoluteTolerance = 1e-12
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.newton.useModifiedNewton = True
    settings.solution.file.write = False
    mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.GeneralizedAlpha)
    return columns(rows)


if __name__ == "__main__":
    main("Exudyn", simulate)
