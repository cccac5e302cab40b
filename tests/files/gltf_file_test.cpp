#include <gtest/gtest.h>

#include "files/mesh_file.h"
#include "mesh_samples.h"
#include "rig_files/file_error.h"
#include "scratch_folder.h"

namespace skinglow::test {
namespace {

TriangleMesh read(const GltfSample& sample, const std::string& group = {}) {
    const ScratchFolder folder;
    return read_mesh(folder.write("cube.gltf", sample.text()), group).mesh;
}

void expect_bad(const GltfSample& sample, const std::vector<std::string>& parts) {
    expect_refused<FileError>([&] { read(sample); }, parts);
}

void expect_cube(const TriangleMesh& mesh, const glm::dvec3& low, const glm::dvec3& high,
                 double tolerance = 1e-12) {
    ASSERT_EQ(mesh.vertices().size(), 8U);
    ASSERT_EQ(mesh.triangles().size(), 12U);
    glm::dvec3 min = mesh.vertices().front();
    glm::dvec3 max = min;
    for (const glm::dvec3& vertex : mesh.vertices()) {
        min = glm::min(min, vertex);
        max = glm::max(max, vertex);
    }
    EXPECT_LT(glm::length(min - low), tolerance);
    EXPECT_LT(glm::length(max - high), tolerance);
    const glm::dvec3 size = high - low;
    EXPECT_NEAR(signed_volume(mesh), size.x * size.y * size.z, tolerance * size.x * size.y * 6.0);
}

TEST(GltfFile, MetersAndTheOwnBytes) {
    const ScratchFolder folder;
    const MeshFile file = read_mesh(folder.write("cube.gltf", GltfSample().text()));
    EXPECT_EQ(file.unit_mm, 1000.0);
    EXPECT_TRUE(file.notes.empty());
    expect_cube(file.mesh, {0, 0, 0}, {1, 1, 1});
}

TEST(GltfFile, BuffersBesideItAreFoundByTheirPercentEncodedName) {
    const ScratchFolder folder;
    GltfSample sample;
    folder.write("left ear \xC3\xA4.bin", sample.bytes);
    sample.uri = "left%20ear%20%C3%A4.bin";
    const MeshFile file = read_mesh(folder.write("cube.gltf", sample.text()));
    expect_cube(file.mesh, {0, 0, 0}, {1, 1, 1});
    EXPECT_EQ(file.sources.size(), 2U);
    sample.uri = "missing.bin";
    folder.write("cube.gltf", sample.text());
    expect_refused<FileError>([&] { read_mesh(folder / "cube.gltf"); }, {"missing.bin", "not a file"});
    sample.uri = "https://example.org/cube.bin";
    expect_bad(sample, {"https://example.org/cube.bin", "beside"});
    sample.uri = "data:;base64,!!!!";
    expect_bad(sample, {"data URI"});
}

TEST(GltfFile, MirroredNodesStayWoundOutwards) {
    GltfSample sample;
    sample.nodes = R"([{"mesh": 0, "scale": [-1, 1, 1], "translation": [0, 0, 5]}])";
    expect_cube(read(sample), {-1, 0, 5}, {0, 1, 6});
    // Twice mirrored is not mirrored.
    sample.nodes =
        R"([{"children": [1], "scale": [1, -2, 1]}, {"mesh": 0, "matrix": [1,0,0,0, 0,1,0,0, 0,0,-1,0, 3,0,0,1]}])";
    expect_cube(read(sample), {3, -2, -1}, {4, 0, 0});
}

TEST(GltfFile, MorphTargetsAtTheirDefaultWeights) {
    GltfSample sample;
    std::string offsets;
    for (const glm::vec3& corner : cube_corners) {
        append(offsets, 0.0F);
        append(offsets, 0.0F);
        append(offsets, corner.z);
    }
    sample.add(offsets, 5126, 8, "VEC3");
    sample.primitive = R"(, "targets": [{"POSITION": 2}])";
    expect_cube(read(sample), {0, 0, 0}, {1, 1, 1});
    sample.mesh = R"(, "weights": [0.5])";
    expect_cube(read(sample), {0, 0, 0}, {1, 1, 1.5});
    sample.nodes = R"([{"mesh": 0, "weights": [2.0]}])";
    expect_cube(read(sample), {0, 0, 0}, {1, 1, 3});
}

TEST(GltfFile, SkinnedMeshesIgnoreTheirOwnNode) {
    GltfSample sample;
    std::string joints;
    std::string weights;
    for (int i = 0; i < 8; ++i) {
        for (const int joint : {0, 1, 0, 0}) append(joints, static_cast<std::uint8_t>(joint));
        for (const int weight : {64, 191, 0, 0}) append(weights, static_cast<std::uint8_t>(weight));
    }
    sample.add(joints, 5121, 8, "VEC4");
    sample.add(weights, 5121, 8, "VEC4", R"(, "normalized": true)");
    sample.attributes += R"(, "JOINTS_0": 2, "WEIGHTS_0": 3)";
    sample.more = R"(, "skins": [{"joints": [1, 2]}])";
    sample.nodes = R"([{"mesh": 0, "skin": 0, "translation": [100, 0, 0], "scale": [9, 9, 9]},
        {"translation": [0, 0, 255]}, {"children": [], "translation": [0, 255, 0]}])";
    expect_cube(read(sample), {0, 191, 64}, {1, 192, 65}, 1e-9);
    sample.more = R"(, "skins": [{"joints": [1]}])";
    expect_bad(sample, {"joint that does not exist"});
}

