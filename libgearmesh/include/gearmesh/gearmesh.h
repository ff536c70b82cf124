/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/**
 * @file gearmesh.h
 * The open gear mesh element: contact of two real, measured, helical gears for any solver.
 *
 * The library answers one question: given the two rotation angles of a pair of involute
 * gears, external or a pinion in a ring, how deep do the teeth press into each other, how does that change with both angles, and
 * which force and wrench follow. Every tooth may have a measured flank of its own.
 *
 * ## The call
 *
 *     gm_pair_params params;
 *     gm_pair_params_default(&params);
 *     params.pinion_teeth = 45; ...                      // what the drawing says
 *     gm_pair pair;
 *     int status = gm_pair_init(&pair, &params);
 *
 *     gm_mesh_params law;
 *     gm_mesh_params_default(&law);
 *     law.stiffness = 1.05e8;                            // of one pair of teeth
 *     size_t size = gm_mesh_size(&law, &pair);           // prepared once, in memory of the caller
 *     gm_mesh *mesh;
 *     status = gm_mesh_init(&mesh, &law, &pair, NULL, NULL, memory, size);
 *
 *     gm_state state = { .pinion_angle = 0.1, .wheel_angle = 0.11 };
 *     gm_mesh_result result;                             // at every step, from any thread
 *     status = gm_mesh_evaluate(mesh, &state, GM_WANT_DERIVATIVES, NULL, &result);
 *
 * ## Conventions (libgearmesh/docs/conventions.md has the sketch)
 *
 * - SI units and radians everywhere.
 * - Pinion axis at the origin, +z along it, +x towards the wheel axis at x = center_distance.
 *   `pinion_angle` > 0 counter-clockwise seen against +z; `wheel_angle` > 0 clockwise, so that both
 *   are positive in the driven direction.
 * - At zero angles pinion tooth 0 and a wheel tooth space stand on the centre line in the section
 *   z = 0; the backlash is symmetric there.
 * - Mesh coordinate x = r_bp phi_p - r_bw phi_w. The drive flanks touch for x > backlash / 2, the
 *   coast flanks for x < -backlash / 2. The transmission error shown to users is -x.
 * - helix_angle > 0: the pinion is right-handed (the wheel left-handed).
 * - A ring (wheel_teeth < 0) has its axis at x = -center_distance, wheel_angle > 0 is counter-clockwise, and both
 *   gears have the same hand. All lengths stay above 0.
 * - t1 in [0, 1] runs along the face of each gear, t1 = (z - face_start) / face_width; t2 in [0, 1]
 *   is uniform in the roll angle from the start radius to the tip radius. Flank deviation > 0:
 *   material added.
 *
 * ## Properties of every function here
 *
 * No heap, no input or output, no global state, no recursion; bounded work per call, whatever the
 * angles and numbers of teeth. Same inputs, same bits, from any thread. Apart from the inputs marked
 * `[out]` nothing is written. Functions return a status: 0 done, > 0 the state is at fault (a solver
 * may try a smaller step), < 0 the call is at fault. On any other status than 0 outputs are NaN.
 *
 * Numbers have ranges far beyond all gears, within which no result overflows; what lies outside, or is no
 * number, is refused: lengths of a pair 1e-6 .. 1e9 m, profile shifts up to 1000, deviations of a flank up to
 * 1 m, angles up to 1e9 rad, speeds up to 1e9 rad/s and dx/dt up to 1e9 m/s, stiffness 1e-30 .. 1e30 N/m.
 *
 * ## Sources (equation by equation in libgearmesh/docs/equations.md)
 *
 * - [Paper] "Analytical gear mesh model using 3D gear geometry", Eqs. 1..25, with the corrections
 *   that docs/equations.md lists and derives.
 * - [ISO21771] ISO 21771-1 (geometry of cylindrical involute gears), terms and symbols.
 */
#ifndef GEARMESH_H
#define GEARMESH_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Version of this header; gm_version() gives that of the library. */
#define GM_VERSION_MAJOR  0
#define GM_VERSION_MINOR  2       /**< as above */
#define GM_VERSION_PATCH  0       /**< as above */
#define GM_VERSION_STRING "0.2.0" /**< the three of them */

/** What makes a function of the library visible to its users. */
#if defined(_WIN32) && defined(GEARMESH_SHARED)
#ifdef GEARMESH_BUILDING
#define GM_API __declspec(dllexport)
#else
#define GM_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define GM_API __attribute__((visibility("default")))
#else
#define GM_API
#endif

/* ---------------------------------------------------------------------------------------------
 * Status
 * ------------------------------------------------------------------------------------------- */

/**
 * Status of a call: 0 done; > 0 recoverable, a smaller step may help; < 0 not recoverable. This is
 * the contract of a SUNDIALS right-hand side, so that it can be handed through unchanged.
 */
enum gm_status {
    GM_OK = 0,

    GM_STATE_NOT_FINITE = 1, /**< an angle, speed or coordinate is NaN or infinite */
    GM_STATE_OUT_OF_RANGE =
        2, /**< |x| >= p_bt / 2 (a tooth would be skipped), |angle| > 1e9 rad, or a speed beyond
                1e9 rad/s or m/s */
    GM_NO_EQUILIBRIUM = 3, /**< no contact within |x| < p_bt / 2 carries the torque */
    GM_UNDETERMINED = 4,   /**< no torque: any position within the backlash is in equilibrium */
    GM_POSE_OUT_OF_MESH =
        5, /**< tilted by more than p_bt / 8 over the face, or posed so that tips or faces miss each other, or a tip meets the root of its mate */
    GM_NO_CONVERGENCE = 6, /**< elastic teeth found no balance in the steps allowed */

    GM_ERR_NULL = -1,      /**< a required pointer is NULL */
    GM_ERR_PARAMETER = -2, /**< a parameter is out of its range, see gm_pair_params_check() */
    GM_ERR_GEOMETRY = -3,  /**< each parameter is fine, but together they give no gear pair */
    GM_ERR_MEMORY = -4,    /**< the memory provided is too small, or all table places are taken */
    GM_ERR_TOOTH = -5,    /**< no such tooth or flank, or the flanks have another number of teeth */
    GM_ERR_DEVIATION = -6 /**< a flank or pitch deviation is not finite, or beyond 1 m */
};

/** Text of a status; never NULL, "unknown status" for any other integer. */
GM_API const char *gm_status_text(int status);

/** Version of the library, "major.minor.patch". */
GM_API const char *gm_version(void);

/* ---------------------------------------------------------------------------------------------
 * Gear pair: what a drawing gives, and what follows from it
 * ------------------------------------------------------------------------------------------- */

/** The two gears of a pair, and the order in which they stand in arrays. */
enum gm_role { GM_PINION = 0, GM_WHEEL = 1 };

/** How the base helix angle follows from the helix angle. */
enum gm_base_helix {
    GM_BASE_HELIX_ISO = 0, /**< tan(beta_b) = tan(beta) cos(alpha_t) [ISO21771]: right */
    GM_BASE_HELIX_PAPER =
        1 /**< tan(beta_b) = tan(beta) / cos(alpha_t) as printed in [Paper, Eq. 6]:
                                 wrong, only there to reproduce the printed equation */
};

/**
 * What a drawing gives of a gear pair. Fill with gm_pair_params_default(), then set at least the
 * fields marked required. NaN in an optional field = derive it as stated. All lengths 1e-6 .. 1e9 m.
 */
typedef struct gm_pair_params {
    int pinion_teeth;             /**< z_p, 3 .. 100000, required */
    int wheel_teeth;              /**< z_w, 3 .. 100000, or -100000 .. -3: a ring, required */
    int base_helix;               /**< enum gm_base_helix [GM_BASE_HELIX_ISO] */
    double normal_module;         /**< m_n, m, required */
    double normal_pressure_angle; /**< alpha_n, rad, 0 < alpha_n < 45 deg, required */
    double helix_angle;           /**< beta, rad, |beta| < 60 deg, > 0: right-handed pinion [0] */
    double center_distance;       /**< d, m, > r_bp + r_bw, of a ring > r_bw - r_bp, required */
    double face_width;        /**< b, common to both gears, m, required unless the face widths of
                                        both gears are given */
    double pinion_face_width; /**< b_p of the pinion alone, m [NaN: face_width] */
    double wheel_face_width;  /**< b_w of the wheel alone, m [NaN: face_width] */
    double axial_offset; /**< middle of the wheel's face less that of the pinion's, along +z, m,
                                        |axial_offset| <= 1e9 m [0]; the faces must overlap */

    /** x_p, 1, |x_p| <= 1000 [NaN: half of the sum that gives zero backlash; the rest of that sum if only the
     * wheel's is given] */
    double pinion_profile_shift;

    double wheel_profile_shift; /**< x_w, 1 [NaN: as for the pinion] */
    double backlash;            /**< transverse, along the line of action, m [NaN: from the tooth
                                        thicknesses; else both normal thicknesses at the reference
                                        circles are changed equally to give it]; may be negative,
                                        above -p_bt */
    double pinion_normal_thickness; /**< s_n at the reference circle, m [NaN: from the profile
                                        shift]; where given it wins over the shift */
    double wheel_normal_thickness;  /**< as for the pinion */

    /** h_aP of the basic rack, in modules, 0 .. 10 [NaN: 1, ISO 53]. */
    double pinion_rack_addendum;
    double wheel_rack_addendum; /**< as for the pinion */

    /** h_fP of the basic rack, in modules, 0 .. 10 [NaN: 1.25]; it sets the root radius. */
    double pinion_rack_dedendum;
    double wheel_rack_dedendum; /**< as for the pinion */

    /** rho_fP of the basic rack, in modules, 0 .. 10, rho_fP (1 - sin(alpha_n)) <= h_fP [NaN: 0.38]. */
    double pinion_rack_fillet_radius;
    double wheel_rack_fillet_radius; /**< as for the pinion */

    /** k_p, in modules, < 0: shorter teeth, |k_p| <= 10 [NaN: min(0, (d - r_p - r_w) / m_n - (x_p + x_w))]; not
     *  used where the tip radius is given. */
    double pinion_tip_alteration;
    double wheel_tip_alteration; /**< k_w, as for the pinion */

    /** r_ap, m [NaN: r_p + m_n (h_aP + x_p + k_p)]. Shifts count as printed: thinning by backlash does not
     *  lower a tip. */
    double pinion_tip_radius;
    double wheel_tip_radius; /**< r_aw, m [NaN: as for the pinion] */

    double pinion_start_radius; /**< start of the active profile, m [NaN: the point that meets the
                                        wheel's tip at zero penetration]; below the base circle it is
                                        taken as the base circle */
    double wheel_start_radius;  /**< as for the pinion */
} gm_pair_params;

/**
 * What belongs to one gear alone, as drawn. Nothing of it moves with a pose. Read-only after gm_pair_init().
 */
typedef struct gm_gear {
    int teeth;          /**< z, of a ring its absolute value */
    int start_is_given; /**< 1: the drawing gives the start radius; 0: the mate's tip sets it */
    /** +1: external teeth; -1: a ring, of which ISO 21771 counts z and all lengths below 0. Here they are above. */
    double sign;
    double profile_shift;      /**< x, nominal (1) */
    double rack_addendum;      /**< h_aP / m_n (1) */
    double rack_dedendum;      /**< h_fP / m_n (1) */
    double rack_fillet_radius; /**< rho_fP / m_n (1) */
    double tip_alteration;   /**< k = (r_a - r) / m_n - h_aP - x, whichever of them was given (1) */
    double reference_radius; /**< r (m) */
    double base_radius;      /**< r_b (m) */
    double root_radius;      /**< r_f = r - m_n (h_fP - x) (m) */
    double tip_radius;       /**< r_a (m) */
    double start_radius;     /**< start of the active profile (m) */
    double normal_thickness; /**< s_n at the reference circle, backlash included (m) */
    double base_half_thickness; /**< psi_b, half tooth thickness angle on the base circle (rad) */
    double tip_thickness; /**< s_ta, transverse, at the tip circle, backlash included; < 0: the
                                     flanks cross below it (m) */
    double normal_tip_thickness; /**< s_na = s_ta cos(beta_a), in the normal section (m) */
    double start_roll_length;    /**< rho at the start radius = r_b chi_start (m) */
    double tip_roll_length;      /**< rho at the tip radius = r_b chi_end (m) */
    double pitch_angle;          /**< 2 pi / z, leading part (rad) */

    /** 2 pi / z - pitch_angle, so that 1e6 rad cost one rounding (rad) */
    double pitch_angle_remainder;

    double face_width; /**< b of this gear (m) */
    double face_start; /**< z of its face I; 0 for the pinion (m) */
} gm_gear;

