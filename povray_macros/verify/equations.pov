// Verification of skinglow.inc: Eq. 1-3 for the paper's experiment (its Table 1) against values derived by hand in
// exact fractions. Stops with an #error at a relative difference above 1e-12; writes the results to
// equations.txt, "name M p E" for M * 2^E.
//
//   cd povray_macros && povray verify/equations.pov -D -F

#version 3.7;
#declare Skinglow_Light_Sources = 0;
#include "skinglow.inc"
global_settings { assumed_gamma 1.0 }

#fopen Numbers "equations.txt" write

#macro Verify(Name, Value, Expected)
    #write (Numbers, Name, " ", Skinglow_Exact_Text(Value), "\n")
    #if (abs(Value - Expected) > 1e-12 * abs(Expected))
        #error concat(Name, " is ", str(Value, 0, 17), ", should be ", str(Expected, 0, 17), "\n")
    #end
#end

#macro Verify_Color(Name, Value, Expected)
    Verify(concat(Name, ".r"), Value.x, Expected.x)
    Verify(concat(Name, ".g"), Value.y, Expected.y)
    Verify(concat(Name, ".b"), Value.z, Expected.z)
#end

// Table 1: bytes / 255, each light at its distance from the origin, in different directions. Coefficients (1, 0, 1).
#declare Distances = array[3] {0.92357, 0.85231, 1.01292}
#declare Kinds = array[3] {"POINT", "SPOT", "AREA"}
#declare Colors = array[3] {<255, 112, 69> / 255, <15, 64, 255> / 255, <1, 1, 1>}
#declare Positions = array[3] {Distances[0] * x, Distances[1] * <0, -0.6, 0.8>, -Distances[2] * z}
#declare Powers = array[3] {100, 1, -1}

#declare Attenuations = array[3] {0.5396707823412062, 0.5792291878979711, 0.49358172816165746}
#declare Terms = array[3] {<0.5396707823412062, 0.2370318730282945, 0.14602856463350286>,
                           <0.034072305170468886, 0.14537516872733391, 0.5792291878979711>,
                           <0.49358172816165746, 0.49358172816165746, 0.49358172816165746>}
#declare Weights = Skinglow_Light_Weights(3, Kinds, Colors, Positions, Powers, <0, 0, 0>, <1, 0, 1>)
#for (K, 0, 2)
    Verify(concat("attenuation", str(K + 1, 0, 0)), Skinglow_Attenuation(Distances[K], <1, 0, 1>), Attenuations[K])
    Verify_Color(concat("weight", str(K + 1, 0, 0)), Weights[K], Terms[K])
#end

#declare Light = Skinglow_Light_Weight(3, Kinds, Colors, Positions, Powers, <0, 0, 0>, <1, 0, 1>);
Verify_Color("L", Light, <1.0673248156733326, 0.8759887699172859, 1.2188394806931313>)

// The same lights as a list, and an empty one.
Skinglow_Light("POINT", Colors[0], Positions[0], -z, Powers[0], Skinglow_Point_Shape(0, 1))
Skinglow_Light("SPOT", Colors[1], Positions[1], -z, Powers[1], Skinglow_Spot_Shape(0, 1, 1, 0, 0))
Skinglow_Light("AREA", Colors[2], Positions[2], -z, Powers[2], Skinglow_Rectangle_Shape(1, 1, x, pi))
Verify_Color("listed", Skinglow_Listed_Weight(<0, 0, 0>, <1, 0, 1>), Light)
Skinglow_Forget_Lights()
Verify_Color("forgotten", Skinglow_Listed_Weight(<0, 0, 0>, <1, 0, 1>), <0, 0, 0>)

#declare Base = array[2] {1, 0.25}
#declare Table = Skinglow_Recolor(Base, Skinglow_Blood, Light)
Verify_Color("B+L", Table[0], <2.8673248156733324, 1.375988769917286, 1.6188394806931314>)
Verify_Color("quarter", Table[1], <0.7168312039183331, 0.3439971924793215, 0.40470987017328286>)

#fclose Numbers
#debug "skinglow.inc: Table 1 agrees to 1e-12\n"
camera { location -z }