TEST(GltfFile, QuantizedAndSparsePositions) {
    GltfSample sample;
    std::string shorts;
    for (const glm::vec3& corner : cube_corners) {
        for (int i = 0; i < 3; ++i) append(shorts, static_cast<std::int16_t>(corner[i] * 32767.0F));
        append(shorts, std::int16_t{0});
    }
    sample.add(shorts, 5122, 8, "VEC3", R"(, "normalized": true)");
    sample.views.insert(sample.views.size() - 1, R"(, "byteStride": 8)");
    sample.attributes = R"("POSITION": 2)";
    sample.nodes = R"([{"mesh": 0, "scale": [2, 2, 2]}])";
    sample.more = R"(, "extensionsRequired": ["KHR_mesh_quantization"])";
    expect_cube(read(sample), {0, 0, 0}, {2, 2, 2});

    GltfSample sparse;
    sparse.add(std::string("\x04\x05\x06\x07", 4), 5121, 4, "SCALAR");
    std::string moved;
    for (std::size_t i = 4; i < 8; ++i) {
        append(moved, 7.0F);
        append(moved, cube_corners[i].y);
        append(moved, cube_corners[i].z);
    }
    sparse.add(moved, 5126, 4, "VEC3");
    sparse.accessors +=
        R"(, {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "sparse": {"count": 4,
        "indices": {"bufferView": 2, "componentType": 5121}, "values": {"bufferView": 3}}})";
    sparse.attributes = R"("POSITION": 4)";
    expect_cube(read(sparse), {0, 0, 0}, {7, 1, 1});
}

TEST(GltfFile, InstancesAreAllRead) {
    GltfSample sample;
    std::string translations;
    for (const float t : {0.0F, 0.0F, 0.0F, 10.0F, 0.0F, 0.0F}) append(translations, t);
    sample.add(translations, 5126, 2, "VEC3");
    const std::string instancing =
        R"("extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 2}}})";
    sample.nodes = R"([{"mesh": 0, "scale": [1, 1, -1], )" + instancing + "}]";
    const TriangleMesh mesh = read(sample);
    EXPECT_EQ(mesh.vertices().size(), 16U);
    EXPECT_NEAR(signed_volume(mesh), 2.0, 1e-12);
}

TEST(GltfFile, StripsAndFans) {
    GltfSample sample;
    std::string corners;
    for (const int i : {0, 1, 2, 3}) append(corners, static_cast<std::uint8_t>(i));
    sample.add(corners, 5121, 4, "SCALAR");
    const auto area_vector = [&](int mode) {
        std::string text = sample.text();
        const std::string from = R"("indices": 1)";
        text.replace(text.find(from), from.size(), R"("indices": 2, "mode": )" + std::to_string(mode));
        const ScratchFolder folder;
        const TriangleMesh mesh = read_mesh(folder.write("strip.gltf", text)).mesh;
        EXPECT_EQ(mesh.triangles().size(), 2U);
        glm::dvec3 sum(0.0);
        for (const glm::uvec3& t : mesh.triangles()) {
            sum += glm::cross(mesh.vertices()[t.y] - mesh.vertices()[t.x],
                              mesh.vertices()[t.z] - mesh.vertices()[t.x]);
        }
        return sum;
    };
    EXPECT_NEAR(glm::length(area_vector(5)), 2.0, 1e-12) << "both triangles of a strip face one way";
    EXPECT_NEAR(glm::length(area_vector(6)), 1.0 - 1.0, 1e-12)
        << "0 1 2, 0 2 3 are wound against each other here";
}

