#include "files/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <stdexcept>
#include <thread>

#include "rig_files/file_error.h"
#include "scratch_folder.h"

namespace {
std::atomic<int> umask_calls = 0;
}

/// Takes the C library's place in this program, to see who calls it.
extern "C" mode_t umask(mode_t mask) {
    ++umask_calls;
    return static_cast<mode_t>(::syscall(SYS_umask, mask));
}

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
    for (const auto& [mask, wanted] : {std::pair{022U, 0644U}, {077U, 0600U}, {0U, 0666U}}) {
        const mode_t before = ::umask(mask);
        write_text_atomically(folder / "a.csv", "1\n");
        ::umask(before);
        EXPECT_EQ(fs::status(folder / "a.csv").permissions(), static_cast<fs::perms>(wanted));
    }
}

TEST(AtomicFile, ManyThreadsWriteAtOnceAndNoneTouchesTheUmask) {
    // The mask belongs to the whole process: even a moment's change of it shows in another thread's new file.
    const ScratchFolder folder;
    const int calls_before = umask_calls;
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i) {
        threads.emplace_back([&folder, i] {
            for (int k = 0; k < 20; ++k) {
                write_text_atomically(folder / "same.csv", std::string(1000, static_cast<char>('a' + i)));
                write_text_atomically(folder / (std::to_string(i) + ".csv"), "1\n");
            }
        });
    }
    threads.clear();
    EXPECT_EQ(umask_calls, calls_before);
    const std::string text = read_bytes(folder / "same.csv");
    EXPECT_EQ(text, std::string(1000, text.at(0)));
    EXPECT_EQ(folder.names().size(), 5U);
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
