// Verification of skinglow_lights.inc and Skinglow_Over, a picture without a seam: white floors, each under a light of one kind 2 m
// above its middle (from top to bottom: point, soft point, sun, spot, area), on the left half computed from the light's law, on
// the right half lit by Skinglow_Light. Declare=Over=1 puts a glow of 0.1 over the lit half by Skinglow_Over, and adds 0.1 to the
// other.
//
//   cd povray_macros && povray verify/lights.pov +W320 +H200 -D -A Declare=Over=1

#version 3.7;
#include "skinglow.inc"
global_settings { assumed_gamma 1.0 }
#ifndef (Over) #declare Over = 0; #end

// Radiance of a white floor, irradiance / pi.
#declare Squared = function(x, y) { x * x + y * y + 4 }
#declare Cosine = function(x, y) { 2 / sqrt(Squared(x, y)) }
#declare Point = function(x, y) { 60 / (4 * pi) / Squared(x, y) * Cosine(x, y) / pi }
#declare Soft_Point = function(x, y) { 60 / (4 * pi) / (Squared(x, y) + 0.25) * Cosine(x, y) / pi }
#declare Sun = function(x, y) { 2 * 0.8 / pi }
#declare Ramp = function(x, y) { min(max((Cosine(x, y) - cos(0.8)) / (0.4 * (1 - cos(0.8))), 0), 1) }
#declare Spot = function(x, y) { Point(x, y) * Ramp(x, y) * Ramp(x, y) * (3 - 2 * Ramp(x, y)) }
#declare Area = function(x, y) { 16 / pi / Squared(x, y) * Cosine(x, y) * Cosine(x, y) / pi }

#macro Floor(Band, Law, Kind, Direction, Power, Shape)
    light_group {
        Skinglow_Light(Kind, <1, 1, 1>, -2 * Direction, Direction, Power, Shape)
        box {
            <0, -0.5, -0.1>, <4, 0.5, 0>
            texture {
                #if (Over)
                    Skinglow_Over(texture { pigment { rgb 1 } finish { ambient 0 diffuse 1 } }, pigment { rgb 1 }, 0.1)
                #else
                    pigment { rgb 1 } finish { ambient 0 diffuse 1 }
                #end
            }
        }
        box {
            <-4, -0.5, -0.1>, <0, 0.5, 0>
            pigment { function { Law(x, y) + 0.1 * Over } color_map { [0 rgb 0] [1 rgb 1] } }
            finish { ambient 0 diffuse 0 emission 1 }
        }
        global_lights off
        translate (2 - Band) * y
    }
#end

Floor(0, Point, "POINT", -z, 60, Skinglow_Point_Shape(0, 1))
Floor(1, Soft_Point, "POINT", -z, 60, Skinglow_Point_Shape(0.5, 1))
Floor(2, Sun, "SUN", <0.6, 0, -0.8>, 2, Skinglow_Sun_Shape(0))
Floor(3, Spot, "SPOT", -z, 60, Skinglow_Spot_Shape(0, 1, 1.6, 0.4, 0))
Floor(4, Area, "AREA", -z, 16, Skinglow_Rectangle_Shape(0.001, 0.001, x, pi))

camera { orthographic location 9 * z direction -z right -8 * x up 5 * y }
