#include <algorithm>
#include <cmath>
#include <cstdint>

#include "files/image_output.h"
#include "files/lut_format.h"
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

bool fits_0_to_1(const glm::dvec3& color) {
    return std::min({color.r, color.g, color.b}) >= 0.0 && std::max({color.r, color.g, color.b}) <= 1.0;
}

OIIO::ImageSpec exr_spec(std::size_t width, int channels) {
    OIIO::ImageSpec spec(static_cast<int>(width), 1, channels, OIIO::TypeFloat);
    spec.attribute("compression", "zip");
    spec.attribute("oiio:ColorSpace", "Linear");
    return spec;
}

}  // namespace

std::string lut_exr_bytes(const std::filesystem::path& path, const LutTable& table) {
    std::vector<float> pixels;
    pixels.reserve(table.colors.size() * 3);
    for (std::size_t i = 0; i < table.colors.size(); ++i) {
        for (int channel = 0; channel < 3; ++channel)
            pixels.push_back(to_float(table.colors[i][channel], path, i));
    }
    return image_bytes(path, exr_spec(table.colors.size(), 3), to_header_text(table.record), pixels.data());
}

std::size_t count_clamped(const LutTable& table) {
    const auto held = std::count_if(table.colors.begin(), table.colors.end(), fits_0_to_1);
    return table.colors.size() - static_cast<std::size_t>(held);
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
    if (png.bits == 8) {
        write_image(path, spec, text, quantize_table<std::uint8_t>(table, png).data());
    } else {
        write_image(path, spec, text, quantize_table<std::uint16_t>(table, png).data());
    }
    return {count_clamped(table)};
}

void write_base_lut(const std::filesystem::path& path, const BaseLut& base) {
    if (small_extension(path) != ".exr") {
        refuse_file(path, "cannot hold a table of matrices", "name it .exr; it has nine channels of floats");
    }
    std::vector<float> pixels;
    pixels.reserve(base.size() * 9);
    for (std::size_t texel = 0; texel < base.size(); ++texel) {
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) {
                pixels.push_back(
                    to_float(base.matrices()[texel][column][row], path, texel));  // GLM: column first
            }
        }
    }
    OIIO::ImageSpec spec = exr_spec(base.size(), 9);
    spec.channelnames = matrix_channels();
    LutRecord record;
    record.max_thickness_mm = base.axis().max_thickness_mm();
    HeaderText text = to_header_text(record);
    text["skinglow:table"] = "base";
    write_image(path, spec, text, pixels.data());
}

}  // namespace skinglow::detail
