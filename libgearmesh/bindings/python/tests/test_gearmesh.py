# SPDX-FileCopyrightText: The gearmesh authors
# SPDX-License-Identifier: BSD-3-Clause
"""The Python package against the headers, against gearsim, and against what must hold."""
import pathlib
import pickle
import runpy
import threading

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import gearmesh

ROOT = pathlib.Path(__file__).resolve().parents[4]
EXAMPLE = ROOT / "data" / "example"

DRAWING = {"pinion_teeth": 45, "wheel_teeth": 41, "normal_module": 1.65e-3, "normal_pressure_angle": 0.279252680,
           "helix_angle": 0.575958653, "center_distance": 0.085, "face_width": 0.0175, "backlash": 100e-6}
LAW = {"stiffness": 1.05e8, "damping": 844.0}


@pytest.fixture(name="pair")
def fixture_pair():
    return gearmesh.Pair(**DRAWING)


@pytest.fixture(name="mesh")
def fixture_mesh(pair):
    return gearmesh.Mesh(pair, **LAW)


def states_about_contact(pair, count, seed=1):
    """Angles and speeds at random whose drive flanks touch."""
    random = np.random.default_rng(seed)
    pinion_angle = random.uniform(-50.0, 50.0, count)
    offset = random.uniform(51e-6, 60e-6, count)
    wheel_angle = (pair.pinion.base_radius * pinion_angle - offset) / pair.wheel.base_radius
    return pinion_angle, wheel_angle, random.uniform(-1.0, 1.0, count), random.uniform(-1.0, 1.0, count)


# ----------------------------------------------------------------------------------------------------
# Pair
# ----------------------------------------------------------------------------------------------------


def test_pair_has_what_follows_from_the_drawing(pair):
    module = DRAWING["normal_module"] / np.cos(DRAWING["helix_angle"])
    pressure_angle = np.arctan(np.tan(DRAWING["normal_pressure_angle"]) / np.cos(DRAWING["helix_angle"]))
    assert pair.wheel.base_radius == pytest.approx(41 * module / 2 * np.cos(pressure_angle), rel=1e-14)
    assert pair.backlash == pytest.approx(100e-6, rel=1e-10)
    assert pair.pinion.teeth == 45
    assert len(pair.phase_origin) == 2


def test_pair_names_the_parameter_at_fault():
    with pytest.raises(gearmesh.Error, match=r"normal_module: must be .*got -1\.0"):
        gearmesh.Pair(**{**DRAWING, "normal_module": -1.0})
    with pytest.raises(gearmesh.Error, match="wheel_width: no such parameter"):
        gearmesh.Pair(**DRAWING, wheel_width=1.0)
    with pytest.raises(gearmesh.Error, match="pinion_teeth: must be a number"):
        gearmesh.Pair(**{**DRAWING, "pinion_teeth": 45.5})
    with pytest.raises(gearmesh.Error, match="base_helix: must be one of iso, paper"):
        gearmesh.Pair(**DRAWING, base_helix="oblique")


def test_pair_cannot_be_changed_after_it_was_derived(pair):
    with pytest.raises(AttributeError):
        pair.backlash = 0.0


def test_pair_warns_as_the_library_does():
    assert "pinion_undercut" in gearmesh.Pair(**{**DRAWING, "pinion_teeth": 5, "wheel_teeth": 81}).warnings


def test_documentation_of_parameters_comes_from_the_header():
    text = pathlib.Path(gearmesh._records.__file__).read_text(encoding="utf-8")
    assert "alpha_n, rad, 0 < alpha_n < 45 deg, required" in text


# ----------------------------------------------------------------------------------------------------
# Mesh
# ----------------------------------------------------------------------------------------------------


def test_force_is_that_of_the_program_in_the_readme(mesh):
    result = mesh.evaluate(1.25e-3, 0.0, 0.01, want="derivatives")
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert f"force {result.force:.2f} N, by pinion angle {result.force_by.pinion_angle:.4g} N/rad, " in readme


def test_arrays_give_the_bits_of_single_calls(pair, mesh):
    states = states_about_contact(pair, 50)
    together = mesh.evaluate(*states, want=["derivatives", "wrench", "pairs"])
    for index, state in enumerate(zip(*states)):
        alone = mesh.evaluate(*state, want=["derivatives", "wrench", "pairs"])
        assert alone.tobytes() == together[index].tobytes()
    assert together.wrench.pinion_moment.shape == (50, 3)


def test_arguments_broadcast_and_what_is_not_wanted_is_nan(mesh):
    result = mesh.evaluate(np.zeros((3, 1)), np.linspace(-1e-3, 1e-3, 4))
    assert result.shape == (3, 4)
    assert result.force.dtype == float
    assert np.isnan(result.force_by.pinion_angle).all()


