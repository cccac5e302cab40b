#include <array>
#include <glm/gtc/matrix_access.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "files/gltf_nodes.h"
#include "files/mesh_builder.h"

namespace skinglow::detail {
namespace {

using nlohmann::json;

/// What instances and nodes may make of the parts of a file, in vertices and triangles; a larger file may
/// hold more.
constexpr std::size_t max_expanded = 10'000'000;

glm::dvec3 vector_at(const std::vector<double>& values, std::size_t i) {
    return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

bool is_mirrored(const glm::dmat4& matrix) {
    return glm::determinant(glm::dmat3(matrix)) < 0.0;
}

/// Where the vertices of a primitive go: all by one matrix, or each by its own.
struct Placement {
    std::vector<glm::dmat4> matrices;
    const glm::dmat4& of(std::size_t vertex) const {
        return matrices.size() == 1 ? matrices[0] : matrices[vertex];
    }
};

class GltfReader {
  public:
    GltfReader(const std::filesystem::path& path, const std::string& group)
        : group_(group), document_(path), nodes_(read_gltf_nodes(document_)), builder_(document_.path()) {
        std::error_code error;
        max_elements_ = std::max<std::size_t>(max_expanded, std::filesystem::file_size(path, error));
    }

    MeshFile read() {
        std::vector<bool> is_wanted(nodes_.parents.size(), group_.empty());
        for (const std::size_t node : nodes_.in_scene) {  // parents come first
            const std::size_t parent = nodes_.parents[node];
            const json& entry = document_.entry("nodes", node);
            const std::string name = entry.value("name", "");
            is_wanted[node] =
                group_.empty() || name == group_ || (parent != GltfNodes::no_parent && is_wanted[parent]);
            names_.push_back(name);
            found_group_ = found_group_ || (is_wanted[node] && name == group_);
            if (entry.contains("mesh")) read_node(node, entry, is_wanted[node]);
        }
        if (!group_.empty() && !found_group_) refuse_group(document_.path(), group_, names_);
        MeshFile file;
        file.mesh = builder_.take();
        file.unit_mm = 1000.0;
        file.sources = document_.sources();
        if (nodes_.meshes_elsewhere > 0) {
            file.notes.push_back(std::to_string(nodes_.meshes_elsewhere) +
                                 " nodes with a mesh are not in its default scene and were left out");
        }
        return file;
    }

  private:
    void read_node(std::size_t node, const json& entry, bool is_wanted) {
        const std::size_t index = document_.number(entry, "mesh", "nodes[" + std::to_string(node) + "]");
        const json& mesh = document_.entry("meshes", index);
        const std::string name = mesh.value("name", "");
        names_.push_back(name);
        if (!group_.empty() && name == group_) is_wanted = found_group_ = true;
        if (!is_wanted) return;
        const auto& weights = entry.contains("weights") ? entry : mesh;
        const std::vector<double> morph = weights.value("weights", std::vector<double>());
        const json& primitives = mesh.at("primitives");
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            read_primitive(primitives[i], node, entry, morph,
                           "meshes[" + std::to_string(index) + "].primitives[" + std::to_string(i) + "]");
        }
    }

    void read_primitive(const json& primitive, std::size_t node, const json& entry,
                        const std::vector<double>& morph, const std::string& where) {
        const std::size_t mode = document_.number(primitive, "mode", where, 4);
        const json& attributes = primitive.at("attributes");
        if (mode < 4 || !attributes.contains("POSITION")) return;  // points and lines
        if (mode > 6) document_.refuse("has the unknown mode " + std::to_string(mode), where);
        refuse_compressed(primitive, where);
        const std::size_t index = document_.number(attributes, "POSITION", where);
        std::vector<double> positions = document_.read_accessor(index, "VEC3");
        const std::size_t count = positions.size() / 3;
        add_morph_targets(positions, primitive, morph, where);
        const std::vector<std::uint32_t> corners = read_corners(primitive, count, where);
        if (entry.contains("skin") && attributes.contains("JOINTS_0")) {
            add(positions, corners, mode,
                {skin_matrices(document_.number(entry, "skin", where), attributes, count, where)});
            return;
        }
        for (const glm::dmat4& placement : placements(entry, nodes_.placements[node])) {
            add(positions, corners, mode, {{placement}});
        }
    }

    /// A file may compress without demanding that this be known, and leave the plain data out all the same.
    void refuse_compressed(const json& primitive, const std::string& where) const {
        const json extensions = primitive.value("extensions", json::object());
        const auto position = document_.number(primitive.at("attributes"), "POSITION", where);
        if (!extensions.contains("KHR_draco_mesh_compression")) return;
        if (document_.entry("accessors", position).contains("bufferView")) return;
        refuse_file(document_.path(), "is compressed by KHR_draco_mesh_compression, which is not read",
                    "export it without", where);
    }

    void add_morph_targets(std::vector<double>& positions, const json& primitive,
                           const std::vector<double>& weights, const std::string& where) {
        const json targets = primitive.value("targets", json::array());
        for (std::size_t i = 0; i < std::min(targets.size(), weights.size()); ++i) {
            if (weights[i] == 0.0 || !targets[i].contains("POSITION")) continue;
            const auto offsets =
                document_.read_accessor(document_.number(targets[i], "POSITION", where), "VEC3");
            if (offsets.size() != positions.size()) {
                document_.refuse("has a morph target with another number of vertices", where);
            }
            for (std::size_t k = 0; k < positions.size(); ++k) positions[k] += weights[i] * offsets[k];
        }
    }

    std::vector<std::uint32_t> read_corners(const json& primitive, std::size_t count,
                                            const std::string& where) {
        std::vector<std::uint32_t> corners;
        if (!primitive.contains("indices")) {
            for (std::size_t i = 0; i < count; ++i) corners.push_back(static_cast<std::uint32_t>(i));
            return corners;
        }
        const auto indices = document_.read_accessor(document_.number(primitive, "indices", where), "SCALAR");
        corners.reserve(indices.size());
        for (const double index : indices) {
            if (!(index >= 0.0 && index < static_cast<double>(count))) {
                document_.refuse("has an index of a vertex that does not exist", where);
            }
            corners.push_back(static_cast<std::uint32_t>(index));
        }
        return corners;
    }

    /// Of the node itself, or of its instances (EXT_mesh_gpu_instancing).
    std::vector<glm::dmat4> placements(const json& entry, const glm::dmat4& node) {
        const json extensions = entry.value("extensions", json::object());
        if (!extensions.contains("EXT_mesh_gpu_instancing")) return {node};
        const std::string where = "EXT_mesh_gpu_instancing";
        const json& attributes = extensions[where].at("attributes");
        const auto read = [&](const char* key, const char* type) {
            if (!attributes.contains(key)) return std::vector<double>();
            return document_.read_accessor(document_.number(attributes, key, where), type);
        };
        const auto translations = read("TRANSLATION", "VEC3");
        const auto rotations = read("ROTATION", "VEC4");
        const auto scales = read("SCALE", "VEC3");
        const std::size_t count =
            std::max({translations.size() / 3, rotations.size() / 4, scales.size() / 3});
        const auto fits = [&](const std::vector<double>& values, std::size_t size) {
            return values.empty() || values.size() == count * size;
        };
        if (!fits(translations, 3) || !fits(rotations, 4) || !fits(scales, 3)) {
            document_.refuse("has attributes of different counts", where);
        }
        std::vector<glm::dmat4> result;
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec4 rotation = rotations.empty()
                                            ? glm::dvec4(0.0, 0.0, 0.0, 1.0)
                                            : glm::dvec4(rotations[4 * i], rotations[4 * i + 1],
                                                         rotations[4 * i + 2], rotations[4 * i + 3]);
            result.push_back(
                node * gltf_transform(translations.empty() ? glm::dvec3(0.0) : vector_at(translations, i),
                                      rotation, scales.empty() ? glm::dvec3(1.0) : vector_at(scales, i)));
        }
        return result;
    }

