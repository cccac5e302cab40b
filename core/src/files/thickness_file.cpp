#include <algorithm>
#include <array>
#include <bit>
#include <string>

#include "files/atomic_file.h"
#include "files/mesh_file.h"
#include "numerics/argument_check.h"
#include "rig_files/file_error.h"

namespace skinglow::detail {
namespace {

/// The number's bytes, lowest first, whatever the machine's own order.
template <class Number>
void append_little_endian(std::string& bytes, Number number) {
    auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(number);
    if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
    bytes.append(raw.data(), raw.size());
}

std::string csv_text(const TriangleMesh& mesh, std::span<const double> thickness_mm, double unit_mm) {
    std::string text = "# Thickness of the body at each vertex, mm. Positions in units of " +
                       to_text(unit_mm) + " mm.\nvertex,x,y,z,thickness_mm\n";
    for (std::size_t i = 0; i < mesh.vertices().size(); ++i) {
        const glm::dvec3& position = mesh.vertices()[i];
        text += std::to_string(i) + "," + to_text(position.x) + "," + to_text(position.y) + "," +
                to_text(position.z) + "," + to_text(thickness_mm[i]) + "\n";
    }
    return text;
}

std::string ply_bytes(const TriangleMesh& mesh, std::span<const double> thickness_mm, double unit_mm) {
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\ncomment skinglow: one unit is " + to_text(unit_mm) +
        " mm\nelement vertex " + std::to_string(mesh.vertices().size()) +
        "\nproperty double x\nproperty double y\nproperty double z\nproperty float thickness_mm\n"
        "element face " +
        std::to_string(mesh.triangles().size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
    for (std::size_t i = 0; i < mesh.vertices().size(); ++i) {
        // Far from the origin float32 would join what lies apart.
        for (int axis = 0; axis < 3; ++axis) append_little_endian(bytes, mesh.vertices()[i][axis]);
        append_little_endian(bytes, static_cast<float>(thickness_mm[i]));
    }
    for (const glm::uvec3& triangle : mesh.triangles()) {
        bytes += '\x03';
        for (int corner = 0; corner < 3; ++corner) append_little_endian(bytes, triangle[corner]);
    }
    return bytes;
}

}  // namespace

void write_thickness(const std::filesystem::path& path, const TriangleMesh& mesh,
                     std::span<const double> thickness_mm, double unit_mm) {
    if (thickness_mm.size() != mesh.vertices().size()) {
        refuse_argument("number of thicknesses", std::to_string(thickness_mm.size()),
                        "one for each of " + std::to_string(mesh.vertices().size()) + " vertices");
    }
    for (std::size_t i = 0; i < thickness_mm.size(); ++i) {
        require_not_negative("thickness of vertex " + std::to_string(i), thickness_mm[i]);
    }
    const std::string extension = small_extension(path);
    if (extension == ".csv") {
        write_atomically(path, csv_text(mesh, thickness_mm, unit_mm));
    } else if (extension == ".ply") {
        write_atomically(path, ply_bytes(mesh, thickness_mm, unit_mm));
    } else {
        refuse_file(path, "is of a kind that cannot hold thickness", "name it .csv or .ply");
    }
}

}  // namespace skinglow::detail
