// Verification of an exported scene: prints the table that the macros compute from its base lookup and its lights, for
// comparison with the table of the exporting program. Copy this file next to the scene's lut.inc (glow by macros, any mode) and
// run it there; it writes lut.txt, one entry per line: red, green and blue, each as M p E for M * 2^E.
//
//   povray lut.pov -D -F

#version 3.7;
global_settings { assumed_gamma 1.0 }
#include "skinglow.inc"
#if (file_exists("lights.inc")) #include "lights.inc" #end
#include "lut.inc"

#fopen Numbers "lut.txt" write
#for (I, 0, dimension_size(Skinglow_Table, 1) - 1)
    #local Entry = Skinglow_Table[I];
    #write (Numbers, Skinglow_Exact_Text(Entry.x), " ", Skinglow_Exact_Text(Entry.y), " ", Skinglow_Exact_Text(Entry.z), "\n")
#end
#fclose Numbers
camera { location -z }
