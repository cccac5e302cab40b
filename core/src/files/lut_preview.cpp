#include "files/lut_preview.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "files/image_output.h"
#include "numerics/argument_check.h"
#include "rig_files/file_error.h"

namespace skinglow::detail {
namespace {

void check_side(const char* name, int value) {
    constexpr int longest = 16384;
    if (value < 1 || value > longest) refuse_argument(name, std::to_string(value), "1 to 16384 pixels");
}

/// The table at 0 (first entry) to 1 (last).
glm::dvec3 sample(const std::vector<glm::dvec3>& colors, double position) {
    const double place = position * static_cast<double>(colors.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), colors.size() - 1);
    const std::size_t above = std::min(below + 1, colors.size() - 1);
    const double share = place - static_cast<double>(below);
    return colors[below] * (1.0 - share) + colors[above] * share;
}

}  // namespace

LutWriteReport write_lut_preview(const std::filesystem::path& path, const LutTable& table, int width,
                                 int height) {
    check_side("preview width", width);
    check_side("preview height", height);
    if (small_extension(path) != ".png") refuse_file(path, "cannot hold a preview", "name it .png");
    const LutAxis checked(table.colors.size(), table.record.max_thickness_mm);
    std::vector<std::uint8_t> row;
    for (int x = 0; x < width; ++x) {
        const glm::dvec3 color =
            sample(table.colors, width == 1 ? 0.0 : static_cast<double>(x) / (width - 1));
        for (int i = 0; i < 3; ++i)
            row.push_back(static_cast<std::uint8_t>(quantize(color[i], Encoding::srgb, 255)));
    }
    std::vector<std::uint8_t> pixels;
    pixels.reserve(row.size() * static_cast<std::size_t>(height));
    for (int y = 0; y < height; ++y) pixels.insert(pixels.end(), row.begin(), row.end());
    OIIO::ImageSpec spec(width, height, 3, OIIO::TypeUInt8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    write_image(path, spec, {{"skinglow:max_thickness_mm", to_text(table.record.max_thickness_mm)}},
                pixels.data());
    return {count_clamped(table)};
}

}  // namespace skinglow::detail
