// Verification of skinglow_textures.inc, a picture without a seam: bands whose right half has a lookup along u, and whose left half
// is computed, mirrored. From top to bottom: a table along u, a table by a picture of thickness, a picture as lookup, a surface lit
// by a sun, and surface and glow together. The picture, a ramp of 8 texels, is rendered first.
//
//   cd povray_macros && povray verify/textures.pov +W8 +H1 -D -A +FE +Otextures.exr Declare=Ramp=1
//   povray verify/textures.pov +W320 +H200 -D -A

#version 3.7;
#include "skinglow.inc"
global_settings { assumed_gamma 1.0 }
#ifndef (Ramp) #declare Ramp = 0; #end

#if (Ramp)
    camera { orthographic location <0.5, 0.5, -9> direction z right x up y }
    plane { -z, 0 pigment { function { min(max(x, 0), 1) } color_map { [0 rgb 0] [1 rgb 1] } } finish { ambient 0 diffuse 0 emission 1 } }
#else
    Skinglow_Light("SUN", <1, 1, 1>, 9 * z, <0.6, 0, -0.8>, pi, Skinglow_Sun_Shape(0))
    #declare Table = array[5] {<0, 0.8, 0.2>, <0.2, 0.6, 0.2>, <0.4, 0.4, 0.2>, <0.6, 0.2, 0.2>, <0.8, 0, 0.2>}

    // Both halves; u is 0.1 in the middle of the picture and 0.9 at its sides, for beyond the outer texels' centers pictures repeat.
    #macro Band(Row, Red, Green, Blue, Texture)
        union {
            mesh2 {
                vertex_vectors { 4, <0, -0.5, 0>, <4, -0.5, 0>, <4, 0.5, 0>, <0, 0.5, 0> }
                uv_vectors { 4, <0.1, 0.5>, <0.9, 0.5>, <0.9, 0.5>, <0.1, 0.5> }
                face_indices { 2, <0, 1, 2>, <0, 2, 3> }
                uv_mapping
                texture { Texture }
            }
            box {
                <-4, -0.5, -0.1>, <0, 0.5, 0>
                pigment {
                    average pigment_map {
                        [1 function { Red(0.1 - 0.2 * x) } color_map { [0 rgb 0] [1 rgb 3 * x] }]
                        [1 function { Green(0.1 - 0.2 * x) } color_map { [0 rgb 0] [1 rgb 3 * y] }]
                        [1 function { Blue(0.1 - 0.2 * x) } color_map { [0 rgb 0] [1 rgb 3 * z] }]
                    }
                }
                finish { ambient 0 diffuse 0 emission 1 }
            }
            translate (2 - Row) * y
        }
    #end

    // Entry 0 of the table is at the center of the first of five texels.
    #declare Entry = function(x) { min(max(5 * x - 0.5, 0), 4) }
    #declare Half_Red = function(x) { 0.5 * 0.2 * Entry(x) }
    #declare Half_Green = function(x) { 0.5 * (0.8 - 0.2 * Entry(x)) }
    #declare Half_Blue = function(x) { 0.1 }
    Band(0, Half_Red, Half_Green, Half_Blue, texture { Skinglow_Glow(Skinglow_Table_Pigment(Table), 0.5) })

    // 0 to 8 mm in a table of 8 mm.
    #declare Mm = Skinglow_Picture_Thickness("textures.exr", 0, 8)
    #declare Red = function(x) { 0.8 * x }
    #declare Green = function(x) { 0.8 * (1 - x) }
    #declare Blue = function(x) { 0.2 }
    Band(1, Red, Green, Blue, texture { Skinglow_Glow(Skinglow_Thickness_Pigment(Table, 8, Mm, 1), 1) })

    #declare Gray = function(x) { x }
    Band(2, Gray, Gray, Gray, texture { Skinglow_Glow(Skinglow_Image_Pigment("textures.exr"), 1) })

    // A white sun of pi W/m^2 gives 0.8 times the color.
    #declare Lit_Red = function(x) { 0.8 * 0.5 * 0.7 }
    #declare Lit_Green = function(x) { 0.8 * 0.3 * 0.7 }
    #declare Lit_Blue = function(x) { 0.8 * 0.2 * 0.7 }
    Band(3, Lit_Red, Lit_Green, Lit_Blue, texture { Skinglow_Surface(pigment { rgb <0.5, 0.3, 0.2> }, 0.7) })

    #declare Sum_Red = function(x) { Half_Red(x) + Lit_Red(x) }
    #declare Sum_Green = function(x) { Half_Green(x) + Lit_Green(x) }
    #declare Sum_Blue = function(x) { Half_Blue(x) + Lit_Blue(x) }
    Band(4, Sum_Red, Sum_Green, Sum_Blue,
         texture { Skinglow_Skin(pigment { rgb <0.5, 0.3, 0.2> }, 0.7, Skinglow_Table_Pigment(Table), 0.5) })

    camera { orthographic location 9 * z direction -z right -8 * x up 5 * y }
#end