def test_the_force_is_the_slope_of_the_energy(mesh):
    offsets = np.linspace(20e-6, 70e-6, 1001)  # ideal flanks: apart, and then pressed together
    result = mesh.evaluate_offset(0.01, offsets, want="energy")
    assert np.isnan(mesh.evaluate_offset(0.01, offsets).energy).all()
    assert (result.energy[result.force == 0] == 0).all() and result.energy[-1] > 0
    slope = np.gradient(result.energy, offsets)
    # Lines end with the overlap: 1e-3 of the force, as the overlap is to the length of the path.
    assert slope[1:-1] == pytest.approx(result.force[1:-1], rel=0.01, abs=0.002 * result.force.max())


def test_results_go_where_an_earlier_call_put_them(pair, mesh):
    states = states_about_contact(pair, 20)
    coordinates = states[0], np.full(20, 54e-6)
    place = mesh.evaluate(*states, want="derivatives")
    for call, arguments in ((mesh.evaluate, states), (mesh.evaluate_offset, coordinates)):
        expected = call(*arguments)
        place.force = -1.0
        assert call(*arguments, out=place) is place
        assert place.tobytes() == expected.tobytes()

    for wrong in (place[:10], place[::-1], np.empty(20), mesh.evaluate(0.0, 0.0), place.tolist()):
        with pytest.raises(gearmesh.Error, match=r"out: must be what an earlier call returned, of the shape \[20\]"):
            mesh.evaluate(*states, out=wrong)


def test_derivatives_agree_with_differences(pair, mesh):
    states = np.array(states_about_contact(pair, 40))
    result = mesh.evaluate(*states, want="derivatives")
    step = 1e-9
    for row, name in enumerate(("pinion_angle", "wheel_angle")):
        ahead, behind = states.copy(), states.copy()
        ahead[row] += step
        behind[row] -= step
        slope = (mesh.evaluate(*ahead).force - mesh.evaluate(*behind).force) / (2 * step)
        # 1e-9 rad moves flanks by 4e-11 m; a kink within that is rare, and rounding of 50 rad is worth 1e-5 of the step.
        assert np.median(np.abs(slope / result.force_by[name] - 1)) < 1e-4


def test_offset_is_the_same_state_as_the_angles(pair, mesh):
    pinion_angle, wheel_angle, pinion_speed, wheel_speed = states_about_contact(pair, 40)
    r_bp, r_bw = pair.pinion.base_radius, pair.wheel.base_radius
    direct = mesh.evaluate(pinion_angle, wheel_angle, pinion_speed, wheel_speed)
    reduced = mesh.evaluate_offset(pinion_angle, r_bp * pinion_angle - r_bw * wheel_angle,
                                   r_bp * pinion_speed - r_bw * wheel_speed)
    assert reduced.force == pytest.approx(direct.force, rel=1e-6)


def test_static_equilibrium_carries_the_torque(pair, mesh):
    angle, torque = np.linspace(0, 1, 30)[:, None], np.array([10.0, 40.0])
    static = mesh.static(angle, torque)
    assert static.offset.shape == (30, 2)
    assert static.result.force * pair.wheel.base_radius == pytest.approx(np.broadcast_to(torque, (30, 2)), rel=1e-9)
    assert mesh.static(0.5, 10.0).offset == pytest.approx(mesh.static([0.4, 0.5], 10.0).offset[1], abs=1e-15)


def test_friction_comes_with_the_speed_of_the_pinion(pair):
    rough = gearmesh.Mesh(pair, **LAW, friction_coefficient=0.08)
    halves = gearmesh.DoubleHelical(gearmesh.Pair.half(1e-3, **{**DRAWING, "face_width": 36e-3}), 1e-3, **LAW, friction_coefficient=0.08)
    angle, speed = np.linspace(0, 0.14, 8), 100.0
    for gears in (rough, halves):
        rolls, stands = gears.static(angle, 20.0, speed), gears.static(angle, 20.0)
        assert rolls.result.wheel_torque == pytest.approx(20.0, rel=1e-9)
        assert (rolls.result.loss > 0.01).all() and (stands.result.loss == 0).all()
        assert np.abs(rolls.offset - stands.offset).max() > 1e-9

        # What the pinion gives goes into the wheel and into heat.
        found = gears.evaluate_offset(angle, rolls.offset, 0.0, speed)
        result = getattr(found, "result", found)
        power = result.pinion_torque * speed - result.wheel_torque * speed * pair.pinion.base_radius / pair.wheel.base_radius
        assert result.loss == pytest.approx(power, rel=1e-6)
        assert result.loss == pytest.approx(rolls.result.loss, rel=1e-6)


