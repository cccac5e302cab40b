#include <algorithm>
#include <cmath>
#include <glm/matrix.hpp>

#include "geometry/vector.h"
#include "geometry/weld.h"
#include "numerics/argument_check.h"
#include "povray/povray_parts.h"
#include "povray/sdl_text.h"

namespace skinglow::detail {
namespace {

/// The vertices that triangles use, in their order; `index` of the others means nothing.
Weld used_vertices(const TriangleMesh& mesh) {
    Weld used{.first = {}, .index = std::vector<std::uint32_t>(mesh.vertices().size(), 0)};
    for (const glm::uvec3& t : mesh.triangles()) {
        for (int k = 0; k < 3; ++k) used.index[t[k]] = 1;
    }
    for (std::uint32_t i = 0; i < used.index.size(); ++i) {
        if (used.index[i] == 0) continue;
        used.index[i] = static_cast<std::uint32_t>(used.first.size());
        used.first.push_back(i);
    }
    return used;
}

template <typename ValueAt>
void add_vectors(SdlText& text, std::string_view keyword, std::span<const std::uint32_t> entries,
                 ValueAt value_at) {
    text.add("  ", keyword, " { ", entries.size(), ",");
    for (std::size_t i = 0; i < entries.size(); ++i) text.add_item(i, 4, value_at(entries[i]));
    text.add("\n  }\n");
}

/// POV-Ray takes a normal shorter than 1e-10 for none, and of a very long one the square is infinite.
glm::dvec3 written_normal(const glm::dvec3& normal) {
    if (normal == glm::dvec3(0.0)) return {0.0, 0.0, 1.0};
    // A host's, of single precision, stay as they are.
    constexpr double same = 1e-6;
    return std::abs(length(normal) - 1.0) < same ? normal : unit(normal);
}

template <typename IndexOfCorner>
void add_indices(SdlText& text, std::string_view keyword, std::size_t triangles, IndexOfCorner index) {
    text.add("  ", keyword, " { ", triangles, ",");
    for (std::size_t i = 0; i < triangles; ++i) {
        text.add_item(i, 8, "<", index(3 * i), ",", index(3 * i + 1), ",", index(3 * i + 2), ">");
    }
    text.add("\n  }\n");
}

void add_corner_indices(SdlText& text, std::string_view keyword, const Weld& corners) {
    add_indices(text, keyword, corners.index.size() / 3, [&](std::size_t i) { return corners.index[i]; });
}

template <typename Vector>
void require_finite_list(std::string_view name, std::span<const Vector> values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        for (int k = 0; k < values[i].length(); ++k) require_finite(entry_name(name, i), values[i][k]);
    }
}

}  // namespace

void validate(const PovrayScene& scene, const PovrayMesh& mesh) {
    const std::size_t corners = 3 * mesh.geometry.triangles().size();
    if (corners == 0) refuse_argument("mesh", "0 triangles", "1 or more");
    const std::size_t vertices = mesh.geometry.vertices().size();
    if (scene.lut.glow == PovrayGlow::texels) {
        require_count("glow_uv", mesh.glow_uv.size(), corners, "three per triangle");
        require_finite_list<glm::dvec2>("glow_uv", mesh.glow_uv);
    } else {
        if (!has_own_uv(scene) || !mesh.lut_u.empty())
            require_count("lut_u", mesh.lut_u.size(), vertices, "one per vertex");
        for (std::size_t i = 0; i < mesh.lut_u.size(); ++i)
            require_finite(entry_name("lut_u", i), mesh.lut_u[i]);
    }
    if (!mesh.vertex_normals.empty() && !mesh.corner_normals.empty()) {
        refuse_argument("normals", "given per vertex and per corner", "one of the two");
    }
    if (!mesh.vertex_normals.empty())
        require_count("vertex_normals", mesh.vertex_normals.size(), vertices, "one per vertex");
    if (!mesh.corner_normals.empty())
        require_count("corner_normals", mesh.corner_normals.size(), corners, "three per triangle");
    require_finite_list<glm::dvec3>("vertex_normals", mesh.vertex_normals);
    require_finite_list<glm::dvec3>("corner_normals", mesh.corner_normals);
    for (std::size_t i = 0; i < mesh.instances.size(); ++i) {
        const glm::dmat4& place = mesh.instances[i];
        for (int column = 0; column < 4; ++column)
            require_finite(entry_name("instances", i), glm::dvec3(place[column]));
        if (glm::determinant(glm::dmat3(place)) == 0.0)
            refuse_argument(entry_name("instances", i)(), "flat",
                            "a matrix with a determinant that is not 0");
    }
    if (has_picture(scene.surface) || has_own_uv(scene)) {
        require_count("surface_uv", mesh.surface_uv.size(), corners, "three per triangle");
        require_finite_list<glm::dvec2>("surface_uv", mesh.surface_uv);
    }
}

