! SPDX-FileCopyrightText: The gearmesh authors
! SPDX-License-Identifier: BSD-3-Clause

! The oscillator of oscillator.h from Fortran, by the classic Runge-Kutta method of fourth order.
program rk4
    use gearmesh
    implicit none
    real(c_double), parameter :: inertia = 2.1e-3_c_double, load = 20, speed = 139.62634_c_double, end_time = 5e-3_c_double
    integer, parameter :: steps = 20000
    real(c_double), parameter :: h = end_time / steps

    type(gm_pair_params) :: params
    type(gm_pair) :: pair
    type(gm_mesh_params) :: law
    type(c_ptr) :: mesh
    real(c_double), target :: memory(512)
    real(c_double) :: state(2), k1(2), k2(2), k3(2), k4(2), time
    integer :: step

    call gm_pair_params_default(params)
    params%pinion_teeth = 45
    params%wheel_teeth = 41
    params%normal_module = 1.65e-3_c_double
    params%normal_pressure_angle = 0.279252680_c_double
    params%helix_angle = 0.575958653_c_double
    params%center_distance = 0.085_c_double
    params%face_width = 0.0175_c_double
    params%backlash = 100e-6_c_double
    call check(gm_pair_init(pair, params))

    ! Ideal flanks; the mesh is prepared in memory of the program.
    call gm_mesh_params_default(law)
    law%stiffness = 1.05e8_c_double
    call check(gm_mesh_init(mesh, law, pair, c_null_ptr, c_null_ptr, c_loc(memory), c_sizeof(memory)))

    state = [52e-6_c_double, 0.0_c_double]
    do step = 0, steps - 1
        time = step * h
        k1 = motion(time, state)
        k2 = motion(time + h / 2, state + h / 2 * k1)
        k3 = motion(time + h / 2, state + h / 2 * k2)
        k4 = motion(time + h, state + h * k3)
        state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    end do
    print '(a, f0.9, a, f0.6, a)', 'x ', 1e6 * state(1), ' um, dx/dt ', 1e3 * state(2), ' mm/s'

contains

    !> d/dt of x and dx/dt.
    function motion(time, state) result(derivative)
        real(c_double), intent(in) :: time, state(2)
        real(c_double) :: derivative(2)
        type(gm_position) :: position
        type(gm_mesh_result) :: result

        call check(gm_position_from_pinion_angle(pair, speed * time, state(1), state(2), position))
        call check(gm_mesh_evaluate_at(mesh, position, GM_WANT_FORCE, c_null_ptr, result))
        derivative = [state(2), (load - result%wheel_torque) * pair%wheel%base_radius / inertia]
    end function

    subroutine check(status)
        integer(c_int), intent(in) :: status
        if (status /= GM_OK) error stop gm_text(gm_status_text(status))
    end subroutine
end program