TEST(GltfFile, GroupsAreNodesWithWhatIsBelowThemOrMeshes) {
    GltfSample sample;
    sample.nodes = R"([{"name": "left ear", "children": [1]}, {"mesh": 0, "translation": [4, 0, 0]},
        {"name": "right", "mesh": 0, "translation": [8, 0, 0]}])";
    EXPECT_EQ(read(sample).vertices().size(), 24U - 8U);
    expect_cube(read(sample, "left ear"), {4, 0, 0}, {5, 1, 1});
    expect_cube(read(sample, "right"), {8, 0, 0}, {9, 1, 1});
    EXPECT_EQ(read(sample, "cube").vertices().size(), 16U);
    expect_refused<FileError>([&] { read(sample, "left"); },
                              {"no group \"left\"", "\"left ear\"", "\"cube\""});
}

TEST(GltfFile, OnlyTheDefaultSceneIsReadAndThatIsTold) {
    const ScratchFolder folder;
    GltfSample sample;
    sample.nodes = R"([{"mesh": 0}, {"mesh": 0, "translation": [3, 0, 0]}])";
    sample.more = R"(, "scenes": [{"nodes": [0]}, {"nodes": [1]}], "scene": 1)";
    const MeshFile file = read_mesh(folder.write("cube.gltf", sample.text()));
    expect_cube(file.mesh, {3, 0, 0}, {4, 1, 1});
    ASSERT_EQ(file.notes.size(), 1U);
    EXPECT_NE(file.notes[0].find("1 nodes with a mesh"), std::string::npos);
}

TEST(GltfFile, DeepTreesAreReadAndWhatIsNoTreeIsRefused) {
    GltfSample sample;
    sample.nodes = "[";
    for (int i = 0; i < 30000; ++i) sample.nodes += R"({"children": [)" + std::to_string(i + 1) + "]}, ";
    sample.nodes += R"({"mesh": 0}])";
    expect_cube(read(sample), {0, 0, 0}, {1, 1, 1});
    sample.nodes = "[";
    for (int i = 0; i < 30; ++i) {
        sample.nodes += R"({"children": [)" + std::to_string(i + 1) + ", " + std::to_string(i + 1) + "]}, ";
    }
    sample.nodes += R"({"mesh": 0}])";
    expect_bad(sample, {"nodes[1]", "twice"});
    sample.nodes = R"([{"children": [1], "mesh": 0}, {"children": [0]}])";
    expect_bad(sample, {"own ancestors"});
    sample.nodes = R"([{"children": [7], "mesh": 0}])";
    expect_bad(sample, {"nodes[0]", "does not exist"});
}

TEST(GltfFile, RefusesWhatItCannotReadByName) {
    GltfSample sample;
    sample.more = R"(, "extensionsRequired": ["KHR_materials_unlit", "VND_other_geometry"])";
    expect_bad(sample, {"VND_other_geometry"});
    sample.more = R"(, "extensionsRequired": ["KHR_materials_unlit", "KHR_texture_transform"])";
    expect_cube(read(sample), {0, 0, 0}, {1, 1, 1});
    GltfSample bad;
    bad.bytes[8 * 12] = '\x08';  // the first index
    expect_bad(bad, {"meshes[0].primitives[0]", "does not exist"});
    GltfSample compressed;
    compressed.primitive = R"(, "extensions": {"KHR_draco_mesh_compression": {"bufferView": 0}})";
    expect_cube(read(compressed), {0, 0, 0}, {1, 1, 1});
    compressed.attributes = R"("POSITION": 2)";
    compressed.accessors += R"(, {"componentType": 5126, "count": 8, "type": "VEC3"})";
    expect_bad(compressed, {"KHR_draco_mesh_compression"});
    GltfSample huge;
    huge.attributes = R"("POSITION": 2)";
    huge.accessors += R"(, {"componentType": 5126, "count": 4000000000, "type": "VEC3"})";
    expect_bad(huge, {"accessors[2]", "no data"});
    GltfSample beyond;
    beyond.accessors.replace(beyond.accessors.find("\"count\": 8"), 10, "\"count\": 9");
    expect_bad(beyond, {"accessors[0]", "beyond its buffer view"});
}

TEST(GltfFile, RepeatedMeshesAreBounded) {
    GltfSample sample;
    std::string translations(std::size_t{3} * 4 * 1'000'000, '\0');
    sample.add(translations, 5126, 1'000'000, "VEC3");
    sample.nodes =
        R"([{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 2}}}}])";
    expect_bad(sample, {"repeats its meshes"});
}

}  // namespace
}  // namespace skinglow::test
