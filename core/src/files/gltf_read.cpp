#include <algorithm>
#include <glm/mat4x4.hpp>
#include <numeric>
#include <optional>
#include <span>

#include "files/gltf_nodes.h"
#include "files/gltf_placement.h"
#include "files/mesh_builder.h"

namespace skinglow::detail {
namespace {

using nlohmann::json;

/// What instances and nodes may make of the parts of a file, in vertices and triangles.
constexpr std::size_t max_expanded = 4'000'000;
/// A larger file may hold more: no exporter writes a vertex or triangle in fewer bytes.
constexpr std::size_t min_element_bytes = 4;

/// How a primitive's corners make triangles.
enum class Mode : std::size_t { triangles = 4, strip = 5, fan = 6 };

std::size_t triangle_count(Mode mode, std::size_t corners) {
    if (corners < 3) return 0;
    return mode == Mode::triangles ? corners / 3 : corners - 2;
}

class GltfReader {
  public:
    GltfReader(const std::filesystem::path& path, const std::string& group)
        : group_(group), document_(path), nodes_(read_gltf_nodes(document_)), builder_(document_.path()) {
        std::error_code error;
        max_elements_ =
            std::max<std::size_t>(max_expanded, std::filesystem::file_size(path, error) / min_element_bytes);
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
        file.has_y_up = true;  // glTF 2.0, 3.4
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
        const std::size_t mode_number = document_.number(primitive, "mode", where, 4);
        const json& attributes = primitive.at("attributes");
        if (mode_number < 4 || !attributes.contains("POSITION")) return;  // points and lines
        if (mode_number > 6) document_.refuse("has the unknown mode " + std::to_string(mode_number), where);
        const auto mode = static_cast<Mode>(mode_number);
        refuse_compressed(primitive, where);
        const GltfAccessor positions =
            document_.accessor(document_.number(attributes, "POSITION", where), "VEC3");
        std::optional<GltfAccessor> indices;
        if (primitive.contains("indices"))
            indices = document_.accessor(document_.number(primitive, "indices", where), "SCALAR");
        const std::size_t triangles = triangle_count(mode, indices ? indices->count : positions.count);
        if (triangles == 0) return;
        if (positions.count == 0) document_.refuse("has faces and no vertices", where);
        const bool is_skinned = entry.contains("skin") && attributes.contains("JOINTS_0");
        const auto expect = [&](std::size_t copies) { expect_elements(copies, positions.count + triangles); };
        const GltfInstances instances(document_, is_skinned ? json::object() : entry, nodes_.placements[node],
                                      expect);
        if (instances.count() == 0) return;

        const std::size_t first_vertex = builder_.vertex_count();
        const std::span<glm::dvec3> vertices = builder_.add_vertices(instances.count() * positions.count);
        const std::span<glm::dvec3> original = vertices.first(positions.count);
        document_.read(positions, &original[0].x);
        add_morph_targets(original, primitive, morph, where);
        const std::span<glm::uvec3> faces = builder_.add_triangles(instances.count() * triangles);
        read_triangles(indices, mode, positions.count, faces.first(triangles), where);
        if (is_skinned) {
            const std::size_t skin = document_.number(entry, "skin", where);
            const auto mirrored =
                apply_gltf_skin(document_, nodes_, skin, attributes, original, where,
                                [&](std::size_t elements) { expect_elements(elements, 1); });
            for (glm::uvec3& face : faces) {
                if (mirrored[face.x] != 0) std::swap(face.y, face.z);
            }
            for (glm::uvec3& face : faces) face += static_cast<std::uint32_t>(first_vertex);
            return;
        }
        // The first copy last, since the others are made of it.
        for (std::size_t i = instances.count(); i-- > 0;) {
            transform(original, vertices.subspan(i * positions.count, positions.count),
                      faces.first(triangles), faces.subspan(i * triangles, triangles), instances.placement(i),
                      static_cast<std::uint32_t>(first_vertex + i * positions.count));
        }
    }

