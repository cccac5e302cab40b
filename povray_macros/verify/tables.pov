// Verification of skinglow_tables.inc and of the pigments in skinglow_textures.inc: tables by hand, and pigments as functions.
// Stops with an #error at a difference above 1e-12, of pigments 1e-6 (POV-Ray's colors have 24 bits).
//
//   cd povray_macros && povray verify/tables.pov -D -F

#version 3.7;
#include "skinglow.inc"
global_settings { assumed_gamma 1.0 }

#macro Verify(Name, Value, Expected, Allowed)
    #if (!(abs(Value - Expected) < Allowed))
        #error concat(Name, " is ", str(Value, 0, 17), ", should be ", str(Expected, 0, 17), "\n")
    #end
#end

#macro Verify_Color(Name, Value, Expected, Allowed)
    Verify(concat(Name, ".r"), Value.x, Expected.x, Allowed)
    Verify(concat(Name, ".g"), Value.y, Expected.y, Allowed)
    Verify(concat(Name, ".b"), Value.z, Expected.z, Allowed)
#end

// Entries of 0 to 12 mm, at the centers of texels.
Verify("thickness of entry 3 of 5", Skinglow_Thickness(3, 5, 12), 9, 1e-12)
Verify("u of 9 mm", Skinglow_Lut_U(9, 5, 12), 3.5 / 5, 1e-12)
Verify("u of 99 mm", Skinglow_Lut_U(99, 5, 12), 4.5 / 5, 1e-12)

// The fixed lookup at 0 is the sum of the published weights, and white.
#declare Fixed = Skinglow_Six_Gaussian(5, 12)
Verify_Color("fixed lookup at 0", Fixed[0], <1, 1, 1>, 1e-12)
Verify("fixed lookup at 3 mm, red", Fixed[1].x,
       0.113 * exp(-9 / 0.567) + 0.358 * exp(-9 / 1.99) + 0.078 * exp(-9 / 7.41) + 0.118 * exp(-9 / 0.187), 1e-12)
// Its brightness is the base lookup: luminance.
#declare Base = Skinglow_Six_Gaussian_Base(5, 12)
Verify("base at 0", Base[0], 1, 1e-12)
Verify("base at 3 mm", Base[1], vdot(Fixed[1], <0.2126, 0.7152, 0.0722>), 1e-12)

// Mode physical: columns times weight.
#declare Red = array[2] {<1, 2, 3>, <0.1, 0.2, 0.3>}
#declare Green = array[2] {<4, 5, 6>, <0.4, 0.5, 0.6>}
#declare Blue = array[2] {<7, 8, 9>, <0.7, 0.8, 0.9>}
#declare Table = Skinglow_Recolor_Columns(Red, Green, Blue, Skinglow_Diffuse_Radiance(pi * <1, 0.5, 0.25>))
Verify_Color("columns at 0", Table[0], <4.75, 6.5, 8.25>, 1e-12)
Verify_Color("columns at the end", Table[1], <0.475, 0.65, 0.825>, 1e-12)

// Pigments (without uv_mapping, which no function has), a quarter of the way between the centers of two texels, and beyond the end.
#declare Texel = function(x, y, z) { 2 * x - 0.5 }
#declare By_U = function { Skinglow_Entry_Pigment(Table, Texel, 0) }
#declare At = By_U(0.375, 0.5, 0);
Verify_Color("table pigment", <At.red, At.green, At.blue>, 0.75 * Table[0] + 0.25 * Table[1], 1e-5)
#declare At = By_U(0.9, 0.5, 0);
Verify_Color("table pigment at the end", <At.red, At.green, At.blue>, Table[1], 1e-5)
#declare Mm = function(x, y, z) { 2 + 4 * z }
#declare By_Mm = function { Skinglow_Thickness_Pigment(Table, 8, Mm, 0) }
#declare At = By_Mm(7, 7, 0);
Verify_Color("thickness pigment", <At.red, At.green, At.blue>, 0.75 * Table[0] + 0.25 * Table[1], 1e-5)

#debug "skinglow.inc: tables and pigments agree\n"
camera { location -z }
