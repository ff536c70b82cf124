#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Convert reference cases of posed gears from JSON to the text that test_pose.c reads.

    convert_pose.py pose.json > pose.txt

Numbers are written so that they give the same double back.
"""
import json
import sys

HEAD = """\
# Reference cases of gears with faces of their own and of posed gears: static transmission error under load, constant
# stiffness, no deviations.
# Source: brute force with flanks as 3D involute helicoids, turned and displaced, and root search; shares no formula with
# the library. Made by convert_pose.py from the JSON form of the cases; do not edit.
#
# SI units and radians; "nan" = derive. One record per line:
#   case NAME
#   teeth Z_P Z_W
#   gear m_n alpha_n beta d backlash face face_p face_w axial_offset start_p start_w      radii of the starts
#   pose dx dy dz skew inclination
#   load K torque tolerance N                       tolerance of te; then N lines
#   point phi_p te
"""
UM, MM, DEGREE = 1e-6, 1e-3, 0.017453292519943295


def main():
    cases = json.load(open(sys.argv[1], encoding="utf-8"))["cases"]
    sys.stdout.write(HEAD)
    for case in cases:
        gears, pose = case["gears"], case["pose"]

        def length(name, unit=MM):
            return gears[name] * unit if name in gears else float("nan")

        print("case", case["name"].replace(" ", "_"))
        print("teeth", gears["pinion_teeth"], gears["wheel_teeth"])
        numbers = [length("normal_module_mm"), length("normal_pressure_angle_deg", DEGREE), gears.get("helix_angle_deg", 0.0) * DEGREE,
                   length("center_distance_mm"), length("backlash_um", UM), length("face_width_mm"), length("pinion_face_width_mm"),
                   length("wheel_face_width_mm"), gears.get("axial_offset_mm", 0.0) * MM, length("pinion_start_diameter_mm", MM / 2),
                   length("wheel_start_diameter_mm", MM / 2)]
        print("gear", *map(repr, numbers))
        print("pose", *map(repr, [pose.get("center_distance_change_um", 0.0) * UM, pose.get("offset_um", 0.0) * UM,
                                  pose.get("axial_shift_um", 0.0) * UM, pose.get("skew_mrad", 0.0) * 1e-3,
                                  pose.get("inclination_mrad", 0.0) * 1e-3]))
        points = case["pinion_angle_rad_te_um"]
        print("load", repr(case["stiffness_N_per_m"]), repr(case["mean_Nm"]), repr(case["tolerance_um"] * UM), len(points))
        for angle, te in points:
            print("point", repr(angle), repr(te * UM))


if __name__ == "__main__":
    main()
