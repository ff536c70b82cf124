/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* apps/gearsim/drive.c: a speed linear in time, or a torque. */
#include "drive.h"

#include "gm_test.h"

static void speed_is_linear_and_angle_its_integral(void) {
    const config conf = {
        .drive = DRIVE_SPEED, .start_speed = 10.0, .end_speed = 1000.0, .duration = 60.0};
    const pinion_drive drive = drive_create(&conf);

    /* Closed form: 10 t + 8.25 t^2. */
    const double times[] = {0.0, 0.5, 30.0, 60.0, 61.0};
    for (size_t i = 0; i < sizeof times / sizeof times[0]; ++i) {
        const double t = times[i];
        const drive_motion motion = drive_at(&drive, t);
        GM_ASSERT_REL(motion.speed, 10.0 + 16.5 * t, 1e-15 * 4);
        GM_ASSERT_REL(motion.angle, 10.0 * t + 8.25 * t * t, 1e-15 * 4);
    }
    GM_ASSERT(drive.torque == 0.0);
}

static void a_torque_prescribes_no_acceleration(void) {
    const config conf = {
        .drive = DRIVE_TORQUE, .start_speed = 5.0, .end_speed = 77.0, .drive_torque = 21.0};
    const pinion_drive drive = drive_create(&conf);

    GM_ASSERT(drive.acceleration == 0.0);
    GM_ASSERT(drive.torque == 21.0);
    GM_ASSERT(drive.start_speed == 5.0);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(speed_is_linear_and_angle_its_integral),
        GM_TEST(a_torque_prescribes_no_acceleration),
    };
    return gm_test_main("gearsim.drive", tests, GM_TEST_COUNT(tests), argc, argv);
}