def test_refused_states_are_nan_and_the_others_are_not(mesh):
    result = mesh.evaluate([1.25e-3, np.nan, 1.25e-3, 1.0], [0.0, 0.0, 0.0, 0.0], want="wrench")
    assert np.isnan(result.force).tolist() == [False, True, False, True]
    assert np.isnan(result.wrench.pinion_force[:, 0]).tolist() == [False, True, False, True]
    assert np.isnan(mesh.evaluate_offset([0.0, 1e12, 0.0], [1e-6, 1e-6, 1.0]).force).tolist() == [False, True, True]
    assert np.isnan(mesh.static(0.0, [10.0, 0.0, 10.0]).offset).tolist() == [False, True, False]


def test_calls_at_fault_are_told(mesh):
    with pytest.raises(gearmesh.Error, match="must be one of force, derivatives"):
        mesh.evaluate(0.0, 0.0, want="torque")
    with pytest.raises(TypeError, match="angle"):
        mesh.evaluate(0.0, 0.0, angle=1.0)


def test_mesh_names_the_parameter_at_fault(pair):
    with pytest.raises(gearmesh.Error, match="stiffness: must be .*got nan"):
        gearmesh.Mesh(pair)
    with pytest.raises(gearmesh.Error, match="they do not mesh"):
        gearmesh.Mesh(pair, **LAW, pose={"skew": 1.0})


def test_pose_of_the_mesh_shifts_the_error_as_an_involute_does(pair):
    # A wheel that moves by dx along the line of centres opens the drive gap by dx sin(alpha_wt), to first order.
    change = 1e-6
    posed = gearmesh.Mesh(pair, **LAW, pose={"center_distance_change": change})
    plain = gearmesh.Mesh(pair, **LAW)
    difference = np.mean(posed.static(np.linspace(0, 0.14, 50), 20.0).offset - plain.static(np.linspace(0, 0.14, 50), 20.0).offset)
    assert difference == pytest.approx(change * np.sin(pair.working_pressure_angle), rel=1e-2)


def test_pose_of_a_call_is_that_of_a_mesh(pair, mesh):
    states = states_about_contact(pair, 20)
    pose = {"center_distance_change": 3e-6, "skew": 1e-4}
    posed = gearmesh.Mesh(pair, **LAW, pose=pose).evaluate(*states, want="wrench")
    called = mesh.evaluate(*states, want="wrench", pose=pose)
    assert called.force == pytest.approx(posed.force, rel=1e-9)
    assert called.wrench.wheel_moment == pytest.approx(posed.wrench.wheel_moment, rel=1e-9, abs=1e-9)

    # One pose for each state, and a wheel that moves away is a mesh that opens: it damps.
    each = mesh.evaluate(*states, pose={"skew": np.linspace(0, 1e-4, 20)})
    assert each.force[0] == mesh.evaluate(*(state[0] for state in states)).force
    assert each.force[-1] == mesh.evaluate(*(state[-1] for state in states), pose={"skew": 1e-4}).force
    assert (mesh.evaluate(*states, pose_rate={"center_distance_change": 1e-3}).force < mesh.evaluate(*states).force).all()
    with pytest.raises(TypeError, match="no such argument: tilt"):
        mesh.evaluate(*states, pose={"tilt": 1.0})


def test_tangent_is_that_of_differences(mesh):
    angle, pose = np.array([1.30e-3, 1.35e-3]), {"center_distance_change": 1e-6, "skew": 2e-5}
    tangent = mesh.tangent(angle, 0.0, 0.01, pose=pose)
    assert tangent.force_by.shape == (2, 7)

    def at(more):
        return mesh.evaluate(angle, 0.0, 0.01, want="wrench", pose={**pose, "skew": 2e-5 + more})

    ahead, behind, skew = at(1e-8), at(-1e-8), gearmesh.lib.GM_SKEW
    assert tangent.force_by[:, skew] == pytest.approx((ahead.force - behind.force) / 2e-8, rel=1e-4)
    moments = (ahead.wrench.wheel_moment - behind.wrench.wheel_moment) / 2e-8
    assert tangent.wrench_by["wheel_moment"][:, skew] == pytest.approx(moments, rel=1e-3, abs=1e-4 * np.abs(moments).max())
    assert np.isnan(mesh.tangent(np.nan, 0.0).force_by).all()


