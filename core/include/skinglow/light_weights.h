#pragma once

#include <skinglow/light.h>

#include <glm/vec3.hpp>
#include <span>
#include <vector>

/// How much each light counts at a point of the skin, by the method of Kim, Moon, Choi, Yang and Han,
/// "Advanced Pre-Integrated BRDF for Realistic Transmission Light Color in Skin Rendering based on Unity3D",
/// Eq. 2 and 3. Mode `paper`.
/// @code
/// const std::vector<skinglow::Light> lights = {skinglow::LightSettings{.position = {0, 0, 2}}};
/// const glm::dvec3 l = skinglow::light_weight(lights, glm::dvec3(0.0), {.constant = 1, .quadratic = 0.5});
/// @endcode
namespace skinglow {

/// Coefficients of Eq. 2. The paper gives no values; ours are shown and settable everywhere.
struct AttenuationCoefficients {
    double constant = 1.0;   ///< k_c, 0 or more
    double linear = 0.0;     ///< k_l, 1/length unit of the scene
    double quadratic = 1.0;  ///< k_q, 1/length unit squared
};

/// Throws std::invalid_argument on a negative or non-finite coefficient.
void validate(const AttenuationCoefficients& coefficients);

/// Eq. 2: min(1 / (k_c + k_l d + k_q d^2), 1), in [0, 1]; 1 where all coefficients are 0.
/// @param distance  in the scene's length unit, finite and 0 or more, else std::invalid_argument
double attenuation(double distance, const AttenuationCoefficients& coefficients = {});

/// Distance from the light to the point, in the scene's unit; 0 for a sun, which has none (its attenuation is
/// 1). Does not overflow: the distance between points 1e300 apart is right. Throws std::invalid_argument
/// where it is beyond the largest double.
double light_distance(const Light& light, const glm::dvec3& point);

/// Each light's term of Eq. 3, color * attenuation; (0,0,0) for a light that is off.
/// @param point  world, scene unit, finite, else std::invalid_argument
/// @return one per light, in the order given
std::vector<glm::dvec3> light_weights(std::span<const Light> lights, const glm::dvec3& point,
                                      const AttenuationCoefficients& coefficients = {});

/// Eq. 3: the sum of `light_weights`, (0,0,0) without lights. The order of the lights does not matter beyond
/// the last bits (compensated sum). Throws std::invalid_argument also where the sum is beyond the largest
/// double.
glm::dvec3 light_weight(std::span<const Light> lights, const glm::dvec3& point,
                        const AttenuationCoefficients& coefficients = {});

}  // namespace skinglow