    /// A file may compress without demanding that this be known, and leave the plain data out all the same.
    void refuse_compressed(const json& primitive, const std::string& where) const {
        const auto extensions = primitive.find("extensions");
        if (extensions == primitive.end() || !extensions->contains("KHR_draco_mesh_compression")) return;
        const auto position = document_.number(primitive.at("attributes"), "POSITION", where);
        if (document_.entry("accessors", position).contains("bufferView")) return;
        refuse_file(document_.path(), "is compressed by KHR_draco_mesh_compression, which is not read",
                    "export it without", where);
    }

    /// Instances, morph targets and skins repeat what is in the file once: told before memory and time are
    /// spent on them.
    void expect_elements(std::size_t copies, std::size_t elements) {
        if (copies > 0 && elements > (max_elements_ - elements_) / copies) {
            refuse_file(document_.path(),
                        "repeats its meshes to more than " + std::to_string(max_elements_) +
                            " vertices and triangles",
                        "reduce it, or read a group of it");
        }
        elements_ += copies * elements;
    }

    void add_morph_targets(std::span<glm::dvec3> positions, const json& primitive,
                           const std::vector<double>& weights, const std::string& where) {
        const auto targets = primitive.find("targets");
        if (targets == primitive.end()) return;
        for (std::size_t i = 0; i < std::min(targets->size(), weights.size()); ++i) {
            const json& target = (*targets)[i];
            if (weights[i] == 0.0 || !target.contains("POSITION")) continue;
            expect_elements(1, positions.size());
            const auto offsets = document_.read_accessor(document_.number(target, "POSITION", where), "VEC3");
            if (offsets.size() != 3 * positions.size()) {
                document_.refuse("has a morph target with another number of vertices", where);
            }
            for (std::size_t k = 0; k < positions.size(); ++k) {
                positions[k] +=
                    weights[i] * glm::dvec3(offsets[3 * k], offsets[3 * k + 1], offsets[3 * k + 2]);
            }
        }
    }

    /// Triangles of the primitive's own vertices.
    void read_triangles(const std::optional<GltfAccessor>& indices, Mode mode, std::size_t vertices,
                        std::span<glm::uvec3> triangles, const std::string& where) {
        if (indices && mode == Mode::triangles && indices->count % 3 == 0) {
            document_.read(*indices, &triangles[0].x);
        } else {  // the last one or two corners may make no triangle
            std::vector<std::uint32_t> corners(indices ? indices->count : vertices);
            if (indices) {
                document_.read(*indices, corners.data());
            } else {
                std::iota(corners.begin(), corners.end(), 0U);
            }
            for (std::size_t i = 0; i < triangles.size(); ++i) {
                const std::size_t at = mode == Mode::triangles ? 3 * i : i;
                triangles[i] = {corners[mode == Mode::fan ? 0 : at], corners[at + 1], corners[at + 2]};
                // Every other triangle of a strip is wound the other way.
                if (mode == Mode::strip && i % 2 == 1) std::swap(triangles[i].y, triangles[i].z);
            }
        }
        bool is_beyond = false;
        for (const glm::uvec3& t : triangles)
            is_beyond |= (t.x >= vertices) | (t.y >= vertices) | (t.z >= vertices);
        if (is_beyond) document_.refuse("has an index of a vertex that does not exist", where);
    }

    /// One copy of a primitive. The copy may be the original itself.
    static void transform(std::span<const glm::dvec3> from, std::span<glm::dvec3> to,
                          std::span<const glm::uvec3> from_faces, std::span<glm::uvec3> to_faces,
                          const glm::dmat4& placement, std::uint32_t first) {
        const bool moves = placement != glm::dmat4(1.0);
        if (!moves && from.data() == to.data() && first == 0) return;
        for (std::size_t i = 0; i < from.size(); ++i) {
            to[i] = moves ? glm::dvec3(placement * glm::dvec4(from[i], 1.0)) : from[i];
        }
        const bool flips = is_mirrored(placement);
        for (std::size_t i = 0; i < from_faces.size(); ++i) {
            const glm::uvec3 face = from_faces[i] + first;
            to_faces[i] = flips ? glm::uvec3(face.x, face.z, face.y) : face;
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
