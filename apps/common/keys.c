/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

#include "keys.h"
#include "key_macros.h"

#include <math.h>

/* ---------------------------------------------------------------------------------------------
 * The table
 * ------------------------------------------------------------------------------------------- */

/* A field of config, and of gm_pair_params by its name there. */
#define INTO(member)     .target = offsetof(config, member)
#define INTO_GEARS(name) .target = offsetof(config, gears.name), .field = #name

/* Far beyond all machines: a slip of the pen is told, and nothing that follows overflows. Lengths as for
 * gm_pair_params_check(). */
#define LENGTH    BETWEEN(1e-3, 1e12)
#define DIAMETER  BETWEEN(2e-3, 2e12)
#define STIFFNESS BETWEEN(1e-3, 1e15)
#define INERTIA   BETWEEN(1e-15, 1e12)
#define DURATION  BETWEEN(1e-9, 1e9)

#include "modification_rows.h"

/* clang-format off */
static const key_spec keys[] = {
    {NAME("gears", "pinion_teeth"), COUNT(3, 100000), INTO_GEARS(pinion_teeth),
     .required = FOR_ALL, .example = "45", .help = "number of teeth"},
    {NAME("gears", "wheel_teeth"), SIGNED_COUNT(3, 100000), INTO_GEARS(wheel_teeth),
     .required = FOR_ALL, .example = "41", .help = "number of teeth, < 0: internal, a ring around the pinion"},
    {NAME("gears", "normal_module_mm"), NUMBER(UNIT_MM, LENGTH), INTO_GEARS(normal_module),
     .required = FOR_ALL, .example = "1.65", .help = "module in the normal section"},
    {NAME("gears", "normal_pressure_angle_deg"), NUMBER(UNIT_DEG, WITHIN(0, 45)),
     INTO_GEARS(normal_pressure_angle), .required = FOR_ALL, .example = "16", .help = "pressure angle in the normal section"},
    {NAME("gears", "helix_angle_deg"), NUMBER(UNIT_DEG, WITHIN(-60, 60)), INTO_GEARS(helix_angle),
     .standard = "0", .example = "33", .help = "> 0: the pinion is right-handed"},
    {NAME("gears", "center_distance_mm"), NUMBER(UNIT_MM, LENGTH), INTO_GEARS(center_distance),
     .required = FOR_ALL, .example = "85", .help = "distance of the axes"},
    {NAME("gears", "face_width_mm"), NUMBER(UNIT_MM, LENGTH), INTO_GEARS(face_width),
     .required = FOR_ALL, .example = "17.5", .help = "face width common to both gears; may be left out if each has its own"},
    {NAME("gears", "pinion_face_width_mm"), NUMBER(UNIT_MM, LENGTH), INTO_GEARS(pinion_face_width),
     .derived = "as face_width_mm", .help = "of the pinion alone"},
    {NAME("gears", "wheel_face_width_mm"), NUMBER(UNIT_MM, LENGTH), INTO_GEARS(wheel_face_width),
     .derived = "as face_width_mm", .help = "of the wheel alone"},
    {NAME("gears", "axial_offset_mm"), NUMBER(UNIT_MM, UP_TO(1e12)), INTO_GEARS(axial_offset),
     .standard = "0", .help = "middle of the wheel's face less that of the pinion's, along +z"},
    {NAME("gears", "double_helical_gap_mm"), NUMBER(UNIT_MM, BETWEEN(0, 1e12)), INTO(double_helical_gap),
     .derived = "one helix", .help = "two halves of opposite hand on the face width, with this between them; the pinion floats axially"},
    {NAME("gears", "pinion_profile_shift"), NUMBER(UNIT_SI, UP_TO(1000)), INTO_GEARS(pinion_profile_shift),
     .derived = "half, or rest, of the zero-backlash sum", .help = "profile shift coefficient"},
    {NAME("gears", "wheel_profile_shift"), NUMBER(UNIT_SI, UP_TO(1000)), INTO_GEARS(wheel_profile_shift),
     .derived = "half, or rest, of the zero-backlash sum", .help = "profile shift coefficient"},
    {NAME("gears", "backlash_um"), NUMBER(UNIT_UM, UP_TO(1e15)), INTO_GEARS(backlash),
     .derived = "from the tooth thicknesses",
     .example = "100", .help = "along the line of action, by thinning both teeth"},
    {NAME("gears", "pinion_rack_addendum"), NUMBER(UNIT_SI, BETWEEN(0, 10)), INTO_GEARS(pinion_rack_addendum),
     .derived = "1", .help = "h_aP of the basic rack, in modules"},
    {NAME("gears", "wheel_rack_addendum"), NUMBER(UNIT_SI, BETWEEN(0, 10)), INTO_GEARS(wheel_rack_addendum),
     .derived = "1", .help = "h_aP of the basic rack, in modules"},
    {NAME("gears", "pinion_rack_dedendum"), NUMBER(UNIT_SI, BETWEEN(0, 10)), INTO_GEARS(pinion_rack_dedendum),
     .derived = "1.25", .help = "h_fP of the basic rack, in modules: sets the root circle"},
    {NAME("gears", "wheel_rack_dedendum"), NUMBER(UNIT_SI, BETWEEN(0, 10)), INTO_GEARS(wheel_rack_dedendum),
     .derived = "1.25", .help = "h_fP of the basic rack, in modules: sets the root circle"},
    {NAME("gears", "pinion_rack_fillet_radius"), NUMBER(UNIT_SI, BETWEEN(0, 10)),
     INTO_GEARS(pinion_rack_fillet_radius), .derived = "0.38", .help = "rho_fP of the basic rack, in modules"},
    {NAME("gears", "wheel_rack_fillet_radius"), NUMBER(UNIT_SI, BETWEEN(0, 10)),
     INTO_GEARS(wheel_rack_fillet_radius), .derived = "0.38", .help = "rho_fP of the basic rack, in modules"},
    {NAME("gears", "pinion_tip_alteration"), NUMBER(UNIT_SI, UP_TO(10)), INTO_GEARS(pinion_tip_alteration),
     .derived = "min(0, (d - a) / m_n - (x_p + x_w)), a the reference center distance; d, a < 0 with a ring",
     .help = "k in modules, < 0: shorter teeth"},
    {NAME("gears", "wheel_tip_alteration"), NUMBER(UNIT_SI, UP_TO(10)), INTO_GEARS(wheel_tip_alteration),
     .derived = "min(0, (d - a) / m_n - (x_p + x_w)), a the reference center distance; d, a < 0 with a ring",
     .help = "k in modules, < 0: shorter teeth"},
    {NAME("gears", "pinion_tip_diameter_mm"), NUMBER(UNIT_MM_DIAMETER, DIAMETER),
     INTO_GEARS(pinion_tip_radius), .derived = "reference diameter + 2 m_n (h_aP + x + k)", .help = "tip circle"},
    {NAME("gears", "wheel_tip_diameter_mm"), NUMBER(UNIT_MM_DIAMETER, DIAMETER),
     INTO_GEARS(wheel_tip_radius), .derived = "reference diameter + 2 m_n (h_aP + x + k), - of a ring", .help = "tip circle"},
    {NAME("gears", "pinion_start_diameter_mm"), NUMBER(UNIT_MM_DIAMETER, DIAMETER),
     INTO_GEARS(pinion_start_radius), .derived = "the point that meets the wheel's tip",
     .help = "start of the active profile"},
    {NAME("gears", "wheel_start_diameter_mm"), NUMBER(UNIT_MM_DIAMETER, DIAMETER),
     INTO_GEARS(wheel_start_radius), .derived = "the point that meets the pinion's tip",
     .help = "start of the active profile"},
    {NAME("gears", "pinion_bore_diameter_mm"), NUMBER(UNIT_MM_DIAMETER, DIAMETER), INTO(pinion_bore_radius),
     .derived = "rigid body", .used = FOR_ELASTIC, .help = "the body winds up between bore and root circle"},
    {NAME("gears", "wheel_bore_diameter_mm"), NUMBER(UNIT_MM_DIAMETER, DIAMETER), INTO(wheel_bore_radius),
     .derived = "rigid body", .used = FOR_ELASTIC, .help = "the body winds up between bore and root circle"},
    {NAME("gears", "base_helix"), CHOICE("iso paper"), INTO_GEARS(base_helix), .standard = "iso",
     .help = "paper: as printed there in Eq. 6, which is wrong"},

    {NAME("flanks", "pinion"), .kind = KEY_PATH, INTO(pinion_flanks.deviations),
     .derived = "ideal", .used = FOR_3D, .help = "file of measured deviations"},
    {NAME("flanks", "wheel"), .kind = KEY_PATH, INTO(wheel_flanks.deviations),
     .derived = "ideal", .used = FOR_3D, .help = "file of measured deviations"},
    {NAME("flanks", "pinion_pitch"), .kind = KEY_PATH, INTO(pinion_flanks.pitch),
     .derived = "ideal", .used = FOR_3D, .help = "file of pitch deviations"},
    {NAME("flanks", "wheel_pitch"), .kind = KEY_PATH, INTO(wheel_flanks.pitch),
     .derived = "ideal", .used = FOR_3D, .help = "file of pitch deviations"},
    {NAME("flanks", "pinion_second_half"), .kind = KEY_PATH, INTO(pinion_second_flanks.deviations),
     .derived = "as pinion, mirrored", .used = FOR_3D | FOR_DOUBLE_HELICAL, .help = "the half at face II; t1 = 0 there, 1 at the gap"},
    {NAME("flanks", "wheel_second_half"), .kind = KEY_PATH, INTO(wheel_second_flanks.deviations),
     .derived = "as wheel, mirrored", .used = FOR_3D | FOR_DOUBLE_HELICAL, .help = "the half at face II; t1 = 0 there, 1 at the gap"},
    {NAME("flanks", "pinion_second_half_pitch"), .kind = KEY_PATH, INTO(pinion_second_flanks.pitch),
     .derived = "as pinion_pitch", .used = FOR_3D | FOR_DOUBLE_HELICAL, .help = "file of pitch deviations of that half"},
    {NAME("flanks", "wheel_second_half_pitch"), .kind = KEY_PATH, INTO(wheel_second_flanks.pitch),
     .derived = "as wheel_pitch", .used = FOR_3D | FOR_DOUBLE_HELICAL, .help = "file of pitch deviations of that half"},
    {NAME("flanks", "pinion_tooth_stiffness"), .kind = KEY_PATH, INTO(pinion_flanks.tooth_stiffness),
     .derived = "all teeth alike", .used = FOR_3D | FOR_ELASTIC, .help = "file tooth,factor: teeth softer by a crack or spall"},
    {NAME("flanks", "wheel_tooth_stiffness"), .kind = KEY_PATH, INTO(wheel_flanks.tooth_stiffness),
     .derived = "all teeth alike", .used = FOR_3D | FOR_ELASTIC, .help = "file tooth,factor: teeth softer by a crack or spall"},
    {NAME("flanks", "scale"), NUMBER(UNIT_SI, ANY), INTO(flank_scale), .standard = "1",
     .used = FOR_3D, .help = "multiplies deviations and pitch"},
    {NAME("flanks", "deviation_direction"), CHOICE("normal transverse"), INTO(deviation_direction),
     .standard = "normal", .used = FOR_3D, .help = "in which deviations are measured"},
    {NAME("flanks", "profile_from"), NUMBER(UNIT_SHARE, BETWEEN(0, 1)), INTO(profile_from),
     .standard = "0", .used = FOR_3D, .help = "deviations (not pitch) count from here (start 0, tip 1)"},
    {NAME("flanks", "profile_to"), NUMBER(UNIT_SHARE, BETWEEN(0, 1)), INTO(profile_to),
     .standard = "1", .used = FOR_3D, .help = "to here"},
    {NAME("flanks", "profile_blend"), NUMBER(UNIT_SI, BETWEEN(0, 1000)), INTO(profile_blend),
     .standard = "0.1", .used = FOR_3D, .help = "width of the ramps to zero outside that range"},

    {NAME("modifications", "tolerance_um"), NUMBER(UNIT_UM, BETWEEN(1e-5, 1e4)), INTO(modification_tolerance),
     .standard = "0.01", .used = FOR_3D, .help = "how far the table of a design may be off; linear reliefs have none"},
    MODIFICATION_ROWS

    {NAME("mesh", "model"), CHOICE("simple 3d"), INTO(model), .standard = "3d",
     .help = "simple: a spring with backlash"},
    {NAME("mesh", "law"), CHOICE("constant iso6336 elastic"), INTO(law),
     .derived = "constant with stiffness_N_per_m, else elastic",
     .help = "iso6336: stiffness of ISO 6336-1, method B; elastic: teeth that bend and share the load; both from the gear data"},
    {NAME("mesh", "stiffness_N_per_m"), NUMBER(UNIT_SI, STIFFNESS), INTO(stiffness), .used = FOR_CONSTANT,
     .required = FOR_RUN | FOR_CONSTANT, .example = "1.05e8", .help = "of one tooth pair in contact over the full face width"},
    {NAME("mesh", "iso_blank_factor"), NUMBER(UNIT_SHARE, BETWEEN(0.01, 2)), INTO(iso_blank_factor), .standard = "1",
     .used = FOR_ISO6336, .help = "C_R of ISO 6336-1, below 1 for thin rims and webs"},
    {NAME("mesh", "damping_Ns_per_m"), NUMBER(UNIT_SI, BETWEEN(0, 1e15)), INTO(damping),
     .derived = "0", .used = FOR_DYNAMIC, .example = "844", .help = "of one tooth pair"},
    {NAME("mesh", "damping_ratio"), NUMBER(UNIT_SHARE, BETWEEN(0, 1)), INTO(damping_ratio),
     .derived = "as damping_Ns_per_m", .used = FOR_DYNAMIC,
     .help = "in place of it: share of critical damping, of both bodies on the mean stiffness of the mesh"},
    {NAME("mesh", "simple_stiffness_N_per_m"), NUMBER(UNIT_SI, STIFFNESS), INTO(simple_stiffness),
     .derived = "stiffness_N_per_m * eps_alpha", .used = FOR_SIMPLE,
     .help = "of the simple model"},
    {NAME("mesh", "friction_coefficient"), NUMBER(UNIT_SHARE, BETWEEN(0, 1)), INTO(friction_coefficient),
     .standard = "0", .used = FOR_3D | FOR_COEFFICIENT, .help = "of the flanks, 0: no friction"},
    {NAME("mesh", "friction_law"), CHOICE("constant iso14179 benedict_kelley"), INTO(friction_law), .standard = "constant",
     .used = FOR_3D, .help = "iso14179: mean coefficient from load, speed and oil; benedict_kelley: place by place"},
    {NAME("mesh", "friction_speed_m_per_s"), NUMBER(UNIT_SI, BETWEEN(1e-6, 1e3)), INTO(friction_speed),
     .standard = "0.01", .used = FOR_3D, .help = "sliding speed v0 below which friction fades: mu v / sqrt(v^2 + v0^2)"},
    {NAME("mesh", "oil_viscosity_mPas"), NUMBER(UNIT_MPAS, BETWEEN(1e-3, 1e6)), INTO(oil_viscosity),
     .used = FOR_3D | FOR_OIL, .required = FOR_RUN | FOR_3D | FOR_OIL, .derived = "needed by these laws",
     .help = "dynamic viscosity at the temperature of the oil"},
    {NAME("mesh", "roughness_Ra_um"), NUMBER(UNIT_UM, BETWEEN(1e-3, 1e3)), INTO(roughness),
     .used = FOR_3D | FOR_ROUGHNESS, .required = FOR_RUN | FOR_3D | FOR_ROUGHNESS, .derived = "needed by iso14179",
     .help = "of the flanks, mean of both gears"},

    {NAME("mesh", "pinion_youngs_modulus_GPa"), NUMBER(UNIT_GPA, BETWEEN(1e-3, 1e6)), INTO(pinion_youngs_modulus),
     .standard = "206", .help = "E of the pinion's material"},
    {NAME("mesh", "wheel_youngs_modulus_GPa"), NUMBER(UNIT_GPA, BETWEEN(1e-3, 1e6)), INTO(wheel_youngs_modulus),
     .standard = "206", .help = "E of the wheel's material"},
    {NAME("mesh", "pinion_poisson_ratio"), NUMBER(UNIT_SI, BETWEEN(0, 0.499)), INTO(pinion_poisson_ratio),
     .standard = "0.3", .help = "nu of the pinion's material"},
    {NAME("mesh", "wheel_poisson_ratio"), NUMBER(UNIT_SI, BETWEEN(0, 0.499)), INTO(wheel_poisson_ratio),
     .standard = "0.3", .help = "nu of the wheel's material"},
    {NAME("mesh", "stations"), COUNT(2, 97), INTO(stations), .derived = "17 to 97, as the gears need",
     .used = FOR_ELASTIC, .help = "along the face, at which the teeth deflect; 0.4 % in the transmission error"},
    {NAME("mesh", "corner_contact"), CHOICE("off on"), INTO(corner_contact), .derived = "on for elastic teeth, else off",
     .used = FOR_3D, .help = "on: tip edges touch before and after the path of contact, so that the force does not jump"},
    {NAME("mesh", "tip_rounding"), NUMBER(UNIT_SI, BETWEEN(0.001, 1)), INTO(tip_rounding), .standard = "0.05",
     .used = FOR_ELASTIC, .help = "radius of the tip edges, in modules"},

    {NAME("pose", "center_distance_change_um"), NUMBER(UNIT_UM, UP_TO(1e9)), INTO(pose.center_distance_change),
     .standard = "0", .help = "the wheel's axis has moved away from the pinion's"},
    {NAME("pose", "offset_um"), NUMBER(UNIT_UM, UP_TO(1e9)), INTO(pose.offset),
     .standard = "0", .help = "and along +y, to the left seen from the pinion's axis against +z"},
    {NAME("pose", "axial_shift_um"), NUMBER(UNIT_UM, UP_TO(1e9)), INTO(pose.axial_shift),
     .standard = "0", .help = "and the wheel along its axis, +z"},
    {NAME("pose", "skew_mrad"), NUMBER(UNIT_MRAD, UP_TO(100)), INTO(pose.skew),
     .standard = "0", .help = "its axis is tilted out of the plane of the axes, about +x at mid-face"},
    {NAME("pose", "inclination_mrad"), NUMBER(UNIT_MRAD, UP_TO(100)), INTO(pose.inclination),
     .standard = "0", .help = "and in that plane, about +y"},

    {NAME("bodies", "pinion_inertia_kg_m2"), NUMBER(UNIT_SI, INERTIA), INTO(pinion_inertia),
     .used = FOR_DYNAMIC | FOR_TORQUE, .required = FOR_RUN | FOR_DYNAMIC | FOR_TORQUE,
     .example = "2.1e-3", .help = "about its axis"},
    {NAME("bodies", "wheel_inertia_kg_m2"), NUMBER(UNIT_SI, INERTIA), INTO(wheel_inertia),
     .used = FOR_DYNAMIC, .required = FOR_RUN | FOR_DYNAMIC, .example = "2.1e-3", .help = "about its axis"},
    {NAME("bodies", "pinion_drag_Nms"), NUMBER(UNIT_SI, BETWEEN(0, 1e12)), INTO(pinion_drag), .standard = "0",
     .used = FOR_DYNAMIC | FOR_TORQUE, .help = "viscous drag of bearings and oil: torque over speed, always on"},
    {NAME("bodies", "wheel_drag_Nms"), NUMBER(UNIT_SI, BETWEEN(0, 1e12)), INTO(wheel_drag), .standard = "0",
     .used = FOR_DYNAMIC, .help = "the same of the wheel; not part of load_torque_Nm"},

    {NAME("drive", "kind"), CHOICE("speed torque"), INTO(drive), .standard = "speed",
     .used = FOR_DYNAMIC, .help = "what is prescribed at the pinion"},
    {NAME("drive", "start_rpm"), NUMBER(UNIT_RPM, ANY), INTO(start_speed), .standard = "0",
     .used = FOR_DYNAMIC, .required = FOR_RUN | FOR_DYNAMIC | FOR_SPEED,
     .example = "1000", .help = "pinion speed at the start"},
    {NAME("drive", "end_rpm"), NUMBER(UNIT_RPM, ANY), INTO(end_speed),
     .used = FOR_DYNAMIC | FOR_SPEED, .required = FOR_RUN | FOR_DYNAMIC | FOR_SPEED,
     .example = "2000", .help = "pinion speed at the end, linear in time"},
    {NAME("drive", "torque_Nm"), NUMBER(UNIT_SI, UP_TO(1e12)), INTO(drive_torque),
     .used = FOR_DYNAMIC | FOR_TORQUE, .required = FOR_RUN | FOR_DYNAMIC | FOR_TORQUE,
     .example = "87.8", .help = "constant torque on the pinion"},
    {NAME("drive", "file"), .kind = KEY_PATH, INTO(drive_file), .derived = "no table", .used = FOR_DYNAMIC,
     .help = "table over time in place of start_rpm and end_rpm, or torque_Nm: time_s,speed_rpm or time_s,torque_Nm"},
    {NAME("drive", "interpolation"), CHOICE("linear cubic"), INTO(drive_interpolation), .standard = "linear",
     .used = FOR_DYNAMIC, .help = "between the rows of the table"},
    {NAME("drive", "repeat"), CHOICE("off on"), INTO(drive_repeat), .standard = "off",
     .used = FOR_DYNAMIC, .help = "on: the table begins again at its end"},
    {NAME("drive", "ripple"), .kind = KEY_RIPPLE, INTO(drive_ripple), .derived = "no ripple", .used = FOR_DYNAMIC,
     .help = "harmonics of the pinion's turn, added to its speed in rpm or its torque in N m"},

    {NAME("load", "mean_Nm"), NUMBER(UNIT_SI, ANY), INTO(mean_load),
     .required = FOR_RUN, .example = "80", .help = "on the wheel, > 0 resists its driven direction"},
    {NAME("load", "end_Nm"), NUMBER(UNIT_SI, ANY), INTO(end_load), .derived = "as mean_Nm",
     .used = FOR_STATIC, .help = "last of the loads of a static analysis, the first is mean_Nm"},
    {NAME("load", "noise_amplitude_Nm"), NUMBER(UNIT_SI, BETWEEN(0, 1e12)), INTO(noise_amplitude),
     .standard = "0", .used = FOR_DYNAMIC, .help = "noise on the load: values uniform in +- amplitude, up to 25 % more in between"},
    {NAME("load", "noise_interval_s"), NUMBER(UNIT_SI, DURATION), INTO(noise_interval),
     .standard = "1e-5", .used = FOR_DYNAMIC, .help = "time between independent values, cubic in between"},
    {NAME("load", "seed"), .kind = KEY_SEED, INTO(seed),
     .standard = "1", .used = FOR_DYNAMIC, .help = "of the noise; same seed, same run"},
    {NAME("load", "per_speed_Nms"), NUMBER(UNIT_SI, BETWEEN(0, 1e12)), INTO(load_per_speed), .standard = "0",
     .used = FOR_DYNAMIC, .help = "load over the wheel's speed w in rad/s: c w is added, also where w < 0"},
    {NAME("load", "per_speed_squared_Nms2"), NUMBER(UNIT_SI, BETWEEN(0, 1e12)), INTO(load_per_speed_squared),
     .standard = "0", .used = FOR_DYNAMIC, .help = "c2 w |w| is added, as of fans and propellers"},
    {NAME("load", "file"), .kind = KEY_PATH, INTO(load_file), .derived = "no table", .used = FOR_DYNAMIC,
     .help = "table over time in place of mean_Nm: time_s,torque_Nm"},
    {NAME("load", "interpolation"), CHOICE("linear cubic"), INTO(load_interpolation), .standard = "linear",
     .used = FOR_DYNAMIC, .help = "between the rows of the table"},
    {NAME("load", "repeat"), CHOICE("off on"), INTO(load_repeat), .standard = "off",
     .used = FOR_DYNAMIC, .help = "on: the table begins again at its end"},
    {NAME("load", "ripple"), .kind = KEY_RIPPLE, INTO(load_ripple), .derived = "no ripple", .used = FOR_DYNAMIC,
     .help = "harmonics of the pinion's turn, added to the load in N m"},

    {NAME("analysis", "type"), CHOICE("dynamic static"), INTO(analysis), .standard = "dynamic",
     .help = "static: transmission error under load (model 3d)"},
    {NAME("analysis", "duration_s"), NUMBER(UNIT_SI, DURATION), INTO(duration),
     .used = FOR_DYNAMIC, .required = FOR_RUN | FOR_DYNAMIC, .example = "1", .help = "simulated time"},
    {NAME("analysis", "stop_rpm"), NUMBER(UNIT_RPM, ANY), INTO(stop_speed), .derived = "at duration_s",
     .used = FOR_DYNAMIC | FOR_TORQUE, .help = "pinion speed that ends the run, if it comes before duration_s"},
    {NAME("analysis", "positions"), COUNT(1, 100000000), INTO(positions),
     .standard = "200", .used = FOR_STATIC, .help = "equal steps over the period"},
    {NAME("analysis", "period"), CHOICE("mesh pinion hunting"), INTO(period),
     .standard = "mesh", .used = FOR_STATIC, .help = "one tooth, one turn, or until the same teeth meet"},
    {NAME("analysis", "loads"), COUNT(1, 1000000), INTO(loads), .standard = "1",
     .used = FOR_STATIC, .help = "one period for each of so many loads, evenly from mean_Nm to end_Nm"},

    {NAME("solver", "method"), CHOICE("bdf adams erk"), INTO(method), .standard = "adams",
     .used = FOR_DYNAMIC, .help = "of CVODE; erk: explicit Runge-Kutta, of ARKODE"},
    {NAME("solver", "relative_tolerance"), NUMBER(UNIT_SI, BETWEEN(0, 1)), INTO(relative_tolerance),
     .standard = "1e-4", .used = FOR_DYNAMIC, .help = "of the integration; spur gears in 3d: a hundredth of it"},
    {NAME("solver", "absolute_tolerance_um"), NUMBER(UNIT_UM, BETWEEN(1e-12, 1e6)), INTO(absolute_tolerance),
     .derived = "that of relative_tolerance, 1e-4 at most", .used = FOR_DYNAMIC,
     .help = "of the mesh coordinate; spur gears in 3d: a hundredth of it"},
    {NAME("solver", "max_step_s"), NUMBER(UNIT_SI, BETWEEN(0, 1e9)), INTO(max_step),
     .standard = "0", .used = FOR_DYNAMIC, .help = "longest step, 0 = no limit"},
    {NAME("solver", "lookup"), CHOICE("off on auto always"), INTO(lookup),
     .standard = "auto", .used = FOR_DYNAMIC | FOR_3D,
     .help = "mesh from tables, approximate. on: where that is faster; auto: and no worse than the solver's error; always: in any case"},
    {NAME("solver", "lookup_depth_um"), NUMBER(UNIT_UM, BETWEEN(1e-3, 1e6)), INTO(lookup_depth),
     .derived = "from the loads", .used = FOR_DYNAMIC | FOR_3D,
     .help = "penetration up to which the tables reach, exact beyond"},
    {NAME("solver", "lookup_threads"), COUNT(0, 64), INTO(lookup_threads),
     .standard = "0", .used = FOR_DYNAMIC | FOR_3D,
     .help = "threads that fill the tables before the run; 0: what a run meets is filled as it meets it"},

    {NAME("output", "file"), .kind = KEY_PATH, INTO(output_file),
     .derived = "name of the INI file, .csv", .help = "result; HDF5 if it ends in .h5 or .hdf5"},
    {NAME("output", "rate_Hz"), NUMBER(UNIT_SI, BETWEEN(1e-9, 1e12)), INTO(output_rate),
     .standard = "25600", .used = FOR_DYNAMIC, .help = "rows per simulated second"},
    {NAME("output", "oversampling"), COUNT(1, 64), INTO(oversampling),
     .standard = "4", .used = FOR_DYNAMIC, .help = "samples per row, low-pass filtered, force and load as means; 1 = values at the time"},
    {NAME("output", "digits"), COUNT(3, 17), INTO(digits),
     .standard = "10", .help = "significant digits in CSV"},
    {NAME("output", "columns"), .kind = KEY_TEXT, INTO(columns),
     .standard = "all", .help = "names separated by commas"},
    {NAME("output", "wrench"), CHOICE("off on"), INTO(wrench),
     .standard = "off", .help = "on: force and moment on each gear as columns; off: those named in columns"},
    {NAME("output", "load_distribution"), .kind = KEY_PATH, INTO(load_distribution), .derived = "not written",
     .used = FOR_STATIC | FOR_3D, .help = "CSV of line load, pressure and gap: a row for each position, pair and station"},
};
/* clang-format on */

