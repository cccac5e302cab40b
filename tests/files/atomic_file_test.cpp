#include "files/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <stdexcept>

#include "rig_files/file_error.h"
#include "scratch_folder.h"

namespace skinglow::test {
namespace {

namespace fs = std::filesystem;

TEST(AtomicFile, WritesTheWholeTextAndLeavesNothingElse) {
    const ScratchFolder folder;
    const std::string text = std::string(100000, 'x') + "\n";
    write_text_atomically(folder / "a.csv", text);
    EXPECT_EQ(read_bytes(folder / "a.csv"), text);
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.csv"});
}

TEST(AtomicFile, AFailingWriterLeavesTheOldFileAndNothingElse) {
    const ScratchFolder folder;
    const fs::path path = folder.write("lut.exr", "old");
    fs::path seen;
    const auto fail = [&](const fs::path& temporary) {
        seen = temporary;
        std::ofstream(temporary) << "half of the n";
        throw std::runtime_error("the writer broke");
    };
    EXPECT_THROW(write_atomically(path, fail), std::runtime_error);
    EXPECT_EQ(read_bytes(path), "old");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"lut.exr"});
    EXPECT_EQ(seen.parent_path(), folder.path()) << "a rename is whole only within one file system";
    EXPECT_EQ(seen.extension(), ".exr") << "writers choose the format by it";
}

TEST(AtomicFile, HasTheOrdinaryPermissionsOfANewFile) {
    const ScratchFolder folder;
    const mode_t before = ::umask(022);
    write_text_atomically(folder / "a.csv", "1\n");
    ::umask(before);
    const auto bits = fs::status(folder / "a.csv").permissions();
    EXPECT_EQ(bits, static_cast<fs::perms>(0644));
}

TEST(AtomicFile, FollowsALinkInsteadOfReplacingIt) {
    const ScratchFolder folder;
    fs::create_directory(folder / "real");
    fs::create_symlink(folder / "real/a.csv", folder / "link.csv");
    write_text_atomically(folder / "link.csv", "1\n");
    EXPECT_TRUE(fs::is_symlink(folder / "link.csv"));
    EXPECT_EQ(read_bytes(folder / "real/a.csv"), "1\n");
}

TEST(AtomicFile, RefusesFoldersDevicesAndWhatCannotBeWritten) {
    const ScratchFolder folder;
    const auto write = [](const fs::path& path) { return [path] { write_text_atomically(path, "1\n"); }; };
    expect_refused<FileError>(write(folder.path()), {folder.path(), "not a regular file"});
    expect_refused<FileError>(write("/dev/null"), {"file /dev/null", "not a regular file"});
    expect_refused<FileError>(write(folder / "missing/a.csv"),
                              {"missing/a.csv", "No such file", "choose a folder"});
    // Read-only for root as well, which the tests may run as.
    expect_refused<FileError>(write("/proc/a.csv"),
                              {"file /proc/a.csv", "cannot be written", "choose a folder"});
}

TEST(AtomicFile, RefusesAFullDisk) {
    // /dev/full is what a full disk is to a writer; the writer here is the one of write_text_atomically's
    // kind.
    const ScratchFolder folder;
    const auto write_to_full = [&](const fs::path&) {
        std::ofstream full("/dev/full");
        full << std::string(1 << 20, 'x') << std::flush;
        if (!full)
            refuse_file(folder / "a.csv", "cannot be written: No space left on device", "free some space");
    };
    expect_refused<FileError>([&] { write_atomically(folder / "a.csv", write_to_full); }, {"No space left"});
    EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace skinglow::test
