#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "files/image_file.h"

namespace skinglow::detail {

/// How far two images are apart, over the pixels that count; linear light.
struct ImageDifference {
    double rms = 0.0;
    double max = 0.0;  ///< largest absolute difference
    std::optional<double>
        psnr;  ///< 20 log10(peak / rms), dB; none where the images are the same (it has no bound)
};

struct CompareOptions {
    double peak = 1.0;               ///< the value that PSNR takes for white; finite, above 0
    bool ignore_edges = false;       ///< leave out antialiased edges: see compare_images
    bool ignore_background = false;  ///< leave out pixels where the alpha of both images is 0
    std::optional<std::filesystem::path>
        mask;  ///< an image of the same size; only where it is above 0 is compared
};

struct ImageComparison {
    ImageDifference total;                   ///< over all three channels together
    std::array<ImageDifference, 3> channel;  ///< red, green, blue
    int width = 0;
    int height = 0;
    std::size_t compared_pixels = 0;
    std::size_t left_out_pixels = 0;    ///< in all
    std::size_t background_pixels = 0;  ///< left out by `ignore_background`
    std::size_t worst_x = 0;            ///< pixel of the largest difference, from the left and the top
    std::size_t worst_y = 0;
    /// `error` of the compared pixels: the value that so many percent of them do not exceed.
    std::vector<std::pair<double, double>> percentiles;
    std::vector<float> error;  ///< (height, width): largest absolute difference of the channels; -1 left out
    std::vector<std::string> notes;  ///< what reading the files decided
};

/// Compares the linear light of two images, multiplied by their alpha.
///
/// Left out are pixels where the mask is 0 or less, and with `ignore_edges` those on an antialiased edge,
/// where the pixel filters of two programs may rightly differ: a pixel in whose 3 x 3 neighborhood (within
/// the image) the alpha of either image, or the mask, is not the same everywhere. Same means within 1/255 for
/// alpha and for the mask. A mask may number the objects (an object index pass): edges are then where objects
/// meet.
///
/// Throws FileError where an image cannot be read, sizes differ (naming both), nothing is left to compare, or
/// edges are to be left out and neither alpha nor a mask says where they are; std::invalid_argument on a peak
/// that is not allowed.
ImageComparison compare_images(const std::filesystem::path& first, const std::filesystem::path& second,
                               const CompareOptions& options = {});

/// Writes the comparison as a picture to look at (8-bit sRGB PNG, whole or not at all): black, no difference,
/// through ever brighter colors to white, `scale` or more; transparent where left out. The scale stands in
/// the header as "skinglow:heat_map_white", too.
/// @param scale  linear difference shown white, finite, above 0; without it the largest there is (1 where all
/// is alike)
/// @return the scale
double write_heat_map(const std::filesystem::path& path, const ImageComparison& comparison,
                      std::optional<double> scale = {});

/// Writes both images and the heat map beside each other (8-bit sRGB PNG, whole or not at all).
/// @param heat_map_white  as write_heat_map gives it
/// @throws FileError where an image cannot be read or written
void write_side_by_side(const std::filesystem::path& path, const std::filesystem::path& first,
                        const std::filesystem::path& second, const ImageComparison& comparison,
                        double heat_map_white);

/// The picture of write_heat_map: (height, width, 4), 8 bits.
std::vector<std::uint8_t> heat_map_pixels(const ImageComparison& comparison, double white);
/// What is white without a scale: the largest difference, 1 where there is none.
double heat_map_white(const ImageComparison& comparison);

/// Color of a heat map at 0 to 1, sRGB-encoded 0 to 1: brightness rises evenly, so that brighter is always
/// worse. The cubehelix of D. A. Green, "A colour scheme for the display of astronomical intensity images",
/// Bulletin of the Astronomical Society of India 39, 289 (2011), with start 0.5, -1.5 rotations, hue 1,
/// gamma 1.
std::array<double, 3> heat_color(double value);

}  // namespace skinglow::detail