/**
 * A gear pair ready for evaluation, as drawn: at the nominal center distance. Filled by gm_pair_init(),
 * read-only afterwards; plain data, may be copied. The first half follows from the gears alone, the
 * second from them and the center distance.
 */
typedef struct gm_pair {
    gm_gear pinion; /**< the driving gear in the signs of this file, at the origin */
    gm_gear wheel;  /**< its mate, at x = center_distance */

    double normal_module;             /**< m_n (m) */
    double transverse_module;         /**< m_t (m) */
    double normal_pressure_angle;     /**< alpha_n (rad) */
    double transverse_pressure_angle; /**< alpha_t (rad) */
    double helix_angle;               /**< beta, > 0: right-handed pinion (rad) */
    double base_helix_angle;          /**< beta_b, sign of beta (rad) */
    double transverse_base_pitch;     /**< p_bt (m) */
    double face_width;                /**< b, of the common face: where both gears have one (m) */
    double face_start;                /**< z at which the common face begins (m) */
    double face_advance;         /**< b tan(beta_b): how far a contact line advances along the line
                                           of action over the common face, signed (m) */
    double normal_to_transverse; /**< 1 / cos(beta_b): factor from a deviation along the surface
                                           normal to one in the transverse section (1) */
    double hunting_passes;       /**< tooth passes until the same two teeth meet again: the least
                                           common multiple of the numbers of teeth (1) */

    double center_distance;           /**< d (m) */
    double reference_center_distance; /**< r_p + r_w (m) */
    double working_pressure_angle;    /**< alpha_wt (rad) */
    double involute_difference;       /**< inv(alpha_wt) - inv(alpha_t) (1) */
    double line_of_action;            /**< T0, between the base tangent points (m) */
    double path_start;                /**< of the path of contact at zero penetration, from the
                                           pinion's tangent point (m) */
    double path_end;                  /**< end of it (m) */
    double transverse_contact_ratio;  /**< eps_alpha (1) */
    double overlap_ratio;             /**< eps_beta >= 0, of the common face (1) */
    double total_contact_ratio;       /**< eps_gamma (1) */
    double backlash;                  /**< transverse, along the line of action (m) */
    /** [enum gm_flank_side] rho_p of tooth 0 at phi_p = 0 where the common face begins (m):
     *  r_bp (alpha_wt + psi_bp) + face_start tan(beta_b) for the drive side, minus for the coast side. */
    double phase_origin[2];
    double pinion_working_pitch_radius; /**< r_wp = r_bp / cos(alpha_wt) (m) */
    double wheel_working_pitch_radius;  /**< r_ww (m) */
    double pinion_tip_clearance;        /**< c_p, from the pinion's tip to the wheel's root, on the
                                           centre line: d - r_ap - r_fw (m) */
    double wheel_tip_clearance;         /**< c_w, from the wheel's tip to the pinion's root (m) */
} gm_pair;

/** Fills with NaN (optional: derive; required: missing), zero helix angle, ISO base helix, 0 teeth. */
GM_API void gm_pair_params_default(gm_pair_params *params);

/**
 * Checks parameters without deriving a pair.
 *
 * @param[in]  params       the parameters
 * @param[out] field        name of the offending field of gm_pair_params, a constant string; NULL if
 *                          all is well. May be NULL.
 * @param[out] requirement  what would be right, a constant string for people; NULL if all is well.
 *                          May be NULL.
 * @return GM_OK, GM_ERR_NULL, GM_ERR_PARAMETER, GM_ERR_GEOMETRY
 */
GM_API int gm_pair_params_check(const gm_pair_params *params, const char **field,
                                const char **requirement);

/**
 * Derives a gear pair [Paper, Eqs. 4-8, 13-17, 23, corrected; ISO21771].
 *
 * @param[out] pair    the pair; on error every double in it is NaN and the numbers of teeth are 0
 * @param[in]  params  the parameters
 * @return GM_OK, GM_ERR_NULL, GM_ERR_PARAMETER, GM_ERR_GEOMETRY
 *
 * Valid for cylindrical involute pairs on parallel axes, external or a pinion in a ring. A ring is refused
 * (GM_ERR_GEOMETRY) where its tip reaches beyond the pinion's tangent point (involute interference), where the
 * tips meet beside the path of contact (trochoid interference), or when the pinion is moved in along the centre
 * line (trimming).
 */
GM_API int gm_pair_init(gm_pair *pair, const gm_pair_params *params);

/** Properties that do not forbid a run but that an engineer wants to hear of. */
enum gm_pair_warning {
    GM_WARN_PINION_UNDERCUT = 1 << 0, /**< generating rack cuts below the pinion's base circle */
    GM_WARN_WHEEL_UNDERCUT = 1 << 1,  /**< as for the pinion */
    GM_WARN_PINION_TIP_LAND = 1 << 2, /**< normal tip thickness below 0.2 m_n, or a pointed tooth */
    GM_WARN_WHEEL_TIP_LAND = 1 << 3,  /**< as for the pinion */
    GM_WARN_PINION_ROOT_FORM = 1 << 4, /**< start radius below the root form circle */
    GM_WARN_WHEEL_ROOT_FORM = 1 << 5,  /**< as for the pinion */
    GM_WARN_CONTACT_RATIO = 1 << 6,    /**< transverse contact ratio below 1 */
    GM_WARN_BACKLASH = 1 << 7,         /**< backlash below -1e-4 m_n: both flanks press */
    GM_WARN_PINION_START_RADIUS =
        1 << 8, /**< a start radius below the base circle was raised to it */
    GM_WARN_WHEEL_START_RADIUS = 1 << 9,     /**< as for the pinion */
    GM_WARN_PINION_TIP_CLEARANCE = 1 << 10,  /**< pinion_tip_clearance below 0.1 m_n */
    GM_WARN_WHEEL_TIP_CLEARANCE = 1 << 11,   /**< as for the pinion */
    GM_WARN_PINION_TIP_ALTERATION = 1 << 12, /**< not used, as the tip radius is given */
    GM_WARN_WHEEL_TIP_ALTERATION = 1 << 13,  /**< as for the pinion */
    /** Backlash between -1e-4 m_n and 0, as profile shifts printed with few digits leave it: a note. */
    GM_WARN_BACKLASH_ROUNDED = 1 << 14
};

/**
 * Warnings about a pair, as a sum of enum gm_pair_warning; 0 = none, or a pointer is NULL.
 *
 * The root form and undercut are those of a rack whose straight flank reaches h_Ff below its reference line:
 * rho_Ff = r sin(alpha_t) - (h_Ff - x m_n) / sin(alpha_t), undercut where < 0. Where the rack's dedendum or
 * fillet radius is given, h_Ff = h_fP - rho_fP (1 - sin(alpha_n)). Else the flank is taken to reach 0.05 m_n
 * deeper than the mate's tip does on the centre line: h_Ff - x m_n = r + r_a,mate - d + 0.05 m_n.
 */
GM_API int gm_pair_warnings(const gm_pair *pair, const gm_pair_params *params);

/* ---------------------------------------------------------------------------------------------
 * Flanks: deviations of every tooth from the ideal involute helicoid
 * ------------------------------------------------------------------------------------------- */

/** The two flanks of a tooth. */
enum gm_flank_side {
    GM_DRIVE = 0, /**< flanks that touch when the pinion drives the wheel forward */
    GM_COAST = 1  /**< the other flanks */
};

/** In place of a tooth number: all teeth of the gear. */
#define GM_ALL_TEETH (-1)

/** Sizes of the flank tables of one gear. A side without tables has 0 tables, nodes are ignored. */
typedef struct gm_flanks_params {
    int teeth;            /**< number of teeth of the gear */
    int drive_tables;     /**< how many different tables the drive side can hold, 0 .. teeth + 1 */
    int drive_face_nodes; /**< grid lines along the face (t1), 2 .. 10000 */
    int drive_profile_nodes; /**< grid lines along the profile (t2), 2 .. 10000 */
    int coast_tables;        /**< as for the drive side */
    int coast_face_nodes;    /**< as for the drive side */
    int coast_profile_nodes; /**< as for the drive side */
} gm_flanks_params;

/**
 * A linear relief: takes max(0, offset + per_t1 t1 + per_t2 t2) off the flank (m). Tip, root and end reliefs and
 * triangular corners are ramps, see gm_modifications_split(). Ramps add up, to each other and to the table of a tooth.
 */
typedef struct gm_flank_ramp {
    double offset; /**< at t1 = t2 = 0 (m) */
    double per_t1; /**< change over the face width (m) */
    double per_t2; /**< change over the active profile (m) */
} gm_flank_ramp;

/** Largest number of ramps of a side. */
#define GM_FLANK_RAMPS_MAX 16

/** The flanks of one gear, in memory of the caller. Prepared once by the functions below, read-only in evaluation. */
typedef struct gm_flanks gm_flanks;

/** Bytes of memory that gm_flanks_init() needs, 0 if the parameters are out of range or too large. */
GM_API size_t gm_flanks_size(const gm_flanks_params *params);

/**
 * Prepares ideal flanks in memory of the caller; tables and pitch deviations are set afterwards.
 *
 * @param[out] flanks       the flanks, which begin at `memory`; valid as long as the memory is, which must not move.
 *                          NULL on an error
 * @param[in]  params       sizes
 * @param[in]  memory       at least gm_flanks_size() bytes, aligned for double
 * @param[in]  memory_size  bytes in memory
 * @return GM_OK, GM_ERR_NULL, GM_ERR_PARAMETER, GM_ERR_MEMORY (too little, or not aligned)
 */
GM_API int gm_flanks_init(gm_flanks **flanks, const gm_flanks_params *params, void *memory,
                          size_t memory_size);

/** Number of teeth of the gear; 0 for NULL. */
GM_API int gm_flanks_teeth(const gm_flanks *flanks);

/**
 * Most material that any tooth of a side adds to the ideal flank, pitch included, before ramps take some off (m). Two
 * gears do not touch on a side while its ideal penetration is below minus the sum of both peaks. 0 for NULL, which is
 * ideal; NaN for no such side.
 */
GM_API double gm_flanks_peak(const gm_flanks *flanks, int side);

/**
 * Steepest change of the deviations of any tooth of a side along the profile, ramps included: a bound of |d deviation /
 * d t2| (m). Costs a look at every node. 0 for NULL; NaN for no such side.
 */
GM_API double gm_flanks_profile_slope(const gm_flanks *flanks, int side);

/**
 * How deep the flanks of a side are modified: the most that ramps take off at a point, and what lies between the highest
 * and the lowest node of a tooth's table, of the tooth where that is most (m). Pitch does not count. Costs a look at every
 * node. 0 for NULL; NaN for no such side.
 */
GM_API double gm_flanks_depth(const gm_flanks *flanks, int side);