    /// The joints' placements of a skinned mesh, blended for each vertex; its own node's does not count (glTF
    /// 2.0, chapter Skins).
    std::vector<glm::dmat4> skin_matrices(std::size_t index, const json& attributes, std::size_t count,
                                          const std::string& where) {
        const std::vector<glm::dmat4> joints = joint_matrices(index);
        std::vector<glm::dmat4> matrices(count, glm::dmat4(0.0));
        std::vector<double> sums(count, 0.0);
        for (int set = 0; attributes.contains("JOINTS_" + std::to_string(set)); ++set) {
            const std::string joints_key = "JOINTS_" + std::to_string(set);
            const std::string weights_key = "WEIGHTS_" + std::to_string(set);
            const auto which =
                document_.read_accessor(document_.number(attributes, joints_key.c_str(), where), "VEC4");
            const auto weights =
                document_.read_accessor(document_.number(attributes, weights_key.c_str(), where), "VEC4");
            if (which.size() != 4 * count || weights.size() != 4 * count) {
                document_.refuse("has joints or weights for another number of vertices", where);
            }
            for (std::size_t i = 0; i < 4 * count; ++i) {
                if (weights[i] == 0.0) continue;
                if (which[i] >= static_cast<double>(joints.size()))
                    document_.refuse("has a joint that does not exist", where);
                matrices[i / 4] += weights[i] * joints[static_cast<std::size_t>(which[i])];
                sums[i / 4] += weights[i];
            }
        }
        for (std::size_t i = 0; i < count; ++i)
            matrices[i] = sums[i] != 0.0 ? matrices[i] / sums[i] : joints.front();
        return matrices;
    }

