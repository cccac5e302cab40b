#include "files/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
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
    write_atomically(folder / "a.csv", text);
    EXPECT_EQ(read_bytes(folder / "a.csv"), text);
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.csv"});
}

TEST(AtomicFile, AFullDiskLeavesTheOldFileAndNothingElse) {
    // What a limit of the process refuses stands for what a full disk does.
    const ScratchFolder folder;
    const fs::path path = folder.write("lut.exr", "old");
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    const rlimit small{1000, before.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    const std::string text(100000, 'x');
    expect_refused<FileError>([&] { write_atomically(path, text); },
                              {"lut.exr", "cannot be written", "disk"});
    expect_refused<FileError>([&] { replace_folder(folder / "scene", {{"a.inc", text}}, {}); }, {"scene"});
    ::setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(read_bytes(path), "old");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"lut.exr"});
}

TEST(AtomicFile, HasTheOrdinaryPermissionsOfANewFile) {
    const ScratchFolder folder;
    for (const auto& [mask, wanted] : {std::pair{022U, 0644U}, {077U, 0600U}, {0U, 0666U}}) {
        const mode_t before = ::umask(mask);
        write_atomically(folder / "a.csv", "1\n");
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
                write_atomically(folder / "same.csv", std::string(1000, static_cast<char>('a' + i)));
                write_atomically(folder / (std::to_string(i) + ".csv"), "1\n");
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
    write_atomically(folder / "link.csv", "1\n");
    EXPECT_TRUE(fs::is_symlink(folder / "link.csv"));
    EXPECT_EQ(read_bytes(folder / "real/a.csv"), "1\n");
}

TEST(AtomicFile, RefusesFoldersDevicesAndWhatCannotBeWritten) {
    const ScratchFolder folder;
    const auto write = [](const fs::path& path) { return [path] { write_atomically(path, "1\n"); }; };
    expect_refused<FileError>(write(folder.path()), {folder.path(), "not a regular file"});
    expect_refused<FileError>(write("/dev/null"), {"file /dev/null", "not a regular file"});
    expect_refused<FileError>(write(folder / "missing/a.csv"),
                              {"missing/a.csv", "No such file", "choose a folder"});
    // Read-only for root as well, which the tests may run as.
    expect_refused<FileError>(write("/proc/a.csv"),
                              {"file /proc/a.csv", "cannot be written", "choose a folder"});
}

/// A child process that does `work` again and again. It ends with this one, and by any signal: in the background a
/// shell has Ctrl-C ignored, and would have the child write for ever.
template <class Work>
pid_t start_endless(const Work& work) {
    const pid_t child = ::fork();
    if (child != 0) return child;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
    for (;;) work();
}

/// Whether a child process that does `work` again and again leaves nothing but whole files when it is ended
/// by a signal.
template <class Work>
void expect_nothing_left(const fs::path& folder, int signal, const Work& work) {
    const pid_t child = start_endless(work);
    while (fs::is_empty(folder)) ::usleep(100);
    ::usleep(static_cast<useconds_t>(2000 + 1000 * signal));
    ::kill(child, signal);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(WTERMSIG(status), signal) << "the signal still ends it";
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
    }
}

TEST(AtomicFile, InterruptedWritesLeaveNothing) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const ScratchFolder folder;
        const std::string text(1000000, 'x');
        expect_nothing_left(folder.path(), signal, [&] { write_atomically(folder / "a.csv", text); });
        EXPECT_EQ(read_bytes(folder / "a.csv"), text);
    }
}

TEST(Folder, IsReplacedAsAWholeAndKeepsWhatIsNotItsOwn) {
    const ScratchFolder folder;
    const fs::path scene = folder / "scene";
    replace_folder(scene, {{"a.inc", "1"}, {"b.inc", "1"}}, {});
    std::ofstream(scene / "picture.png") << "mine";
    fs::create_directory(scene / "renders");
    replace_folder(scene, {{"a.inc", "2"}}, {"a.inc", "b.inc"});
    EXPECT_EQ(read_bytes(scene / "a.inc"), "2");
    EXPECT_FALSE(fs::exists(scene / "b.inc"));
    EXPECT_EQ(read_bytes(scene / "picture.png"), "mine");
    EXPECT_TRUE(fs::is_directory(scene / "renders"));
    EXPECT_EQ(folder.names(), std::vector<std::string>{"scene"});
    const auto file = folder.write("file", "");
    expect_refused<FileError>([&] { replace_folder(file, {{"a.inc", "1"}}, {}); }, {"it is a file"});
}

/// Readers by the folder's name never see files of two writings, and interruption leaves nothing.
TEST(Folder, TwoWritersNeverMix) {
    const ScratchFolder folder;
    const fs::path scene = folder / "scene";
    const auto write = [&](const std::string& who) {
        replace_folder(scene, {{"a.inc", who}, {"b.inc", who}, {"c.inc", who}}, {"a.inc", "b.inc", "c.inc"});
    };
    write("0");
    std::vector<pid_t> children;
    for (const char* who : {"1", "2"}) children.push_back(start_endless([&write, who] { write(who); }));
    for (int i = 0; i < 300; ++i) {
        const int descriptor =
            ::open(scene.c_str(), O_RDONLY | O_DIRECTORY);  // one writing's, whatever comes after
        ASSERT_GE(descriptor, 0);
        std::string seen;
        for (const char* name : {"a.inc", "b.inc", "c.inc"}) {
            char letter = '-';  // gone with the folder, once that was replaced
            const int file = ::openat(descriptor, name, O_RDONLY);
            if (file >= 0 && ::read(file, &letter, 1) == 1 && letter != '-') seen += letter;
            if (file >= 0) ::close(file);
        }
        ::close(descriptor);
        EXPECT_EQ(std::string(seen.size(), seen.empty() ? '-' : seen[0]), seen);
    }
    for (const pid_t child : children) ::kill(child, SIGTERM);
    for (const pid_t child : children) ::waitpid(child, nullptr, 0);
    EXPECT_EQ(folder.names(), std::vector<std::string>{"scene"});
    EXPECT_EQ(read_bytes(scene / "a.inc"), read_bytes(scene / "c.inc"));
}

TEST(OutputGuard, AnOutputIsNoInputByAnyName) {
    const ScratchFolder folder;
    const fs::path input = folder.write("head.ply", "ply");
    fs::create_symlink(input, folder / "link.ply");
    fs::create_hard_link(input, folder / "hard.ply");
    fs::create_symlink(folder / "new.png", folder / "to_new.png");
    const auto guard = [](std::vector<fs::path> outputs, std::vector<fs::path> inputs) {
        return [=] { refuse_overwriting(outputs, inputs); };
    };
    for (const char* name : {"head.ply", "link.ply", "hard.ply", "./x/../head.ply"}) {
        fs::create_directories(folder / "x");
        expect_refused<FileError>(guard({folder / name}, {input}), {"is read as", "head.ply"});
    }
    expect_refused<FileError>(guard({folder / "new.png", folder / "to_new.png"}, {}), {"written twice"});
    refuse_overwriting({folder / "new.png", ""}, {input, ""});
}

}  // namespace
}  // namespace skinglow::test
