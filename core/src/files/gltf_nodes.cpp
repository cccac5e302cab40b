#include "files/gltf_nodes.h"

#include <array>
#include <glm/gtc/quaternion.hpp>

namespace skinglow::detail {
namespace {

template <std::size_t count>
std::array<double, count> numbers(const GltfDocument& document, const nlohmann::json& node, const char* key,
                                  const std::array<double, count>& otherwise, const std::string& where) {
    const auto found = node.find(key);
    if (found == node.end()) return otherwise;
    if (!found->is_array() || found->size() != count) {
        document.refuse(std::string("has a ") + key + " that is not " + std::to_string(count) + " numbers",
                        where);
    }
    return found->get<std::array<double, count>>();
}

glm::dmat4 local_transform(const GltfDocument& document, const nlohmann::json& node,
                           const std::string& where) {
    if (node.contains("matrix")) {
        const auto m = numbers<16>(document, node, "matrix", {}, where);
        glm::dmat4 matrix(1.0);
        for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = m[static_cast<std::size_t>(i)];
        return matrix;
    }
    const auto t = numbers<3>(document, node, "translation", {0.0, 0.0, 0.0}, where);
    const auto r = numbers<4>(document, node, "rotation", {0.0, 0.0, 0.0, 1.0}, where);
    const auto s = numbers<3>(document, node, "scale", {1.0, 1.0, 1.0}, where);
    return gltf_transform({t[0], t[1], t[2]}, {r[0], r[1], r[2], r[3]}, {s[0], s[1], s[2]});
}

std::vector<std::size_t> indices(const GltfDocument& document, const nlohmann::json& object, const char* key,
                                 std::size_t count, const std::string& where) {
    std::vector<std::size_t> found;
    const auto list = object.find(key);
    if (list == object.end()) return found;
    for (const nlohmann::json& each : *list) {
        if (!each.is_number_unsigned() || each.get<std::size_t>() >= count) {
            document.refuse(std::string("has an entry in ") + key + " that does not exist: " + each.dump(),
                            where);
        }
        found.push_back(each.get<std::size_t>());
    }
    return found;
}

std::vector<std::size_t> scene_roots(const GltfDocument& document, const GltfNodes& nodes) {
    const nlohmann::json& json = document.json();
    std::vector<std::size_t> roots;
    if (json.contains("scenes") && !json["scenes"].empty()) {
        const std::size_t scene = document.number(json, "scene", "scene", 0);
        return indices(document, document.entry("scenes", scene), "nodes", nodes.parents.size(),
                       "scenes[" + std::to_string(scene) + "]");
    }
    for (std::size_t i = 0; i < nodes.parents.size(); ++i) {
        if (nodes.parents[i] == GltfNodes::no_parent) roots.push_back(i);
    }
    return roots;
}

/// The nodes below the roots, each once and after its parent.
std::vector<std::size_t> walk(const std::vector<std::vector<std::size_t>>& children,
                              std::vector<std::size_t> roots) {
    std::vector<std::size_t> order;
    std::vector<bool> seen(children.size(), false);
    while (!roots.empty()) {
        const std::size_t node = roots.back();
        roots.pop_back();
        if (seen[node]) continue;
        seen[node] = true;
        order.push_back(node);
        roots.insert(roots.end(), children[node].begin(), children[node].end());
    }
    return order;
}

}  // namespace

glm::dmat4 gltf_transform(const glm::dvec3& translation, const glm::dvec4& rotation,
                          const glm::dvec3& scale) {
    const double length = glm::length(rotation);
    const glm::dquat turn = length > 0.0 ? glm::dquat(rotation.w, rotation.x, rotation.y, rotation.z) / length
                                         : glm::dquat(1.0, 0.0, 0.0, 0.0);
    glm::dmat4 matrix = glm::mat4_cast(turn);
    for (int axis = 0; axis < 3; ++axis) matrix[axis] *= scale[axis];
    matrix[3] = glm::dvec4(translation, 1.0);
    return matrix;
}

GltfNodes read_gltf_nodes(const GltfDocument& document) {
    const nlohmann::json& json = document.json();
    const std::size_t count = json.contains("nodes") ? json["nodes"].size() : 0;
    GltfNodes nodes;
    nodes.parents.assign(count, GltfNodes::no_parent);
    nodes.placements.assign(count, glm::dmat4(1.0));
    std::vector<std::vector<std::size_t>> children(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::string where = "nodes[" + std::to_string(i) + "]";
        children[i] = indices(document, document.entry("nodes", i), "children", count, where);
        for (const std::size_t child : children[i]) {
            if (nodes.parents[child] != GltfNodes::no_parent) {
                document.refuse("is the child of a node twice", "nodes[" + std::to_string(child) + "]");
            }
            nodes.parents[child] = i;
        }
    }
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < count; ++i) {
        if (nodes.parents[i] == GltfNodes::no_parent) roots.push_back(i);
    }
    const std::vector<std::size_t> order = walk(children, std::move(roots));
    if (order.size() != count) document.refuse("has nodes that are their own ancestors", "nodes");
    for (const std::size_t i : order) {
        const glm::dmat4 local =
            local_transform(document, document.entry("nodes", i), "nodes[" + std::to_string(i) + "]");
        const std::size_t parent = nodes.parents[i];
        nodes.placements[i] = parent == GltfNodes::no_parent ? local : nodes.placements[parent] * local;
    }
    nodes.in_scene = walk(children, scene_roots(document, nodes));
    const auto with_mesh = [&](std::size_t i) { return document.entry("nodes", i).contains("mesh"); };
    for (std::size_t i = 0; i < count; ++i) nodes.meshes_elsewhere += with_mesh(i) ? 1 : 0;
    for (const std::size_t i : nodes.in_scene) nodes.meshes_elsewhere -= with_mesh(i) ? 1 : 0;
    return nodes;
}

}  // namespace skinglow::detail
