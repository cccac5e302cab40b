#include <algorithm>

#include "numerics/argument_check.h"
#include "povray/povray_parts.h"
#include "povray/sdl_text.h"

namespace skinglow {

std::string povray_frame_choice(std::span<const PovrayFrameFile> files) {
    if (files.empty()) detail::refuse_argument("files", "0 entries", "1 or more");
    const auto include = [](const PovrayFrameFile& entry) {
        return "#include " + detail::sdl_string("file", entry.file);
    };
    detail::SdlText text;
    text.add("#switch (frame_number)\n");
    for (std::size_t i = 0; i + 1 < files.size(); ++i) {
        const int next = files[i + 1].first_frame;
        if (next <= files[i].first_frame) {
            detail::refuse_argument(detail::entry_name("files", i + 1)(), "of frame " + std::to_string(next),
                                    "a frame after " + std::to_string(files[i].first_frame));
        }
        text.add("  #range (", files[i].first_frame, ", ", next - 1, ") ", include(files[i]), " #break\n");
    }
    const int last = files.back().first_frame;
    text.add("  #range (", last, ", 2147483647) ", include(files.back()), " #break\n");
    text.add("  #else ", include(files.front()), "\n#end\n");
    return text.take();
}

namespace detail {

void validate(const PovrayFrames& frames) {
    if (frames.first < 0) refuse_argument("first frame", std::to_string(frames.first), "0 or more");
    if (frames.last < frames.first) {
        refuse_argument("last frame", std::to_string(frames.last),
                        "the first one, " + std::to_string(frames.first) + ", or more");
    }
    require_positive("frames per second", frames.per_second);
}

std::string povray_ini_text(const PovrayScene& scene) {
    const PovrayCamera& camera = scene.camera;
    SdlText text;
    text.add("; povray scene.ini               linear EXR; nine samples on a fixed grid in each pixel\n");
    text.add("; povray \"scene.ini[Preview]\"    a quarter of the width and height, one sample\n");
    text.add("; povray \"scene.ini[Final]\"      49 samples\n");
    text.add("Input_File_Name=scene.pov\nOutput_File_Name=scene.exr\nOutput_File_Type=E\n");
    text.add("Width=", camera.width, "\nHeight=", camera.height);
    text.add(
        "\nDisplay=Off\nAntialias=On\nSampling_Method=1\nAntialias_Depth=3\nAntialias_Threshold=0\nJitter="
        "Off\n");
    if (const auto& frames = scene.frames) {
        // The clock is seconds.
        text.add("Initial_Frame=", frames->first, "\nFinal_Frame=", frames->last,
                 "\nInitial_Clock=0\nFinal_Clock=", (frames->last - frames->first) / frames->per_second,
                 "\n");
    }
    if (is_in_parts(scene)) {
        // Not declared here: POV-Ray holds on to the first declaration, so that no other could be asked for.
        text.add(
            "; Needs Declare=Skinglow_Part=1 (the surface) or 2 (the glow). Their sum is the picture.\n");
    }
    text.add("\n[Preview]\nWidth=", std::max(1U, camera.width / 4),
             "\nHeight=", std::max(1U, camera.height / 4), "\nAntialias=Off\n\n[Final]\nAntialias_Depth=7\n");
    return text.take();
}

}  // namespace detail
}  // namespace skinglow