/**
 * Gives one tooth, or all teeth, a table of deviations. Each call takes one table place; a later call
 * for a tooth replaces the table of that tooth alone.
 *
 * @param[in,out] flanks     the flanks
 * @param[in]     side       GM_DRIVE or GM_COAST
 * @param[in]     tooth      0 .. teeth - 1, or GM_ALL_TEETH
 * @param[in]     deviation  [face_nodes][profile_nodes] node values at t1 = k1 / (face_nodes - 1),
 *                           t2 = k2 / (profile_nodes - 1), bilinear in between, > 0 material added, at most
 *                           1 m either way after multiplication by the factor (m)
 * @param[in]     factor     multiplies every node: pair.normal_to_transverse for deviations along the
 *                           surface normal (as measured), 1 for those in the transverse section
 * @return GM_OK, GM_ERR_NULL, GM_ERR_TOOTH, GM_ERR_MEMORY (no place left), GM_ERR_DEVIATION; on an
 *         error nothing is changed
 */
GM_API int gm_flanks_set_table(gm_flanks *flanks, int side, int tooth, const double *deviation,
                               double factor);

/**
 * Sets the pitch deviation of one tooth, or of all teeth: a shift of the whole flank in the
 * transverse section along the line of action, > 0 material added on that side, at most 1 m either way (m).
 *
 * A tooth displaced by f along +phi_p has drive +f and coast -f; a wheel tooth displaced by f along
 * +phi_w has drive -f and coast +f.
 *
 * @return GM_OK, GM_ERR_NULL, GM_ERR_TOOTH, GM_ERR_DEVIATION
 */
GM_API int gm_flanks_set_pitch(gm_flanks *flanks, int side, int tooth, double deviation);

/**
 * Gives all teeth of one side these linear reliefs, in place of those that they had. Evaluated exactly, without a table.
 *
 * @param[in,out] flanks  the flanks
 * @param[in]     side    GM_DRIVE or GM_COAST
 * @param[in]     ramps   [count]; may be NULL if there are none
 * @param[in]     count   0 .. GM_FLANK_RAMPS_MAX
 * @param[in]     factor  multiplies every ramp, as with gm_flanks_set_table(); > 0
 * @return GM_OK, GM_ERR_NULL, GM_ERR_TOOTH (no such side), GM_ERR_PARAMETER (count or factor), GM_ERR_DEVIATION (not
 *         finite, or beyond 1e30 m); on an error nothing is changed
 */
GM_API int gm_flanks_set_ramps(gm_flanks *flanks, int side, const gm_flank_ramp *ramps, int count,
                               double factor);

/* ---------------------------------------------------------------------------------------------
 * Designed modifications: what the drawing wants beside the involute helicoid
 *
 * Terms, signs, formulae and the error bound with a sketch: libgearmesh/docs/modifications.md
 * ------------------------------------------------------------------------------------------- */

/**
 * Kinds of modification [ISO21771]. Face I is t1 = 0, face II is t1 = 1. Deviations are along the surface
 * normal, > 0 material added. Slopes and twist turn about the middle of the flank, which they leave as it is.
 */
enum gm_modification_kind {
    GM_MOD_HELIX_SLOPE = 0,      /**< C_H_beta: amount > 0 adds material towards face II */
    GM_MOD_CROWNING = 1,         /**< C_beta: amount removed at both faces, none at mid-face */
    GM_MOD_END_RELIEF_I = 2,     /**< C_beta_I: amount removed at face I */
    GM_MOD_END_RELIEF_II = 3,    /**< C_beta_II: amount removed at face II */
    GM_MOD_PROFILE_SLOPE = 4,    /**< C_H_alpha: amount > 0 adds material towards the tip */
    GM_MOD_PROFILE_CROWNING = 5, /**< C_alpha: amount removed at tip and start of the profile */
    GM_MOD_TIP_RELIEF = 6,       /**< C_alpha_a: amount removed at the tip */
    GM_MOD_ROOT_RELIEF = 7,      /**< C_alpha_f: amount removed at the start of the profile */
    GM_MOD_TWIST =
        8, /**< S_alpha: profile slope at face II less that at face I (= helix slope at the
                             tip less that at the start of the profile, S_beta) */
    GM_MOD_TIP_CORNER_I = 9,    /**< triangular relief: amount removed at the corner tip, face I */
    GM_MOD_TIP_CORNER_II = 10,  /**< the same at tip, face II */
    GM_MOD_ROOT_CORNER_I = 11,  /**< start of the profile, face I */
    GM_MOD_ROOT_CORNER_II = 12, /**< start of the profile, face II */
    GM_MODIFICATION_KINDS = 13  /**< how many kinds there are */
};

/** How a relief or crowning runs from nothing to its amount over its length. */
enum gm_modification_shape {
    GM_SHAPE_LINEAR = 0,    /**< with a kink where the range begins; not for crownings */
    GM_SHAPE_PARABOLIC = 1, /**< tangent to the ideal flank where the range begins */
    GM_SHAPE_CIRCULAR = 2   /**< a circle tangent there, over the length in metres */
};

/** What the profile range of a relief is given by. */
enum gm_modification_range {
    GM_RANGE_LENGTH = 0, /**< roll length from the tip, or from the start of the profile (m) */
    GM_RANGE_SHARE = 1,  /**< the same as a share of the active profile, 0 .. 1 */
    GM_RANGE_RADIUS = 2 /**< radius up to which the relief reaches, from the tip or the start (m) */
};

/** Largest number of modifications of a flank. */
#define GM_MODIFICATIONS_MAX 200

/** One designed modification of a flank. Fields that its kind does not use are ignored. */
typedef struct gm_modification {
    int kind;             /**< enum gm_modification_kind */
    int shape;            /**< enum gm_modification_shape: reliefs, corners and crownings */
    int profile_range_by; /**< enum gm_modification_range: tip and root reliefs, corners */
    double amount; /**< m, |amount| <= 10 mm; reliefs and corners: >= 0. Circular: at most half the
                          length that it runs over */
    double face_range;    /**< end reliefs and corners: length from the face, 0 < range <= b (m) */
    double profile_range; /**< tip and root reliefs, corners: as profile_range_by says */
} gm_modification;

/** The modifications of one flank of a gear: they add up. The pointers must outlive the calls. */
typedef struct gm_modifications {
    const gm_modification *list; /**< [count] */
    int count;                   /**< 0 .. GM_MODIFICATIONS_MAX */
    const gm_gear *gear;         /**< of a pair; gives radii and roll lengths */
    double face_width;           /**< of that pair (m) */
} gm_modifications;

/** A grid for a table of modifications. */
typedef struct gm_modifications_grid {
    int face_nodes;    /**< grid lines along t1 */
    int profile_nodes; /**< grid lines along t2 */
    double error;      /**< the bilinear table differs nowhere by more, along the normal (m) */
} gm_modifications_grid;

/**
 * Checks the modifications of a flank.
 *
 * @param[in]  modifications  the modifications
 * @param[out] index          which one is at fault, -1 = none in particular. May be NULL
 * @param[out] field          name of its field, a constant string; NULL if all is well. May be NULL
 * @param[out] requirement    what would be right, a constant string; NULL if all is well. May be NULL
 * @return GM_OK, GM_ERR_NULL, GM_ERR_PARAMETER
 */
GM_API int gm_modifications_check(const gm_modifications *modifications, int *index,
                                  const char **field, const char **requirement);

/**
 * Divides the modifications of a flank: linear reliefs and linear corners become ramps, which are exact and need no
 * table, up to GM_FLANK_RAMPS_MAX of them; the others are left for a table. Those with an amount of 0 are left out.
 *
 * @param[in]  modifications  the modifications
 * @param[out] ramps          along the surface normal: gm_flanks_set_ramps() takes them with the factor of the tables
 * @param[out] ramp_count     how many ramps; 0 on an error
 * @param[out] rest           [modifications.count] the others, in their order
 * @param[out] rest_count     how many others; 0 on an error
 * @return GM_OK, GM_ERR_NULL, GM_ERR_PARAMETER
 */
GM_API int gm_modifications_split(const gm_modifications *modifications,
                                  gm_flank_ramp ramps[GM_FLANK_RAMPS_MAX], int *ramp_count,
                                  gm_modification *rest, int *rest_count);

/**
 * Exact sum of the modifications at a point, along the surface normal (m). NaN where
 * gm_modifications_check() would not return GM_OK, or for a point outside 0 <= t1, t2 <= 1.
 */
GM_API double gm_modifications_value(const gm_modifications *modifications, double t1, double t2);

/**
 * Finds a uniform grid on which a bilinear table of the modifications is true to a tolerance. Few lines are
 * preferred, and lines where linear reliefs begin. If no grid of 262144 nodes is fine enough (a linear
 * triangular relief has a kink across the grid), one of the best is given: its error says so. Linear reliefs and
 * corners need no table, see gm_modifications_split().
 *
 * @param[in]  modifications  the modifications
 * @param[in]  face_nodes     of a table that they are to be added to: all its nodes are kept, so that it
 *                            can be resampled exactly. 2 .. 10000; 2 = no such table
 * @param[in]  profile_nodes  as for the face
 * @param[in]  tolerance      >= 1e-12 m; 1e-8 m suits most purposes
 * @param[out] grid           the grid and a guaranteed bound of its error; 0 nodes and NaN on an error
 * @return GM_OK, GM_ERR_NULL, GM_ERR_PARAMETER
 */
GM_API int gm_modifications_grid_find(const gm_modifications *modifications, int face_nodes,
                                      int profile_nodes, double tolerance,
                                      gm_modifications_grid *grid);

/**
 * Adds the modifications to the nodes of a table as gm_flanks_set_table() takes it.
 *
 * @param[in]     modifications  the modifications
 * @param[in]     face_nodes     2 .. 10000
 * @param[in]     profile_nodes  2 .. 10000
 * @param[in,out] deviation      [face_nodes][profile_nodes] along the surface normal (m)
 * @return GM_OK, GM_ERR_NULL, GM_ERR_PARAMETER; on an error nothing is changed
 */
GM_API int gm_modifications_add(const gm_modifications *modifications, int face_nodes,
                                int profile_nodes, double *deviation);

/* ---------------------------------------------------------------------------------------------
 * Penetration
 * ------------------------------------------------------------------------------------------- */

/** What a solver knows: two angles and speeds in the driven direction. */
typedef struct gm_state {
    double pinion_angle; /**< phi_p (rad) */
    double wheel_angle;  /**< phi_w (rad) */
    double pinion_speed; /**< d phi_p / dt (rad/s) */
    double wheel_speed;  /**< d phi_w / dt (rad/s) */
} gm_state;

/**
 * The same with the angles reduced to teeth: what the evaluation really needs. A solver that
 * integrates x itself (micrometres matter) fills it with gm_position_from_pinion_angle().
 */
typedef struct gm_position {
    int pinion_tooth; /**< pinion tooth whose phase it is, 0 .. z_p - 1 */
    int wheel_tooth;  /**< wheel tooth that its drive flank meets, 0 .. z_w - 1 */

    /** r_bp times the angle of that pinion tooth, in [0, p_bt) up to a rounding (m) */
    double phase;

    double offset;       /**< x = r_bp phi_p - r_bw phi_w, |x| < p_bt / 2 (m) */
    double offset_rate;  /**< dx/dt (m/s) */
    double pinion_speed; /**< d phi_p / dt, which friction needs to know (rad/s) */
} gm_position;

/** Result of an evaluation. Net = drive - coast. */
typedef struct gm_penetration {
    double penetration; /**< net sum of Eq. 24 over all pairs (m) */
    double rate;        /**< net approach speed dx/dt times the touching fraction (m/s) */
    double drive;       /**< sum over the drive flanks, >= 0 (m) */
    double coast;       /**< sum over the coast flanks, >= 0 (m) */
    double drive_rate;  /**< rate of the drive flanks alone; rate = drive_rate - coast_rate (m/s) */
    double coast_rate;  /**< rate of the coast flanks alone (m/s) */
    double drive_contact;  /**< touching part of the face width, summed over drive pairs (1) */
    double coast_contact;  /**< the same of the coast pairs (1) */
    double d_pinion_angle; /**< partial derivative of penetration by phi_p, exact (m/rad) */
    double d_wheel_angle;  /**< partial derivative of penetration by phi_w, exact (m/rad) */
    int drive_pairs;       /**< drive pairs that touch */
    int coast_pairs;       /**< coast pairs that touch */
} gm_penetration;

