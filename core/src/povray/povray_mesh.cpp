#include <algorithm>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <unordered_map>

#include "numerics/argument_check.h"
#include "povray/povray_parts.h"
#include "povray/sdl_text.h"

namespace skinglow {
namespace {

constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();

/// What is written of a list, and the place in it of each thing that refers to it.
struct Selection {
    std::vector<std::uint32_t> kept;      // entries of the list, in the order written
    std::vector<std::uint32_t> place_of;  // by who refers to them: place in `kept`
};

Selection used_vertices(const PovrayMesh& mesh) {
    Selection used{.kept = {}, .place_of = std::vector<std::uint32_t>(mesh.positions.size(), unused)};
    for (const glm::uvec3& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) used.place_of[t[k]] = 0;
    }
    for (std::uint32_t i = 0; i < used.place_of.size(); ++i) {
        if (used.place_of[i] == unused) continue;
        used.place_of[i] = static_cast<std::uint32_t>(used.kept.size());
        used.kept.push_back(i);
    }
    return used;
}

template <typename Vector>
struct BitHash {
    std::size_t operator()(const Vector& value) const {
        // FNV-1a over whole numbers (G. Fowler, L. C. Noll, K.-P. Vo); the shift brings high bits down.
        std::uint64_t hash = 14695981039346656037ULL;
        for (int k = 0; k < value.length(); ++k) {
            // Adding 0 makes zero of minus zero: they compare equal, so they must hash equal.
            const double number = value[k] + 0.0;
            std::uint64_t bits = 0;
            std::memcpy(&bits, &number, sizeof bits);
            hash = (hash ^ bits) * 1099511628211ULL;
            hash ^= hash >> 32U;
        }
        return hash;
    }
};

/// Corner values, each different one once: neighboring triangles mostly agree on them.
template <typename Vector>
Selection distinct(std::span<const Vector> values) {
    Selection result;
    result.place_of.reserve(values.size());
    std::unordered_map<Vector, std::uint32_t, BitHash<Vector>> place;
    place.reserve(values.size() / 2);
    for (std::uint32_t i = 0; i < values.size(); ++i) {
        const auto [entry, is_new] =
            place.try_emplace(values[i], static_cast<std::uint32_t>(result.kept.size()));
        if (is_new) result.kept.push_back(i);
        result.place_of.push_back(entry->second);
    }
    return result;
}

template <typename ValueAt>
void add_vectors(SdlText& text, std::string_view keyword, std::span<const std::uint32_t> kept,
                 ValueAt value_at) {
    text.add("  ").add(keyword).add(" { ").add(static_cast<std::uint32_t>(kept.size())).add(",");
    for (std::size_t i = 0; i < kept.size(); ++i) text.add_item(i, 4, value_at(kept[i]));
    text.add("\n  }\n");
}

template <typename PlaceOfCorner>
void add_indices(SdlText& text, std::string_view keyword, std::size_t triangles, PlaceOfCorner place) {
    text.add("  ").add(keyword).add(" { ").add(static_cast<std::uint32_t>(triangles)).add(",");
    for (std::size_t i = 0; i < triangles; ++i) {
        text.add_item(i, 8, "<")
            .add(place(3 * i))
            .add(",")
            .add(place(3 * i + 1))
            .add(",")
            .add(place(3 * i + 2));
        text.add(">");
    }
    text.add("\n  }\n");
}

void add_corner_indices(SdlText& text, std::string_view keyword, const Selection& corners) {
    add_indices(text, keyword, corners.place_of.size() / 3,
                [&](std::size_t i) { return corners.place_of[i]; });
}

void require_count(std::string_view name, std::size_t count, std::size_t wanted, std::string_view of_what) {
    if (count != wanted) {
        refuse_argument(name, std::to_string(count) + " entries",
                        std::to_string(wanted) + ", " + std::string(of_what));
    }
}

template <typename Vector>
void require_finite_list(std::string_view name, std::span<const Vector> values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        for (int k = 0; k < values[i].length(); ++k) {
            require_finite(std::string(name) + "[" + std::to_string(i) + "]", values[i][k]);
        }
    }
}

}  // namespace

double PovrayBounds::diagonal() const {
    return glm::length(high - low);
}

PovrayBounds bounds_of(const PovrayMesh& mesh) {
    const glm::dvec3& first = mesh.positions[mesh.triangles[0].x];
    PovrayBounds bounds{first, first};
    for (const glm::uvec3& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            bounds.low = glm::min(bounds.low, mesh.positions[t[k]]);
            bounds.high = glm::max(bounds.high, mesh.positions[t[k]]);
        }
    }
    return bounds;
}