std::string mesh_identifier(const PovrayMesh& mesh) {
    return sdl_identifier("Mesh", mesh.name);
}

std::string povray_mesh_text(const PovrayScene& scene) {
    const PovrayMesh& mesh = scene.mesh;
    const Weld used = used_vertices(mesh.geometry);
    const bool in_parts = is_in_parts(scene);
    const bool picture_uv = in_parts || has_own_uv(scene);
    SdlText text;
    text.reserve(used.first.size() * 180 + mesh.geometry.triangles().size() * 60);
    text.add("// ", sdl_comment(mesh.name),
             ": triangles in world space, as Blender has it (right-handed, z up).\n", "#declare ",
             mesh_identifier(mesh), " = mesh2 {\n");
    add_vectors(text, "vertex_vectors", used.first,
                [&](std::uint32_t i) { return mesh.geometry.vertices()[i]; });

    const std::span<const glm::dvec3> normals =
        mesh.vertex_normals.empty() ? mesh.corner_normals : mesh.vertex_normals;
    const auto normal_at = [&](std::uint32_t i) { return written_normal(normals[i]); };
    const bool smooth = scene.surface && !normals.empty();
    const bool by_corner = smooth && mesh.vertex_normals.empty();
    const Weld corner_normals = by_corner ? weld(normals) : Weld{};
    if (smooth) add_vectors(text, "normal_vectors", by_corner ? corner_normals.first : used.first, normal_at);

    const Weld corner_uv = picture_uv ? weld<glm::dvec2>(mesh.surface_uv) : Weld{};
    if (in_parts) text.add("#if (Skinglow_Part = 1)\n");
    if (picture_uv)
        add_vectors(text, "uv_vectors", corner_uv.first, [&](std::uint32_t i) { return mesh.surface_uv[i]; });
    if (in_parts) text.add("#else\n");
    const bool by_texel = scene.lut.glow == PovrayGlow::texels;
    const Weld glow_uv = by_texel ? weld<glm::dvec2>(mesh.glow_uv) : Weld{};
    if (by_texel) {
        add_vectors(text, "uv_vectors", glow_uv.first, [&](std::uint32_t i) { return mesh.glow_uv[i]; });
    } else if (!has_own_uv(scene)) {
        const double first = scene.lut.axis.texel_offset();
        add_vectors(text, "uv_vectors", used.first, [&](std::uint32_t i) {
            return glm::dvec2(std::clamp(mesh.lut_u[i], first, 1.0 - first), 0.5);
        });
    }
    if (in_parts) text.add("#end\n");

    add_indices(text, "face_indices", mesh.geometry.triangles().size(), [&](std::size_t i) {
        return used.index[mesh.geometry.triangles()[i / 3][static_cast<int>(i % 3)]];
    });
    if (by_corner) add_corner_indices(text, "normal_indices", corner_normals);
    if (in_parts) text.add("#if (Skinglow_Part = 1)\n");
    if (picture_uv) add_corner_indices(text, "uv_indices", corner_uv);
    if (in_parts) text.add("#else\n");
    if (by_texel) add_corner_indices(text, "uv_indices", glow_uv);
    if (in_parts) text.add("#end\n");
    text.add("  uv_mapping\n}\n");
    return text.take();
}

}  // namespace skinglow::detail
