// SPDX-FileCopyrightText: The gearmesh authors
// SPDX-License-Identifier: BSD-3-Clause
within ;
package GearMesh "The open gear mesh element: contact of two real, measured helical gears"
  extends Modelica.Icons.Package;
  import SI = Modelica.Units.SI;

  constant Real derived = 1e60 "In place of a number: the library derives it, or takes its default";

  class Mesh "Pair of gears, flanks and force law, prepared by the library"
    extends ExternalObject;

    function constructor "Prepares a mesh"
      input Real pair[:] "PairParameters.values";
      input Real law[:] "MeshParameters.values";
      input String pinion_flanks "File of flank deviations; empty: ideal";
      input String pinion_pitch "File of pitch deviations; empty: none";
      input String wheel_flanks "Likewise";
      input String wheel_pitch "Likewise";
      input Real double_helical_gap = derived "Between two halves of opposite hand (m); derived: one helix";
      input String pinion_second_half = "" "File of the half at face II; empty: as pinion_flanks";
      input String pinion_second_half_pitch = "" "Likewise";
      input String wheel_second_half = "" "Likewise";
      input String wheel_second_half_pitch = "" "Likewise";
      output Mesh mesh;
      external "C" mesh = gearmesh_modelica_new(pair, size(pair, 1), law, size(law, 1), double_helical_gap,
        pinion_flanks, pinion_pitch, wheel_flanks, wheel_pitch,
        pinion_second_half, pinion_second_half_pitch, wheel_second_half, wheel_second_half_pitch)
        annotation(Include="#include \"gearmesh_modelica.h\"",
          Library={"gearmesh_modelica", "gearmesh_io", "gearmesh"});
    end constructor;

    function destructor "Frees it"
      input Mesh mesh;
      external "C" gearmesh_modelica_free(mesh)
        annotation(Include="#include \"gearmesh_modelica.h\"",
          Library={"gearmesh_modelica", "gearmesh_io", "gearmesh"});
    end destructor;
  end Mesh;

  package Functions "What a mesh says of a state"
    extends Modelica.Icons.FunctionsPackage;

    pure function evaluate "Torques on both gears and force, from angles and speeds"
      extends Modelica.Icons.Function;
      input Mesh mesh;
      input Real state[4] "Angles of pinion and wheel, both positive in the driven direction (rad), and their speeds (rad/s)";
      output Real result[3] "Torque that the mesh takes from the pinion, torque that it gives to the wheel (N.m), force along the line of action (N)";
      external "C" gearmesh_modelica_evaluate(mesh, state, size(state, 1), result, size(result, 1))
        annotation(Include="#include \"gearmesh_modelica.h\"",
          Library={"gearmesh_modelica", "gearmesh_io", "gearmesh"});
      annotation(derivative=evaluate_der, Documentation(info="<html>
<p>The derivatives are the exact ones of the library. A state in which a tooth would be skipped is an error, which makes the
integrator try a smaller step.</p></html>"));
    end evaluate;

    pure function evaluate_der "Its exact derivative by time"
      extends Modelica.Icons.Function;
      input Mesh mesh;
      input Real state[4];
      input Real state_rate[4] "Change of the state by time";
      output Real result_rate[3] "Change of the result by time";
      external "C" gearmesh_modelica_evaluate_der(mesh, state, size(state, 1), state_rate, size(state_rate, 1),
        result_rate, size(result_rate, 1))
        annotation(Include="#include \"gearmesh_modelica.h\"",
          Library={"gearmesh_modelica", "gearmesh_io", "gearmesh"});
    end evaluate_der;

    pure function loads "Force and moment on two bodies at the middles of their faces"
      extends Modelica.Icons.Function;
      input Mesh mesh;
      input Real pinion[18] "Position of the middle of the face (m), rotation from body to world row by row, velocity (m/s), angular velocity (rad/s), in the world frame";
      input Real wheel[18] "Likewise";
      output Real loads[12] "Force (N) and moment (N.m) on the pinion, then on the wheel, in the world frame";
      external "C" gearmesh_modelica_loads(mesh, pinion, size(pinion, 1), wheel, size(wheel, 1),
        loads, size(loads, 1))
        annotation(Include="#include \"gearmesh_modelica.h\"",
          Library={"gearmesh_modelica", "gearmesh_io", "gearmesh"});
    end loads;

    pure function static_offset "Mesh coordinate in equilibrium under load"
      extends Modelica.Icons.Function;
      input Mesh mesh;
      input SI.Angle pinion_angle;
      input SI.Torque wheel_torque "Resists the wheel; > 0: drive flanks";
      output SI.Position offset "r_bp phi_p - r_bw phi_w; the transmission error is its opposite";
      external "C" offset = gearmesh_modelica_static_offset(mesh, pinion_angle, wheel_torque)
        annotation(Include="#include \"gearmesh_modelica.h\"",
          Library={"gearmesh_modelica", "gearmesh_io", "gearmesh"});
    end static_offset;

    pure function base_radii "Base radii of pinion and wheel"
      extends Modelica.Icons.Function;
      input Mesh mesh;
      output SI.Radius radii[2];
      external "C" gearmesh_modelica_base_radii(mesh, radii, size(radii, 1))
        annotation(Include="#include \"gearmesh_modelica.h\"",
          Library={"gearmesh_modelica", "gearmesh_io", "gearmesh"});
    end base_radii;
  end Functions;

  package Components "The mesh between shafts and between bodies"
    extends Modelica.Icons.Package;

    model MeshElement "Mesh of two gears between their shafts"
      extends Modelica.Mechanics.Rotational.Interfaces.PartialTwoFlanges;
      extends PartialMesh;
      SI.AngularVelocity pinion_speed;
      SI.AngularVelocity wheel_speed;
      SI.Position offset "r_bp phi_p - r_bw phi_w; beyond half the backlash teeth touch";
      SI.Force force "Along the line of action, > 0: drive flanks";
    equation
      pinion_speed = der(flange_a.phi);
      wheel_speed = der(flange_b.phi);
      offset = radii[1]*flange_a.phi - radii[2]*flange_b.phi;
      {flange_a.tau, -flange_b.tau, force} = Functions.evaluate(mesh, {flange_a.phi, flange_b.phi, pinion_speed, wheel_speed});
      annotation(Documentation(info="<html>
<p>The pinion's shaft is <code>flange_a</code>, the wheel's <code>flange_b</code>. Both angles are positive in the driven
direction, as with <code>Modelica.Mechanics.Rotational.Components.IdealGear</code>. At zero angles the backlash is the same on
both flanks. Drive and coast flanks are always both there: reversal of the load and rattle need no switch.</p>
<p>With <code>double_helical_gap</code> the pinion has two halves and floats along its axis to where both carry the same;
stiffness and damping are those of both together.</p>
</html>"));
    end MeshElement;

    model MeshElement3D "Mesh of two gears between their bodies"
      extends Modelica.Mechanics.MultiBody.Interfaces.PartialTwoFrames;
      extends PartialMesh;
    protected
      Real loads[12];
    equation
      loads = Functions.loads(mesh,
        cat(1, frame_a.r_0, frame_a.R.T[:, 1], frame_a.R.T[:, 2], frame_a.R.T[:, 3], der(frame_a.r_0),
          transpose(frame_a.R.T)*frame_a.R.w),
        cat(1, frame_b.r_0, frame_b.R.T[:, 1], frame_b.R.T[:, 2], frame_b.R.T[:, 3], der(frame_b.r_0),
          transpose(frame_b.R.T)*frame_b.R.w));
      frame_a.f = -frame_a.R.T*loads[1:3];
      frame_a.t = -frame_a.R.T*loads[4:6];
      frame_b.f = -frame_b.R.T*loads[7:9];
      frame_b.t = -frame_b.R.T*loads[10:12];
      annotation(Documentation(info="<html>
<p>The pinion is at <code>frame_a</code>, the wheel at <code>frame_b</code>: the origin of each frame is the middle of the
gear's own face on its axis, z is the axis. At zero angle, as drawn, x of both points from the pinion to the wheel. Shafts
may bend, tilt and float; whole turns need not be known. Both bodies have to determine their frames. Double-helical gears
between bodies are two meshes, of helix angles of opposite sign, each at the middle of its own half.</p>
</html>"));
    end MeshElement3D;

    partial model PartialMesh "What both have"
      parameter PairParameters gears "What the drawing says" annotation(Dialog(group="Gears"));
      parameter MeshParameters law "Stiffness, damping, friction, pose" annotation(Dialog(group="Mesh"));
      parameter String pinion_flanks = "" "File of flank deviations; empty: ideal" annotation(Dialog(group="Flanks"));
      parameter String pinion_pitch = "" "File of pitch deviations; empty: none" annotation(Dialog(group="Flanks"));
      parameter String wheel_flanks = "" "Likewise" annotation(Dialog(group="Flanks"));
      parameter String wheel_pitch = "" "Likewise" annotation(Dialog(group="Flanks"));
      parameter Real double_helical_gap(unit="m") = derived "Between two halves of opposite hand, helix_angle that of the one at face I; derived: one helix" annotation(Dialog(group="Double-helical"));
      parameter String pinion_second_half = "" "File of the half at face II; empty: as pinion_flanks" annotation(Dialog(group="Double-helical"));
      parameter String pinion_second_half_pitch = "" "Likewise" annotation(Dialog(group="Double-helical"));
      parameter String wheel_second_half = "" "Likewise" annotation(Dialog(group="Double-helical"));
      parameter String wheel_second_half_pitch = "" "Likewise" annotation(Dialog(group="Double-helical"));
      final parameter Mesh mesh = Mesh(gears.values, law.values, pinion_flanks, pinion_pitch, wheel_flanks, wheel_pitch,
        double_helical_gap, pinion_second_half, pinion_second_half_pitch, wheel_second_half, wheel_second_half_pitch);
      final parameter SI.Radius radii[2] = Functions.base_radii(mesh) "Base radii of pinion and wheel";
      annotation(Icon(graphics={
        Ellipse(extent={{-100, 60}, {20, -60}}, lineColor={0, 0, 0}, fillColor={215, 215, 215}, fillPattern=FillPattern.Solid),
        Ellipse(extent={{10, 45}, {100, -45}}, lineColor={0, 0, 0}, fillColor={215, 215, 215}, fillPattern=FillPattern.Solid),
        Line(points={{-12, -56}, {38, 56}}, color={255, 0, 0}, thickness=0.5),
        Text(extent={{-150, 110}, {150, 70}}, textColor={0, 0, 255}, textString="%name")}));
    end PartialMesh;
  end Components;

  package Examples "Models that run as they are"
    extends Modelica.Icons.ExamplesPackage;

    record Gears "The gears of the paper that the library follows"
      extends PairParameters(
        pinion_teeth=45, wheel_teeth=41, normal_module=1.65e-3, normal_pressure_angle=0.27925268031909273,
        helix_angle=0.57595865315812877, center_distance=0.085, face_width=0.0175, backlash=100e-6);
    end Gears;

    record Law "Constant stiffness and damping of a pair of teeth"
      extends MeshParameters(stiffness=1.05e8, damping=844.361);
    end Law;

    model GearPair "Two gears between a drive and a load"
      extends Modelica.Icons.Example;
      Modelica.Mechanics.Rotational.Sources.ConstantTorque drive(tau_constant=25);
      Modelica.Mechanics.Rotational.Components.Inertia pinion(J=2.1e-3);
      Components.MeshElement gears(gears=Gears(), law=Law());
      Modelica.Mechanics.Rotational.Components.Inertia wheel(J=2.1e-3);
      Modelica.Mechanics.Rotational.Sources.ConstantTorque load(tau_constant=-20);
    initial equation
      pinion.phi = 0;
      pinion.w = 104.71975511965977;
      gears.offset = 53e-6;
      der(gears.offset) = 0;
    equation
      connect(drive.flange, pinion.flange_a);
      connect(pinion.flange_b, gears.flange_a);
      connect(gears.flange_b, wheel.flange_a);
      connect(wheel.flange_b, load.flange);
      annotation(experiment(StopTime=0.02, Tolerance=1e-8), Documentation(info="<html>
<p>Plot <code>gears.force</code> and <code>gears.offset</code>: the vibration at the stiffness of the teeth.</p></html>"));
    end GearPair;

    model TiltingShaft "The same on bodies; the wheel's shaft tilts on springs"
      extends Modelica.Icons.Example;
      inner Modelica.Mechanics.MultiBody.World world(gravityType=Modelica.Mechanics.MultiBody.Types.GravityTypes.NoGravity);
      Modelica.Mechanics.MultiBody.Joints.Revolute pinion_shaft(n={0, 0, 1}, useAxisFlange=true,
        phi(start=0, fixed=true), w(start=104.71975511965977, fixed=true));
      Modelica.Mechanics.MultiBody.Parts.Body pinion(m=1, r_CM={0, 0, 0}, I_11=1.1e-3, I_22=1.1e-3, I_33=2.1e-3);
      Modelica.Mechanics.Rotational.Sources.ConstantTorque drive(tau_constant=25);
      Components.MeshElement3D gears(gears=Gears(), law=Law());
      Modelica.Mechanics.MultiBody.Parts.FixedTranslation distance(r={0.085, 0, 0});
      Modelica.Mechanics.MultiBody.Joints.Revolute tilt_x(n={1, 0, 0}, useAxisFlange=true, phi(start=0, fixed=true), w(start=0, fixed=true));
      Modelica.Mechanics.MultiBody.Joints.Revolute tilt_y(n={0, 1, 0}, useAxisFlange=true, phi(start=0, fixed=true), w(start=0, fixed=true));
      Modelica.Mechanics.Rotational.Components.SpringDamper bearing_x(c=2e4, d=1);
      Modelica.Mechanics.Rotational.Components.SpringDamper bearing_y(c=2e4, d=1);
      Modelica.Mechanics.MultiBody.Joints.Revolute wheel_shaft(n={0, 0, 1}, useAxisFlange=true,
        phi(start=53e-6/gears.radii[2], fixed=true), w(start=-104.71975511965977*gears.radii[1]/gears.radii[2], fixed=true));
      Modelica.Mechanics.MultiBody.Parts.Body wheel(m=1, r_CM={0, 0, 0}, I_11=1.1e-3, I_22=1.1e-3, I_33=2.1e-3);
      Modelica.Mechanics.Rotational.Sources.ConstantTorque load(tau_constant=20) "Angles of bodies count in one direction: it resists";
    equation
      connect(world.frame_b, pinion_shaft.frame_a);
      connect(pinion_shaft.frame_b, pinion.frame_a);
      connect(drive.flange, pinion_shaft.axis);
      connect(pinion_shaft.frame_b, gears.frame_a);
      connect(world.frame_b, distance.frame_a);
      connect(distance.frame_b, tilt_x.frame_a);
      connect(tilt_x.frame_b, tilt_y.frame_a);
      connect(bearing_x.flange_a, tilt_x.support);
      connect(bearing_x.flange_b, tilt_x.axis);
      connect(bearing_y.flange_a, tilt_y.support);
      connect(bearing_y.flange_b, tilt_y.axis);
      connect(tilt_y.frame_b, wheel_shaft.frame_a);
      connect(wheel_shaft.frame_b, wheel.frame_a);
      connect(wheel_shaft.frame_b, gears.frame_b);
      connect(load.flange, wheel_shaft.axis);
      annotation(experiment(StopTime=0.005, Tolerance=1e-8), Documentation(info="<html>
<p>Plot <code>tilt_x.phi</code> and <code>tilt_y.phi</code>: the axial force of the helix tilts the shaft.</p></html>"));
    end TiltingShaft;

    model TransmissionError "Under a constant load, over the angle of the pinion"
      extends Modelica.Icons.Example;
      parameter SI.Torque torque = 20 "On the wheel";
      final parameter Mesh mesh = Mesh(gears.values, law.values, "", "", "", "");
      parameter Gears gears;
      parameter Law law;
      SI.Position transmission_error;
    equation
      transmission_error = -Functions.static_offset(mesh, time, torque);
      annotation(experiment(StopTime=0.13962634015954636), Documentation(info="<html>
<p>Time stands for the pinion's angle: one pitch.</p></html>"));
    end TransmissionError;
  end Examples;

  annotation(version="@PROJECT_VERSION@", uses(Modelica(version="4.0.0")),
    Documentation(info="<html>
<p>Given the angles of two helical gears, or the places of their bodies, the mesh says which torques, or forces and moments,
follow. Every tooth may have its own measured flank. The C library gearmesh, which this package calls, integrates the
overlap of the flanks exactly along all lines of contact.</p>
<ul>
<li><code>Components.MeshElement</code> is the mesh between two shafts, <code>Components.MeshElement3D</code> between two
bodies. Their parameters are what a drawing gives, stiffness and damping, and files of flanks.</li>
<li><code>Functions</code> are for models of your own. Derivatives are exact where a tool asks for them.</li>
<li>SI units and radians everywhere, signs as in conventions.md of the library.</li>
</ul>
</html>"),
    Icon(graphics={
      Ellipse(extent={{-80, 40}, {10, -50}}, lineColor={0, 0, 0}, fillColor={215, 215, 215}, fillPattern=FillPattern.Solid),
      Ellipse(extent={{4, 30}, {78, -44}}, lineColor={0, 0, 0}, fillColor={215, 215, 215}, fillPattern=FillPattern.Solid),
      Line(points={{-14, -54}, {26, 44}}, color={255, 0, 0}, thickness=0.5)}));
end GearMesh;
