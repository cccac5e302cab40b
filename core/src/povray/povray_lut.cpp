#include <algorithm>
#include <array>
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

void add_paper_table(SdlText& text, const PovrayLut& lut) {
    const AttenuationCoefficients& k = lut.coefficients;
    text.add("// Base lookup: brightness by thickness.\n");
    add_array(text, "Base", lut.base.size(), 8, [&](std::size_t i) { return lut.base[i]; });
    text.add("#declare Skinglow_Blood_Weight = ", lut.blood_weight, ";  // B\n");
    text.add("// Eq. 2 and 3: what the distances are measured to, and k_c, k_l, k_q.\n");
    text.add("#declare Skinglow_Weight = Skinglow_Listed_Weight(", lut.point, ", ",
             glm::dvec3(k.constant, k.linear, k.quadratic), ");  // L\n");
    text.add(
        "#declare Skinglow_Table = Skinglow_Recolor(Skinglow_Base, Skinglow_Blood_Weight, "
        "Skinglow_Weight)\n");
}

void add_physical_table(SdlText& text, const PovrayLut& lut) {
    text.add("#include \"columns.inc\"\n// W/m^2 of the lights where they are measured, and of the world.\n");
    text.add("#declare Skinglow_E = Skinglow_Listed_Irradiance(", lut.point, ") + ", lut.world_irradiance,
             ";\n");
    text.add(
        "#declare Skinglow_Table = Skinglow_Recolor_Columns(Skinglow_Red_Column, Skinglow_Green_Column,\n"
        "    Skinglow_Blue_Column, Skinglow_Diffuse_Radiance(Skinglow_E))\n");
}

void check_picture(const PovrayThicknessPicture& picture) {
    const std::string_view keyword = povray_image_keyword("thickness image", picture.file);
    if (keyword != "exr" && keyword != "png" && keyword != "tiff") {
        refuse_argument("thickness image", "\"" + sdl_comment(picture.file) + "\"",
                        "a name that ends in .exr, .png, .tif or .tiff");
    }
    require_finite("thickness at black", picture.black_mm);
    require_finite("thickness at white", picture.white_mm);
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
    if (lut.thickness) check_picture(*lut.thickness);
    if (lut.glow != PovrayGlow::macros) {
        if (povray_image_keyword("LUT image", lut.image) != "exr") {
            refuse_argument("LUT image", "\"" + sdl_comment(lut.image) + "\"", "a name that ends in .exr");
        }
        if (lut.thickness) {
            refuse_argument("glow", "an image, with a thickness image",
                            "macros: they look the thickness up in a table of their own");
        }
        return;
    }
    if (lut.mode == LutMode::existing) return;
    require_finite("point", lut.point);
    if (lut.mode == LutMode::physical) {
        require_count("matrices", lut.matrices.size(), lut.axis.size(), "the axis's");
        for (std::size_t i = 0; i < lut.matrices.size(); ++i) {
            for (int column = 0; column < 3; ++column)
                require_finite(entry_name("matrices", i), lut.matrices[i][column]);
        }
        require_finite("world_irradiance", lut.world_irradiance);
        return;
    }
    require_count("base", lut.base.size(), lut.axis.size(), "the axis's");
    for (std::size_t i = 0; i < lut.base.size(); ++i)
        require_not_negative(entry_name("base", i), lut.base[i]);
    require_finite("blood_weight", lut.blood_weight);
    validate(lut.coefficients);
}

std::string povray_columns_text(const PovrayLut& lut) {
    SdlText text;
    text.add(
        "// Skin of mode physical: what comes through of red, green and blue light alone, per unit of "
        "radiant ");
    text.add("exitance: the\n// columns of M(d), linear Rec.709, ", lut.axis.size(), " entries, 0 to ",
             lut.axis.max_thickness_mm(), " mm. For Skinglow_Recolor_Columns.\n");
    const std::array<std::string_view, 3> names = {"Red_Column", "Green_Column", "Blue_Column"};
    for (int column = 0; column < 3; ++column) {
        add_array(text, names[static_cast<std::size_t>(column)], lut.matrices.size(), 4,
                  [&](std::size_t i) { return lut.matrices[i][column]; });
    }
    return text.take();
}

std::string povray_lut_text(const PovrayLut& lut) {
    SdlText text;
    const bool by_thickness = lut.glow != PovrayGlow::texels;
    if (by_thickness) {
        text.add("// Lookup of the light that comes through, mode `", to_text(lut.mode),
                 "`: ", lut.axis.size(), " entries, 0 to ", lut.axis.max_thickness_mm(),
                 " mm, at the centers of u's texels. Linear Rec.709. After lights.inc.\n");
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
        if (lut.mode == LutMode::paper) add_paper_table(text, lut);
        if (lut.mode == LutMode::physical) add_physical_table(text, lut);
    }
    if (lut.thickness) {
        text.add("#declare Skinglow_Thickness_mm = Skinglow_Picture_Thickness(",
                 sdl_string("thickness image", lut.thickness->file), ", ", lut.thickness->black_mm, ", ",
                 lut.thickness->white_mm, ")\n#declare Skinglow_Lookup = ");
        text.add("Skinglow_Thickness_Pigment(Skinglow_Table, ", lut.axis.max_thickness_mm(),
                 ", Skinglow_Thickness_mm, 1)\n");
    } else {
        text.add("#declare Skinglow_Lookup = Skinglow_Table_Pigment(Skinglow_Table)\n");
    }
    return text.take();
}

}  // namespace detail
}  // namespace skinglow