def test_bodies_get_the_torques_of_the_angles_and_balance_each_other(pair, mesh):
    pinion_angle, wheel_angle, pinion_speed, wheel_speed = states_about_contact(pair, 30)

    def about_z(angle):
        c, s, zero, one = np.cos(angle), np.sin(angle), np.zeros_like(angle), np.ones_like(angle)
        return np.stack([np.stack([c, -s, zero], -1), np.stack([s, c, zero], -1), np.stack([zero, zero, one], -1)], -2)

    # In a frame that is turned and moved against that of the drawing; the wheel turns clockwise.
    frame, origin, middle = about_z(np.array(0.7)), np.array([1.0, 2.0, 3.0]), np.array([0.0, 0.0, pair.face_width / 2])
    z = np.array([0.0, 0.0, 1.0])
    pinion = {"position": origin + frame @ middle, "rotation": frame @ about_z(pinion_angle), "velocity": np.zeros(3),
              "angular_velocity": pinion_speed[:, None] * z}
    wheel = {"position": origin + frame @ (middle + [pair.center_distance, 0, 0]), "rotation": frame @ about_z(-wheel_angle),
             "velocity": np.zeros(3), "angular_velocity": -wheel_speed[:, None] * z}
    found = mesh.evaluate_bodies(pinion, wheel)
    expected = mesh.evaluate(pinion_angle, wheel_angle, pinion_speed, wheel_speed)
    # Angles of 50 rad come back from a matrix with a few 1e-15, worth 1e-8 of 5 um.
    assert -found.pinion_moment[:, 2] == pytest.approx(expected.pinion_torque, rel=1e-6)
    assert -found.wheel_moment[:, 2] == pytest.approx(expected.wheel_torque, rel=1e-6)

    # Force and moment of both together are none, about any point.
    force = np.linalg.norm(found.pinion_force, axis=1)
    assert found.pinion_force + found.wheel_force == pytest.approx(0, abs=1e-9 * force.max())
    total = (found.pinion_moment + found.wheel_moment + np.cross(pinion["position"], found.pinion_force) +
             np.cross(wheel["position"], found.wheel_force))
    assert total == pytest.approx(0, abs=1e-8 * force.max())
    with pytest.raises(TypeError, match="missing: rotation, velocity, angular_velocity"):
        mesh.evaluate_bodies({"position": np.zeros(3)}, wheel)
    with pytest.raises(gearmesh.Error, match=r"position: must have the shape \[..., 3\]"):
        mesh.evaluate_bodies({**pinion, "position": 1.0}, wheel)


def test_line_loads_are_uniform_with_a_constant_stiffness_and_add_up_to_the_force(pair, mesh):
    offset = mesh.static(0.1, 20.0).offset
    load, points = mesh.line_loads(0.1, offset)
    force = mesh.evaluate_offset(0.1, offset).force
    # The overlap of ideal flanks is the same all along the lines; its integral over z is the force.
    assert load.face_load_factor == pytest.approx(1.0, rel=1e-12)
    assert points.line_load == pytest.approx(load.largest_line_load, rel=1e-12)
    assert load.largest_line_load * load.touching_width == pytest.approx(force, rel=1e-9)
    assert set(points.side) == {0}
    # rho_p + rho_w is the line of action.
    assert points.pinion_roll_length + points.wheel_roll_length == pytest.approx(pair.line_of_action, rel=1e-3)

    # Flanks slide by how far they are from the pitch point.
    pinion, wheel = pair.pinion.base_radius, pair.wheel.base_radius
    from_pitch_point = points.pinion_roll_length - pinion * np.tan(pair.working_pressure_angle)
    assert np.all(points.sliding_speed == 0.0)
    points = mesh.line_loads(0.1, offset, 50.0).points
    assert points.sliding_speed == pytest.approx(50.0 * (1.0 + pinion / wheel) * from_pitch_point, rel=1e-12)

    # Beside each other and out of range.
    assert np.isnan(mesh.line_loads(0.1, 0.0).load.largest_line_load)
    assert len(mesh.line_loads(0.1, 1.0).points) == 0
    with pytest.raises(gearmesh.Error):
        gearmesh.Mesh(pair, model="simple", **LAW).line_loads(0.1, offset)


def test_line_loads_of_elastic_teeth_add_up_to_the_force(pair):
    mesh = gearmesh.Mesh(pair, law="elastic", stations=49)
    static = mesh.static(0.1, 20.0)
    load, points = mesh.line_loads(0.1, static.offset)
    # Trapezoids between the stations of each line leave out its ends, less than 1 of 48 parts of the face at each; at one
    # of them a line goes over a tip, where its load is small.
    total = sum(np.trapezoid(line.line_load, line.z) if len(line) > 1 else 0.0
                for line in (points[points.pinion_tooth == tooth] for tooth in set(points.pinion_tooth)))
    assert 0.95 < total / static.result.force <= 1.01
    assert load.largest_pressure >= points.pressure.max() > 1e7
    assert load.face_load_factor > 1.0


def test_elastic_teeth_have_a_workspace_in_every_thread(pair):
    mesh = gearmesh.Mesh(pair, law="elastic", stations=5)
    angle = np.linspace(0, 0.14, 8)
    static = mesh.static(angle, 20.0)
    # The torque of elastic teeth is that of the force on the base circle, as there is no friction.
    assert static.result.wheel_torque == pytest.approx(20.0, rel=1e-6)
    found = []
    thread = threading.Thread(target=lambda: found.append(mesh.static(angle, 20.0).offset))
    thread.start()
    thread.join()
    assert found[0] == pytest.approx(static.offset, abs=1e-12)

    # Teeth of half the stiffness give way more, and they are one array for each gear.
    soft = gearmesh.Mesh(pair, law="elastic", stations=5, pinion_tooth_stiffness=np.full(45, 0.5))
    assert (soft.static(angle, 20.0).offset > static.offset).all()
    with pytest.raises(gearmesh.Error, match=r"wheel_tooth_stiffness: must have the shape \[41\] \(got \[45\]\)"):
        gearmesh.Mesh(pair, law="elastic", wheel_tooth_stiffness=np.ones(45))


