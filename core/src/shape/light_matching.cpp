#include "shape/light_matching.h"

#include <functional>
#include <unordered_map>

namespace skinglow::detail {
namespace {

bool shine_alike(const Light& a, const Light& b) {
    return a.shape() == b.shape() && (a.kind() == LightKind::sun || a.position() == b.position()) &&
           (a.kind() == LightKind::point || a.direction() == b.direction());
}

/// The same for lights that shine alike.
std::size_t place_of(const Light& light) {
    std::size_t hash = light.shape().index();
    const auto add = [&](const glm::dvec3& v) {
        for (int c = 0; c < 3; ++c) hash = hash * 1000003U ^ std::hash<double>()(v[c]);
    };
    if (light.kind() != LightKind::sun) add(light.position());
    if (light.kind() != LightKind::point) add(light.direction());
    return hash;
}

}  // namespace

std::vector<std::size_t> matching_lights(std::span<const Light> lights, std::span<const Light> others) {
    std::vector<std::size_t> result(lights.size(), not_matched);
    std::vector<bool> is_taken(others.size(), false);
    for (std::size_t i = 0; i < lights.size() && i < others.size(); ++i) {
        if (!shine_alike(lights[i], others[i])) continue;
        result[i] = i;
        is_taken[i] = true;
    }
    std::unordered_map<std::size_t, std::vector<std::size_t>> free;
    for (std::size_t k = others.size(); k-- > 0;) {
        if (!is_taken[k]) free[place_of(others[k])].push_back(k);
    }
    if (free.empty()) return result;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (result[i] != not_matched) continue;
        const auto found = free.find(place_of(lights[i]));
        if (found == free.end() || found->second.empty()) continue;
        // Lights at one position that shine in different ways are few.
        if (!shine_alike(lights[i], others[found->second.back()])) continue;
        result[i] = found->second.back();
        found->second.pop_back();
    }
    return result;
}

}  // namespace skinglow::detail