const key_table gearsim_keys = {"gearsim", keys, (int)(sizeof keys / sizeof keys[0]),
                                modification_legend};

/* ---------------------------------------------------------------------------------------------
 * Situations
 * ------------------------------------------------------------------------------------------- */

static const unsigned law_situation[] = {
    [LAW_CONSTANT] = FOR_CONSTANT, [LAW_ISO6336] = FOR_ISO6336, [LAW_ELASTIC] = FOR_ELASTIC};

static unsigned situation_of(const config *conf) {
    return (unsigned)(conf->model == MODEL_3D ? FOR_3D : FOR_SIMPLE) | law_situation[conf->law] |
           (unsigned)(conf->friction_law == FRICTION_CONSTANT ? FOR_COEFFICIENT : FOR_OIL) |
           (unsigned)(conf->friction_law == FRICTION_ISO14179 ? FOR_ROUGHNESS : 0) |
           (unsigned)(isnan(conf->double_helical_gap) ? 0 : FOR_DOUBLE_HELICAL) |
           (unsigned)(conf->drive == DRIVE_SPEED ? FOR_SPEED : FOR_TORQUE) |
           (unsigned)(conf->analysis == ANALYSIS_DYNAMIC ? FOR_DYNAMIC : FOR_STATIC);
}

int key_is_used(const key_spec *key, const config *conf, const char **reason) {
    static const char *const friction[] = {"mesh.friction_law = constant",
                                           "mesh.friction_law = iso14179",
                                           "mesh.friction_law = benedict_kelley"};
    unsigned lacking = key->used & ~situation_of(conf);

    /* Static positions roll at this speed where that means friction. */
    if (key->target == offsetof(config, start_speed) && config_has_friction(conf)) {
        lacking &= ~(unsigned)FOR_DYNAMIC;
    }

    /* The setting that says most about why it is not used. */
    if (lacking & (FOR_DYNAMIC | FOR_STATIC)) {
        *reason = conf->analysis == ANALYSIS_DYNAMIC ? "analysis.type = dynamic"
                                                     : "analysis.type = static";
    } else if (lacking & (FOR_SPEED | FOR_TORQUE)) {
        *reason = conf->drive == DRIVE_SPEED ? "drive.kind = speed" : "drive.kind = torque";
    } else if (lacking & (FOR_COEFFICIENT | FOR_OIL | FOR_ROUGHNESS)) {
        *reason = friction[conf->friction_law];
    } else if (lacking & (FOR_CONSTANT | FOR_ISO6336 | FOR_ELASTIC)) {
        *reason = conf->law == LAW_CONSTANT  ? "mesh.law = constant"
                  : conf->law == LAW_ISO6336 ? "mesh.law = iso6336"
                                             : "mesh.law = elastic";
    } else if (lacking & FOR_DOUBLE_HELICAL) {
        *reason = "one helix, without gears.double_helical_gap_mm";
    } else if (lacking) {
        *reason = conf->model == MODEL_3D ? "mesh.model = 3d" : "mesh.model = simple";
    }
    return lacking == 0;
}

/* The common face follows from those of both gears, and a table over time stands in the place of numbers. */
static int follows_from_others(const key_spec *key, const config *conf) {
    switch (key->target) {
    case offsetof(config, gears.face_width):
        return !isnan(conf->gears.pinion_face_width) && !isnan(conf->gears.wheel_face_width);
    case offsetof(config, start_speed):
    case offsetof(config, end_speed):
    case offsetof(config, drive_torque):
        return conf->drive_file != NULL;
    case offsetof(config, mean_load):
        return conf->load_file != NULL && conf->analysis == ANALYSIS_DYNAMIC;
    default:
        return 0;
    }
}

int key_is_required(const key_spec *key, const config *conf) {
    const unsigned purposes = conf->purpose == CONFIG_FOR_RUN ? FOR_ALL | FOR_RUN : FOR_ALL;

    if (follows_from_others(key, conf)) {
        return 0;
    }
    return key->required != 0 && (key->required & ~(situation_of(conf) | purposes)) == 0;
}