def test_result_outlives_mesh_and_can_be_pickled(pair):
    result = gearmesh.Mesh(pair, **LAW).evaluate([1.25e-3, 1.3e-3], 0.0)
    assert pickle.loads(pickle.dumps(result)).force == pytest.approx(result.force, rel=0)


def test_threads_share_a_mesh(pair, mesh):
    states = states_about_contact(pair, 20000)
    expected = mesh.evaluate(*states).force
    found = [None] * 4

    def work(index):
        found[index] = mesh.evaluate(*states).force

    threads = [threading.Thread(target=work, args=(index,)) for index in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(expected, forces) for forces in found)


# ----------------------------------------------------------------------------------------------------
# Double-helical pairs
# ----------------------------------------------------------------------------------------------------

GAP = 6e-3
WHOLE = {"pinion_teeth": 23, "wheel_teeth": 31, "normal_module": 2e-3, "normal_pressure_angle": np.radians(20),
         "helix_angle": np.radians(24), "center_distance": 27 * 2e-3 / np.cos(np.radians(24)), "face_width": 36e-3,
         "backlash": 60e-6}


def test_halves_are_the_gears_of_a_single_helix_of_their_width_on_average():
    gears = gearmesh.DoubleHelical(gearmesh.Pair.half(GAP, **WHOLE), GAP, **LAW)
    single = gearmesh.Mesh(gearmesh.Pair(**{**WHOLE, "face_width": 36e-3 - GAP}), stiffness=2.1e8, damping=2 * 844.0)
    angle = np.linspace(0, 2 * np.pi / 23, 2000, endpoint=False)
    found = gears.evaluate_offset(angle, 40e-6, 1e-3)
    # Sums over a period of a function with kinks: (1 / 2000)^2.
    assert found.result.force.mean() == pytest.approx(single.evaluate_offset(angle, 40e-6, 1e-3).force.mean(), rel=1e-6)
    assert found.halves.force.sum(axis=-1) == pytest.approx(found.result.force, rel=1e-12)
    assert found.halves.force[:, 0] == pytest.approx(found.halves.force[:, 1], rel=1e-9)
    assert found.apex == pytest.approx(0.0, abs=1e-12)


def test_halves_at_both_angles_carry_what_turns_the_shafts():
    pair, error = gearmesh.Pair.half(GAP, **WHOLE), 8e-6
    thick = gearmesh.Flanks(pair, "pinion", np.full((2, 2), error))
    gears = gearmesh.DoubleHelical(pair, GAP, (thick, None), **LAW)
    pinion_angle = np.linspace(0.0, 0.3, 40)
    wheel_angle = (pair.pinion.base_radius * pinion_angle - 45e-6) / pair.wheel.base_radius
    found = gears.evaluate(pinion_angle, wheel_angle, 2.0, 1.5, want="derivatives")

    # The same torque in both halves, and as a Python program would find it: each half turned by the float along its helix.
    assert (found.result.wheel_torque > 10.0).all()
    assert found.halves.wheel_torque[:, 0] == pytest.approx(found.halves.wheel_torque[:, 1], rel=1e-6)
    assert found.halves.pinion_torque.sum(axis=-1) == pytest.approx(found.result.pinion_torque, rel=1e-12)
    shift = found.apex * np.tan(pair.base_helix_angle)
    offset_rate = pair.pinion.base_radius * 2.0 - pair.wheel.base_radius * 1.5
    meshes = gearmesh.Mesh(pair, thick, **LAW), gearmesh.Mesh(pair, **LAW)
    for half, (mesh, sign) in enumerate(zip(meshes, (-1, 1))):
        turned = mesh.evaluate_offset(pinion_angle, 45e-6 + sign * shift, offset_rate)
        assert turned.wheel_torque == pytest.approx(found.halves.wheel_torque[:, half], rel=1e-6)

    # Derivatives with the float: 1e-8 rad is 0.3 nm of flanks, kinks within that are rare.
    step = 1e-8
    ahead, behind = (gears.evaluate(pinion_angle, wheel_angle + way, 2.0, 1.5).result for way in (step, -step))
    slope = (ahead.wheel_torque - behind.wheel_torque) / (2 * step)
    assert np.median(np.abs(slope / found.result.wheel_torque_by.wheel_angle - 1)) < 1e-4

    one = gears.evaluate(0.1, 0.1 * 23 / 31)
    assert one.result.force.shape == () and one.halves.shape == (2,)


