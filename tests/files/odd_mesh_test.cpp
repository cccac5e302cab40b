#include <gtest/gtest.h>

#include <bit>

#include "files/mesh_file.h"
#include "mesh_samples.h"
#include "rig_files/file_error.h"
#include "scratch_folder.h"

/// Meshes that are read although they are written in an odd way, and damage that is told in words.
namespace skinglow::test {
namespace {

constexpr const char* tetrahedron_obj =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

void expect_tetrahedron(const std::string& name, const std::string& content) {
    SCOPED_TRACE(content.substr(0, 200));
    const ScratchFolder folder;
    const TriangleMesh mesh = read_mesh(folder.write(name, content)).mesh;
    EXPECT_EQ(mesh.vertices().size(), 4U);
    EXPECT_EQ(mesh.triangles().size(), 4U);
    EXPECT_NEAR(signed_volume(mesh), 1.0 / 6.0, 1e-12);
}

void expect_bad(const std::string& name, const std::string& content, const std::vector<std::string>& parts) {
    SCOPED_TRACE(content.substr(0, 200));
    const ScratchFolder folder;
    folder.write(name, content);
    expect_refused<FileError>([&] { read_mesh(folder / name); }, parts);
}

TEST(OddMesh, ObjInEveryWayOfWritingIt) {
    const std::string text = tetrahedron_obj;
    expect_tetrahedron("a.obj", text);
    expect_tetrahedron("a.obj", replaced(text, "\n", "\r\n"));
    expect_tetrahedron("a.obj", replaced(text, "\n", "\r"));
    expect_tetrahedron("a.obj", "\xEF\xBB\xBF" + text);
    expect_tetrahedron("a.obj", replaced(text, "\n", " #comment\n"));
    expect_tetrahedron("a.obj", replaced(text, "\n", " # a \\ in it\n"));
    expect_tetrahedron("a.obj", replaced(text, " ", " \\\n"));
    expect_tetrahedron("a.obj", replaced(text, "v 0 0 0", "v +0.0e-5 1e-400 -0."));
    expect_tetrahedron("a.obj", replaced(text, "v 0 0 1", "v 0 0 1 0.5 0.25 1"));
    expect_tetrahedron("a.obj", replaced(text, "f 2 3 4", "l 1 2\np 3\nf -3/9 -2//7 -1/1/1"));
    expect_tetrahedron("a.obj", "f 1 3 2\n" + replaced(text, "f 1 3 2\n", ""));
}

TEST(OddMesh, ObjWithWhatIsNoNumber) {
    const std::string text = tetrahedron_obj;
    for (const std::string word : {"1e400", "-1.#IND", "nan", "inf", "0x10", "0,5", "1e", "+-1", "1d0", ""}) {
        expect_bad("a.obj", replaced(text, "v 0 1 0", "v 0 1 " + word), {"a.obj", "line 3", word});
    }
    for (const std::string word : {"0", "-9", "99999999999999999999", "4294967297", "x"}) {
        expect_bad("a.obj", replaced(text, "f 2 3 4", "f 2 3 " + word), {"a.obj", "line 8", word});
    }
    expect_bad("a.obj", std::string("\xFF\xFEv\0 \0", 6), {"UTF-16", "UTF-8"});
}

std::string stl_text() {
    std::string text = "solid my head\n";
    for (const char* corners :
         {"0 0 0,0 1 0,1 0 0", "0 0 0,1 0 0,0 0 1", "0 0 0,0 0 1,0 1 0", "1 0 0,0 1 0,0 0 1"}) {
        text += "facet normal 0 0 0\nouter loop\nvertex " + replaced(corners, ",", "\nvertex ") +
                "\nendloop\nendfacet\n";
    }
    return text + "endsolid my head\n";
}

std::string stl_binary(const std::string& header) {
    std::string bytes = header;
    bytes.resize(80, '\0');
    append(bytes, std::uint32_t{4});
    for (const auto& corners : {std::array{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}) {
        bytes.append(12, '\0');
        for (const int corner : corners) {
            for (int axis = 1; axis <= 3; ++axis) append(bytes, corner == axis ? 1.0F : 0.0F);
        }
        bytes.append(2, '\0');
    }
    return bytes;
}

TEST(OddMesh, StlOfBothKindsHoweverItBegins) {
    const std::string text = stl_text();
    expect_tetrahedron("a.stl", text);
    expect_tetrahedron("a.stl", replaced(text, "\n", "\r\n"));
    expect_tetrahedron("a.stl", "\xEF\xBB\xBF \n" + text);
    expect_tetrahedron("a.stl", replaced(replaced(text, "vertex", "VERTEX"), "solid", "SOLID"));
    expect_tetrahedron("a.stl", replaced(text, "my head", "vertex endloop"));
    expect_tetrahedron("a.stl", stl_binary("made by hand"));
    expect_tetrahedron("a.stl", stl_binary("solid made by hand"));
    expect_bad("a.stl", stl_binary("solid made by hand") + "more", {"another size"});
    expect_bad("a.stl", stl_binary("solid made by hand").substr(0, 270), {"another size"});
    expect_bad("a.stl", replaced(text, "endsolid my head\n", ""), {"ends too early"});
    expect_bad("a.stl", replaced(text, "\nendloop", "\nvertex 0 0 0\nendloop"), {"more than three corners"});
}

TEST(OddMesh, PlyElementsTwiceAndWithoutAFormat) {
    const std::string start =
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
    expect_bad("a.ply", start + "element vertex 3\nend_header\n", {"line 7", "vertex a second time"});
    expect_bad("a.ply", replaced(start, "format ascii 1.0\n", "") + "end_header\n", {"format"});
}

TEST(OddMesh, PlyBinaryOfTrianglesAndOthersInTurn) {
    std::string bytes =
        "ply\nformat binary_big_endian 1.0\nobj_info by hand\nelement face 6\nproperty ushort flags\n"
        "property list int float vertex_index\nproperty double area\nelement nothing 2\nproperty char c\n"
        "element vertex 4\nproperty short z\nproperty uchar red\nproperty double x\nproperty float "
        "y\nend_header\n";
    const auto add_face = [&](const std::vector<int>& corners) {
        append(bytes, std::uint16_t{7}, true);
        append(bytes, static_cast<std::int32_t>(corners.size()), true);
        for (const int corner : corners) append(bytes, static_cast<float>(corner), true);
        append(bytes, 0.5, true);
    };
    // A pair of corners is no face, and a quad with one corner twice has a triangle without area.
    for (const auto& corners :
         std::vector<std::vector<int>>{{0, 2, 1}, {0, 1, 3}, {}, {0, 3}, {0, 3, 2}, {1, 2, 3}})
        add_face(corners);
    bytes += "cc";
    for (const glm::vec3 corner : {glm::vec3(0, 0, 0), {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
        append(bytes, static_cast<std::int16_t>(corner.z), true);
        bytes += '\xFF';
        append(bytes, static_cast<double>(corner.x), true);
        append(bytes, corner.y, true);
    }
    expect_tetrahedron("a.ply", bytes);
}

TEST(OddMesh, VersionsOfGltf) {
    const auto with_asset = [](const std::string& asset) {
        return replaced(GltfSample().text(), R"({"version": "2.0"})", asset);
    };
    const ScratchFolder folder;
    EXPECT_EQ(read_mesh(folder.write("a.gltf", with_asset(R"({"version": "2.1"})"))).mesh.triangles().size(),
              12U);
    expect_bad("a.gltf", with_asset(R"({"version": "2.1", "minVersion": "2.1"})"), {"version 2.1"});
    expect_bad("a.gltf", with_asset(R"({"version": "1.0"})"), {"version 1.0"});
    expect_bad("a.gltf", with_asset("\"2.0\""), {"not valid glTF"});
}

TEST(OddMesh, DataUrisPercentEncoded) {
    GltfSample sample;
    sample.uri = "data:application/octet-stream;base64," + replaced(base64(sample.bytes), "/", "%2F") + "%3D";
    const ScratchFolder folder;
    EXPECT_EQ(read_mesh(folder.write("a.gltf", sample.text())).mesh.triangles().size(), 12U);
    sample.uri = "data:,";
    for (const char byte : sample.bytes) {
        constexpr std::string_view digits = "0123456789ABCDEF";
        sample.uri += std::string("%") + digits[static_cast<unsigned char>(byte) >> 4U] + digits[byte & 15];
    }
    EXPECT_EQ(read_mesh(folder.write("a.gltf", sample.text())).mesh.triangles().size(), 12U);
    sample.uri += "%4";
    expect_bad("a.gltf", sample.text(), {"data URI"});
}

TEST(OddMesh, MessagesAreOneLineOfText) {
    const ScratchFolder folder;
    folder.write("a.obj", "v 0 0 \xFF\x1B[31m\xC3\xA4\xC3\n");
    expect_refused<FileError>([&] { read_mesh(folder / "a.obj"); }, {"\"??[31m\xC3\xA4?\""});
    folder.write("a.gltf", "\xFF\xFE{");
    expect_refused<FileError>([&] { read_mesh(folder / "a.gltf"); }, {"last read: '?'"});
}

}  // namespace
}  // namespace skinglow::test
