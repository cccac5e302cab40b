#include "files/image_compare.h"

#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "files/image_io.h"
#include "numerics/argument_check.h"
#include "rig_files/file_error.h"

namespace skinglow::detail {
namespace {

constexpr float edge_tolerance = 1.0F / 255.0F;
/// Of pixels left out because nothing is there; 1 are those left out otherwise.
constexpr char background = 2;

std::string size_text(const LinearImage& image) {
    return std::to_string(image.width) + " x " + std::to_string(image.height);
}

void require_same_size(const std::filesystem::path& path, const LinearImage& image,
                       const std::filesystem::path& other_path, const LinearImage& other) {
    if (image.width == other.width && image.height == other.height) return;
    refuse_file(path,
                "is " + size_text(image) + " pixels and " + other_path.string() + " is " + size_text(other),
                "render both at one size");
}

/// Marks pixels in whose 3 x 3 neighborhood not all values are the same.
void mark_edges(std::vector<float>& values, const LinearImage& image, std::vector<char>& edge) {
    const OIIO::ImageBuf given(OIIO::ImageSpec(image.width, image.height, 1, OIIO::TypeFloat), values.data());
    const OIIO::ImageBuf largest = OIIO::ImageBufAlgo::dilate(given);  // over 3 x 3
    const OIIO::ImageBuf smallest = OIIO::ImageBufAlgo::erode(given);
    const auto* max = static_cast<const float*>(largest.localpixels());
    const auto* min = static_cast<const float*>(smallest.localpixels());
    for (std::size_t i = 0; i < edge.size(); ++i) {
        if (max[i] - min[i] > edge_tolerance) edge[i] = 1;
    }
}

std::vector<float> read_mask(const std::filesystem::path& path, const std::filesystem::path& image_path,
                             const LinearImage& image) {
    const LinearImage mask = read_image(path);
    require_same_size(path, mask, image_path, image);
    std::vector<float> values(mask.pixels());
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = std::max({mask.rgb[3 * i], mask.rgb[3 * i + 1], mask.rgb[3 * i + 2]});
    }
    return values;
}

/// Marks pixels that neither image covers.
void mark_background(const LinearImage& first, const LinearImage& second, std::vector<char>& out) {
    const auto uncovered = [](const LinearImage& image, std::size_t i) {
        return image.alpha.empty() || !(image.alpha[i] > 0.0F);
    };
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (uncovered(first, i) && uncovered(second, i)) out[i] = background;
    }
}

/// Not 0 where a pixel is left out.
std::vector<char> left_out(const std::filesystem::path& first_path, LinearImage& first, LinearImage& second,
                           const CompareOptions& options) {
    std::vector<char> out(first.pixels(), 0);
    std::vector<float> mask;
    if (options.mask) mask = read_mask(*options.mask, first_path, first);
    const bool no_alpha = first.alpha.empty() && second.alpha.empty();
    if (options.ignore_edges) {
        if (mask.empty() && no_alpha) {
            refuse_file(first_path, "has no alpha to find edges by, nor has the other",
                        "render with a transparent background, or give a mask");
        }
        for (std::vector<float>* coverage : {&first.alpha, &second.alpha, &mask}) {
            if (!coverage->empty()) mark_edges(*coverage, first, out);
        }
    }
    for (std::size_t i = 0; i < mask.size(); ++i) {
        if (!(mask[i] > 0.0F)) out[i] = 1;
    }
    if (options.ignore_background) {
        if (no_alpha) {
            refuse_file(first_path, "has no alpha to tell the background by, nor has the other",
                        "render with a transparent background");
        }
        mark_background(first, second, out);
    }
    return out;
}

std::vector<std::pair<double, double>> percentiles_of(const ImageComparison& comparison) {
    std::vector<float> sorted;
    sorted.reserve(comparison.compared_pixels);
    std::copy_if(comparison.error.begin(), comparison.error.end(), std::back_inserter(sorted),
                 [](float error) { return error >= 0.0F; });
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::pair<double, double>> found;
    for (const double percent : {50.0, 90.0, 95.0, 99.0, 99.9}) {
        // A little less, so that rounding does not take the next one.
        const double rank = std::ceil(percent / 100.0 * static_cast<double>(sorted.size()) - 1e-6);
        found.emplace_back(percent, sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1]);
    }
    return found;
}

ImageDifference make_difference(double sum_of_squares, double max, double count, double peak) {
    ImageDifference difference{std::sqrt(sum_of_squares / count), max, {}};
    if (difference.rms > 0.0) difference.psnr = 20.0 * (std::log10(peak) - std::log10(difference.rms));
    return difference;
}

void add_notes(ImageComparison& comparison, const std::filesystem::path& path, const LinearImage& image) {
    for (const std::string& note : image.notes) comparison.notes.push_back(path.string() + ": " + note);
}

}  // namespace

ImageComparison compare_images(const std::filesystem::path& first_path,
                               const std::filesystem::path& second_path, const CompareOptions& options) {
    require_positive("peak", options.peak);
    LinearImage first = read_image(first_path);
    LinearImage second = read_image(second_path);
    require_same_size(first_path, first, second_path, second);
    const std::vector<char> out = left_out(first_path, first, second, options);

    ImageComparison comparison;
    comparison.width = first.width;
    comparison.height = first.height;
    add_notes(comparison, first_path, first);
    add_notes(comparison, second_path, second);
    comparison.error.assign(first.pixels(), -1.0F);
    std::array<double, 3> squares{};
    std::array<double, 3> largest{};
    double worst = -1.0;
    for (std::size_t i = 0; i < first.pixels(); ++i) {
        if (out[i] != 0) {
            ++comparison.left_out_pixels;
            if (out[i] == background) ++comparison.background_pixels;
            continue;
        }
        ++comparison.compared_pixels;
        double pixel_error = 0.0;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            // In doubles: the difference of two large floats of unlike sign would overflow.
            const double difference =
                std::abs(double{first.rgb[3 * i + channel]} - double{second.rgb[3 * i + channel]});
            squares[channel] += difference * difference;
            largest[channel] = std::max(largest[channel], difference);
            pixel_error = std::max(pixel_error, difference);
        }
        constexpr double largest_float = std::numeric_limits<float>::max();
        comparison.error[i] = static_cast<float>(std::min(pixel_error, largest_float));
        if (pixel_error > worst) {
            worst = pixel_error;
            comparison.worst_x = i % static_cast<std::size_t>(first.width);
            comparison.worst_y = i / static_cast<std::size_t>(first.width);
        }
    }
    if (comparison.compared_pixels == 0) {
        refuse_file(first_path, "has no pixel left to compare",
                    "mask, edges and background leave out all of them");
    }
    comparison.percentiles = percentiles_of(comparison);
    const auto count = static_cast<double>(comparison.compared_pixels);
    for (std::size_t channel = 0; channel < 3; ++channel) {
        comparison.channel[channel] =
            make_difference(squares[channel], largest[channel], count, options.peak);
    }
    comparison.total =
        make_difference(squares[0] + squares[1] + squares[2], worst, 3.0 * count, options.peak);
    return comparison;
}

}  // namespace skinglow::detail
