#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Convert the cases of elastic teeth from JSON to the line-oriented text that test_elastic.c reads.

    convert_elastic.py elastic.json > elastic.txt

Every number is written with the fewest digits that give the same double back. The layout is described in the head of
the output.
"""
import json
import re
import sys

HEAD = """\
# Reference cases of elastic teeth: inputs and results.
# Source: an independent implementation of the model (section, hertz, strip, mesh: tolerances of the numbers), and finite
# elements in plane strain and in three dimensions (te2d, te3d, khb: tolerances are model errors that were seen, with margin).
# libgearmesh/docs/elastic.md describes the model. Made by convert_elastic.py from the JSON form; do not edit.
#
# SI units, rad. o: rho_p of line 0 at z = 0, line i at o + i p_bt, drive flanks. w > 0: material added. One record per line:
#   gear NAME m_n alpha_n beta d b z_p z_w x_p x_w r_a_p r_a_w h_fP rho_fP E nu stations     what the next records refer to
#   section tol z_n r_bn psi_n foot_half_chord foot_y N      tooth of the pinion; then N lines
#   load rho alpha' y_p t c_tooth c_foundation
#   hertz tol B L gamma q dq U
#   strip tol N, then lines tooth_diagonal, tooth_beside, rim_diagonal, rim_beside (times r^2), end_load (solution for a unit
#   load at node 0)
#   mesh ID CASE tol o x misalignment C r1 re F dF/dx U U_o tol_U_o dF/do(nan = not given) q_max N_LINES N_Z
#       w = misalignment z / b - C max(0, (rho_p - r1) / (re - r1))
#   z values                                                   N_Z
#   line INDEX force q values                                  N_LINES lines, q over z
#   te2d NAME alpha_n z_p m_p x_p r_a_p z_w m_w x_w r_a_w T p_b rho_start F/b tol_point tol_pp N, then N lines: xi te
#       spur gears with real numbers of teeth; body removed
#   te3d F misalignment tol_te tol_te_after_offset tol_q_rms tol_q_max N, then N blocks; w = -misalignment (z / b - 1/2)
#   row o te N, then N lines: INDEX z q weight
#   khb F/b misalignment K_Hbeta tol                           one pair of the gear, at the pitch point
"""

GEAR = ["normal_module", "normal_pressure_angle", "helix_angle", "center_distance", "face_width"]


def number(value):
    return "nan" if value is None else repr(float(value))


class Writer:
    """Lines of the output; a gear once, in front of what refers to it."""

    def __init__(self, out):
        self.out = out
        self.gear = None

    def line(self, key, *values):
        self.out.write(" ".join([key, *(v if isinstance(v, str) else number(v) for v in values)]) + "\n")

    def begin_gear(self, name, data):
        known = set(GEAR) | {"pinion", "wheel", "hfP", "rho_fP", "E", "nu", "chi_per_gear", "nodes"}
        if set(data) != known or data["chi_per_gear"] != 0.37:
            raise SystemExit(f"{name}: unexpected quantities {set(data) ^ known}")
        p, w = data["pinion"], data["wheel"]
        values = [*(data[k] for k in GEAR), p["z"], w["z"], p["x"], w["x"], p["tip_radius"], w["tip_radius"],
                  data["hfP"], data["rho_fP"], data["E"], data["nu"]]
        if self.gear != (name, values, data["nodes"]):
            self.gear = name, values, data["nodes"]
            self.line("gear", name, *values, str(data["nodes"]))


def write_section(writer, case):
    if case["gear"] != "pinion":
        raise SystemExit("a section of the wheel")
    writer.begin_gear(case["name"], case["data"])
    writer.line("section", *(case[k] for k in ("tol_rel", "z_n", "r_bn", "psi_n", "foot_half_chord", "foot_y")),
                str(len(case["points"])))
    for point in case["points"]:
        writer.line("load", *(point[k] for k in ("rho", "alpha", "y_p", "t", "c_tooth", "c_foundation")))


def write_strip(writer, case):
    writer.begin_gear(case["name"], case["data"])
    writer.line("strip", case["tol_rel"], str(case["data"]["nodes"]))
    for key, name in (("A_diag", "tooth_diagonal"), ("A_off", "tooth_beside"), ("rim_diag", "rim_diagonal"),
                      ("rim_off", "rim_beside"), ("phi_end", "end_load")):
        writer.line(name, *case[key])


def deviation(options):
    """misalignment, C, r1, re of w = misalignment z / b - C max(0, (rho_p - r1) / (re - r1))."""
    misalignment = 0.0
    if "misalignment_w" in options:
        misalignment = float(re.fullmatch(r"w = (\S+) z/b", options["misalignment_w"])[1])
    return [misalignment, *(options.get(k, d) for k, d in (("C", 0.0), ("r1", 0.0), ("re", 1.0)))]


def write_mesh(writer, case):
    writer.begin_gear(case["name"], case["data"])
    indices = sorted(case["pair_force"], key=int)
    writer.line("mesh", str(case["id"]), case["case"], case["tol_rel"], case["o"], case["approach"],
                *deviation(case["options"]), case["force"], case["dF_dx"], case["energy"], case["dU_do"],
                case["dU_do_tol_abs"], case["dF_do"], case["q_max_gauss"], str(len(indices)), str(len(case["z"])))
    writer.line("z", *case["z"])
    for index in indices:
        writer.line("line", index, case["pair_force"][index], *case["q"][index])


def write_te2d(writer, case):
    gears = [case[g][k] for g in ("pinion", "wheel") for k in ("z_n", "normal_module", "x", "tip_radius")]
    writer.line("te2d", re.sub(r"[^A-Za-z0-9]+", "_", case["name"]), case["normal_pressure_angle"], *gears,
                *(case[k] for k in ("line_of_action", "base_pitch", "rho_start", "force_per_width",
                                    "tol_rel_point", "tol_rel_pp")), str(len(case["xi"])))
    for row in zip(case["xi"], case["te"]):
        writer.line("point", *row)


def write_te3d(writer, case):
    writer.begin_gear(case["name"], case["data"])
    writer.line("te3d", *(case[k] for k in ("force", "misalignment", "tol_rel_te", "tol_abs_te_after_offset",
                                            "tol_q_rms_rel", "tol_q_max_rel")), str(len(case["rows"])))
    for row in case["rows"]:
        writer.line("row", row["o"], row["te"], str(len(row["z"])))
        for index, *values in zip(row["pairs"], row["z"], row["q"], row["weight"]):
            writer.line("load", str(index), *values)


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        data = json.load(file)
    writer = Writer(sys.stdout)
    sys.stdout.write(HEAD)
    for case in data["section"]:
        write_section(writer, case)
    for case in data["hertz"]:
        writer.line("hertz", *(case[k] for k in ("tol_rel", "B", "L", "gamma", "q", "dq", "U")))
    for case in data["strip"]:
        write_strip(writer, case)
    for case in data["mesh"]:
        write_mesh(writer, case)
    for case in data["truth_khb"]:
        gear = next(c["data"] for c in data["mesh"] if c["name"] == case["name"])
        writer.begin_gear(case["name"], gear)
        writer.line("khb", *(case[k] for k in ("force_per_width", "misalignment", "K_Hbeta_fe", "tol_rel")))
    for case in data["truth_2d"]:
        write_te2d(writer, case)
    for case in data["truth_3d"]:
        write_te3d(writer, case)


if __name__ == "__main__":
    main()
