#pragma once

#include <skinglow/angular_weight.h>

#include <array>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>

/// Light from the world around a scene.
/// @code
/// const skinglow::Environment sky(glm::dvec3(0.2, 0.3, 0.5));  // constant radiance
/// const glm::dvec3 e = sky.irradiance({0, 0, 1});
/// const skinglow::Environment photo = skinglow::Environment::from_equirectangular({pixels, 2048, 1024, 4});
/// @endcode
namespace skinglow {

/// The brightest radiance that an environment takes, W/(m^2 sr): with it no sum of a picture is beyond single
/// precision.
constexpr double max_radiance = 1e30;

/// A view of an image of radiance as a host stores it, so that a large one need not be copied.
struct RadianceImage {
    std::span<const float> values;  ///< width * height * channels, row by row, of at most max_radiance
    std::size_t width = 0;
    std::size_t height = 0;
    std::size_t channels = 3;  ///< 3 or more: R, G, B and what is not read; 1 or 2: gray and what is not read
    bool bottom_first = false;  ///< whether the first row is the lowest, as in Blender's `pixels`
};

/// The world's light as nine coefficients of real spherical harmonics per channel: all of it that a cosine
/// lets through to about 1 % (R. Ramamoorthi and P. Hanrahan, "An Efficient Representation for Irradiance
/// Environment Maps", SIGGRAPH 2001). Order: l = 0; l = 1, m = -1, 0, 1 (y, z, x); l = 2, m = -2 ... 2 (xy,
/// yz, 3z^2 - 1, xz, x^2 - y^2). Orthonormal.
class Environment {
  public:
    /// No coefficient of radiance up to max_radiance is larger: sqrt(4 pi) times that, rounded up.
    static constexpr double max_coefficient = 4 * max_radiance;

    /// @param radiance  from every direction, W/(m^2 sr), 0 to max_radiance
    explicit Environment(const glm::dvec3& radiance);

    /// @param coefficients  of the radiance, of at most max_coefficient
    explicit Environment(const std::array<glm::dvec3, 9>& coefficients);

    /// From an equirectangular image of radiance, as image files have it: row 0 looks up (+z), the last row
    /// down (Blender's `pixels` start at the bottom: flip them); columns run as `direction` says.
    /// @param pixels  row by row, of at most max_radiance
    /// @param width   pixels in a row, at least 1
    /// @param height  rows, at least 1
    /// @throws std::invalid_argument naming what is wrong
    static Environment from_equirectangular(std::span<const glm::dvec3> pixels, std::size_t width,
                                            std::size_t height);
    /// The same from float32 pixels; each counts with the exact integral of the harmonics over it, so that
    /// a small image costs no accuracy.
    /// @param image  the pixels as the host stores them
    static Environment from_equirectangular(const RadianceImage& image);

    /// From the picture of a mirrored ball seen from far away along +y, with +z up, as Blender's projection
    /// Mirror Ball: the ball fills the square image, whose corners are not read. On a ball equal areas show
    /// equal solid angles; a pixel that the rim cuts counts where its center lies.
    /// @param image  the square picture
    static Environment from_mirror_ball(const RadianceImage& image);

    /// The same light with the world rotated: what came from direction d comes from rotation * d.
    /// @param rotation  orthogonal to 1e-5, with or without a reflection, else std::invalid_argument
    Environment rotated(const glm::dmat3& rotation) const;

    /// Unit direction of an image position, as Blender's Environment Texture maps it: the center of the image
    /// looks along +x, a quarter from the left +y.
    /// @param u  0 at the left, 1 at the right
    /// @param v  0 at the bottom, 1 at the top
    static glm::dvec3 direction(double u, double v);

    /// Irradiance on a surface, W/m^2, not below 0; pi L for constant radiance L.
    /// @param normal          unit
    /// @param angular_weight  none: every angle enters alike
    glm::dvec3 irradiance(const glm::dvec3& normal, const AngularWeight* angular_weight = nullptr) const;

    /// The mean of `irradiance` over all normals, pi times the mean radiance: the object weight, which knows
    /// no normal.
    glm::dvec3 mean_irradiance() const;

    /// `irradiance` before it is clamped at 0, as coefficients of 1, y, z, x, xy, yz, 3z^2 - 1, xz, x^2 - y^2 of
    /// the normal.
    /// @param angular_weight  none: every angle enters alike
    std::array<glm::dvec3, 9> irradiance_polynomial(const AngularWeight* angular_weight = nullptr) const;

    /// An upper bound of |irradiance(n) - mean_irradiance()| over all normals: what one weight for the whole
    /// object may be off.
    glm::dvec3 mean_irradiance_error() const;

    const std::array<glm::dvec3, 9>& coefficients() const { return coefficients_; }

  private:
    std::array<glm::dvec3, 9> coefficients_{};
};

}  // namespace skinglow
