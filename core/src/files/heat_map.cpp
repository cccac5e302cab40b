#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "files/image_compare.h"
#include "files/image_output.h"
#include "numerics/argument_check.h"
#include "rig_files/file_error.h"

namespace skinglow::detail {

std::array<double, 3> heat_color(double value) {
    constexpr double start = 0.5;
    constexpr double rotations = -1.5;
    const double brightness = std::clamp(value, 0.0, 1.0);
    const double angle = 2.0 * std::numbers::pi * (start / 3.0 + 1.0 + rotations * brightness);
    const double amplitude = brightness * (1.0 - brightness) / 2.0;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    // Green 2011, Eq. 2: directions of constant perceived brightness around the gray diagonal.
    return {std::clamp(brightness + amplitude * (-0.14861 * c + 1.78277 * s), 0.0, 1.0),
            std::clamp(brightness + amplitude * (-0.29227 * c - 0.90649 * s), 0.0, 1.0),
            std::clamp(brightness + amplitude * (1.97294 * c), 0.0, 1.0)};
}

double write_heat_map(const std::filesystem::path& path, const ImageComparison& comparison,
                      std::optional<double> scale) {
    if (small_extension(path) != ".png") refuse_file(path, "cannot hold a heat map", "name it .png");
    const double largest = comparison.total.max > 0.0 ? comparison.total.max : 1.0;
    const double white = scale ? require_positive("heat map scale", *scale) : largest;
    std::vector<std::uint8_t> pixels;
    pixels.reserve(comparison.error.size() * 4);
    for (const float error : comparison.error) {
        if (error < 0.0F) {
            pixels.insert(pixels.end(), {0, 0, 0, 0});
            continue;
        }
        for (const double channel : heat_color(error / white)) {
            pixels.push_back(static_cast<std::uint8_t>(std::lround(channel * 255.0)));
        }
        pixels.push_back(255);
    }
    OIIO::ImageSpec spec(comparison.width, comparison.height, 4, OIIO::TypeUInt8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    write_image(path, spec, {{"skinglow:heat_map_white", to_text(white)}}, pixels.data());
    return white;
}

}  // namespace skinglow::detail
