/* SPDX-FileCopyrightText: The gearmesh authors */
/* SPDX-License-Identifier: BSD-3-Clause */

/* apps/gearsim/drive.c: a speed linear in time, or a torque. */
#include "drive.h"

#include "gm_test.h"

static void speed_is_linear_and_angle_its_integral(void) {
    const config conf = {
        .drive = DRIVE_SPEED, .start_speed = 10.0, .end_speed = 1000.0, .duration = 60.0};
    pinion_drive drive;
    GM_ASSERT_INT(drive_create(&drive, &conf), 0);

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
    pinion_drive drive;
    GM_ASSERT_INT(drive_create(&drive, &conf), 0);

    GM_ASSERT(drive.acceleration == 0.0);
    GM_ASSERT(drive.torque == 21.0);
    GM_ASSERT(drive.start_speed == 5.0);
}

/* At constant speed w the sine of order n turns the pinion by A / (n w) (cos(phase) - cos(n w t + phase)). */
static void ripple_of_a_speed_follows_the_angle_without_it(void) {
    const double rad_per_s = 3.14159265358979323846 / 30.0;
    const config conf = {.drive = DRIVE_SPEED,
                         .start_speed = -90.0,
                         .end_speed = -90.0,
                         .duration = 10.0,
                         .drive_ripple = {2, {{2.0, 30.0, 0.5}, {0.5, 12.0, -2.0}}}};
    pinion_drive drive;
    GM_ASSERT_INT(drive_create(&drive, &conf), 0);

    /* Forwards, then back beyond all that is kept. */
    for (int i = 0; i < 400; ++i) {
        const double t = i < 300 ? i * 0.0333 : (400 - i) * 0.01;
        const double angle = -90.0 * t;
        double speed = -90.0, turned = angle, acceleration = 0.0;
        for (int k = 0; k < 2; ++k) {
            const harmonic *h = &conf.drive_ripple.harmonics[k];
            const double a = h->amplitude * rad_per_s, rate = h->order * -90.0;
            speed += a * sin(h->order * angle + h->phase);
            acceleration += a * rate * cos(h->order * angle + h->phase);
            turned += a / rate * (cos(h->phase) - cos(h->order * angle + h->phase));
        }
        const drive_motion motion = drive_at(&drive, t);
        gm_test_context("t = %g", t);
        GM_ASSERT_ABS(motion.speed, speed, 1e-13);
        GM_ASSERT_ABS(motion.angle, turned, 1e-12); /* the rounding of 900 rad */
        GM_ASSERT_ABS(drive_acceleration(&drive, t), acceleration, 1e-10);
    }
    GM_ASSERT(!drive_is_linear(&drive));
    drive_free(&drive);
}

/* Through zero speed. Simpson's rule is off by h^4 / 180 of the fourth derivative, 2 (7.5 300)^4, in a wave: 5e-11. */
static void angle_is_the_integral_of_the_speed(void) {
    const config conf = {.drive = DRIVE_SPEED,
                         .start_speed = 100.0,
                         .end_speed = -300.0,
                         .duration = 2.0,
                         .drive_ripple = {2, {{3.0, 50.0, 0.0}, {7.5, 20.0, 1.0}}}};
    const double h = 2e-5;
    double sum = 0.0;
    pinion_drive drive;
    GM_ASSERT_INT(drive_create(&drive, &conf), 0);

    for (int i = 0; i < 50000; ++i) {
        const double t = 2.0 * h * i;
        sum += h / 3.0 *
               (drive_at(&drive, t).speed + 4.0 * drive_at(&drive, t + h).speed +
                drive_at(&drive, t + 2.0 * h).speed);
        GM_ASSERT_ABS(drive_at(&drive, t + 2.0 * h).angle, sum, 1e-10);
    }
    drive_free(&drive);
}

/* However the motion goes on, the acceleration changes by the bound times the time at most. */
static void acceleration_changes_less_than_its_bound(void) {
    const config conf = {.drive = DRIVE_SPEED,
                         .start_speed = 100.0,
                         .end_speed = 300.0,
                         .duration = 1.0,
                         .drive_ripple = {2, {{3.0, 50.0, 0.0}, {7.5, 20.0, 1.0}}}};
    double steepest = 0.0;
    pinion_drive drive;
    GM_ASSERT_INT(drive_create(&drive, &conf), 0);

    const double bound = drive_jerk(&drive, 0.3);
    for (double t = 0.0; t < 1.0; t += 1e-5) {
        const double change = drive_acceleration(&drive, t + 1e-5) - drive_acceleration(&drive, t);
        steepest = fmax(steepest, fabs(change) * 1e5);
    }
    GM_ASSERT(steepest < bound);
    GM_ASSERT(steepest > 0.5 * bound); /* both sines together, at the highest speed */
    drive_free(&drive);
}

int main(int argc, char **argv) {
    static const gm_test tests[] = {
        GM_TEST(speed_is_linear_and_angle_its_integral),
        GM_TEST(a_torque_prescribes_no_acceleration),
        GM_TEST(ripple_of_a_speed_follows_the_angle_without_it),
        GM_TEST(angle_is_the_integral_of_the_speed),
        GM_TEST(acceleration_changes_less_than_its_bound),
    };
    return gm_test_main("gearsim.drive", tests, GM_TEST_COUNT(tests), argc, argv);
}
