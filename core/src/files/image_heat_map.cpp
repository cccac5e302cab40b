#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "files/atomic_file.h"
#include "files/color_encoding.h"
#include "files/image_compare.h"
#include "files/image_io.h"
#include "numerics/argument_check.h"
#include "rig_files/file_error.h"

namespace skinglow::detail {
namespace {

/// Rows of 8-bit sRGB as a PNG.
void write_picture(const std::filesystem::path& path, int width, int channels,
                   const std::map<std::string, std::string>& text, const std::vector<std::uint8_t>& pixels) {
    const int height = static_cast<int>(pixels.size()) / (width * channels);
    OIIO::ImageSpec spec(width, height, channels, OIIO::TypeUInt8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    write_atomically(path, image_bytes(path, spec, text, pixels.data()));
}

}  // namespace

double heat_map_white(const ImageComparison& comparison) {
    return comparison.total.max > 0.0 ? comparison.total.max : 1.0;
}

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

std::vector<std::uint8_t> heat_map_pixels(const ImageComparison& comparison, double white) {
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
    return pixels;
}

double write_heat_map(const std::filesystem::path& path, const ImageComparison& comparison,
                      std::optional<double> scale) {
    if (small_extension(path) != ".png") refuse_file(path, "cannot hold a heat map", "name it .png");
    const double white = scale ? require_positive("heat map scale", *scale) : heat_map_white(comparison);
    const std::vector<std::uint8_t> pixels = heat_map_pixels(comparison, white);
    write_picture(path, comparison.width, 4, {{"skinglow:heat_map_white", to_text(white)}}, pixels);
    return white;
}
void write_side_by_side(const std::filesystem::path& path, const std::filesystem::path& first,
                        const std::filesystem::path& second, const ImageComparison& comparison,
                        double heat_map_white) {
    if (small_extension(path) != ".png")
        refuse_file(path, "cannot hold a picture to look at", "name it .png");
    const std::array<LinearImage, 2> images = {read_image(first), read_image(second)};
    const std::vector<std::uint8_t> heat = heat_map_pixels(comparison, heat_map_white);
    const auto width = static_cast<std::size_t>(comparison.width);
    std::vector<std::uint8_t> pixels;
    pixels.reserve(9 * comparison.error.size());
    for (std::size_t row = 0; row < static_cast<std::size_t>(comparison.height); ++row) {
        for (const LinearImage& image : images) {
            for (std::size_t i = 3 * row * width; i < 3 * (row + 1) * width; ++i) {
                const double encoded = linear_to_srgb(std::clamp(double{image.rgb[i]}, 0.0, 1.0));
                pixels.push_back(static_cast<std::uint8_t>(std::lround(255.0 * encoded)));
            }
        }
        for (std::size_t i = row * width; i < (row + 1) * width; ++i)
            pixels.insert(pixels.end(), {heat[4 * i], heat[4 * i + 1], heat[4 * i + 2]});
    }
    write_picture(path, 3 * comparison.width, 3, {}, pixels);
}

}  // namespace skinglow::detail