/**
 * Reduces angles and speeds to a position. Costs one rounding of each angle and no more, up to
 * 1e9 rad (Cody-Waite reduction with the pitch angle in two parts).
 *
 * @return GM_OK, GM_ERR_NULL, GM_STATE_NOT_FINITE, GM_STATE_OUT_OF_RANGE (angles, speeds)
 */
GM_API int gm_position_from_state(const gm_pair *pair, const gm_state *state,
                                  gm_position *position);

/**
 * The same for a solver that integrates x = r_bp phi_p - r_bw phi_w instead of the wheel angle.
 *
 * @param[in]  pair          the pair
 * @param[in]  pinion_angle  phi_p (rad)
 * @param[in]  offset        x (m); any size here, but the 3D model takes |x| < p_bt / 2 only
 * @param[in]  offset_rate   dx/dt (m/s)
 * @param[out] position      the position, with a pinion_speed of 0: set it where the mesh has friction
 * @return GM_OK, GM_ERR_NULL, GM_STATE_NOT_FINITE, GM_STATE_OUT_OF_RANGE
 */
GM_API int gm_position_from_pinion_angle(const gm_pair *pair, double pinion_angle, double offset,
                                         double offset_rate, gm_position *position);

/**
 * Simple model: a spring with backlash [Paper, Eqs. 9-11, with |x| in Eq. 10]. One pair, no tooth
 * engagement; drive = max(0, x - backlash / 2), coast = max(0, -x - backlash / 2).
 *
 * @return as gm_position_from_state(), with |x| <= 1e18 m
 */
GM_API int gm_penetration_simple(const gm_pair *pair, const gm_state *state,
                                 gm_penetration *result);

/**
 * 3D model: exact integral of the penetration over all contact lines of both flanks [Paper, Eqs. 12-25,
 * corrected]. The plain entry point; a solver prepares a gm_mesh once and evaluates that.
 *
 * @param[in]  pair           the pair
 * @param[in]  pinion_flanks  deviations of the pinion's teeth, NULL = ideal
 * @param[in]  wheel_flanks   deviations of the wheel's teeth, NULL = ideal
 * @param[in]  state          angles and speeds
 * @param[out] result         all fields; NaN (pairs 0) on error
 * @return GM_OK, GM_ERR_NULL, GM_ERR_TOOTH (flanks of another number of teeth), GM_STATE_NOT_FINITE,
 *         GM_STATE_OUT_OF_RANGE
 *
 * Valid for |x| < p_bt / 2, where no tooth is skipped. The sum is continuous for helical gears and
 * jumps for spur gears (helix angle 0) when a pair enters or leaves. Derivatives are one-sided on the
 * countable kinks.
 * Accuracy: 1e-10 relative plus what double precision loses in one rounding of the angles.
 */
GM_API int gm_penetration_3d(const gm_pair *pair, const gm_flanks *pinion_flanks,
                             const gm_flanks *wheel_flanks, const gm_state *state,
                             gm_penetration *result);

/* ---------------------------------------------------------------------------------------------
 * Mesh: pair, flanks and force law as one object
 * ------------------------------------------------------------------------------------------- */

/** Where the overlap of the flanks comes from. */
enum gm_model {
    GM_MODEL_3D = 0,    /**< exact integral over all lines of contact [Paper, Eqs. 12-25] */
    GM_MODEL_SIMPLE = 1 /**< a spring with backlash [Paper, Eqs. 9-11]; ideal flanks, any |x| */
};

/** How force follows from overlap. */
enum gm_law {
    GM_LAW_CONSTANT = 0, /**< constant stiffness K of a pair of teeth, uniform over face and profile
                              [Paper, Eq. 3] */
    GM_LAW_ISO6336 = 1,  /**< the same with K = c' times the common face width,
                              gm_iso6336_single_stiffness() */
    GM_LAW_ELASTIC = 2 /**< teeth that bend, share the load and flatten, from drawing and material;
                              unmeasured in rings: docs/elastic.md */
};

/**
 * Whether the tip edges of loaded teeth touch the mate's flank before and after the ideal path of contact, off the line of
 * action. With it no line of contact ends but at the faces: the force has no jumps, and of helical gears no kinks.
 * An evaluation then takes some 3000 instructions of spur gears and 30 000 of helical ones, tables apart.
 */
enum gm_corner_contact {
    GM_CORNER_BY_LAW = 0, /**< as the law has it: on for GM_LAW_ELASTIC, else off */
    GM_CORNER_OFF = 1,    /**< a line of contact ends where the path does */
    GM_CORNER_ON = 2      /**< it goes on, its overlap less by the gap of the corner */
};

/** Coefficient of friction mu of flanks that slide on each other. */
enum gm_friction_law {
    GM_FRICTION_CONSTANT = 0, /**< friction_coefficient */
    GM_FRICTION_ISO14179 =
        1, /**< mean over the mesh, of Schlenk [ISO14179]: 0.048 (F/b / (v_sum rho_red))^0.2 eta^-0.05 Ra^0.25, mineral
                oil; N/mm, m/s, mm, mPa s, um; v_sum and rho_red in the pitch point */
    GM_FRICTION_BENEDICT_KELLEY =
        2 /**< by place [BenedictKelley]: 0.0127 lg(29.66 (F/b) / (eta |v| v_sum^2)), N/m, mPa s, m/s, |v| taken as
               sqrt(v^2 + v0^2) */
};

/* ISO 6336-1, method B: stiffness of steel teeth from the gear data. What a constant stiffness of a pair of teeth cannot
   do is said in docs/equations.md. */

/**
 * Single stiffness c' per face width, along the line of action in the transverse section [ISO6336, method B]:
 *
 *     c' = C_M C_R C_B cos(beta) / q',   C_M = 0.8,   C_B = (1 + 0.5 (1.2 - h_fP)) (1 - 0.02 (20 - alpha_n in degrees))
 *
 * with q' from numbers of teeth of the normal section and profile shifts, and the mean of both h_fP. "1" in the standard
 * is the gear with fewer teeth; a ring counts as infinitely many. The standard gives +5 % to -8 % between 100 and 1600 N per mm of face, for steel; below,
 * real teeth are softer.
 *
 * @param[in] pair          from gm_pair_init()
 * @param[in] blank_factor  C_R, 1 for solid blanks, > 0
 * @return (N/m2; 1e9 of them are 1 N/(mm um)); NaN for NULL, such a factor, or gears so far off that the fit is not above 0
 */
GM_API double gm_iso6336_single_stiffness(const gm_pair *pair, double blank_factor);

/** Mesh stiffness per face width, c_gamma_alpha = c' (0.75 eps_alpha + 0.25) (N/m2). The standard has up to 10 % less
 *  for spur gears with eps_alpha below 1.2. For comparison: a mesh has K eps_alpha, see gm_mesh_mean_stiffness(). */
GM_API double gm_iso6336_mesh_stiffness(const gm_pair *pair, double blank_factor);

/** Where gears are outside the range for which the standard gives q'. 1 is the gear with fewer teeth. */
enum gm_iso6336_warning {
    GM_WARN_ISO6336_SHIFT_ORDER = 1 << 0, /**< x_1 < x_2 */
    GM_WARN_ISO6336_SHIFT_SUM = 1 << 1,   /**< x_1 + x_2 below -0.5 or above 2 */
    GM_WARN_ISO6336_HELIX = 1 << 2        /**< helix angle beyond 45 degrees */
};

/** Warnings about a pair, as a sum of enum gm_iso6336_warning; 0 = none, or NULL. */
GM_API int gm_iso6336_warnings(const gm_pair *pair);

/**
 * How the wheel stands against the drawing: where its axis and its face have moved, along the axes of the file comment.
 * The drawing stays what it is; angles are counted from its zeros, so that the transmission error contains the shift.
 */
typedef struct gm_pose {
    double center_distance_change; /**< along +x, away from the pinion (m) [0] */
    double offset;                 /**< along +y (m) [0] */
    double axial_shift;            /**< along +z (m) [0] */

    /* The wheel's rotation vector is (skew, inclination, 0), right-handed, about the middle of its own face. Overlap to
       second order, within some nanometres at 4 mrad; the force keeps its direction. Up to p_bt / 8 over the face. */
    double skew;        /**< out of the plane of the axes, about +x, f_Sigma_beta (rad) [0] */
    double inclination; /**< in that plane, about +y, f_Sigma_delta (rad) [0] */
} gm_pose;

/**
 * Model and law of a mesh. Fill with gm_mesh_params_default(), then set at least the stiffness, or a law that
 * has its own.
 *
 * The simple model takes the same K and D of one pair of teeth: its spring is K eps_alpha, its damper D eps_alpha, so
 * that both models share eigenfrequency and damping ratio.
 */
typedef struct gm_mesh_params {
    int model; /**< enum gm_model [GM_MODEL_3D] */
    int law;   /**< enum gm_law [GM_LAW_CONSTANT] */

    /** K of one pair of teeth that touches over the common face width, 1e-30 .. 1e30 N/m, required by
     * GM_LAW_CONSTANT, not used by others */
    double stiffness;

    double iso_blank_factor; /**< C_R of GM_LAW_ISO6336, 0.01 .. 2 [1: solid blanks] */
    double damping;          /**< D of one pair of teeth likewise, 0 .. 1e30 N s/m [0] */

    /** spring of the simple model, 1e-30 .. 1e30 N/m [NaN: K eps_alpha] */
    double simple_stiffness;

    gm_pose pose; /**< of the wheel [as drawn] */

    /* Of elastic teeth, which need no stiffness: it follows. With other laws E and nu give the contact pressure. */
    double pinion_youngs_modulus; /**< E, 1e6 .. 1e15 N/m2 [206e9] */
    double wheel_youngs_modulus;  /**< as for the pinion */
    double pinion_poisson_ratio;  /**< nu, 0 .. 0.499 [0.3] */
    double wheel_poisson_ratio;   /**< as for the pinion */

    /** of a disc that winds up between bore and root, in series with the teeth, m, 0 < r < r_f [NaN: rigid body] */
    double pinion_bore_radius;

    double wheel_bore_radius; /**< as for the pinion */

    /** [pinion_teeth] factor of each tooth's stiffness, 0.01 .. 100: below 1 for cracks and spalls; must stay where
     * it is as long as the mesh is used [NULL: 1] */
    const double *pinion_tooth_stiffness;

    const double *wheel_tooth_stiffness; /**< [wheel_teeth] likewise */

    /** load on the wheel, > 0 N m, at which the stiffness is taken that eigenfrequency and damping go by [NaN: 100
     * N per mm of face] */
    double reference_torque;

    int stations; /**< along the face, 2 .. 97, or 0: gm_elastic_stations_modified() of the flanks [0] */

    /** enum gm_corner_contact [GM_CORNER_BY_LAW]. GM_CORNER_ON: 3D model, no tip that reaches to the mate's base
     *  circle. Start radii then end no line. With constant stiffness line loads have no pressure under an edge. */
    int corner_contact;

    /** radius of the tip edges of elastic teeth in modules, 0.001 .. 1 [0.05] */
    double tip_rounding;

    /* Friction, of the 3D model. At a sliding speed v its coefficient is mu v / sqrt(v^2 + v0^2). */
    int friction_law;            /**< enum gm_friction_law [GM_FRICTION_CONSTANT] */
    double friction_coefficient; /**< mu of GM_FRICTION_CONSTANT, 0 .. 1 [0: no friction] */
    double friction_speed;       /**< v0, 1e-9 .. 1e3 m/s [0.01] */

    /** dynamic viscosity eta at the temperature of the oil, 1e-6 .. 1e6 Pa s, required by the other laws */
    double oil_viscosity;

    /** Ra, mean of both gears, 1e-9 .. 1e-3 m, required by GM_FRICTION_ISO14179 */
    double roughness;
} gm_mesh_params;

