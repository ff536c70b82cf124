#!/usr/bin/env python3
# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""Convert reference cases from JSON to the line-oriented text that test_reference.c reads.

    convert_cases.py cases.json > cases.txt

Every number is written with the fewest digits that give the same double back, "nan" for a
quantity that the case leaves to be derived. The layout is described in the head of the output.
"""
import json
import sys

HEAD = """\
# Reference cases of the gear contact model: inputs and results.
# Source: an independent high-precision reference implementation (40 digits, exact integration), itself
# confirmed by a second construction from 3D helicoid surfaces that shares no formula with it. Inputs are
# exact doubles; results were computed from them and rounded to double.
# Made by convert_cases.py from the JSON form of the cases; do not edit.
#
# Tolerances (given with the cases): {rule}
# atol_pen and atol_te are what double precision can lose in r_b * angle, case by case.
#
# SI units, rad; "nan" = derive. Conventions: libgearmesh/docs/conventions.md. One record per line:
#   case ID GROUP
#   teeth Z_P Z_W
#   gear m_n alpha_n beta d b x_p x_w s_n_p s_n_w r_a_p r_a_w r_s_p r_s_w
#   derived {derived}
#   deviation none|transverse|normal
#   pitch SIDE N values                     SIDE = p_drive p_coast w_drive w_coast
#   table SIDE N1 N2 TOOTH|all values       t1 outer, t2 inner; "all" serves teeth without an own table
#   state phi_p phi_w atol_pen
#   drive sum fraction overlap N_PAIRS      then N_PAIRS lines
#   pair i j tooth_p tooth_w t1_lo t1_hi delta_ideal integral fraction
#   coast ...                               as drive
#   net value
#   equilibrium K T atol_te N               in place of state .. net; then N lines
#   point phi_p phi_w te
#   end
"""

GEAR = ["m_n", "alpha_n", "beta", "d", "b", "x_p", "x_w", "s_n_p", "s_n_w",
        "r_a_p", "r_a_w", "r_s_p", "r_s_w"]
DERIVED = ["m_t", "alpha_t", "beta_b", "r_p", "r_w", "r_bp", "r_bw", "a_ref", "alpha_wt", "dist",
           "p_bt", "gap", "s_t_p", "s_t_w", "psi_p", "psi_w", "r_a_p", "r_a_w", "r_s_p", "r_s_w",
           "g_A", "g_E", "eps_alpha", "eps_beta", "eps_gamma"]
PAIR = ["t1_lo", "t1_hi", "delta_ideal", "integral", "fraction"]


def number(value):
    return "nan" if value is None else repr(float(value))


def line(out, key, *values):
    out.write(" ".join([key, *(v if isinstance(v, str) else number(v) for v in values)]) + "\n")


def write_deviation(out, dev):
    line(out, "deviation", dev["kind"] if dev else "none")
    if not dev:
        return
    for side, values in dev.get("pitch", {}).items():
        line(out, "pitch", side, str(len(values)), *values)
    for side, table in dev.get("tables", {}).items():
        # "all" first: an own table of a tooth replaces it.
        teeth = sorted(table["teeth"].items(), key=lambda item: (item[0] != "all", item[0]))
        for tooth, rows in teeth:
            assert len(rows) == table["n1"] and all(len(row) == table["n2"] for row in rows)
            line(out, "table", side, str(table["n1"]), str(table["n2"]), tooth,
                 *(value for row in rows for value in row))


def write_side(out, side, expect):
    line(out, side, expect["sum"], expect["fraction"], expect["overlap"], str(len(expect["pairs"])))
    for pair in expect["pairs"]:
        line(out, "pair", *(str(pair[k]) for k in ("i", "j", "tooth_p", "tooth_w")),
             *(pair[k] for k in PAIR))


def write_case(out, case):
    gear, expect = case["gear"], case["expect"]
    unknown = set(gear) - set(GEAR) - {"z_p", "z_w"}
    if unknown or set(expect["derived"]) != set(DERIVED):
        raise SystemExit(f"{case['id']}: unexpected quantities {unknown}")
    line(out, "case", case["id"], case["group"])
    line(out, "teeth", str(gear["z_p"]), str(gear["z_w"]))
    line(out, "gear", *(gear.get(k) for k in GEAR))
    line(out, "derived", *(expect["derived"][k] for k in DERIVED))
    write_deviation(out, case["dev"])
    if "te" in expect:
        line(out, "equilibrium", case["K"], case["T"], case["atol_te"], str(len(expect["te"])))
        for point in expect["te"]:
            line(out, "point", point["phi_p"], point["phi_w"], point["te"])
    else:
        line(out, "state", case["phi_p"], case["phi_w"], case["atol_pen"])
        write_side(out, "drive", expect["drive"])
        write_side(out, "coast", expect["coast"])
        line(out, "net", expect["net"])
    out.write("end\n")


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        data = json.load(file)
    if data["format"] != 1 or data["units"] != "SI, rad":
        raise SystemExit("unknown format of cases")
    out = sys.stdout
    out.write(HEAD.format(rule=data["rule"].replace(" ; ", ";\n#   "), derived=" ".join(DERIVED)))
    line(out, "rel_tol", data["rel_tol"])
    for case in data["cases"]:
        write_case(out, case)


if __name__ == "__main__":
    main()
