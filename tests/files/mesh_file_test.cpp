#include "files/mesh_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include "mesh_samples.h"
#include "rig_files/file_error.h"
#include "scratch_folder.h"

namespace skinglow::test {
namespace {

constexpr std::array<std::array<int, 4>, 6> cube_faces = {
    {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}};

std::string corner(int i) {
    return std::to_string(i / 4) + " " + std::to_string(i / 2 % 2) + " " + std::to_string(i % 2) + "\n";
}

/// A unit cube whose corners have a normal for each face, which a reader may take for vertices of their own.
std::string cube_obj() {
    std::string text = "o cube\n";
    for (int i = 0; i < 8; ++i) text += "v " + corner(i);
    for (int i = 0; i < 6; ++i) text += "vn " + std::to_string(i) + " 1 0\n";
    text += "g box\n";
    for (std::size_t face = 0; face < 6; ++face) {
        text += "f";
        for (const int i : cube_faces[face])
            text += " " + std::to_string(i + 1) + "//" + std::to_string(face + 1);
        text += "\n";
    }
    return text + "g extra\nv 5 5 5\nv 6 5 5\nv 5 6 5\nf 9 10 11\n";
}

std::string cube_ply_text() {
    std::string text =
        "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 8\nproperty float x\nproperty float y\n"
        "property float z\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n";
    for (int i = 0; i < 8; ++i) text += corner(i);
    for (const auto& face : cube_faces) {
        text += "4";
        for (const int i : face) text += " " + std::to_string(i);
        text += "\n";
    }
    return text;
}

std::string cube_ply_binary(bool big_endian) {
    std::string bytes =
        std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
        "_endian 1.0\nelement vertex 8\nproperty double x\nproperty float y\nproperty short z\n"
        "element face 6\nproperty uchar flags\nproperty list uint8 uint32 vertex_index\nend_header\n";
    for (int i = 0; i < 8; ++i) {
        append(bytes, static_cast<double>(i / 4), big_endian);
        append(bytes, static_cast<float>(i / 2 % 2), big_endian);
        append(bytes, static_cast<std::int16_t>(i % 2), big_endian);
    }
    for (const auto& face : cube_faces) {
        bytes += '\x00';
        bytes += '\x04';
        for (const int i : face) append(bytes, static_cast<std::uint32_t>(i), big_endian);
    }
    return bytes;
}

/// A cube is closed: each directed edge of its triangles meets its opposite.
void expect_unit_cube(const TriangleMesh& mesh) {
    ASSERT_EQ(mesh.vertices().size(), 8U) << "one vertex for each position";
    ASSERT_EQ(mesh.triangles().size(), 12U);
    double volume = 0.0;
    for (const glm::uvec3& t : mesh.triangles()) {
        const glm::dvec3 a = mesh.vertices()[t.x];
        const glm::dvec3 b = mesh.vertices()[t.y];
        const glm::dvec3 c = mesh.vertices()[t.z];
        volume +=
            (a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x)) /
            6.0;
    }
    EXPECT_NEAR(volume, 1.0, 1e-12) << "winding is kept";
}

TEST(MeshFile, ObjVerticesAreJoinedAndGroupsChosen) {
    const ScratchFolder folder;
    const auto path = folder.write("cube.obj", cube_obj());
    expect_unit_cube(read_mesh(path, "box").mesh);
    EXPECT_EQ(read_mesh(path).mesh.triangles().size(), 13U);
    expect_refused<FileError>([&] { read_mesh(path, "nose"); },
                              {"cube.obj", "no group \"nose\"", "box", "extra"});
}

TEST(MeshFile, PlyInEveryCoding) {
    const ScratchFolder folder;
    expect_unit_cube(read_mesh(folder.write("a.ply", cube_ply_text())).mesh);
    expect_unit_cube(read_mesh(folder.write("b.ply", cube_ply_binary(false))).mesh);
    expect_unit_cube(read_mesh(folder.write("c.ply", cube_ply_binary(true))).mesh);
    expect_refused<FileError>([&] { read_mesh(folder / "a.ply", "box"); }, {"a.ply", "no group"});
}

TEST(MeshFile, RefusesPlyCutAtEveryLength) {
    const ScratchFolder folder;
    for (const std::string& whole : {cube_ply_text(), cube_ply_binary(false)}) {
        // The last character of the text is a line end, of no meaning.
        for (std::size_t length = 0; length + 1 < whole.size(); length += 5) {
            folder.write("cut.ply", whole.substr(0, length));
            SCOPED_TRACE(length);
            expect_refused<FileError>([&] { read_mesh(folder / "cut.ply"); }, {"cut.ply"});
        }
    }
}

TEST(MeshFile, RefusesPlyWithWrongContent) {
    const ScratchFolder folder;
    const auto expect_bad = [&](const std::string& from, const std::string& to,
                                const std::vector<std::string>& parts) {
        std::string text = cube_ply_text();
        text.replace(text.find(from), from.size(), to);
        folder.write("bad.ply", text);
        expect_refused<FileError>([&] { read_mesh(folder / "bad.ply"); }, parts);
    };
    expect_bad("4 0 1 3 2", "4 0 1 3 8", {"face 0", "does not exist"});
    expect_bad("4 0 1 3 2", "4 0 1 3 -1", {"face 0", "does not exist"});
    expect_bad("0 0 1\n", "0 0 nan\n", {"vertex 1"});
    expect_bad("0 0 1\n", "0 0 one\n", {"vertex 1", "no number"});
    expect_bad("float x", "real x", {"line 5", "real"});
    expect_bad("ascii", "hex", {"line 2", "hex"});
    expect_bad("ply\n", "plx\n", {"line 1"});
    expect_bad("vertex 8", "vertex 99999999999999999999", {"line 4"});
    expect_bad("vertex 8", "vertex 999999999999999", {"vertex "});
    expect_bad("element face 6\n", "element nothing 999999999999999\nelement face 6\n",
               {"nothing", "without properties"});
    expect_bad("element face 6", "element face 0", {"no triangles"});
}

TEST(MeshFile, RefusesOtherDamagedMeshes) {
    const ScratchFolder folder;
    expect_refused<FileError>([&] { read_mesh(folder / "none.obj"); }, {"none.obj", "is not a file"});
    folder.write("text.obj", "Dear friend,\nthis is a letter and not a mesh at all.\n");
    expect_refused<FileError>([&] { read_mesh(folder / "text.obj"); }, {"text.obj"});
    folder.write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    expect_refused<FileError>([&] { read_mesh(folder / "index.obj"); }, {"index.obj"});
    folder.write("short.glb", std::string("glTF\x02\x00\x00\x00\xff\x00\x00\x00", 12) + std::string(40, 'x'));
    expect_refused<FileError>([&] { read_mesh(folder / "short.glb"); }, {"short.glb"});
    folder.write("mesh.xyz", "1 2 3\n");
    expect_refused<FileError>([&] { read_mesh(folder / "mesh.xyz"); },
                              {"mesh.xyz", "OBJ, PLY, STL, glTF or GLB"});
}

TEST(ThicknessFile, CsvHasEveryDigitAndPlyReadsBack) {
    const ScratchFolder folder;
    const TriangleMesh mesh = read_mesh(folder.write("cube.ply", cube_ply_text())).mesh;
    std::vector<double> thickness;
    for (int i = 0; i < 8; ++i) thickness.push_back(1.0 / (3 + i));
    write_thickness(folder / "t.csv", mesh, thickness, 10.0);
    const std::string text = read_bytes(folder / "t.csv");
    EXPECT_NE(text.find("units of 10 mm"), std::string::npos);
    EXPECT_NE(text.find("\nvertex,x,y,z,thickness_mm\n0,0,0,0,0.3333333333333333\n1,0,0,1,0.25\n"),
              std::string::npos)
        << text;
    write_thickness(folder / "t.ply", mesh, thickness, 10.0);
    expect_unit_cube(read_mesh(folder / "t.ply").mesh);
    EXPECT_NE(read_bytes(folder / "t.ply").find("property float thickness_mm"), std::string::npos);
}

TEST(ThicknessFile, Refuses) {
    const ScratchFolder folder;
    const TriangleMesh mesh = read_mesh(folder.write("cube.ply", cube_ply_text())).mesh;
    const std::vector<double> good(8, 1.0);
    std::vector<double> bad = good;
    bad[3] = std::numeric_limits<double>::quiet_NaN();
    expect_refused<FileError>([&] { write_thickness(folder / "t.txt", mesh, good, 1.0); },
                              {"t.txt", ".csv or .ply"});
    expect_refused<std::invalid_argument>([&] { write_thickness(folder / "t.csv", mesh, bad, 1.0); },
                                          {"vertex 3"});
    bad.pop_back();
    expect_refused<std::invalid_argument>([&] { write_thickness(folder / "t.csv", mesh, bad, 1.0); },
                                          {"8 vertices"});
}

}  // namespace
}  // namespace skinglow::test