/**
 * A mesh: pair, flanks of both gears, model and law, prepared once in memory of the caller. Read-only afterwards, without
 * hidden state: any number of threads may evaluate one mesh. It refers to the flanks, which must not change or move as
 * long as it is used; the pair is copied.
 */
typedef struct gm_mesh gm_mesh;

/** Fills with the defaults; the stiffness is NaN: required. */
GM_API void gm_mesh_params_default(gm_mesh_params *params);

/**
 * Checks the parameters of a mesh.
 *
 * @param[in]  params       the parameters
 * @param[out] field        name of the offending field of gm_mesh_params, a constant string; NULL if all is well. May be
 *                          NULL
 * @param[out] requirement  what would be right, a constant string; NULL if all is well. May be NULL
 * @return GM_OK, GM_ERR_NULL, GM_ERR_PARAMETER
 */
GM_API int gm_mesh_params_check(const gm_mesh_params *params, const char **field,
                                const char **requirement);

/**
 * Stations along the face with which elastic teeth of a pair have a transmission error that is within 0.4 % of what many
 * stations converge to: 17, and up to 97 on faces that are wide for the length of their lines of contact.
 *
 * @param[in] pair  from gm_pair_init()
 * @return 17 .. 97; 0 for NULL
 *
 * Valid for: flanks whose load goes from end to end of their lines, and tilted axes. Modified flanks want more:
 * gm_elastic_stations_modified().
 * Source:    docs/elastic.md, measured on random pairs.
 */
GM_API int gm_elastic_stations(const gm_pair *pair);

/**
 * The same for flanks with modifications, by the ratio of their depth to what teeth give way by under the reference torque,
 * which is 10 F / (E b): from 0.3 on a quarter more elements, from 1.5 on twice as many, from 6 on three times, and from 25
 * on four times.
 *
 * @param[in] pair    from gm_pair_init()
 * @param[in] params  of the mesh: its moduli and reference torque
 * @param[in] depth   gm_flanks_depth() of the flank where it is most, transverse (m)
 * @return 17 .. 97; 0 for NULL
 *
 * Valid for: depths of up to 50 times the deflection. Under much less than the reference torque modifications are deeper
 * against the deflection.
 * Source:    docs/elastic.md, measured on random pairs.
 */
GM_API int gm_elastic_stations_modified(const gm_pair *pair, const gm_mesh_params *params,
                                        double depth);

/**
 * Estimate of what so many stations leave in the transmission error, at its worst position, relative to it (1). Twice as
 * much may be left where the face is less than three times as wide as lines of contact are long; it is 0 for spur gears,
 * and knows nothing of reliefs.
 *
 * @param[in] pair      from gm_pair_init()
 * @param[in] stations  2 or more
 * @return the estimate; NaN for NULL, fewer stations, or a pair that is none
 *
 * Source: docs/elastic.md: 0.04 h^2 tan(beta_b) / (l g_alpha).
 */
GM_API double gm_elastic_stations_error(const gm_pair *pair, int stations);

/** Bytes of memory that gm_mesh_init() needs; 0 where it would refuse the parameters or the pair. */
GM_API size_t gm_mesh_size(const gm_mesh_params *params, const gm_pair *pair);

/**
 * Prepares a mesh in memory of the caller.
 *
 * @param[out] mesh           the mesh, which begins at `memory`; NULL on an error
 * @param[in]  params         model and law
 * @param[in]  pair           from gm_pair_init(); copied
 * @param[in]  pinion_flanks  deviations of the pinion's teeth, NULL = ideal; the simple model ignores them
 * @param[in]  wheel_flanks   deviations of the wheel's teeth, NULL = ideal
 * @param[in]  memory         at least gm_mesh_size() bytes, aligned for double
 * @param[in]  memory_size    bytes in memory
 * @return GM_OK, GM_ERR_NULL, GM_ERR_PARAMETER, GM_ERR_GEOMETRY (not a pair, or one to which the law gives no
 *         stiffness, or corner contact of a tip that reaches to the mate's base circle), GM_ERR_TOOTH (flanks of another number of
 *         teeth), GM_ERR_MEMORY (too little, or not aligned), GM_STATE_NOT_FINITE or GM_POSE_OUT_OF_MESH (the pose)
 */
GM_API int gm_mesh_init(gm_mesh **mesh, const gm_mesh_params *params, const gm_pair *pair,
                        const gm_flanks *pinion_flanks, const gm_flanks *wheel_flanks, void *memory,
                        size_t memory_size);

/**
 * Checks whether the teeth of a pair can be elastic: a fillet at the root, no undercut, contact on the involute.
 *
 * @param[in]  params       law GM_LAW_ELASTIC
 * @param[in]  pair         from gm_pair_init()
 * @param[out] field        field of gm_pair_params or gm_mesh_params that is to be changed, a constant string; NULL if all
 *                          is well. May be NULL
 * @param[out] requirement  what would be right, likewise
 * @param[in]  memory       at least gm_mesh_size() bytes, aligned for double; overwritten
 * @param[in]  memory_size  bytes in memory
 * @return GM_OK, GM_ERR_GEOMETRY, and as gm_mesh_init()
 */
GM_API int gm_mesh_check_teeth(const gm_mesh_params *params, const gm_pair *pair,
                               const char **field, const char **requirement, void *memory,
                               size_t memory_size);

/** Memory of elastic teeth: where their last balance was, one for each thread that evaluates a mesh. */
typedef struct gm_workspace gm_workspace;

/** Bytes of memory that gm_workspace_init() needs; 0 where the law needs none, and for NULL. */
GM_API size_t gm_workspace_size(const gm_mesh *mesh);

/**
 * Prepares a workspace in memory of the caller. An evaluation begins from the last one; what it gives does not depend on that
 * beyond the accuracy of docs/elastic.md, and a workspace as it comes from here is always valid. It must not
 * move. For one mesh at a time.
 *
 * @param[out] workspace    the workspace, which begins at `memory`; NULL on an error, and where the law needs none
 * @param[in]  mesh         the mesh
 * @param[in]  memory       at least gm_workspace_size() bytes, aligned for double
 * @param[in]  memory_size  bytes in memory
 * @return GM_OK, GM_ERR_NULL, GM_ERR_MEMORY
 */
GM_API int gm_workspace_init(gm_workspace **workspace, const gm_mesh *mesh, void *memory,
                             size_t memory_size);

/** Stiffness of elastic teeth at the reference torque, between ideal flanks, along the line of action (N/m). Taken at 32
 *  places of the mesh cycle or the path; bodies with a bore are not in it. */
typedef struct gm_mesh_stiffness {
    double
        mesh_mean; /**< dF/dx of all pairs, with corner contact if the mesh has it, mean over a mesh cycle */
    double mesh_smallest; /**< in it */
    double mesh_largest;  /**< in it */

    /** of one pair that carries the force alone, all along the face, within its path, mean over it */
    double single_mean;

    double single_smallest; /**< on it */
    double single_largest;  /**< on it */
} gm_mesh_stiffness;

/** The stiffness of elastic teeth. GM_OK, GM_ERR_NULL, GM_ERR_PARAMETER (another law); NaN on an error. */
GM_API int gm_mesh_elastic_stiffness(const gm_mesh *mesh, gm_mesh_stiffness *stiffness);

/** The pair of a mesh; NULL for NULL. */
GM_API const gm_pair *gm_mesh_pair(const gm_mesh *mesh);

/** Stiffness along the line of action over all pairs that touch on average: K eps_alpha, or the spring of the simple
 *  model; of elastic teeth the mean of dF/dx at the reference torque (N/m). NaN for NULL. */
GM_API double gm_mesh_mean_stiffness(const gm_mesh *mesh);

/** Damping likewise: D eps_alpha (N s/m). NaN for NULL. */
GM_API double gm_mesh_mean_damping(const gm_mesh *mesh);

/**
 * Eigenfrequency of two bodies on the mean stiffness of the mesh, sqrt(K_mean (r_bp^2 / I_p + r_bw^2 / I_w)) / (2 pi).
 *
 * @param[in] mesh            the mesh
 * @param[in] pinion_inertia  I_p, > 0; infinite (HUGE_VAL) where the pinion's motion is prescribed (kg m2)
 * @param[in] wheel_inertia   I_w, likewise
 * @return (Hz); NaN for NULL or an inertia that is not above 0
 */
GM_API double gm_mesh_eigenfrequency(const gm_mesh *mesh, double pinion_inertia,
                                     double wheel_inertia);

/**
 * How far x may go before flanks of a side can touch: backlash / 2 less the peaks of both gears' flanks (m). No drive
 * flanks touch while x < clearance of GM_DRIVE, no coast flanks while -x < clearance of GM_COAST. Negative where flanks
 * may touch at x = 0. NaN for NULL or no such side.
 */
GM_API double gm_mesh_clearance(const gm_mesh *mesh, int side);

/** Force and moment on both gears in the frame of the file comment. */
typedef struct gm_wrench {
    double pinion_force[3];  /**< on the pinion (N) */
    double pinion_moment[3]; /**< on the pinion about its axis at z = 0 (N m) */
    double wheel_force[3];   /**< on the wheel (N) */
    double wheel_moment[3];  /**< on the wheel about its axis, not yet tilted, at z = 0 (N m) */
} gm_wrench;

/** What an evaluation shall give beside force, penetration and contact: a sum of these. */
enum gm_wanted {
    GM_WANT_FORCE = 0,
    GM_WANT_DERIVATIVES =
        1, /**< exact derivatives of force and penetration; about a third more work with tables */
    GM_WANT_WRENCH = 2, /**< force and moment on both gears */
    GM_WANT_PAIRS =
        4, /**< numbers of pairs also where a cache answers, which does not count them */
    GM_WANT_ENERGY =
        8 /**< gm_mesh_result.energy; about another evaluation of the force with constant stiffness, of
                            elastic teeth next to nothing */
};

/** Partial derivatives of one quantity by what a solver knows, all else fixed. */
typedef struct gm_gradient {
    double pinion_angle; /**< by phi_p (per rad) */
    double wheel_angle;  /**< by phi_w (per rad) */
    double pinion_speed; /**< by d phi_p / dt (per rad/s) */
    double wheel_speed;  /**< by d phi_w / dt (per rad/s) */
} gm_gradient;

/** Result of an evaluation of a mesh. What was not asked for is NaN. */
typedef struct gm_mesh_result {
    double force;       /**< F along the transverse line of action, > 0 drives the wheel forward (N)
                             [Paper, Eqs. 1-2, base radii] */
    double drive_force; /**< of the drive flanks alone, >= 0; F = drive_force - coast_force (N) */
    double coast_force; /**< of the coast flanks alone, >= 0 (N) */

    /** that the mesh takes from the pinion: I_p phi_p'' = M_p - pinion_torque; F r_bp without friction (N m) */
    double pinion_torque;

    /** that it gives to the wheel: I_w phi_w'' = -M_w + wheel_torque; likewise (N m) */
    double wheel_torque;

    /** power that friction takes, >= 0; pinion_torque times the pinion's speed is wheel_torque times the wheel's, F
     * dx/dt, and this (W) */
    double loss;

    /**
     * U stored in what is pressed together, both flank sides: K / 2 times the integral of the overlap squared, or what
     * elastic teeth, contact and bodies hold. It depends on where the gears are alone. Without damping and friction,
     * pinion_torque is dU/d phi_p and wheel_torque -dU/d phi_w, so that dU/dx = F, but for what docs/equations.md lists:
     * with constant stiffness lines that end with some overlap, and the slope of deviations along the profile (J)
     */
    double energy;

    gm_gradient force_by;         /**< derivatives of F (N/rad, N s/rad) */
    gm_gradient pinion_torque_by; /**< of pinion_torque (N m/rad, N m s/rad) */
    gm_gradient wheel_torque_by;  /**< of wheel_torque, likewise */

    /** overlap and contact of the flanks, as gm_penetration_3d(); of elastic teeth those that a mesh of constant
     * stiffness K_mean / eps_alpha has under the same force: F / K, dF/dx / K */
    gm_penetration contact;

    /** each line of contact taken where it is: with the tilting moments of helical gears and of partly touching
     * flanks. Forces along the surface normal. In the simple model all acts in the pitch point at mid-face */
    gm_wrench wrench;
} gm_mesh_result;