def test_halves_of_elastic_teeth_carry_the_torque():
    gears = gearmesh.DoubleHelical(gearmesh.Pair.half(GAP, **WHOLE), GAP, law="elastic", stations=5)
    static = gears.static(np.linspace(0, 0.2, 5)[:, None], [150.0, 300.0])
    # The torque of elastic teeth is that of the force on the base circle, as there is no friction.
    assert static.result.wheel_torque == pytest.approx(np.broadcast_to([150.0, 300.0], (5, 2)), rel=1e-6)
    assert static.halves.force.shape == (5, 2, 2)


def test_pinion_floats_by_half_the_error_of_one_half():
    pair, error = gearmesh.Pair.half(GAP, **WHOLE), 8e-6
    thick = gearmesh.Flanks(pair, "pinion", np.full((2, 2), error))
    for first, second, sign in (((thick, None), (None, None), 1), ((None, None), (thick, None), -1)):
        gears = gearmesh.DoubleHelical(pair, GAP, first, second, **LAW)
        static = gears.static(np.linspace(0, 0.2, 9), 20.0)
        # Given along the normal, error / cos(beta_b) along the line of action. The ends of the path follow x, not the
        # thickness: that counts as the overlap, here below the error, against the length of the path.
        assert static.apex == pytest.approx(sign * 0.5 * error / np.sin(pair.base_helix_angle),
                                            rel=2 * error / (pair.path_end - pair.path_start))
        assert static.result.wheel_torque == pytest.approx(20.0, rel=1e-9)
        assert static.halves.force[:, 0] == pytest.approx(static.halves.force[:, 1], rel=1e-6)
        again = gears.evaluate_offset(0.2, static.offset[-1], want=["derivatives", "wrench"])
        assert again.result.force == pytest.approx(static.result.force[-1], rel=1e-9)
        assert again.result.wrench["pinion_force"][2] == pytest.approx(0.0, abs=1e-9 * again.result.force)

        # Lines of both halves, none in the gap, and all of the force.
        load, points = gears.line_loads(0.2, static.offset[-1], static.apex[-1])
        assert ((points.z < 15e-3 + 1e-6) | (points.z > 21e-3 - 1e-6)).all()
        assert points.z.min() < 15e-3 < 21e-3 < points.z.max()
        assert load.largest_line_load * load.touching_width / load.face_load_factor == pytest.approx(
            static.result.force[-1], rel=1e-9)


def test_pose_is_that_of_the_whole_wheel():
    pair, angle, change = gearmesh.Pair.half(GAP, **WHOLE), np.linspace(0, 0.2, 50), 1e-6
    plain, moved, *skewed = (gearmesh.DoubleHelical(pair, GAP, **LAW, pose=pose).static(angle, 20.0) for pose in
                             ({}, {"center_distance_change": change}, {"skew": 1e-4}, {"skew": -1e-4}))
    # As of a single helix: the drive gap opens by dx sin(alpha_wt), to first order.
    assert np.mean(moved.offset - plain.offset) == pytest.approx(change * np.sin(pair.working_pressure_angle), rel=1e-2)

    # A skew takes the halves apart, one to each side, and the pinion follows: by some um of 1e-4 rad of 21 mm.
    assert skewed[0].apex == pytest.approx(-skewed[1].apex, rel=1e-2)
    assert (1e-6 < np.abs(skewed[0].apex)).all()
    assert (np.abs(skewed[0].apex) < 1e-4 * 21e-3 * 3).all()


def test_halves_that_cannot_be_are_refused():
    with pytest.raises(gearmesh.Error, match="gap: must be at least 0"):
        gearmesh.Pair.half(-1e-3, **WHOLE)
    with pytest.raises(gearmesh.Error, match="faces wider than the gap"):
        gearmesh.Pair.half(40e-3, **WHOLE)
    with pytest.raises(gearmesh.Error, match="normal_module: must be"):
        gearmesh.Pair.half(GAP, **{**WHOLE, "normal_module": -1.0})
    pair = gearmesh.Pair.half(GAP, **WHOLE)
    with pytest.raises(gearmesh.Error, match="gap: must be at least 0"):
        gearmesh.DoubleHelical(pair, np.nan, **LAW)
    gears = gearmesh.DoubleHelical(pair, GAP, **LAW)
    assert np.isnan(gears.evaluate_offset([0.0, np.nan, 0.0], 40e-6).result.force).tolist() == [False, True, False]
    assert np.isnan(gears.evaluate([0.0, 0.0, 0.0], [0.0, 1.0, 0.0]).result.force).tolist() == [False, True, False]
    assert np.isnan(gears.static(0.0, [150.0, 0.0, 150.0]).offset).tolist() == [False, True, False]


# ----------------------------------------------------------------------------------------------------
# Flanks
# ----------------------------------------------------------------------------------------------------


