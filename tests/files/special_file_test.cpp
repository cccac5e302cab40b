// What is no file - a pipe without a writer, an endless device, a folder, a socket - is refused by every reader at once.

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <functional>
#include <map>
#include <stdexcept>

#include "files/image_compare.h"
#include "files/image_file.h"
#include "files/lut_file.h"
#include "files/mesh_file.h"
#include "mesh_samples.h"
#include "rig_files/file_error.h"
#include "rig_files/light_rig.h"
#include "rig_files/studio_light.h"
#include "scratch_folder.h"

namespace skinglow::test {
namespace {

namespace fs = std::filesystem;
using Maker = std::function<void(const fs::path&)>;
using Reader = std::function<void(const fs::path&)>;

/// Ends the test program where a reader waits: nothing could be done about that within it.
class TimeLimit {
  public:
    TimeLimit() { ::alarm(60); }
    TimeLimit(const TimeLimit&) = delete;
    TimeLimit& operator=(const TimeLimit&) = delete;
    ~TimeLimit() { ::alarm(0); }
};

void make_pipe(const fs::path& path) {
    if (::mkfifo(path.c_str(), 0600) != 0) throw std::runtime_error("no pipe");
}

void make_socket(const fs::path& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.string().copy(address.sun_path, sizeof(address.sun_path) - 1);
    const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
    if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0)
        throw std::runtime_error("no socket");
    ::close(socket);  // its name stays
}

const std::map<std::string, Maker> special_files = {
    {"a pipe", make_pipe},
    {"a link to a pipe",
     [](const fs::path& path) {
         make_pipe(path.string() + ".pipe");
         fs::create_symlink(path.string() + ".pipe", path);
     }},
    {"an endless device", [](const fs::path& path) { fs::create_symlink("/dev/zero", path); }},
    {"an empty device", [](const fs::path& path) { fs::create_symlink("/dev/null", path); }},
    {"a folder", [](const fs::path& path) { fs::create_directory(path); }},
    {"a link to itself", [](const fs::path& path) { fs::create_symlink(path, path); }},
    {"a socket", make_socket}};

void expect_all_refused(const std::string& name, const Reader& read) {
    const TimeLimit limit;
    for (const auto& [kind, make] : special_files) {
        std::string what = name;
        SCOPED_TRACE(what.append(" as ").append(kind));
        const ScratchFolder folder;
        make(folder / name);
        expect_refused<FileError>([&] { read(folder / name); }, {"file ", name});
    }
}

TEST(SpecialFile, IsNoRigAndNoStudioLight) {
    expect_all_refused("rig.json", [](const fs::path& path) { read_light_rig(path); });
    expect_all_refused("studio.sl", [](const fs::path& path) { read_studio_light(path); });
}

TEST(SpecialFile, IsNoTable) {
    for (const char* name : {"table.csv", "table.exr", "table.png"}) {
        expect_all_refused(name, [](const fs::path& path) { read_lut(path); });
        expect_all_refused(name, [](const fs::path& path) { read_base_lut(path); });
    }
}

TEST(SpecialFile, IsNoMesh) {
    for (const char* name : {"mesh.obj", "mesh.ply", "mesh.stl", "mesh.glb", "mesh.gltf"})
        expect_all_refused(name, [](const fs::path& path) { read_mesh(path); });
}

TEST(SpecialFile, IsNoBufferOfAMesh) {
    expect_all_refused("buffer.bin", [](const fs::path& path) {
        GltfSample sample;
        sample.uri = "buffer.bin";
        const fs::path mesh = path.parent_path() / "mesh.gltf";
        std::ofstream(mesh, std::ios::binary) << sample.text();
        read_mesh(mesh);
    });
}

TEST(SpecialFile, IsNoPicture) {
    for (const char* name : {"picture.exr", "picture.png", "picture.jpg", "picture.tif", "picture.hdr"}) {
        expect_all_refused(name, [](const fs::path& path) { read_image(path); });
        expect_all_refused(name, [](const fs::path& path) { compare_images(path, path, {}); });
        expect_all_refused(name, [](const fs::path& path) { read_raw_channels(path, {"R"}); });
    }
}

}  // namespace
}  // namespace skinglow::test