/**
 * Evaluates a mesh: force, and what else is wanted.
 *
 * Per flank side the force is max(0, K penetration + D rate): teeth do not pull, and where damping would make them, force
 * and derivatives are 0.
 *
 * @param[in]     mesh       the mesh
 * @param[in]     state      angles and speeds
 * @param[in]     wanted     a sum of enum gm_wanted
 * @param[in,out] workspace  of this thread; NULL: the constant law needs none
 * @param[out]    result     all fields, NaN where not wanted; on an error all NaN, pairs 0
 * @return GM_OK, GM_ERR_NULL, GM_ERR_PARAMETER (wanted), GM_STATE_NOT_FINITE, GM_STATE_OUT_OF_RANGE, GM_NO_CONVERGENCE
 *
 * Validity and accuracy as gm_penetration_3d(), or gm_penetration_simple(). Cost: docs/performance.md.
 */
GM_API int gm_mesh_evaluate(const gm_mesh *mesh, const gm_state *state, int wanted,
                            gm_workspace *workspace, gm_mesh_result *result);

/**
 * As gm_mesh_evaluate(), from a reduced position: the hot entry, without trigonometry.
 *
 * @return as gm_mesh_evaluate(), and GM_ERR_TOOTH (no such teeth)
 */
GM_API int gm_mesh_evaluate_at(const gm_mesh *mesh, const gm_position *position, int wanted,
                               gm_workspace *workspace, gm_mesh_result *result);

/**
 * How many pairs of teeth touch at a reduced position, and nothing else: gm_penetration.drive_pairs and coast_pairs of
 * gm_mesh_evaluate_at(), exactly, also where the mesh has a cache.
 *
 * @param[in]     mesh       the mesh
 * @param[in]     position   where the gears are; speeds do not matter
 * @param[in,out] workspace  as gm_mesh_evaluate()
 * @param[out]    pairs      of GM_DRIVE and GM_COAST; 0 on an error
 * @return as gm_mesh_evaluate_at()
 *
 * Cost: with tables less than half an evaluation, as a line that carries is known to touch from one of its points and only
 * others are followed; elastic teeth, linear reliefs, corner contact and a pose take a whole one. docs/performance.md.
 */
GM_API int gm_mesh_pairs_at(const gm_mesh *mesh, const gm_position *position,
                            gm_workspace *workspace, int pairs[2]);

/**
 * How the force grows with other flanks: dF/da, where `a` times a change is added to the flanks of the mesh and both angles
 * are held. Of any number of changes at once. For the search of modifications: at a given load without friction the
 * transmission error (the wheel's lead) changes by dF/da over dF/dx, dF/dx = -force_by.wheel_angle / r_bw.
 *
 * @param[in]     mesh            3D, and with constant stiffness without corner contact
 * @param[in]     position        where the gears are; speeds do not matter
 * @param[in]     pinion_changes  [count] what each adds to the pinion's flanks for a = 1: any prepared flanks, as of one
 *                                modification by 1 um; NULL = nothing
 * @param[in]     wheel_changes   [count] likewise
 * @param[in]     count           of changes, 0 or more
 * @param[in,out] workspace       of this mesh, one for each thread; NULL: the constant law needs none
 * @param[out]    force_by        [count] dF/da, F the net force of gm_mesh_result.force without damping (N, a being a number);
 *                                NaN on an error
 * @return as gm_mesh_evaluate_at(); GM_ERR_PARAMETER for other meshes and a count below 0, GM_ERR_TOOTH for flanks of
 * other gears
 *
 * Accuracy: exact to what the balance of elastic teeth leaves (1e-8), else to rounding (1e-12 m of each change); one-sided
 *           where flanks begin to touch.
 * Source:   elastic teeth: adjoint of the balance, docs/elastic.md; constant stiffness: integral of the change over what
 *           touches, docs/equations.md.
 * Cost:     an evaluation or two, and for each change what it takes to read the flanks.
 */
GM_API int gm_mesh_force_by_flanks(const gm_mesh *mesh, const gm_position *position,
                                   const gm_flanks **pinion_changes,
                                   const gm_flanks **wheel_changes, int count,
                                   gm_workspace *workspace, double *force_by);

/* ---------------------------------------------------------------------------------------------
 * Gears that move: a pose of its own at every call, and bodies of a multibody code
 * ------------------------------------------------------------------------------------------- */

/** Where both gears are and how they move, in the frame of the file comment. */
typedef struct gm_motion {
    gm_position position; /**< angles and dx/dt, see gm_position_from_state() */
    gm_pose pose;         /**< of the wheel, in addition to the one that the mesh was prepared in */

    /** its rate (m/s, rad/s), each at most 1e9 either way; the approach speed of the flanks contains it */
    gm_pose pose_rate;
} gm_motion;

/**
 * As gm_mesh_evaluate_at(), with the wheel in a pose of its own at every call: for shafts that bend, bodies that float.
 * Without pose and rate it is gm_mesh_evaluate_at(), to the last bit; with one a cache does not answer.
 *
 * The damping force of a side is D times the integral of the speed of approach over its touching part: dx/dt, less the
 * velocity of the wheel's axis along the surface normal, less what a changing tilt does at each point, in first order. With
 * elastic teeth the mean over the touching part is taken. The sliding speed of friction contains what the wheel's body
 * does across the line of action.
 *
 * @return as gm_mesh_evaluate_at(), and GM_POSE_OUT_OF_MESH; GM_STATE_OUT_OF_RANGE for rates too
 *
 * Cost: 1.4 evaluations with tables, 1.7 with a shift along the axis; docs/performance.md.
 */
GM_API int gm_mesh_evaluate_posed(const gm_mesh *mesh, const gm_motion *motion, int wanted,
                                  gm_workspace *workspace, gm_mesh_result *result);

/** How many coordinates a mesh has: both angles and the five of the pose. */
#define GM_COORDINATES 7

/** These coordinates, in the order of the tangent. */
enum gm_coordinate {
    GM_PINION_ANGLE = 0,           /**< phi_p (rad) */
    GM_WHEEL_ANGLE = 1,            /**< phi_w (rad) */
    GM_CENTER_DISTANCE_CHANGE = 2, /**< of gm_pose (m) */
    GM_OFFSET = 3,                 /**< of gm_pose (m) */
    GM_AXIAL_SHIFT = 4,            /**< of gm_pose (m) */
    GM_SKEW = 5,                   /**< of gm_pose (rad) */
    GM_INCLINATION = 6             /**< of gm_pose (rad) */
};

/** Derivatives of force and wrench by the coordinates of enum gm_coordinate, all else fixed (N, N m per m, rad), and by
 *  their rates (per m/s, rad/s). */
typedef struct gm_tangent {
    double force_by[GM_COORDINATES];          /**< of gm_mesh_result.force */
    double force_by_rate[GM_COORDINATES];     /**< likewise */
    gm_wrench wrench_by[GM_COORDINATES];      /**< of each component of gm_mesh_result.wrench */
    gm_wrench wrench_by_rate[GM_COORDINATES]; /**< likewise */
} gm_tangent;

/**
 * The exact tangent of gm_mesh_evaluate_posed(), for implicit integrators: one-sided at the countable kinks, where a line
 * begins or ends to touch a limit, such as equal faces that are not shifted.
 *
 * @param[in]  mesh     the mesh; of constant stiffness, or that of ISO 6336-1
 * @param[in]  motion   where the gears are and how they move
 * @param[out] tangent  all of it; NaN on an error
 * @return as gm_mesh_evaluate_posed(); GM_ERR_PARAMETER for elastic teeth: take the derivatives by both angles of
 *         gm_mesh_evaluate(), and differences for the pose
 *
 * The wrench contains friction; the rates of both angles change how fast the flanks approach and how fast they slide.
 * libgearmesh/examples/bodies.c takes it to the coordinates of two bodies.
 * Accuracy: roundings. Cost: two to three evaluations with tables, and more with friction and corners, as lines are cut
 * into parts; docs/performance.md. Source: docs/equations.md.
 */
GM_API int gm_mesh_tangent(const gm_mesh *mesh, const gm_motion *motion, gm_tangent *tangent);

/** The events of a mesh, in the order of gm_mesh_event_indicators(). */
enum gm_event {
    GM_EVENT_DRIVE_CONTACT = 0, /**< drive flanks come into reach of each other, or get out of it */
    GM_EVENT_DRIVE_LOWER =
        1, /**< a line of contact reaches the lower end of the path with its foremost point: there a pair
                                     enters as the pinion turns forwards */
    GM_EVENT_DRIVE_UPPER =
        2, /**< it passes the upper end with its last point: there a pair leaves */
    GM_EVENT_COAST_CONTACT = 3, /**< as for the drive flanks */
    GM_EVENT_COAST_LOWER = 4, /**< likewise; as the pinion turns forwards, coast pairs leave here */
    GM_EVENT_COAST_UPPER = 5  /**< and enter here */
};

/** How many there are. */
#define GM_EVENTS 6

/**
 * Event indicators, for solvers with root finding: continuous functions of the motion, of which one changes its sign where
 * contact is gained or lost on a flank side, or a pair enters or leaves the path.
 *
 * Those of the path are sines of the way of the lines past that end, with the period of a base pitch: 0 at each event, and
 * once more halfway to the next, where nothing happens. As the pinion turns forwards under a steady load, those of drive
 * flanks rise through 0 at events, and those of coast flanks fall. They count while the contact of the side is above 0.
 *
 * @param[in]  mesh        the mesh
 * @param[in]  motion      where the gears are and how they move
 * @param[out] indicators  [enum gm_event]; contact: overlap of the foremost flanks, < 0 apart (m); path: sines (1). NaN on
 *                         an error
 * @return as gm_mesh_tangent(), whatever law and friction
 *
 * Between ideal flanks exact. With deviations contact is that of the highest points: below 0 nothing touches, and above
 * force begins from 0. The path is that of parallel axes; of elastic teeth that without load; with corner contact it ends
 * where the gap of the corner is the overlap. The simple model has no lines: their indicators are 1. Cost: some hundred
 * instructions.
 */
GM_API int gm_mesh_event_indicators(const gm_mesh *mesh, const gm_motion *motion,
                                    double indicators[GM_EVENTS]);

/**
 * A gear as a rigid body, in any right-handed frame common to both gears. The reference point is the middle of the gear's
 * own face on its own axis. The body's z axis is that axis. At angle 0 and as drawn, the axes of both bodies are those of
 * the file comment: x from the pinion to the wheel (to a ring's pitch point); pinion tooth 0 and a wheel tooth space then stand on the centre line
 * in the section of the pinion's face I (z = 0), half a face width before the pinion's reference point.
 */
typedef struct gm_body {
    double position[3]; /**< of the reference point (m) */

    /** from the body's axes to the common frame, row by row: v_common = R v_body */
    double rotation[9];

    double velocity[3];         /**< of the reference point (m/s) */
    double angular_velocity[3]; /**< in the common frame (rad/s) */
} gm_body;

