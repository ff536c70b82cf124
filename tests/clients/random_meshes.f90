! SPDX-FileCopyrightText: The gearmesh authors
! SPDX-License-Identifier: BSD-3-Clause

! The meshes of random_meshes.py from Fortran, with what random_meshes.c prints of them.
!
!     random_meshes_fortran MESHES.txt
program random_meshes
    use gearmesh
    use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
    implicit none
    integer, parameter :: tables = 3
    integer :: unit, meshes, states, mesh, state
    character(1000) :: path
    real(c_double) :: gap
    type(c_ptr) :: half(2), workspace(2)
    type(gm_pair) :: pair

    call get_command_argument(1, path)
    open (newunit=unit, file=trim(path), status='old', action='read')
    read (unit, *) meshes
    do mesh = 1, meshes
        call read_mesh()
        read (unit, *) states
        do state = 1, states
            call evaluate_state()
        end do
    end do

contains

    !> The memory lives as long as the program.
    function memory_of(size) result(memory)
        integer(c_size_t), intent(in) :: size
        type(c_ptr) :: memory
        real(c_double), pointer :: numbers(:)
        allocate (numbers(size / 8 + 1))
        memory = c_loc(numbers)
    end function

    !> The same table for all teeth and both sides.
    function flanks_of(teeth, rows, columns, table) result(flanks)
        integer(c_int), intent(in) :: teeth
        integer, intent(in) :: rows, columns
        real(c_double), intent(in) :: table(:)
        type(c_ptr) :: flanks
        type(gm_flanks_params) :: params
        integer(c_size_t) :: size
        integer(c_int) :: side
        flanks = c_null_ptr
        if (rows == 0) return
        params = gm_flanks_params(teeth, 1, rows, columns, 1, rows, columns)
        size = gm_flanks_size(params)
        call check(gm_flanks_init(flanks, params, memory_of(size), size))
        do side = GM_DRIVE, GM_COAST
            call check(gm_flanks_set_table(flanks, side, GM_ALL_TEETH, table, pair%normal_to_transverse))
        end do
    end function

    subroutine read_mesh()
        type(gm_pair_params) :: p, drawing
        type(gm_mesh_params) :: l
        type(gm_pose) :: poses(2)
        type(gm_pose) :: whole
        integer :: count, rows, columns, halves, k
        integer(c_size_t) :: size
        real(c_double), allocatable :: table(:, :)

        ! In the order of the header.
        call gm_pair_params_default(p)
        call gm_mesh_params_default(l)
        read (unit, *) gap
        read (unit, *) count, p%pinion_teeth, p%wheel_teeth, p%base_helix, p%normal_module, p%normal_pressure_angle, &
            p%helix_angle, p%center_distance, p%face_width, p%pinion_face_width, p%wheel_face_width, p%axial_offset, &
            p%pinion_profile_shift, p%wheel_profile_shift, p%backlash, p%pinion_normal_thickness, &
            p%wheel_normal_thickness, p%pinion_rack_addendum, p%wheel_rack_addendum, p%pinion_rack_dedendum, &
            p%wheel_rack_dedendum, p%pinion_rack_fillet_radius, p%wheel_rack_fillet_radius, p%pinion_tip_alteration, &
            p%wheel_tip_alteration, p%pinion_tip_radius, p%wheel_tip_radius, p%pinion_start_radius, p%wheel_start_radius
        read (unit, *) count, l%model, l%law, l%stiffness, l%iso_blank_factor, l%damping, l%simple_stiffness, &
            l%pose%center_distance_change, l%pose%offset, l%pose%axial_shift, l%pose%skew, l%pose%inclination, &
            l%pinion_youngs_modulus, l%wheel_youngs_modulus, l%pinion_poisson_ratio, l%wheel_poisson_ratio, &
            l%pinion_bore_radius, l%wheel_bore_radius, l%reference_torque, l%stations, l%corner_contact, l%tip_rounding, &
            l%friction_law, l%friction_coefficient, l%friction_speed, l%oil_viscosity, l%roughness
        read (unit, *) rows, columns
        allocate (table(rows * columns, tables), source=0.0_c_double)
        if (rows > 0) read (unit, *) table
        table = 1e-6_c_double * table

        drawing = p
        halves = merge(1, 2, ieee_is_nan(gap))
        if (halves == 2) call check(gm_double_helical_half(p, gap, drawing))
        call check(gm_pair_init(pair, drawing))
        whole = l%pose
        poses = whole
        if (halves == 2) then
            call check(gm_double_helical_pose(pair, gap, whole, poses))
            l%stiffness = 0.5_c_double * l%stiffness
            l%damping = 0.5_c_double * l%damping
            l%simple_stiffness = 0.5_c_double * l%simple_stiffness
            l%reference_torque = 0.5_c_double * l%reference_torque
        end if
        do k = 1, halves
            l%pose = poses(k)
            size = gm_mesh_size(l, pair)
            call check(gm_mesh_init(half(k), l, pair, &
                flanks_of(pair%pinion%teeth, rows, columns, table(:, merge(3, 1, k == 2))), &
                flanks_of(pair%wheel%teeth, rows, columns, table(:, 2)), memory_of(size), size))
            size = gm_workspace_size(half(k))
            call check(gm_workspace_init(workspace(k), half(k), memory_of(size), size))
        end do
    end subroutine

    subroutine evaluate_state()
        type(gm_state) :: at
        type(gm_motion) :: motion
        type(gm_mesh_result) :: each(2), found
        type(gm_double_helical) :: gears
        type(gm_tangent) :: tangent
        real(c_double) :: apex
        integer(c_int) :: status, wanted
        integer :: k

        read (unit, *) at%pinion_angle, at%wheel_angle, at%pinion_speed, at%wheel_speed
        read (unit, *) motion%pose%center_distance_change, motion%pose%offset, motion%pose%axial_shift, motion%pose%skew, &
            motion%pose%inclination
        read (unit, *) motion%pose_rate%center_distance_change, motion%pose_rate%offset, motion%pose_rate%axial_shift, &
            motion%pose_rate%skew, motion%pose_rate%inclination
        call check(gm_position_from_state(pair, at, motion%position))
        wanted = ior(GM_WANT_DERIVATIVES, GM_WANT_WRENCH)
        apex = 0
        if (ieee_is_nan(gap)) then
            status = gm_mesh_evaluate_posed(half(1), motion, wanted, workspace(1), found)
        else
            gears%half = half
            gears%workspace = workspace
            gears%gap = gap
            status = gm_double_helical_evaluate_at(gears, motion%position, wanted, apex, each, found)
        end if

        write (*, '(i0)', advance='no') status
        call print_bits([found%force, found%pinion_torque, found%wheel_torque, found%loss, found%force_by%pinion_angle, &
            found%force_by%wheel_angle, found%force_by%pinion_speed, found%force_by%wheel_speed])
        call print_bits([found%wrench%pinion_force, found%wrench%pinion_moment, found%wrench%wheel_force, &
            found%wrench%wheel_moment, apex])

        ! The tangent of laws that have one; else 0.
        status = 1
        if (ieee_is_nan(gap)) status = gm_mesh_tangent(half(1), motion, tangent)
        if (status == GM_OK) then
            call print_bits([tangent%force_by, tangent%force_by_rate])
            call print_bits([(tangent%wrench_by(k)%wheel_moment, k=1, GM_COORDINATES)])
        else
            call print_bits([(0.0_c_double, k=1, 5 * GM_COORDINATES)])
        end if
        write (*, *)
    end subroutine

    subroutine print_bits(values)
        real(c_double), intent(in) :: values(:)
        integer :: k
        do k = 1, size(values)
            if (ieee_is_nan(values(k))) then
                write (*, '(a)', advance='no') ' NaN'
            else
                write (*, '(1x, z16.16)', advance='no') transfer(values(k), 0_c_int64_t)
            end if
        end do
    end subroutine

    subroutine check(status)
        integer(c_int), intent(in) :: status
        if (status /= GM_OK) error stop gm_text(gm_status_text(status))
    end subroutine
end program