    std::vector<glm::dmat4> joint_matrices(std::size_t index) {
        const std::string where = "skins[" + std::to_string(index) + "]";
        const json& skin = document_.entry("skins", index);
        const auto joints = skin.at("joints").get<std::vector<std::size_t>>();
        if (joints.empty()) document_.refuse("has no joints", where);
        std::vector<double> inverse;
        if (skin.contains("inverseBindMatrices")) {
            inverse = document_.read_accessor(document_.number(skin, "inverseBindMatrices", where), "MAT4");
            if (inverse.size() < 16 * joints.size())
                document_.refuse("has fewer matrices than joints", where);
        }
        std::vector<glm::dmat4> matrices;
        for (std::size_t i = 0; i < joints.size(); ++i) {
            if (joints[i] >= nodes_.placements.size())
                document_.refuse("has a joint that does not exist", where);
            glm::dmat4 bind(1.0);
            for (std::size_t k = 0; k < 16 && !inverse.empty(); ++k) {
                bind[static_cast<int>(k / 4)][static_cast<int>(k % 4)] = inverse[16 * i + k];
            }
            matrices.push_back(nodes_.placements[joints[i]] * bind);
        }
        return matrices;
    }

    void add(const std::vector<double>& positions, const std::vector<std::uint32_t>& corners,
             std::size_t mode, const Placement& placement) {
        const std::size_t count = positions.size() / 3;
        elements_ += count + corners.size() / 3;
        if (elements_ > max_elements_) {
            refuse_file(document_.path(),
                        "repeats its meshes to more than " + std::to_string(max_elements_) +
                            " vertices and triangles",
                        "reduce it, or read a group of it");
        }
        const std::size_t first = builder_.vertex_count();
        for (std::size_t i = 0; i < count; ++i) {
            builder_.add_vertex(glm::dvec3(placement.of(i) * glm::dvec4(vector_at(positions, i), 1.0)));
        }
        std::vector<bool> mirrored(placement.matrices.size());
        for (std::size_t i = 0; i < mirrored.size(); ++i) mirrored[i] = is_mirrored(placement.matrices[i]);
        const std::size_t step = mode == 4 ? 3 : 1;
        for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
            std::array<std::uint32_t, 3> face = {corners[mode == 6 ? 0 : i], corners[i + 1], corners[i + 2]};
            // Every other triangle of a strip is wound the other way, and all of what is mirrored.
            const bool flipped = (mode == 5 && i % 2 == 1) != mirrored[mirrored.size() == 1 ? 0 : face[0]];
            if (flipped) std::swap(face[1], face[2]);
            for (std::uint32_t& corner : face) corner += static_cast<std::uint32_t>(first);
            builder_.add_face(face);
        }
    }

    const std::string& group_;
    GltfDocument document_;
    GltfNodes nodes_;
    MeshBuilder builder_;
    std::vector<std::string> names_;
    bool found_group_ = false;
    std::size_t elements_ = 0;
    std::size_t max_elements_ = 0;
};

}  // namespace

MeshFile read_gltf(const std::filesystem::path& path, const std::string& group) {
    try {
        return GltfReader(path, group).read();
    } catch (const json::exception& error) {
        refuse_file(path, std::string("is not valid glTF (") + error.what() + ")", damaged_mesh_remedy);
    }
}

}  // namespace skinglow::detail