def test_arrays_of_flanks_are_those_of_a_file(pair, tmp_path):
    random = np.random.default_rng(3)
    table = random.uniform(-5e-6, 5e-6, (45, 2, 3, 4))
    pitch = random.uniform(-5e-6, 5e-6, (45, 2))
    table[7, 1] = np.nan
    with open(tmp_path / "flanks.csv", "w", encoding="utf-8") as file:
        file.write("tooth,flank,t1,t2,deviation_um\n")
        for (tooth, side, n1, n2), value in np.ndenumerate(table):
            if not np.isnan(value):
                file.write(f"{tooth},{('drive', 'coast')[side]},{n1 / 2},{n2 / 3:.17g},{1e6 * value:.17g}\n")
    with open(tmp_path / "pitch.csv", "w", encoding="utf-8") as file:
        file.write("tooth,flank,deviation_um\n")
        for (tooth, side), value in np.ndenumerate(pitch):
            file.write(f"{tooth},{('drive', 'coast')[side]},{1e6 * value:.17g}\n")

    angle, torque = np.linspace(0, 6.28, 100), 20.0
    from_file = gearmesh.Flanks(pair, "pinion", tmp_path / "flanks.csv", tmp_path / "pitch.csv")
    from_array = gearmesh.Flanks(pair, "pinion", table, pitch)
    offsets = [gearmesh.Mesh(pair, flanks, **LAW).static(angle, torque).offset for flanks in (from_file, from_array)]
    assert offsets[0] == pytest.approx(offsets[1], abs=1e-14)
    assert np.ptp(offsets[0]) > 1e-6


def test_added_material_moves_the_mesh_by_its_thickness(pair):
    # 10 um along the normal on all teeth of one gear are 10 um / cos(beta_b) along the line of action. As the path of
    # contact begins there too, 10 um in 7 mm of it are missing, a thousandth of the 2.5 um by which the teeth press.
    angle = np.linspace(0, 0.3, 20)
    ideal = gearmesh.Mesh(pair, **LAW).static(angle, 20.0).offset
    for shape in ((2, 2), (2, 2, 2), (41, 2, 2, 2)):
        thick = gearmesh.Flanks(pair, "wheel", np.full(shape, 10e-6))
        moved = gearmesh.Mesh(pair, wheel_flanks=thick, **LAW).static(angle, 20.0).offset
        assert ideal - moved == pytest.approx(10e-6 / np.cos(pair.base_helix_angle), abs=4e-9)
    thick = gearmesh.Flanks(pair, "wheel", np.full((2, 2), 10e-6), in_transverse_section=True)
    moved = gearmesh.Mesh(pair, wheel_flanks=thick, **LAW).static(angle, 20.0).offset
    assert ideal - moved == pytest.approx(10e-6, abs=4e-9)


def test_modifications_take_material_off(pair):
    relief = gearmesh.Modification("tip_relief", 10e-6, profile_range=0.3, profile_range_by="share")
    crowning = gearmesh.Modification("crowning", 4e-6, shape="parabolic")
    relieved = gearmesh.Flanks(pair, "wheel", drive=[relief, crowning])
    mesh = gearmesh.Mesh(pair, wheel_flanks=relieved, **LAW)
    assert (mesh.static(np.linspace(0, 1, 20), 20.0).offset >
            gearmesh.Mesh(pair, **LAW).static(np.linspace(0, 1, 20), 20.0).offset).all()
    assert mesh.clearance("coast") == pytest.approx(50e-6, rel=1e-9)


def test_flanks_say_what_is_wrong(pair, tmp_path):
    with pytest.raises(gearmesh.Error, match="nowhere.csv"):
        gearmesh.Flanks(pair, "pinion", tmp_path / "nowhere.csv")
    (tmp_path / "bad.csv").write_text("tooth,flank,t1,t2,deviation_um\n0,drive,0,0,much\n", encoding="utf-8")
    with pytest.raises(gearmesh.Error, match=r"bad\.csv:2: "):
        gearmesh.Flanks(pair, "pinion", tmp_path / "bad.csv")
    with pytest.raises(gearmesh.Error, match=r"deviations: must have the shape .*got \(3, 2, 2\)"):
        gearmesh.Flanks(pair, "pinion", np.zeros((3, 2, 2)))
    with pytest.raises(gearmesh.Error, match=r"pitch: must have the shape \[45, 2\]"):
        gearmesh.Flanks(pair, "pinion", pitch=np.zeros(45))
    with pytest.raises(gearmesh.Error):
        gearmesh.Flanks(pair, "pinion", np.array([[0.0, np.inf], [0.0, 0.0]]))
    with pytest.raises(gearmesh.Error, match="modification 0: amount: must be "):
        gearmesh.Flanks(pair, "pinion", drive=[gearmesh.Modification("tip_relief", -1.0, profile_range=1e-3)])
    with pytest.raises(gearmesh.Error, match="role"):
        gearmesh.Flanks(pair, "sun")
    with pytest.raises(gearmesh.Error, match="kind: must be one of"):
        gearmesh.Modification("polish", 1e-6)


