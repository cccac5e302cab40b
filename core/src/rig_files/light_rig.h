#pragma once

#include <skinglow/light.h>
#include <skinglow/light_weights.h>
#include <skinglow/lut.h>

#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Lights around a point of skin, with the numbers of Eq. 1 and 2 that go with them. As a file:
/// docs/rig_format.md.
struct LightRig {
    std::string name;
    glm::dvec3 point{0.0};  ///< where distances are measured from, world
    AttenuationCoefficients coefficients;
    glm::dvec3 blood_weight = paper_blood_weight;
    std::vector<Light> lights;
};

/// Throws std::invalid_argument on a light, coefficient or weight that is not allowed.
void validate(const LightRig& rig);

/// Reads a rig file. Strict: a key that the format does not know is refused, as is one that the kind of light
/// has not. Throws FileError, naming key and line, on anything that docs/rig_format.md does not allow.
LightRig read_light_rig(const std::filesystem::path& path);

/// Writes a rig file that reads back as the same numbers, whole or not at all.
/// Throws std::invalid_argument as `validate` does, FileError where the file cannot be written.
void write_light_rig(const std::filesystem::path& path, const LightRig& rig);

}  // namespace skinglow::detail
