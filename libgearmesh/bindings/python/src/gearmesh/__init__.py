# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""
The open gear mesh element: contact of two real helical gears, evaluated by the C library libgearmesh.

    import gearmesh

    pair = gearmesh.Pair(pinion_teeth=45, wheel_teeth=41, normal_module=1.65e-3, normal_pressure_angle=0.27925268,
                         helix_angle=0.57595865, center_distance=0.085, face_width=0.0175, backlash=100e-6)
    mesh = gearmesh.Mesh(pair, stiffness=1.05e8, damping=844)
    result = mesh.evaluate(pinion_angle, wheel_angle, want="derivatives")    # numbers or arrays of any shape
    result.force, result.force_by.wheel_angle

SI units and radians everywhere; signs are those of gearmesh.h and libgearmesh/docs/conventions.md. What has no class
here is called as in C, by `gearmesh.lib` and `gearmesh.ffi` (cffi).
"""
from ._gearmesh import ffi, lib
from ._memory import Error
from ._records import Gear, MeshResult
from .double_helical import DoubleHelical, DoubleHelicalResult, DoubleHelicalStaticResult
from .flanks import Flanks, Modification
from .mesh import BodiesResult, LineLoadsResult, Mesh, StaticResult
from .pair import Pair
from .runs import Run, gearsim, read_run

__version__ = ffi.string(lib.gm_version()).decode()
__all__ = ["BodiesResult", "DoubleHelical", "DoubleHelicalResult", "DoubleHelicalStaticResult", "Error", "Flanks", "Gear",
           "LineLoadsResult", "Mesh", "MeshResult", "Modification", "Pair", "Run", "StaticResult", "ffi", "gearsim", "lib",
           "read_run"]
