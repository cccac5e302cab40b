// Verification of an exported scene: what the macros make of its base lookup and its lamps, in numbers, to be compared
// with the LUT that the other host shows. Copy this file beside the scene's lut.inc (mode `paper` or `existing`, glow by
// macros) and run it there; it writes lut.txt, one entry a line: red, green and blue, each as M p E for M * 2^E.
//
//   povray verify_lut.pov -D -F

#version 3.7;
global_settings { assumed_gamma 1.0 }
#include "lut.inc"

#fopen Numbers "lut.txt" write
#for (I, 0, dimension_size(Skinglow_Table, 1) - 1)
    #local Entry = Skinglow_Table[I];
    #write (Numbers, Skinglow_Exact_Text(Entry.x), " ", Skinglow_Exact_Text(Entry.y), " ", Skinglow_Exact_Text(Entry.z), "\n")
#end
#fclose Numbers
camera { location -z }
