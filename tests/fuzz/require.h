#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <glm/vec3.hpp>
#include <span>
#include <stdexcept>
#include <string>

namespace skinglow::fuzz {

/// Ends the process where a property does not hold: what runs the target keeps the input.
inline void require(bool holds, const std::string& property) {
    if (holds) return;
    std::fprintf(stderr, "property does not hold: %s\n", property.c_str());
    std::abort();
}

inline bool is_finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
inline bool is_light(const glm::dvec3& v) {
    return is_finite(v) && v.x >= 0 && v.y >= 0 && v.z >= 0;
}

/// Runs the action; what is refused must be said in one line. Returns whether it was not refused.
template <class Refusal = std::invalid_argument, class Action>
bool runs(const Action& action) {
    try {
        action();
        return true;
    } catch (const Refusal& refusal) {
        const std::string text = refusal.what();
        require(text.size() > 10 && text.find('\n') == std::string::npos, "a refusal is one line: " + text);
        return false;
    }
}

}  // namespace skinglow::fuzz