/** What acts on a body at its reference point, in the common frame. */
typedef struct gm_load {
    double force[3];  /**< (N) */
    double moment[3]; /**< (N m) */
} gm_load;

/**
 * The mesh between two bodies: force and moment on each. Whole turns need not be known, and teeth may be assembled in any
 * pairing: x is the one within half a base pitch, and the tables of the teeth that meet there are used. No state is kept.
 *
 * Both loads are in balance with each other, whatever the motion. Their power is that of the flanks, -(dU/dt + damping
 * loss + friction loss), less three things: flanks that leave at a tip with some overlap take its energy along; deviations that change
 * along the way of contact do work on the rotation; and between tilted axes the force keeps the pinion's normal, so that
 * the power is open by the order of tilt times force times speed.
 *
 * @param[in]     mesh       the mesh
 * @param[in]     pinion     the pinion
 * @param[in]     wheel      the wheel
 * @param[in]     wanted     a sum of enum gm_wanted; the wrench comes in any case
 * @param[in,out] workspace  as gm_mesh_evaluate()
 * @param[out]    result     in the mesh frame, see gm_motion_of_bodies(); NaN on an error
 * @param[out]    on_pinion  load on the pinion; NaN on an error
 * @param[out]    on_wheel   load on the wheel; NaN on an error
 * @return as gm_mesh_evaluate_posed(); GM_STATE_OUT_OF_RANGE too if a matrix is no rotation (columns off by more than
 *         1e-3), GM_POSE_OUT_OF_MESH if the wheel's point is on the pinion's axis or an axis points the other way
 */
GM_API int gm_mesh_evaluate_bodies(const gm_mesh *mesh, const gm_body *pinion, const gm_body *wheel,
                                   int wanted, gm_workspace *workspace, gm_mesh_result *result,
                                   gm_load *on_pinion, gm_load *on_wheel);

/**
 * The motion of two bodies as the mesh sees it. The mesh frame has z along the pinion's axis and x towards the
 * wheel, or away from a ring's axis, so that gm_pose.offset and its rate are 0.
 *
 * @param[in]  mesh    the mesh
 * @param[in]  pinion  the pinion
 * @param[in]  wheel   the wheel
 * @param[out] motion  in the mesh frame; NaN on an error
 * @param[out] frame   from the mesh frame to the common one, row by row; NaN on an error. May be NULL
 * @return as gm_mesh_evaluate_bodies()
 */
GM_API int gm_motion_of_bodies(const gm_mesh *mesh, const gm_body *pinion, const gm_body *wheel,
                               gm_motion *motion, double frame[9]);

/** Stiffness of what touches in a result: K times the touching part of the face width, all pairs and both sides; of elastic
 *  teeth dF/dx (N/m). NaN for NULL. */
GM_API double gm_mesh_touching_stiffness(const gm_mesh *mesh, const gm_mesh_result *result);

/**
 * Quasi-static equilibrium at one pinion angle: the smallest |x| beyond the clearance at which F(x) r_bw = torque, without
 * damping and exactly, also where the mesh has a cache. Where the force of a spur pair steps over the load (a pair with
 * pitch deviations enters), x is the place of the step and result one of its sides.
 *
 * @param[in]     mesh          the mesh
 * @param[in]     pinion_angle  phi_p (rad)
 * @param[in]     wheel_torque  load on the wheel, > 0 resists +phi_w and loads the drive flanks (N m)
 * @param[in]     guess         x to begin with, NaN = none (m). Costs or saves evaluations, and changes x by no more than
 *                              its accuracy. From one pinion angle to the next, in first order, x changes by
 *                              (r_bp + r_bw force_by.pinion_angle / force_by.wheel_angle) times the change of the angle
 * @param[in,out] workspace     as gm_mesh_evaluate()
 * @param[out]    offset        x; the transmission error is -x (m)
 * @param[out]    result        there, with GM_WANT_DERIVATIVES; may be NULL
 * @return GM_OK, GM_ERR_NULL, GM_ERR_PARAMETER (torque), GM_STATE_NOT_FINITE, GM_STATE_OUT_OF_RANGE,
 *         GM_NO_EQUILIBRIUM (simple model: x or F beyond the range of double), GM_UNDETERMINED (no torque within the
 *         backlash)
 *
 * Accuracy: x to 1e-15 of the centre distance. Cost: some 8 evaluations with derivatives, 4 from a good guess.
 */
GM_API int gm_static_equilibrium(const gm_mesh *mesh, double pinion_angle, double wheel_torque,
                                 double guess, gm_workspace *workspace, double *offset,
                                 gm_mesh_result *result);

/**
 * As gm_static_equilibrium(), while the gears roll on each other at a speed: with friction, so that wheel_torque in result
 * is the torque. Without friction the speed changes nothing.
 *
 * @param[in]     mesh          the mesh
 * @param[in]     pinion_angle  phi_p (rad)
 * @param[in]     pinion_speed  d phi_p / dt (rad/s)
 * @param[in]     wheel_torque  load on the wheel (N m)
 * @param[in]     guess         x to begin with, NaN = none (m)
 * @param[in,out] workspace     as gm_mesh_evaluate()
 * @param[out]    offset        x (m)
 * @param[out]    result        there, with GM_WANT_DERIVATIVES; may be NULL
 * @return as gm_static_equilibrium(), and GM_STATE_OUT_OF_RANGE for a speed beyond 1e9 rad/s
 */
GM_API int gm_rolling_equilibrium(const gm_mesh *mesh, double pinion_angle, double pinion_speed,
                                  double wheel_torque, double guess, gm_workspace *workspace,
                                  double *offset, gm_mesh_result *result);

/**
 * As gm_rolling_equilibrium(), under several loads at one pinion angle: the same equilibria, to the accuracy of each, with
 * less work. Helical gears with tables that reach as far to the root as contact, a constant stiffness and parallel axes,
 * without corner contact, friction and linear reliefs: three walks along the lines of contact tell of up to 32 loads at
 * once, and each takes one evaluation more. All others: each load is guessed from the one before, so that loads in order
 * save the most.
 *
 * @param[in]     mesh          the mesh
 * @param[in]     pinion_angle  phi_p (rad)
 * @param[in]     pinion_speed  d phi_p / dt, 0 at rest (rad/s)
 * @param[in]     wheel_torque  [count] loads on the wheel, in any order (N m)
 * @param[in]     count         how many, >= 0
 * @param[in]     wanted        a sum of enum gm_wanted, of the results, in which derivatives may be there without being wanted
 * @param[in,out] workspace     as gm_mesh_evaluate()
 * @param[out]    offset        [count] x; NaN where there is no equilibrium, and everywhere on an error of the call (m)
 * @param[out]    result        [count] there, likewise; may be NULL
 * @return GM_OK, or the status of the first load that has no equilibrium, see gm_rolling_equilibrium(); GM_ERR_PARAMETER
 *         too for `count` or `wanted`
 *
 * Accuracy: as gm_static_equilibrium(). Cost: docs/performance.md.
 */
GM_API int gm_rolling_equilibria(const gm_mesh *mesh, double pinion_angle, double pinion_speed,
                                 const double *wheel_torque, int count, int wanted,
                                 gm_workspace *workspace, double *offset, gm_mesh_result *result);

/** The load at one point of a line of contact. */
typedef struct gm_line_load_point {
    int side;                  /**< GM_DRIVE or GM_COAST */
    int pinion_tooth;          /**< 0 .. z_p - 1 */
    int wheel_tooth;           /**< 0 .. z_w - 1 */
    double z;                  /**< along the face (m) */
    double pinion_roll_length; /**< rho_p (m) */
    double wheel_roll_length;  /**< rho_w, of a ring above 0 too (m) */

    /** q, normal force per length of the contact line (N/m); its integral over z is the transverse force */
    double line_load;

    /** p_0 = 2 q / (pi a), largest Hertzian pressure there (N/m2); NaN under a tip edge with constant stiffness, which does
     *  not know how sharp the edge is: elastic teeth have gm_mesh_params.tip_rounding */
    double pressure;

    double gap; /**< between the surfaces, < 0 pressed into each other (m) */

    /** v, how fast the pinion's flank slides past the wheel's across the line of action, from the speeds of the position; > 0
     *  beyond the pitch point where the pinion turns forwards (m/s) */
    double sliding_speed;
} gm_line_load_point;

/** What is doubtful about a load. */
enum gm_load_warning {
    GM_WARN_LOAD_PRESSURE =
        1 << 0, /**< largest_pressure above 10 GPa, which no material bears: it would yield */
    GM_WARN_LOAD_RING =
        1 << 1 /**< elastic teeth of a ring, which are unmeasured: docs/elastic.md */
};

/** How a mesh is loaded at one position; NaN where nothing touches. */
typedef struct gm_line_loads {
    /** of all lines (N/m). With constant stiffness the largest there is, mostly between stations, exactly but for 1e-3 of
     * it beyond a tip; of elastic teeth the largest at stations, ends of lines and the edges of tips */
    double largest_line_load;

    double largest_pressure; /**< at the same places, where it is known (N/m2) */

    /** largest line load over the mean one along the lines that touch: of a single spur pair max(q) b / F */
    double face_load_factor;

    double touching_width; /**< touching part of the face, summed over all lines (m) */
    int points;            /**< how many were written */
    int warnings;          /**< sum of enum gm_load_warning; 0 = none, or nothing touches */
} gm_line_loads;

/** How many points gm_mesh_line_loads() gives at most; 0 for NULL. */
GM_API int gm_mesh_line_load_points(const gm_mesh *mesh);

/**
 * Load along the lines of contact, without damping: at the stations of the face (17 with the constant law) that a line
 * passes, in the order of sides, lines and z. With corner contact lines go on beyond the path as far as ideal edges would
 * touch: roll lengths there are that of the tip and, of the flank it touches, that of the point where it does.
 *
 * @param[in]     mesh       the mesh, not of the simple model
 * @param[in]     position   where the gears are; its speeds tell how the flanks slide
 * @param[in,out] workspace  as gm_mesh_evaluate()
 * @param[out]    points     [capacity]; NULL: not wanted
 * @param[in]     capacity   gm_mesh_line_load_points() is always enough
 * @param[out]    load       all fields; NaN and 0 on an error
 * @return as gm_mesh_evaluate_at(); GM_ERR_GEOMETRY (simple model), GM_ERR_MEMORY (more points than the capacity)
 *
 * Accuracy: elastic teeth as docs/elastic.md. Pressure of a line contact [Johnson], from E and nu of gm_mesh_params with
 * any law.
 */
GM_API int gm_mesh_line_loads(const gm_mesh *mesh, const gm_position *position,
                              gm_workspace *workspace, gm_line_load_point *points, int capacity,
                              gm_line_loads *load);

/* ---------------------------------------------------------------------------------------------
 * Double-helical pairs: two halves of opposite hand, a pinion that floats along its axis
 * ------------------------------------------------------------------------------------------- */

/**
 * Two meshes of one pair, that of gm_double_helical_half(). The first half begins at the pinion's face I and ends at the gap;
 * the second is the first in a mirror half-way along the face: t1 of its flanks runs from the outer face to the gap too. Each
 * may have flanks of its own. Stiffness and damping of each mesh are those of its half.
 *
 * The pinion floats along its axis without inertia, to where both halves carry the same force: their axial forces cancel.
 * The wheel stands. A float changes which overlap the flanks of each half have. Left out are that it moves the common faces by
 * as much, some micrometres of millimetres, its own speed in the damping, and that between tilted axes it goes along the
 * pinion's: at most float times tilt of overlap, 0.05 um for 50 um at 1 mrad (docs/equations.md).
 */
typedef struct gm_double_helical {
    const gm_mesh
        *half[2]; /**< without cache, of the same pair; in the poses of gm_double_helical_pose() */
    gm_workspace *workspace[2]; /**< of each mesh; NULL where its law needs none */
    double gap;                 /**< between the halves, >= 0 (m) */
} gm_double_helical;

