#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>

#include "files/atomic_file.h"
#include "files/image_io.h"
#include "files/lut_file.h"
#include "numerics/argument_check.h"
#include "rig_files/file_error.h"

namespace skinglow::detail {
namespace {

float to_float(double value, const std::filesystem::path& path, std::size_t texel) {
    const auto narrow = static_cast<float>(value);
    if (!std::isfinite(narrow)) {
        refuse_file(path, "cannot hold " + to_text(value) + ", which is beyond float32",
                    "lower the lights' colors or powers, or write .csv", "texel " + std::to_string(texel));
    }
    return narrow;
}

template <class Number>
std::vector<Number> quantize_table(const LutTable& table, const PngOptions& png) {
    constexpr unsigned levels = static_cast<Number>(-1);
    std::vector<Number> pixels;
    pixels.reserve(table.colors.size() * 3);
    for (const glm::dvec3& color : table.colors) {
        for (int i = 0; i < 3; ++i)
            pixels.push_back(static_cast<Number>(quantize(color[i], png.encoding, levels)));
    }
    return pixels;
}

/// Texels with a channel below 0 or above 1, which files of whole numbers cannot hold.
std::size_t count_clamped(const LutTable& table) {
    return static_cast<std::size_t>(
        std::count_if(table.colors.begin(), table.colors.end(),
                      [](const glm::dvec3& color) { return color != glm::clamp(color, 0.0, 1.0); }));
}

/// The table at 0 (first entry) to 1 (last).
glm::dvec3 sample(const std::vector<glm::dvec3>& colors, double position) {
    const double index = position * static_cast<double>(colors.size() - 1);
    const auto below = static_cast<std::size_t>(index);
    const std::size_t above = std::min(below + 1, colors.size() - 1);
    return glm::mix(colors[below], colors[above], index - static_cast<double>(below));
}

}  // namespace

std::string lut_exr_bytes(const std::filesystem::path& path, const LutTable& table) {
    std::vector<float> pixels;
    pixels.reserve(table.colors.size() * 3);
    for (std::size_t i = 0; i < table.colors.size(); ++i) {
        for (int channel = 0; channel < 3; ++channel)
            pixels.push_back(to_float(table.colors[i][channel], path, i));
    }
    OIIO::ImageSpec spec(static_cast<int>(table.colors.size()), 1, 3, OIIO::TypeFloat);
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    return image_bytes(path, spec, to_header_text(table.record), pixels.data());
}

LutWriteReport write_lut_png(const std::filesystem::path& path, const LutTable& table,
                             const PngOptions& png) {
    const bool srgb = png.encoding == Encoding::srgb;
    HeaderText text = to_header_text(table.record);
    text["skinglow:encoding"] = srgb ? "sRGB" : "linear";
    OIIO::ImageSpec spec(static_cast<int>(table.colors.size()), 1, 3,
                         png.bits == 8 ? OIIO::TypeUInt8 : OIIO::TypeUInt16);
    // OpenImageIO makes of these the PNG chunks sRGB or gAMA, which viewers and renderers know.
    spec.attribute("oiio:ColorSpace", srgb ? "sRGB" : "Linear");
    const auto bytes = [&](const auto& pixels) { return image_bytes(path, spec, text, pixels.data()); };
    write_atomically(path, png.bits == 8 ? bytes(quantize_table<std::uint8_t>(table, png))
                                         : bytes(quantize_table<std::uint16_t>(table, png)));
    return {count_clamped(table)};
}

LutWriteReport write_lut_preview(const std::filesystem::path& path, const LutTable& table, int width,
                                 int height) {
    require_between("preview width", width, 1, 16384, " pixels");
    require_between("preview height", height, 1, 16384, " pixels");
    if (small_extension(path) != ".png") refuse_file(path, "cannot hold a preview", "name it .png");
    const LutAxis checked(table.colors.size(), table.record.max_thickness_mm);
    LutTable columns;
    for (int x = 0; x < width; ++x)
        columns.colors.push_back(
            sample(table.colors, width == 1 ? 0.0 : static_cast<double>(x) / (width - 1)));
    const std::vector<std::uint8_t> row = quantize_table<std::uint8_t>(columns, {.encoding = Encoding::srgb});
    std::vector<std::uint8_t> pixels;
    pixels.reserve(row.size() * static_cast<std::size_t>(height));
    for (int y = 0; y < height; ++y) pixels.insert(pixels.end(), row.begin(), row.end());
    OIIO::ImageSpec spec(width, height, 3, OIIO::TypeUInt8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    write_atomically(
        path, image_bytes(path, spec, {{"skinglow:max_thickness_mm", to_text(table.record.max_thickness_mm)}},
                          pixels.data()));
    return {count_clamped(table)};
}

}  // namespace skinglow::detail
