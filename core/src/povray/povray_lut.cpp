#include <algorithm>
#include <map>

#include "numerics/argument_check.h"
#include "povray/povray_parts.h"
#include "povray/sdl_text.h"

namespace skinglow {
namespace {

template <typename ValueAt>
void add_array(SdlText& text, std::string_view name, std::size_t size, std::size_t per_line,
               ValueAt value_at) {
    text.add("#declare Skinglow_", name, " = array[", size, "] {");
    for (std::size_t i = 0; i < size; ++i) text.add_item(i, per_line, value_at(i));
    text.add("\n}\n");
}

void add_lights(SdlText& text, const std::vector<Light>& lights) {
    const auto quoted_kind = [&](std::size_t i) {
        return '"' + std::string(to_text(lights[i].kind())) + '"';
    };
    add_array(text, "Light_Kinds", lights.size(), 8, quoted_kind);
    add_array(text, "Light_Colors", lights.size(), 4, [&](std::size_t i) { return lights[i].color(); });
    add_array(text, "Light_Positions", lights.size(), 4, [&](std::size_t i) { return lights[i].position(); });
    add_array(text, "Light_Powers", lights.size(), 8, [&](std::size_t i) { return lights[i].power(); });
}

void add_paper_table(SdlText& text, const PovrayLut& lut, const std::vector<Light>& lights) {
    const AttenuationCoefficients& k = lut.coefficients;
    text.add("// Base lookup: brightness by thickness.\n");
    add_array(text, "Base", lut.base.size(), 8, [&](std::size_t i) { return lut.base[i]; });
    text.add("#declare Skinglow_Blood_Weight = ", lut.blood_weight, ";  // B\n");
    text.add("// Lights that are on. Colors as vectors: POV-Ray keeps `rgb` colors in 24 bits only.\n");
    text.add("#declare Skinglow_Light_Count = ", lights.size(), ";\n");
    if (!lights.empty()) add_lights(text, lights);
    text.add("// Eq. 2 and 3: what the distances are measured to, and k_c, k_l, k_q.\n");
    text.add("#declare Skinglow_Light = Skinglow_Light_Weight(Skinglow_Light_Count, ");
    text.add(
        lights.empty()
            ? "0, 0, 0, 0"
            : "Skinglow_Light_Kinds, Skinglow_Light_Colors, Skinglow_Light_Positions, Skinglow_Light_Powers");
    text.add(",\n    ", lut.point, ", ", glm::dvec3(k.constant, k.linear, k.quadratic), ");  // L\n");
    text.add(
        "#declare Skinglow_Table = Skinglow_Recolor(Skinglow_Base, Skinglow_Blood_Weight, "
        "Skinglow_Light)\n");
}

}  // namespace

std::vector<double> gray_entries(const BaseLut& base) {
    std::vector<double> gray;
    gray.reserve(base.size());
    for (const glm::dmat3& matrix : base.matrices()) {
        if (matrix != glm::dmat3(matrix[0][0])) {
            refuse_argument("base lookup entry " + std::to_string(gray.size()), "a matrix",
                            "a gray one, a multiple of the identity");
        }
        gray.push_back(matrix[0][0]);
    }
    return gray;
}

namespace detail {

std::string_view povray_image_keyword(std::string_view field, std::string_view file) {
    static const std::map<std::string, std::string_view> keywords = {
        {".exr", "exr"},   {".hdr", "hdr"},  {".png", "png"},  {".jpg", "jpeg"},
        {".jpeg", "jpeg"}, {".tif", "tiff"}, {".tiff", "tiff"}};
    const std::string quoted = "\"" + sdl_comment(file) + "\"";
    // POV-Ray may read the scene's folder and nothing else, in the set-up that distributions ship.
    if (file.empty() || file.find_first_of("/\\") != std::string_view::npos) {
        refuse_argument(field, quoted, "the name of a file in the scene's own folder");
    }
    std::string extension(file.substr(std::min(file.rfind('.'), file.size())));
    for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
    if (const auto found = keywords.find(extension); found != keywords.end()) return found->second;
    refuse_argument(field, quoted, "a name that ends in .exr, .hdr, .png, .jpg, .jpeg, .tif or .tiff");
}

void validate(const PovrayLut& lut) {
    require_not_negative("strength", lut.strength);
    if (lut.glow != PovrayGlow::macros) {
        if (povray_image_keyword("LUT image", lut.image) != "exr") {
            refuse_argument("LUT image", "\"" + sdl_comment(lut.image) + "\"", "a name that ends in .exr");
        }
        return;
    }
    if (lut.mode == LutMode::physical) {
        refuse_argument("glow", "macros in mode physical",
                        "image: skinglow.inc computes modes existing and paper");
    }
    if (lut.mode == LutMode::existing) return;
    require_count("base", lut.base.size(), lut.axis.size(), "the axis's");
    for (std::size_t i = 0; i < lut.base.size(); ++i)
        require_not_negative(entry_name("base", i), lut.base[i]);
    require_finite("blood_weight", lut.blood_weight);
    require_finite("point", lut.point);
    validate(lut.coefficients);
}

std::string povray_lut_text(const PovrayLut& lut, const std::vector<Light>& lights_on) {
    SdlText text;
    const bool by_thickness = lut.glow != PovrayGlow::texels;
    if (by_thickness) {
        text.add("// Lookup of the light that comes through, mode `", to_text(lut.mode),
                 "`: ", lut.axis.size(), " entries, 0 to ", lut.axis.max_thickness_mm(),
                 " mm, at the centers of u's texels. Linear Rec.709.\n");
    } else {
        text.add("// The light that comes through at points of the skin. Linear Rec.709.\n");
    }
    text.add("#include \"skinglow.inc\"\n");
    text.add("#declare Skinglow_Strength = ", lut.strength, ";  // radiance shown = strength * lookup\n");
    if (lut.glow != PovrayGlow::macros) {
        text.add("#declare Skinglow_Lookup = Skinglow_Image_Pigment(", sdl_string("LUT image", lut.image),
                 ")\n");
        return text.take();
    }
    if (lut.mode == LutMode::existing) {
        text.add("#declare Skinglow_Table = Skinglow_Six_Gaussian(", lut.axis.size(), ", ",
                 lut.axis.max_thickness_mm(), ")\n");
    } else {
        add_paper_table(text, lut, lights_on);
    }
    text.add("#declare Skinglow_Lookup = Skinglow_Table_Pigment(Skinglow_Table)\n");
    return text.take();
}

}  // namespace detail
}  // namespace skinglow