/**
 * The pair of one half, for gm_pair_init(): both faces without the gap halved, ending together at the gap. The hand is that of
 * the half at the pinion's face I.
 *
 * @param[in]  whole  the drawing; axial_offset 0, since the pinion floats; not spur gears
 * @param[in]  gap    between the halves of both gears, 0 <= gap < the narrower face (m)
 * @param[out] half   the drawing of a half; as gm_pair_params_default() on an error
 * @return GM_OK, GM_ERR_NULL, GM_ERR_PARAMETER (gap), GM_ERR_GEOMETRY (too wide a gap, spur gears, an axial offset)
 */
GM_API int gm_double_helical_half(const gm_pair_params *whole, double gap, gm_pair_params *half);

/**
 * The poses of both halves, of which the second counts in its mirror, where the whole wheel has a pose: a tilt, about the
 * middle of the whole face, moves each half. Exact. The axial shift has no effect, the pinion follows it.
 *
 * @param[in]  half   the pair of a half
 * @param[in]  gap    between the halves (m)
 * @param[in]  whole  pose of the wheel
 * @param[out] pose   [2] for gm_mesh_params of each half
 * @return GM_OK, GM_ERR_NULL
 */
GM_API int gm_double_helical_pose(const gm_pair *half, double gap, const gm_pose *whole,
                                  gm_pose pose[2]);

/**
 * Both halves at one position: force, torques and what else is wanted are the sums of both, derivatives are those with the
 * pinion floating. Overlap and touching part in result->contact are means of both halves, so that the stiffness of both
 * together times them is the force; pairs are counted in each half. Damping takes dx/dt alone.
 *
 * @param[in]     gears     two meshes
 * @param[in]     position  where the gears are
 * @param[in]     wanted    a sum of enum gm_wanted
 * @param[in,out] apex      how far the pinion has floated along +z against the wheel (m). On entry where to begin, any number,
 *                          which changes nothing beyond the accuracy; it stays where nothing touches
 * @param[out]    each      [2] of the halves, with derivatives; the second as it is in its mirror. NaN on an error
 * @param[out]    result    of the pair; moments about the axes as gm_wrench says, z = 0 at the pinion's face I. NaN on an error
 * @return as gm_mesh_evaluate_at(); GM_ERR_GEOMETRY (halves of different pairs, spur gears), GM_NO_EQUILIBRIUM (no float
 *         makes the halves carry the same)
 *
 * Accuracy: both forces agree to 1e-12 p_bt of overlap. Cost: some six evaluations with derivatives from a good apex.
 * Source: docs/equations.md.
 */
GM_API int gm_double_helical_evaluate_at(const gm_double_helical *gears,
                                         const gm_position *position, int wanted, double *apex,
                                         gm_mesh_result each[2], gm_mesh_result *result);

/**
 * As gm_double_helical_evaluate_at(), with the wheel in a pose of its own at every call, see gm_mesh_evaluate_posed(): the whole
 * wheel moves beside the pose in which the halves were prepared, about the middle of its whole face. The pinion follows an
 * axial shift; its float counts against the wheel where that is.
 *
 * @param[in]     gears   two meshes, prepared in the halves of one pose
 * @param[in]     motion  where the gears are and how they move. Without pose and rate it is
 *                        gm_double_helical_evaluate_at(), to the last bit
 * @param[in]     wanted  a sum of enum gm_wanted
 * @param[in,out] apex    as gm_double_helical_evaluate_at()
 * @param[out]    each    [2] of the halves, likewise
 * @param[out]    result  of the pair, likewise; the wheel's moment about its axis where it has moved, not yet tilted
 * @return as gm_double_helical_evaluate_at(), and GM_POSE_OUT_OF_MESH; GM_STATE_OUT_OF_RANGE for rates too
 *
 * Accuracy: as gm_double_helical_evaluate_at(). Cost: that, with gm_mesh_evaluate_posed() for each half.
 * Source: docs/equations.md.
 */
GM_API int gm_double_helical_evaluate_posed(const gm_double_helical *gears, const gm_motion *motion,
                                            int wanted, double *apex, gm_mesh_result each[2],
                                            gm_mesh_result *result);

/**
 * Quasi-static equilibrium of both halves while the gears roll on each other, see gm_rolling_equilibrium().
 *
 * @param[in]     gears         two meshes
 * @param[in]     pinion_angle  phi_p (rad)
 * @param[in]     pinion_speed  d phi_p / dt (rad/s)
 * @param[in]     wheel_torque  load on the wheel, carried by both halves (N m)
 * @param[in]     guess         x to begin with, NaN = none (m)
 * @param[out]    offset        x (m); NaN on an error
 * @param[in,out] apex          as gm_double_helical_evaluate_at()
 * @param[out]    each          [2] of the halves there, with derivatives; NaN on an error
 * @param[out]    result        of the pair there, with derivatives; NaN on an error
 * @return as gm_rolling_equilibrium(), and GM_ERR_GEOMETRY as gm_double_helical_evaluate_at()
 */
GM_API int gm_double_helical_equilibrium(const gm_double_helical *gears, double pinion_angle,
                                         double pinion_speed, double wheel_torque, double guess,
                                         double *offset, double *apex, gm_mesh_result each[2],
                                         gm_mesh_result *result);

/**
 * Line loads of both halves, z as in the whole pair; see gm_mesh_line_loads(), of which this takes the points of both meshes.
 *
 * @param[in]  gears     two meshes
 * @param[in]  position  where the gears are
 * @param[in]  apex      of gm_double_helical_evaluate_at() there (m)
 * @param[out] points    [capacity] those of the first half, then those of the second; NULL: not wanted
 * @param[in]  capacity  twice gm_mesh_line_load_points() is always enough
 * @param[out] load      of both halves; NaN and 0 on an error
 * @return as gm_mesh_line_loads(), and GM_ERR_GEOMETRY as gm_double_helical_evaluate_at()
 */
GM_API int gm_double_helical_line_loads(const gm_double_helical *gears, const gm_position *position,
                                        double apex, gm_line_load_point *points, int capacity,
                                        gm_line_loads *load);

/* ---------------------------------------------------------------------------------------------
 * Cache of the 3D model, for long sweeps
 * ------------------------------------------------------------------------------------------- */

/**
 * Resolution and range of a cache; gm_cache_params_default() is for deviations and deflections of some
 * micrometres. Memory grows with phase_cells * depth_cells * tooth passes.
 */
typedef struct gm_cache_params {
    int side; /**< flanks that the cache holds, GM_DRIVE or GM_COAST; the others are exact [GM_DRIVE] */
    int phase_cells; /**< steps of the phase per base pitch, 4 .. 10000; some more at kinks, one if these are weak [16] */
    int depth_cells; /**< steps of delta, 4 .. 10000 [40] */
    double depth;    /**< range of delta from the first touch at each phase on (m),
                          1e-10 .. p_bt / 4 [20e-6] */
} gm_cache_params;

/** A cache in memory of the caller: the sums of one side of a mesh over tooth passes, phase and depth. */
typedef struct gm_cache gm_cache;

/** How far a cache is off; of the side that it holds. */
typedef struct gm_cache_errors {
    double sum_largest;     /**< of the sum, largest (m) */
    double sum_rms;         /**< root mean square (m) */
    double contact_largest; /**< of the touching fraction, largest (1) */
    double contact_rms;     /**< root mean square (1) */
} gm_cache_errors;

/** Fills in the defaults. */
GM_API void gm_cache_params_default(gm_cache_params *params);

/**
 * Bytes of memory that gm_cache_init() needs: 16 bytes for each of passes * columns * (depth_cells + 1)
 * nodes, 24 with corner contact of a constant stiffness, and some. There is one tooth pass if all teeth of a gear have the same flank, on both gears,
 * else up to z_p z_w / gcd(z_p, z_w): 27.3 MB for the 1845 of 45/41 teeth with the defaults.
 *
 * @return 0 where gm_cache_init() would refuse
 */
GM_API size_t gm_cache_size(const gm_cache_params *params, const gm_mesh *mesh);

/**
 * Prepares an empty cache in memory of the caller. Apart from 16 bytes per column the memory is not touched
 * before it is needed.
 *
 * @param[out] cache        the cache, which begins at `memory`; NULL on an error. It refers to the mesh
 * @param[in]  params       resolution and range
 * @param[in]  mesh         3D model of helical gears: the sum of spur gears jumps, and no polynomial follows that
 * @param[in]  memory       at least gm_cache_size() bytes, aligned for double
 * @param[in]  memory_size  bytes in memory
 * @return GM_OK, GM_ERR_NULL, GM_ERR_PARAMETER, GM_ERR_GEOMETRY (spur gears, or the simple model),
 *         GM_ERR_MEMORY (too little or not aligned, or more than a computer has)
 */
GM_API int gm_cache_init(gm_cache **cache, const gm_cache_params *params, const gm_mesh *mesh,
                         void *memory, size_t memory_size);

/** Tooth passes: combinations of teeth that differ; 0 for NULL. */
GM_API int gm_cache_passes(const gm_cache *cache);

/**
 * Fills a range of tooth passes (0 .. gm_cache_passes() - 1) up front. Several threads may fill disjoint
 * ranges at once, each with a workspace of its own where the law needs one. After all are filled nothing writes to the
 * cache any more, and any number of threads may evaluate with it.
 *
 * @return GM_OK, GM_ERR_NULL, GM_ERR_PARAMETER (no such passes)
 */
GM_API int gm_cache_fill(gm_cache *cache, int first_pass, int count, gm_workspace *workspace);

/**
 * Lets a mesh answer from a cache of its own sums, approximately and much faster; NULL: exactly again. What a position
 * needs is filled on first use: **until gm_cache_fill() has filled all passes, mesh and cache belong to one thread.**
 *
 * Sum and derivatives come from one bicubic polynomial per cell, through exact values and slopes at the
 * corners, so that they agree with each other: continuous together with the derivatives, but where the
 * sum reaches zero. The touching fraction is taken as the derivative by x, from which it differs by the
 * slope of the flanks (some um per mm); rates follow from it.
 *
 * A mesh with friction answers exactly, whatever its cache. Never extrapolates: beyond its depth, for teeth that the pair as assembled never brings together, and for
 * a phase outside [0, p_bt] the mesh evaluates exactly, and so it does for a wrench and for the numbers of pairs,
 * which are -1 where the cache answered. Where nothing touches, the sum is exactly 0.
 *
 * Accuracy for the reference pair and flanks of data/paper/ with the defaults, under 1 to 40 N m: sum
 * 2.5e-4 root mean square and 4e-3 at most of its mean under 20 N m (4.9 um); touching fraction (1.3 of
 * it on average) 0.01 and 0.15. libgearmesh/docs/cache.md has other resolutions, gm_cache_error()
 * measures any pair. Cost: about 780 instructions, and about 11 exact evaluations for a column (one
 * phase of one tooth pass) that is met for the first time.
 *
 * @return GM_OK, GM_ERR_NULL (no mesh), GM_ERR_PARAMETER (the cache is of another mesh)
 */
GM_API int gm_mesh_use_cache(gm_mesh *mesh, gm_cache *cache);

/**
 * Measures the error against the exact evaluation in random states, uniform over tooth passes, phase and
 * depth. Fills what it meets.
 *
 * @param[in,out] cache   the cache
 * @param[in]     states  how many, > 0
 * @param[in]     seed    same seed, same states
 * @param[in,out] workspace  as gm_mesh_evaluate()
 * @param[out]    errors  NaN on an error
 * @return GM_OK, GM_ERR_NULL, GM_ERR_PARAMETER
 */
GM_API int gm_cache_error(gm_cache *cache, int states, unsigned seed, gm_workspace *workspace,
                          gm_cache_errors *errors);

#ifdef __cplusplus
}
#endif

#endif /* GEARMESH_H */
