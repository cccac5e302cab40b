#include "files/lut_file.h"

#include <skinglow/spectrum.h>

#include <algorithm>

#include "files/atomic_file.h"
#include "files/image_file.h"
#include "numerics/argument_check.h"
#include "rig_files/file_error.h"

namespace skinglow::detail {
namespace {

void check_table(const LutTable& table, const PngOptions& png) {
    const LutAxis checked(table.colors.size(), table.record.max_thickness_mm);
    for (std::size_t i = 0; i < table.colors.size(); ++i) {
        require_finite("color of table entry " + std::to_string(i), table.colors[i]);
    }
    if (png.bits != 8 && png.bits != 16) refuse_argument("bits", std::to_string(png.bits), "8 or 16");
}

glm::dvec3 pixel(const LinearImage& image, int x, int y) {
    const std::size_t i = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                               static_cast<std::size_t>(x));
    return {image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]};
}

/// Luminance of a color; of a gray exactly its value, which the weights of luminance would round.
double brightness(const glm::dvec3& color) {
    return color.r == color.g && color.g == color.b ? color.r : luminance(color);
}

/// The mean of a column, summed as differences so that equal rows give their value to the last bit.
glm::dvec3 column_mean(const LinearImage& image, int x) {
    const glm::dvec3 first = pixel(image, x, 0);
    glm::dvec3 sum{0.0};
    for (int y = 1; y < image.height; ++y) sum += pixel(image, x, y) - first;
    return first + sum / static_cast<double>(image.height);
}

bool rows_differ(const LinearImage& image) {
    const auto row = static_cast<std::ptrdiff_t>(image.width) * 3;
    for (int y = 1; y < image.height; ++y) {
        if (!std::equal(image.rgb.begin(), image.rgb.begin() + row, image.rgb.begin() + y * row)) return true;
    }
    return false;
}

double choose_axis(std::optional<double> asked, std::optional<double> own, std::vector<std::string>& notes) {
    if (asked) return require_positive("max_thickness_mm", *asked);
    if (own) return *own;
    notes.push_back("it has no thickness axis; its last texel is taken as " +
                    to_text(default_max_thickness_mm) + " mm");
    return default_max_thickness_mm;
}

BaseLutFile base_of_matrices(const std::filesystem::path& path, const RawChannels& raw,
                             std::optional<double> max_thickness_mm) {
    if (raw.height != 1)
        refuse_file(path, "has " + std::to_string(raw.height) + " rows", "a table of matrices has one");
    std::vector<glm::dmat3> matrices(static_cast<std::size_t>(raw.width));
    for (std::size_t texel = 0; texel < matrices.size(); ++texel) {
        for (int i = 0; i < 9; ++i)
            matrices[texel][i % 3][i / 3] = raw.channels[static_cast<std::size_t>(i)][texel];
    }
    std::vector<std::string> notes;
    const double axis = choose_axis(max_thickness_mm, axis_in(raw.text, path), notes);
    return {BaseLut(std::move(matrices), axis), std::move(notes)};
}

}  // namespace

LutWriteReport write_lut(const std::filesystem::path& path, const LutTable& table, const PngOptions& png) {
    check_table(table, png);
    const std::string extension = small_extension(path);
    if (extension == ".png") return write_lut_png(path, table, png);
    if (extension == ".exr") {
        write_atomically(path, lut_exr_bytes(path, table));
    } else if (extension == ".csv") {
        write_lut_csv(path, table);
    } else {
        refuse_file(path, extension.empty() ? "has no extension" : "has the unknown extension " + extension,
                    "name it .exr, .png or .csv");
    }
    return {};
}

LutFile read_lut(const std::filesystem::path& path) {
    if (small_extension(path) == ".csv") return read_lut_csv(path);
    LinearImage image = read_image(path);
    LutFile file{{{}, to_lut_record(image.text, path)}, std::move(image.notes)};
    if (image.height != 1)
        refuse_file(path, "has " + std::to_string(image.height) + " rows", "a table has one");
    for (int x = 0; x < image.width; ++x) file.table.colors.push_back(pixel(image, x, 0));
    return file;
}

BaseLutFile read_base_lut(const std::filesystem::path& path, std::optional<double> max_thickness_mm) {
    const std::vector<std::string> rows = {"M00", "M01", "M02", "M10", "M11", "M12", "M20", "M21", "M22"};
    if (const auto raw = read_raw_channels(path, rows)) return base_of_matrices(path, *raw, max_thickness_mm);
    const LinearImage image = read_image(path);
    std::vector<std::string> notes = image.notes;
    if (static_cast<std::size_t>(image.width) > max_lut_size) {
        refuse_file(path, "is " + std::to_string(image.width) + " texels wide",
                    "at most " + std::to_string(max_lut_size));
    }
    if (!image.alpha.empty()) notes.emplace_back("its colors were taken as multiplied by its alpha channel");
    if (rows_differ(image)) {
        notes.push_back("its " + std::to_string(image.height) +
                        " rows differ; the mean of each column was taken");
    }
    std::vector<double> gray;
    bool colored = false;
    for (int x = 0; x < image.width; ++x) {
        const glm::dvec3 color = column_mean(image, x);
        colored = colored || color.r != color.g || color.g != color.b;
        gray.push_back(brightness(color));
        if (gray.back() < 0.0) {
            refuse_file(path, "has the brightness " + to_text(gray.back()), "a base lookup has none below 0",
                        "column " + std::to_string(x));
        }
    }
    if (colored)
        notes.emplace_back("its color was reduced to brightness (Rec.709 luminance of linear light)");
    const double axis = choose_axis(max_thickness_mm, axis_in(image.text, path), notes);
    return {BaseLut::from_gray(gray, axis), std::move(notes)};
}

}  // namespace skinglow::detail
