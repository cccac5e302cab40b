#include "files/gltf_placement.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <optional>

namespace skinglow::detail {
namespace {

using nlohmann::json;

glm::dvec3 vector_at(const std::vector<double>& values, std::size_t i, double otherwise) {
    if (values.empty()) return glm::dvec3(otherwise);
    return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

/// Of each joint, from the skin's space into the scene.
std::vector<glm::dmat4> joint_matrices(GltfDocument& document, const GltfNodes& nodes, std::size_t index,
                                       const std::function<void(std::size_t)>& expect) {
    const std::string where = "skins[" + std::to_string(index) + "]";
    const json& skin = document.entry("skins", index);
    const auto joints = skin.at("joints").get<std::vector<std::size_t>>();
    if (joints.empty()) document.refuse("has no joints", where);
    expect(joints.size());
    std::vector<double> inverse;
    if (skin.contains("inverseBindMatrices")) {
        inverse = document.read_accessor(document.number(skin, "inverseBindMatrices", where), "MAT4");
        if (inverse.size() < 16 * joints.size()) document.refuse("has fewer matrices than joints", where);
    }
    std::vector<glm::dmat4> matrices;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        if (joints[i] >= nodes.placements.size()) document.refuse("has a joint that does not exist", where);
        glm::dmat4 bind(1.0);
        for (std::size_t k = 0; k < 16 && !inverse.empty(); ++k) {
            bind[static_cast<int>(k / 4)][static_cast<int>(k % 4)] = inverse[16 * i + k];
        }
        matrices.push_back(nodes.placements[joints[i]] * bind);
    }
    return matrices;
}

/// Four joints and weights a vertex.
struct JointSet {
    std::vector<std::uint32_t> joints;
    std::vector<double> weights;
};

}  // namespace

bool is_mirrored(const glm::dmat4& matrix) {
    return glm::determinant(glm::dmat3(matrix)) < 0.0;
}

GltfInstances::GltfInstances(GltfDocument& document, const json& entry, const glm::dmat4& node,
                             const std::function<void(std::size_t)>& expect)
    : node_(node) {
    constexpr const char* name = "EXT_mesh_gpu_instancing";
    const auto extensions = entry.find("extensions");
    if (extensions == entry.end() || !extensions->contains(name)) {
        expect(count_);
        return;
    }
    const json& attributes = extensions->at(name).at("attributes");
    std::optional<std::size_t> count;
    const auto find = [&](const char* key, const char* type) -> std::optional<GltfAccessor> {
        if (!attributes.contains(key)) return std::nullopt;
        const GltfAccessor found = document.accessor(document.number(attributes, key, name), type);
        if (count && *count != found.count) document.refuse("has attributes of different counts", name);
        count = found.count;
        return found;
    };
    const auto translations = find("TRANSLATION", "VEC3");
    const auto rotations = find("ROTATION", "VEC4");
    const auto scales = find("SCALE", "VEC3");
    count_ = count.value_or(0);
    expect(count_);
    const auto read = [&](const std::optional<GltfAccessor>& accessor, std::vector<double>& values) {
        if (!accessor) return;
        values.resize(accessor->count * accessor->components);
        document.read(*accessor, values.data());
    };
    read(translations, translations_);
    read(rotations, rotations_);
    read(scales, scales_);
}

glm::dmat4 GltfInstances::placement(std::size_t i) const {
    if (translations_.empty() && rotations_.empty() && scales_.empty()) return node_;
    const glm::dvec4 rotation = rotations_.empty() ? glm::dvec4(0.0, 0.0, 0.0, 1.0)
                                                   : glm::dvec4(rotations_[4 * i], rotations_[4 * i + 1],
                                                                rotations_[4 * i + 2], rotations_[4 * i + 3]);
    return node_ * gltf_transform(vector_at(translations_, i, 0.0), rotation, vector_at(scales_, i, 1.0));
}

std::vector<std::uint8_t> apply_gltf_skin(GltfDocument& document, const GltfNodes& nodes, std::size_t skin,
                                          const json& attributes, std::span<glm::dvec3> vertices,
                                          const std::string& where,
                                          const std::function<void(std::size_t)>& expect) {
    const std::vector<glm::dmat4> matrices = joint_matrices(document, nodes, skin, expect);
    std::vector<JointSet> sets;
    for (std::string set = "0"; attributes.contains("JOINTS_" + set); set = std::to_string(sets.size())) {
        const auto find = [&](const std::string& key) {
            GltfAccessor found =
                document.accessor(document.number(attributes, (key + set).c_str(), where), "VEC4");
            if (found.count != vertices.size())
                document.refuse("has joints or weights for another number of vertices", where);
            return found;
        };
        const GltfAccessor joints = find("JOINTS_");
        const GltfAccessor weights = find("WEIGHTS_");
        expect(vertices.size());
        JointSet& added = sets.emplace_back();
        added.joints.resize(4 * vertices.size());
        added.weights.resize(4 * vertices.size());
        document.read(joints, added.joints.data());
        document.read(weights, added.weights.data());
    }
    std::vector<std::uint8_t> mirrored(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        glm::dmat4 blend(0.0);
        double sum = 0.0;
        for (const JointSet& set : sets) {
            for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) {
                if (set.weights[k] == 0.0) continue;
                if (set.joints[k] >= matrices.size())
                    document.refuse("has a joint that does not exist", where);
                blend += set.weights[k] * matrices[set.joints[k]];
                sum += set.weights[k];
            }
        }
        blend = sum != 0.0 ? blend / sum : matrices.front();
        vertices[i] = glm::dvec3(blend * glm::dvec4(vertices[i], 1.0));
        mirrored[i] = is_mirrored(blend) ? 1 : 0;
    }
    return mirrored;
}

}  // namespace skinglow::detail
