#include <skinglow/environment.h>

#include <cmath>
#include <glm/common.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "geometry/vector.h"
#include "numerics/argument_check.h"
#include "radiometry/spherical_harmonics.h"

namespace skinglow {
namespace {

using std::numbers::pi;

using Coefficients = std::array<glm::dvec3, 9>;

/// Integrals over one row of pixels, theta from the zenith, of the parts of the harmonics that depend on it;
/// exact, so that a constant image has exactly no higher bands.
struct RowIntegrals {
    double one, z, s, ss, sz, zz;  // of 1, cos, sin, sin^2, sin cos, cos^2, each times sin theta

    RowIntegrals(double from, double to) {
        const auto between = [&](const auto& antiderivative) {
            return antiderivative(to) - antiderivative(from);
        };
        one = between([](double t) { return -std::cos(t); });
        z = between([](double t) { return 0.5 * std::sin(t) * std::sin(t); });
        s = between([](double t) { return 0.5 * t - 0.25 * std::sin(2 * t); });
        ss = between([](double t) { return std::cos(t) * (std::cos(t) * std::cos(t) / 3 - 1); });
        sz = between([](double t) { return std::pow(std::sin(t), 3) / 3; });
        zz = between([](double t) { return -std::pow(std::cos(t), 3) / 3; });
    }
};

/// The same for each column: of 1, cos, sin, cos 2, sin 2 of the azimuth.
std::vector<std::array<double, 5>> column_integrals(std::size_t width) {
    std::vector<std::array<double, 5>> columns(width);
    for (std::size_t c = 0; c < width; ++c) {
        const double right = pi - 2 * pi * static_cast<double>(c + 1) / static_cast<double>(width);
        const double left = pi - 2 * pi * static_cast<double>(c) / static_cast<double>(width);
        columns[c] = {left - right, std::sin(left) - std::sin(right), std::cos(right) - std::cos(left),
                      0.5 * (std::sin(2 * left) - std::sin(2 * right)),
                      0.5 * (std::cos(2 * right) - std::cos(2 * left))};
    }
    return columns;
}

void require_size(std::string_view name, std::size_t found, std::size_t width, std::size_t height,
                  std::size_t channels) {
    // By division: the product of absurd sizes would run over.
    if (width > 0 && height > 0 && channels > 0 && found / width / height / channels == 1 &&
        found == width * height * channels) {
        return;
    }
    refuse_argument(name, std::to_string(found),
                    "width * height * channels of them, at least 1 (" + std::to_string(width) + " by " +
                        std::to_string(height) + " by " + std::to_string(channels) + ")");
}

/// @param largest  component of any pixel
Environment finite_environment(const Coefficients& sum, const glm::dvec3& largest) {
    constexpr const char* allowed = "finite radiance of at most 1e30 W/(m^2 sr)";
    for (const glm::dvec3& each : sum) {
        if (!is_finite(each)) refuse_argument("pixels", "not all finite", allowed);
    }
    if (!(max_abs(largest) <= max_radiance)) refuse_argument("pixels", "up to " + to_text(largest), allowed);
    return Environment(sum);
}

/// @param pixel  radiance at (row, column), row 0 looking up
template <class Pixel>
Environment integrate_equirectangular(std::size_t width, std::size_t height, const Pixel& pixel) {
    const std::vector<std::array<double, 5>> columns = column_integrals(width);
    Coefficients sum{};
    glm::dvec3 largest(0.0);
    for (std::size_t row = 0; row < height; ++row) {
        std::array<glm::dvec3, 5> along{};
        for (std::size_t c = 0; c < width; ++c) {
            const glm::dvec3 radiance = pixel(row, c);
            largest = glm::max(largest, glm::abs(radiance));
            for (std::size_t k = 0; k < along.size(); ++k) along[k] += radiance * columns[c][k];
        }
        const auto& [one, cosine, sine, cosine2, sine2] = along;
        const RowIntegrals theta(pi * static_cast<double>(row) / static_cast<double>(height),
                                 pi * static_cast<double>(row + 1) / static_cast<double>(height));
        sum[0] += one * theta.one;
        sum[1] += sine * theta.s;
        sum[2] += one * theta.z;
        sum[3] += cosine * theta.s;
        sum[4] += sine2 * (0.5 * theta.ss);
        sum[5] += sine * theta.sz;
        sum[6] += one * (3 * theta.zz - theta.one);
        sum[7] += cosine * theta.sz;
        sum[8] += cosine2 * theta.ss;
    }
    for (std::size_t i = 0; i < 9; ++i) sum[i] *= harmonic_scales[i];
    return finite_environment(sum, largest);
}

/// Reads a view from the top row down, whichever row it begins with.
class PixelReader {
  public:
    explicit PixelReader(const RadianceImage& image) : image_(image) {
        require_size("number of values", image.values.size(), image.width, image.height, image.channels);
    }
    glm::dvec3 operator()(std::size_t row, std::size_t column) const {
        const std::size_t stored = image_.bottom_first ? image_.height - 1 - row : row;
        const float* p = &image_.values[(stored * image_.width + column) * image_.channels];
        return image_.channels < 3 ? glm::dvec3(p[0]) : glm::dvec3(p[0], p[1], p[2]);
    }

  private:
    const RadianceImage& image_;
};

}  // namespace

Environment Environment::from_equirectangular(std::span<const glm::dvec3> pixels, std::size_t width,
                                              std::size_t height) {
    require_size("number of pixels", pixels.size(), width, height, 1);
    return integrate_equirectangular(width, height,
                                     [&](std::size_t row, std::size_t c) { return pixels[row * width + c]; });
}

Environment Environment::from_equirectangular(const RadianceImage& image) {
    return integrate_equirectangular(image.width, image.height, PixelReader(image));
}

Environment Environment::from_mirror_ball(const RadianceImage& image) {
    const PixelReader pixel(image);
    Coefficients sum{};
    glm::dvec3 largest(0.0);
    std::size_t count = 0;
    for (std::size_t row = 0; row < image.height; ++row) {
        const double z = 1 - 2 * (static_cast<double>(row) + 0.5) / static_cast<double>(image.height);
        for (std::size_t c = 0; c < image.width; ++c) {
            const double x = 2 * (static_cast<double>(c) + 0.5) / static_cast<double>(image.width) - 1;
            const double squared = 1 - x * x - z * z;
            if (squared < 0) continue;
            // The ball's normal n = (x, y, z) with y < 0 towards the camera; its reflection of the line of
            // sight (0, 1, 0) leaves along (0, 1, 0) - 2 y n.
            const double y = -std::sqrt(squared);
            const std::array<double, 9> basis = spherical_harmonics({-2 * y * x, 1 - 2 * y * y, -2 * y * z});
            const glm::dvec3 radiance = pixel(row, c);
            largest = glm::max(largest, glm::abs(radiance));
            for (std::size_t i = 0; i < 9; ++i) sum[i] += radiance * basis[i];
            ++count;
        }
    }
    for (glm::dvec3& each : sum) each *= 4 * pi / static_cast<double>(count);
    return finite_environment(sum, largest);
}

}  // namespace skinglow