# ----------------------------------------------------------------------------------------------------
# Solvers and gearsim
# ----------------------------------------------------------------------------------------------------


def test_scipy_finds_the_motion_with_and_without_stiff_methods(pair, mesh):
    """Explicit, switching and implicit methods with the exact Jacobian come to the same end."""
    inertia, load, r_bw = 2.1e-3, 20.0, pair.wheel.base_radius
    speed = 2 * np.pi * 1000 / pair.pinion.teeth

    def motion(time, state):
        return state[1], (load - mesh.evaluate_offset(speed * time, *state).wheel_torque) * r_bw / inertia

    def jacobian(time, state):
        by = mesh.evaluate_offset(speed * time, *state, want="derivatives").wheel_torque_by
        return [[0.0, 1.0], [by.wheel_angle / inertia, by.wheel_speed / inertia]]

    start = (mesh.static(0.0, load).offset, 0.0)
    ends = {}
    for method, options in (("DOP853", {}), ("LSODA", {"jac": jacobian}), ("Radau", {"jac": jacobian}), ("BDF", {"jac": jacobian})):
        run = solve_ivp(motion, (0.0, 3e-3), start, method, rtol=1e-8, atol=1e-13, **options)
        assert run.success
        ends[method] = run.y[0, -1]
    assert np.array(list(ends.values())) == pytest.approx(ends["DOP853"], abs=2e-10), ends


@pytest.fixture(name="program")
def fixture_program(request):
    program = request.config.getoption("--gearsim")
    if not program:
        pytest.skip("needs --gearsim=PROGRAM")
    return program


def test_static_error_is_that_of_gearsim(program):
    parameters = EXAMPLE / "params.ini"
    run = gearmesh.gearsim(parameters, {"analysis.type": "static", "analysis.positions": 200, "load.mean_Nm": 25}, program)
    text = {line.split("=")[0].strip(): line.split("=")[1].split(";")[0].strip()
            for line in parameters.read_text(encoding="utf-8").splitlines() if "=" in line and line[0] not in ";#"}
    mm, deg = 1e-3, np.pi / 180
    pair = gearmesh.Pair(
        pinion_teeth=int(text["pinion_teeth"]), wheel_teeth=int(text["wheel_teeth"]),
        normal_module=float(text["normal_module_mm"]) * mm,
        normal_pressure_angle=float(text["normal_pressure_angle_deg"]) * deg,
        helix_angle=float(text["helix_angle_deg"]) * deg, center_distance=float(text["center_distance_mm"]) * mm,
        face_width=float(text["face_width_mm"]) * mm, backlash=float(text["backlash_um"]) * 1e-6,
        **{f"{gear}_{name}": float(text[f"{gear}_{name}"]) for gear in ("pinion", "wheel")
           for name in ("rack_addendum", "rack_dedendum")},
        **{f"{gear}_tip_radius": float(text[f"{gear}_tip_diameter_mm"]) * mm / 2 for gear in ("pinion", "wheel")})
    assert "flanks.pinion_pitch" in run.parameters and "flanks.wheel_pitch" not in run.parameters
    mesh = gearmesh.Mesh(pair, gearmesh.Flanks(pair, "pinion", EXAMPLE / "flanks.csv", EXAMPLE / "pitch.csv"),
                         gearmesh.Flanks(pair, "wheel", EXAMPLE / "flanks.csv"), stiffness=float(text["stiffness_N_per_m"]))
    te = -mesh.static(run["pinion_angle_rad"], 25.0).offset
    assert run["te_um"].size == 200
    assert 1e6 * te == pytest.approx(run["te_um"], abs=1e-5)
    assert np.ptp(te) > 1e-7


def test_gearsim_says_what_is_wrong(program):
    with pytest.raises(gearmesh.Error, match="load.mean_Nm"):
        gearmesh.gearsim(EXAMPLE / "params.ini", {"load.mean_Nm": "much"}, program)


def test_what_is_no_result_is_refused(tmp_path):
    (tmp_path / "empty.csv").write_text("# a\n", encoding="utf-8")
    with pytest.raises(gearmesh.Error, match="empty.csv: must be a result"):
        gearmesh.read_run(tmp_path / "empty.csv")
    (tmp_path / "ended.csv").write_text("# a.b = 1\ntime_s,x_um\n0,1\n1,2\n# incomplete: killed\n", encoding="utf-8")
    run = gearmesh.read_run(tmp_path / "ended.csv")
    assert (run["x_um"] == [1, 2]).all()
    assert run.parameters == {"a.b": "1", "incomplete": "killed"}


def test_tutorial_runs(capsys):
    runpy.run_path(str(ROOT / "libgearmesh" / "bindings" / "python" / "tutorial.py"))
    assert "Radau" in capsys.readouterr().out