void validate(const PovrayMesh& mesh, const std::optional<PovraySurface>& surface) {
    const std::size_t corners = 3 * mesh.triangles.size();
    if (mesh.triangles.empty() || corners >= unused || mesh.positions.size() >= unused) {
        refuse_argument("mesh", std::to_string(mesh.triangles.size()) + " triangles",
                        "1 or more, fewer than 32 bits can count");
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::uvec3& t = mesh.triangles[i];
        if (std::max({t.x, t.y, t.z}) >= mesh.positions.size()) {
            refuse_argument(
                "triangles[" + std::to_string(i) + "]", std::to_string(std::max({t.x, t.y, t.z})),
                "indices below " + std::to_string(mesh.positions.size()) + ", the number of vertices");
        }
    }
    require_finite_list<glm::dvec3>("positions", mesh.positions);
    require_count("lut_u", mesh.lut_u.size(), mesh.positions.size(), "one per vertex");
    for (std::size_t i = 0; i < mesh.lut_u.size(); ++i) {
        require_finite("lut_u[" + std::to_string(i) + "]", mesh.lut_u[i]);
    }
    if (!mesh.vertex_normals.empty() && !mesh.corner_normals.empty()) {
        refuse_argument("normals", "given per vertex and per corner", "one of the two");
    }
    if (!mesh.vertex_normals.empty()) {
        require_count("vertex_normals", mesh.vertex_normals.size(), mesh.positions.size(), "one per vertex");
    }
    if (!mesh.corner_normals.empty()) {
        require_count("corner_normals", mesh.corner_normals.size(), corners, "three per triangle");
    }
    require_finite_list<glm::dvec3>("vertex_normals", mesh.vertex_normals);
    require_finite_list<glm::dvec3>("corner_normals", mesh.corner_normals);
    if (surface && !surface->image.empty()) {
        require_count("surface_uv", mesh.surface_uv.size(), corners, "three per triangle");
        require_finite_list<glm::dvec2>("surface_uv", mesh.surface_uv);
    }
}

std::string mesh_identifier(const PovrayMesh& mesh) {
    return sdl_identifier("Mesh", mesh.name);
}

std::string povray_mesh_text(const PovrayScene& scene) {
    const PovrayMesh& mesh = scene.mesh;
    const Selection used = used_vertices(mesh);
    const bool has_picture = scene.surface && !scene.surface->image.empty();
    SdlText text;
    text.reserve(used.kept.size() * 180 + mesh.triangles.size() * 60);
    text.add("// " + sdl_comment(mesh.name) +
             ": triangles in world space, as Blender has it (right-handed, z up).\n");
    text.add("#declare ").add(mesh_identifier(mesh)).add(" = mesh2 {\n");
    add_vectors(text, "vertex_vectors", used.kept, [&](std::uint32_t i) { return mesh.positions[i]; });

    const std::span<const glm::dvec3> normals =
        mesh.vertex_normals.empty() ? mesh.corner_normals : mesh.vertex_normals;
    const auto normal_at = [&](std::uint32_t i) {
        return normals[i] == glm::dvec3(0.0) ? glm::dvec3(0.0, 0.0, 1.0) : normals[i];
    };
    const bool smooth = scene.surface && !normals.empty();
    const bool by_corner = smooth && mesh.vertex_normals.empty();
    const Selection corner_normals = by_corner ? distinct(normals) : Selection{};
    if (smooth) add_vectors(text, "normal_vectors", by_corner ? corner_normals.kept : used.kept, normal_at);

    const Selection corner_uv = has_picture ? distinct<glm::dvec2>(mesh.surface_uv) : Selection{};
    if (has_picture) {
        text.add("#if (Skinglow_Part = 1)\n");
        add_vectors(text, "uv_vectors", corner_uv.kept, [&](std::uint32_t i) { return mesh.surface_uv[i]; });
        text.add("#else\n");
    }
    const double first = scene.lut.axis.texel_offset();
    add_vectors(text, "uv_vectors", used.kept, [&](std::uint32_t i) {
        return glm::dvec2(std::clamp(mesh.lut_u[i], first, 1.0 - first), 0.5);
    });
    if (has_picture) text.add("#end\n");

    add_indices(text, "face_indices", mesh.triangles.size(),
                [&](std::size_t i) { return used.place_of[mesh.triangles[i / 3][static_cast<int>(i % 3)]]; });
    if (by_corner) add_corner_indices(text, "normal_indices", corner_normals);
    if (has_picture) {
        text.add("#if (Skinglow_Part = 1)\n");
        add_corner_indices(text, "uv_indices", corner_uv);
        text.add("#end\n");
    }
    text.add("  uv_mapping\n}\n");
    return text.take();
}

}  // namespace skinglow
