// Two thin ears in the same light: the left one uses the existing method, a fixed reddish lookup; the right one that of the
// paper, whose lookup follows the lights. With Declare=Blue=1 the light behind them is blue: the left ear stays red.
//
//   cd povray_macros && povray example.pov +W640 +H480 -D +A0.1 Declare=Blue=1
//
// Lengths are in decimeters, so that the lights are about 1 from the ears, as in the paper's Table 1; thickness in mm.

#version 3.7;
#include "skinglow.inc"
global_settings { assumed_gamma 1.0 }

#ifndef (Blue) #declare Blue = 0; #end

#declare Millimeter = 0.01;
#declare Max_Thickness = 12;
#declare Size = 128;

// ---- lights: one close behind the ears, two in front of them

#declare Count = 3;
#declare Kinds = array[Count] {"POINT", "POINT", "POINT"}
#declare Colors = array[Count] {(Blue ? <15, 64, 255> / 255 : <255, 112, 69> / 255), <1, 0.9, 0.8>, <0.5, 0.6, 1>}
#declare Positions = array[Count] {<0, 0.35, 0.8>, <-2.5, 2, -3.5>, <3, 1, -3>}
#declare Powers = array[Count] {40, 60, 30}  // W, as in Blender

// Blender's watts: irradiance P / (4 pi d^2), and the radiance of a diffuse surface is irradiance / pi. POV-Ray's attenuation is
// 2 / (1 + (d / f)^2).
#declare F = 1e-3;
#for (K, 0, Count - 1)
    light_source { Positions[K] rgb Colors[K] * Powers[K] / (4 * pi * pi) / (2 * F * F) fade_distance F fade_power 2 }
#end

// ---- lookups: Eq. 1-3 and the fixed one. Strength: the fraction of the light that enters.

#declare Light = Skinglow_Light_Weight(Count, Kinds, Colors, Positions, Powers, <0, 0, 0>, <1, 0, 1>);
#declare Base = Skinglow_Six_Gaussian_Base(Size, Max_Thickness)
#declare Recolored = Skinglow_Recolor(Base, Skinglow_Blood, Light)
#declare Fixed = Skinglow_Six_Gaussian(Size, Max_Thickness)

// ---- the ear: a front with folds and a back, separated by a known thickness

#macro Bump(V, Center, Width)
    exp(-pow((V - Center) / Width, 2))
#end

// mm at R (0 at the center, 1 at the rim) and Angle (0 behind, pi at the head, radians)
#macro Ear_Thickness(R, Angle)
    ((0.6 + 2.2 * Bump(R, 0.86, 0.09) + 1.8 * Bump(R, 0.5, 0.1) * (1 + cos(Angle)) / 2
      + 3 * Bump(R, 0.7, 0.3) * pow(max(-sin(Angle), 0), 3) + 9 * R * pow(max(-cos(Angle), 0), 6)) * sqrt(max(1 - pow(R, 16), 0)))
#end

#macro Ear_Fold(R, Angle)
    (7 * Bump(R, 0.9, 0.12) * (1 + 0.6 * cos(Angle - 0.6)) + 4.5 * Bump(R, 0.5, 0.13) * (1 + cos(Angle)) / 2 - 7 * Bump(R, 0.1, 0.3))
#end

#macro Ear_Point(R, Angle, Side)
    #local Depth = -Ear_Fold(R, Angle) + Side * Ear_Thickness(R, Angle) / 2;
    (Millimeter * <R * cos(Angle) * (19 + 5 * sin(Angle)), R * sin(Angle) * 31, Depth + 5 * R * cos(Angle)>)
#end

#macro Ear_Normal(R, Angle, Side)
    #local H = 1e-3;
    vnormalize(vcross(Ear_Point(R + H, Angle, Side) - Ear_Point(R - H, Angle, Side),
                      Ear_Point(R, Angle + H, Side) - Ear_Point(R, Angle - H, Side)))
#end

#declare Rings = 40;
#declare Spokes = 96;
#macro Ear_Radius(I) (0.002 + 0.996 * I / (Rings - 1)) #end
#macro Ear_Skin(Side)
    mesh2 {
        vertex_vectors { Rings * Spokes #for (I, 0, Rings - 1) #for (J, 0, Spokes - 1)
            , Ear_Point(Ear_Radius(I), 2 * pi * J / Spokes, Side) #end #end }
        normal_vectors { Rings * Spokes #for (I, 0, Rings - 1) #for (J, 0, Spokes - 1)
            , Ear_Normal(Ear_Radius(I), 2 * pi * J / Spokes, Side) #end #end }
        uv_vectors { Rings * Spokes #for (I, 0, Rings - 1) #for (J, 0, Spokes - 1)
            , <Skinglow_Lut_U(Ear_Thickness(Ear_Radius(I), 2 * pi * J / Spokes), Size, Max_Thickness), 0.5> #end #end }
        face_indices { 2 * (Rings - 1) * Spokes
            #for (I, 0, Rings - 2)
                #for (J, 0, Spokes - 1)
                    #local A = I * Spokes + J;
                    #local B = I * Spokes + mod(J + 1, Spokes);
                    , <A, B, A + Spokes>, <B, B + Spokes, A + Spokes>
                #end
            #end
        }
        uv_mapping
    }
#end

#declare Ear = union {
    Ear_Skin(-1)
    Ear_Skin(1)
}
#declare Skin = pigment { rgb <0.50, 0.27, 0.19> }

object { Ear texture { Skinglow_Skin(Skin, 1, Skinglow_Table_Pigment(Fixed), 0.7) } translate -0.24 * x }
object { Ear texture { Skinglow_Skin(Skin, 1, Skinglow_Table_Pigment(Recolored), 0.7) } translate 0.24 * x }

background { rgb <0.01, 0.011, 0.013> }
camera { location <0, 0, -3> direction z right 0.36 * x up 0.27 * y }
