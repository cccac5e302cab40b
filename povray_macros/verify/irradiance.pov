// Verification of skinglow_irradiance.inc and skinglow_area.inc: lights for which the irradiance has a formula, worked out here by
// other means than in the macros. Stops with an #error at a relative difference above 1e-9, for integrals 1e-7; writes the results
// to irradiance.txt, "name M p E" for M * 2^E.
//
//   cd povray_macros && povray verify/irradiance.pov -D -F

#version 3.7;
#declare Skinglow_Light_Sources = 0;
#include "skinglow.inc"
global_settings { assumed_gamma 1.0 }

#fopen Numbers "irradiance.txt" write

// The red of a light of <1, 0.5, 0> at 2 m over the origin that shines down, on a surface at the origin.
#macro Verify(Name, Kind, Power, Direction, Shape, Expected, Allowed)
    Skinglow_Light(Kind, <1, 0.5, 0>, <0, 0, 2>, Direction, Power, Shape)
    #local E = Skinglow_Irradiance_Of(Skinglow_Light_Count - 1, <0, 0, 0>);
    #write (Numbers, Name, " ", Skinglow_Exact_Text(E.x), "\n")
    #if (abs(E.x - Expected) > Allowed * abs(Expected) | abs(E.y - E.x / 2) > 1e-15 * abs(E.x) | E.z > 0 | E.z < 0)
        #error concat(Name, " is ", vstr(3, E, ", ", 0, 17), ", red should be ", str(Expected, 0, 17), "\n")
    #end
#end

Verify("point", "POINT", 100, z, Skinglow_Point_Shape(0, 1), 100 / (16 * pi), 1e-9)
Verify("soft_point", "point", 100, z, Skinglow_Point_Shape(0.5, 1), 100 / (4 * pi * 4.25), 1e-9)
Verify("ball", "Point", -100, z, Skinglow_Point_Shape(0.5, 0), -100 / (16 * pi), 1e-9)
Verify("sun", "SUN", 3, <5, 0, -1>, Skinglow_Sun_Shape(0.1), 3, 1e-9)
Verify("spot_on_axis", "SPOT", 100, -z, Skinglow_Spot_Shape(0, 1, 0.8, 0.3, 0), 100 / (16 * pi), 1e-9)
// Half-way through the fading rim, in the cosine, the smoothstep is one half.
#declare Off = acos(cos(0.4) + 0.15 * (1 - cos(0.4)));
Verify("spot_in_rim", "spot", 100, <sin(Off), 0, -cos(Off)>, Skinglow_Spot_Shape(0, 1, 0.8, 0.3, 0), 50 / (16 * pi), 1e-9)
Verify("spot_with_cosine", "spot", 100, <sin(Off), 0, -cos(Off)>, Skinglow_Spot_Shape(0, 1, 0.8, 0.3, 1),
       50 * cos(Off) / (16 * pi), 1e-9)
// A wide spot of a radius, whose axis lies in the middle of a patch that the cone covers in part: without a fading rim, the
// cosine-weighted part of the patch inside of the cone, sin^2(edge) / sin^2(patch).
Verify("spot_with_radius", "SPOT", 100, -z, Skinglow_Spot_Shape(2, 1, 0.8, 0, 0),
       100 / (4 * pi * 8) * pow(sin(0.4), 2) / 0.5, 1e-7)

// A disk of radius R over the point: L pi R^2 / (R^2 + d^2), L = P / (pi * area).
Verify("disk", "AREA", 10, -z, Skinglow_Ellipse_Shape(2, 2, x, pi), 10 / (pi * 5), 1e-7)
// A rectangle with a corner over the point has the form factor below; four of them make it.
#macro Corner_Factor(A, B)
    ((A / sqrt(1 + A * A) * atan(B / sqrt(1 + A * A)) + B / sqrt(1 + B * B) * atan(A / sqrt(1 + B * B))) / (2 * pi))
#end
Verify("rectangle", "AREA", 10, -z, Skinglow_Rectangle_Shape(3, 1, y, pi), 10 / 3 * 4 * Corner_Factor(0.75, 0.25), 1e-9)
// The same disk with a spread: 2 pi L times the integral of (T - x) x / (1 + x^2)^2 up to R / d, over T - arctan T.
#macro Disk_With_Spread(X, T)
    (2 * (T * X * X / (1 + X * X) / 2 - (atan(X) - X / (1 + X * X)) / 2) / (T - atan(T)))
#end
Verify("disk_with_spread", "AREA", 10, -z, Skinglow_Ellipse_Shape(2, 2, x, 2), 10 / pi * Disk_With_Spread(0.5, tan(1)), 1e-7)
// Far off, the gain on the axis: T / (T - arctan T).
Verify("far_rectangle", "AREA", 10, -z, Skinglow_Rectangle_Shape(1e-5, 1e-5, x, 2), 10 / (4 * pi) * tan(1) / (tan(1) - 1), 1e-9)

// A list: two lights that face the point, one of them taken away from.
Skinglow_Forget_Lights()
Skinglow_Light("SUN", <1, 0.5, 0>, <9, 9, 9>, -z, 3, Skinglow_Sun_Shape(0))
Skinglow_Light("POINT", <1, 0.5, 0>, <0, 0, 2>, -z, -16 * pi, Skinglow_Point_Shape(0, 1))
#declare Listed = Skinglow_Listed_Irradiance(<0, 0, 0>);
#declare Alone = Skinglow_Irradiance("point", <2, 0, 0>, <0, 0, 2>, -z, 16 * pi, Skinglow_Point_Shape(0, 1), <0, 0, 0>);
#if (vlength(Listed - <2, 1, 0>) > 1e-14 | vlength(Alone - <2, 0, 0>) > 1e-14)
    #error concat("listed is ", vstr(3, Listed, ", ", 0, 17), ", alone ", vstr(3, Alone, ", ", 0, 17), "\n")
#end

#fclose Numbers
#debug "skinglow.inc: irradiance agrees\n"
camera { location -z }
