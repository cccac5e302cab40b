#include "files/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <mutex>
#include <string>
#include <system_error>

#include "rig_files/file_error.h"

namespace skinglow::detail {
namespace {

namespace fs = std::filesystem;

constexpr const char* folder_remedy = "choose a folder that exists and that you may write to";
constexpr mode_t ordinary_file = 0666;  // less what the umask takes
constexpr mode_t ordinary_folder = 0777;

[[noreturn]] void refuse_write(const fs::path& path, int error_number, std::string_view remedy) {
    refuse_file(path, "cannot be written: " + system_error_text(error_number), remedy);
}

fs::path folder_of(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// A name beside the target that no other process and no other call uses.
fs::path temporary_name(const fs::path& target) {
    static std::atomic<unsigned> calls = 0;
    return folder_of(target) / (".skinglow-" + std::to_string(::getpid()) + "-" + std::to_string(++calls));
}

/// Does something where the scope ends.
template <typename Action>
struct AtEnd {
    Action action;
    ~AtEnd() { action(); }
};
template <typename Action>
AtEnd(Action) -> AtEnd<Action>;

constexpr std::array signals = {SIGINT, SIGTERM, SIGHUP};

// Handlers belong to the process. NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables)
std::mutex signal_mutex;
int deferring = 0;
std::array<struct sigaction, signals.size()> handlers_before{};

// A handler may touch nothing else; signals come on any thread, so that blocking them on one does not do.
volatile std::sig_atomic_t signal_waiting = 0;
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

extern "C" void note_signal(int number) {
    signal_waiting = number;
}

/// While it lives, requests to end (SIGINT, SIGTERM, SIGHUP) wait; then they take effect. May live on many threads at
/// once.
class DeferredSignals {
  public:
    DeferredSignals() {
        const std::lock_guard lock(signal_mutex);
        if (deferring++ > 0) return;
        signal_waiting = 0;
        for (std::size_t i = 0; i < signals.size(); ++i) {
            ::sigaction(signals[i], nullptr, &handlers_before[i]);
            if (handlers_before[i].sa_handler == SIG_IGN) continue;  // as under nohup
            struct sigaction action {};
            action.sa_handler = note_signal;
            action.sa_flags = SA_RESTART;
            ::sigaction(signals[i], &action, nullptr);
        }
    }
    ~DeferredSignals() {
        const std::lock_guard lock(signal_mutex);
        if (--deferring > 0) return;
        for (std::size_t i = 0; i < signals.size(); ++i)
            ::sigaction(signals[i], &handlers_before[i], nullptr);
        if (signal_waiting != 0) ::raise(signal_waiting);
    }
    DeferredSignals(const DeferredSignals&) = delete;
    DeferredSignals& operator=(const DeferredSignals&) = delete;
};

/// @param path  what messages name
void write_all(int descriptor, std::string_view bytes, const fs::path& path) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) refuse_write(path, errno, "check the disk and its free space");
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

void flush(int descriptor, const fs::path& path) {
    // EINVAL: the file system does not flush (some network and FUSE mounts); a rename is whole all the same.
    if (::fsync(descriptor) != 0 && errno != EINVAL)
        refuse_write(path, errno, "check the disk and its free space");
}

void flush_folder(const fs::path& folder, const fs::path& path) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) refuse_write(path, errno, folder_remedy);
    const AtEnd closing{[=] { ::close(descriptor); }};
    flush(descriptor, path);
}

void write_named(const fs::path& name, std::string_view bytes, const fs::path& path) {
    const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, ordinary_file);
    if (file < 0) refuse_write(path, errno, folder_remedy);
    const AtEnd closing{[=] { ::close(file); }};
    write_all(file, bytes, path);
    flush(file, path);
}

/// Into a file without a name, which nothing is left of whatever happens, and then gives it one. False where
/// the file system has no such files.
bool write_unnamed(const fs::path& name, std::string_view bytes, const fs::path& path) {
    const int file = ::open(folder_of(name).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, ordinary_file);
    if (file < 0) return false;
    const AtEnd closing{[=] { ::close(file); }};
    write_all(file, bytes, path);
    flush(file, path);
    const std::string link = "/proc/self/fd/" + std::to_string(file);
    return ::linkat(AT_FDCWD, link.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

bool swap_names(const fs::path& a, const fs::path& b, unsigned flags) {
    return ::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), flags) == 0;
}

/// Gives what the old folder has beside the files of the new one a second name there, so that whoever is killed now
/// loses none of it. Not folders, which have one name alone.
void link_others(const fs::path& old_folder, const fs::path& new_folder,
                 const std::set<std::string>& obsolete) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(old_folder, error)) {
        const fs::path name = entry.path().filename();
        if (!obsolete.contains(name.string())) fs::create_hard_link(entry.path(), new_folder / name, error);
    }
}

/// Moves what the old folder has beside the files of the new one over into it: folders, files where the file system has
/// no second names, and what came after link_others.
void keep_others(const fs::path& old_folder, const fs::path& new_folder,
                 const std::set<std::string>& obsolete) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(old_folder, error)) {
        const fs::path name = entry.path().filename();
        if (obsolete.contains(name.string())) continue;
        swap_names(entry.path(), new_folder / name,
                   RENAME_NOREPLACE);  // fails where the new one has it: right
    }
}

/// One name for a file that need not be there yet.
fs::path resolved(const fs::path& path) {
    std::error_code ignored;
    return fs::weakly_canonical(follow_links(path), ignored);
}

bool is_same(const fs::path& a, const fs::path& b) {
    std::error_code error;
    if (fs::equivalent(a, b, error)) return true;
    return resolved(a) == resolved(b);
}

}  // namespace

fs::path follow_links(fs::path path) {
    constexpr int max_links = 40;  // as many as Linux follows
    std::error_code ignored;
    for (int i = 0; i < max_links && fs::is_symlink(path, ignored); ++i) {
        path = path.parent_path() / fs::read_symlink(path, ignored);  // an absolute link replaces the folder
    }
    return path;
}

void write_atomically(const fs::path& path, std::string_view bytes) {
    std::error_code ignored;
    const fs::path target = follow_links(path);
    if (fs::exists(target, ignored) && !fs::is_regular_file(target, ignored)) {
        refuse_file(path, "cannot be written: it is not a regular file", "give the name of a file");
    }
    const DeferredSignals deferred;
    const fs::path name = temporary_name(target);
    const AtEnd cleanup{[&] { fs::remove_all(name, ignored); }};  // unless it was renamed
    if (!write_unnamed(name, bytes, path)) write_named(name, bytes, path);
    if (::rename(name.c_str(), target.c_str()) != 0) refuse_write(path, errno, folder_remedy);
    flush_folder(folder_of(target), path);
}

void replace_folder(const fs::path& path, const std::map<std::string, std::string>& files,
                    const std::set<std::string>& obsolete) {
    std::error_code ignored;
    // Without a slash at its end, which would make it its own parent.
    fs::path target =
        fs::absolute(follow_links(path.has_filename() ? path : path.parent_path())).lexically_normal();
    if (!target.has_filename()) target = target.parent_path();
    if (fs::exists(target, ignored) && !fs::is_directory(target, ignored)) {
        refuse_file(path, "cannot be made: it is a file", "give the name of a folder");
    }
    if (fs::equivalent(target, fs::current_path(), ignored)) {
        refuse_file(path, "is the folder you are in, and is replaced as a whole", "go to the one above it");
    }
    fs::create_directories(target.parent_path(), ignored);
    const DeferredSignals deferred;
    const fs::path fresh = temporary_name(target);
    const AtEnd cleanup{[&] { fs::remove_all(fresh, ignored); }};  // the old folder, or what was not finished
    if (::mkdir(fresh.c_str(), ordinary_folder) != 0) {
        refuse_file(path, "cannot be made: " + system_error_text(errno),
                    "choose a folder that you may write to");
    }
    for (const auto& [name, bytes] : files) write_named(fresh / name, bytes, path / name);
    flush_folder(fresh, path);
    if (const auto before = fs::status(target, ignored); fs::is_directory(before)) {
        fs::permissions(fresh, before.permissions(), ignored);
    }
    // Another writer may make the folder between the two, or take it away.
    constexpr int max_tries = 100;
    for (int i = 0; i < max_tries; ++i) {
        if (swap_names(fresh, target, RENAME_NOREPLACE)) break;
        if (errno == EEXIST) {
            link_others(target, fresh, obsolete);
            if (swap_names(fresh, target, RENAME_EXCHANGE)) {
                keep_others(fresh, target, obsolete);
                break;
            }
        }
        if ((errno != EEXIST && errno != ENOENT) || i + 1 == max_tries)
            refuse_write(path, errno, folder_remedy);
    }
    flush_folder(target.parent_path(), path);
}

void require_writable(const fs::path& output, std::string_view what,
                      const std::vector<std::string>& endings) {
    if (output.empty()) return;
    const std::string extension = small_extension(output);
    if (std::find(endings.begin(), endings.end(), extension) == endings.end()) {
        std::string allowed;
        for (const std::string& ending : endings) {
            if (!allowed.empty()) allowed += ending == endings.back() ? " or " : ", ";
            allowed += ending;
        }
        const std::string has = "has the extension " + extension + ", which cannot hold " + std::string(what);
        refuse_file(output, extension.empty() ? "has no extension" : has, "name it " + allowed);
    }
    std::error_code ignored;
    const fs::path target = follow_links(output);
    if (fs::exists(target, ignored) && !fs::is_regular_file(target, ignored)) {
        refuse_file(output, "cannot be written: it is not a regular file", "give the name of a file");
    }
    if (::access(folder_of(target).c_str(), W_OK | X_OK) != 0) refuse_write(output, errno, folder_remedy);
}

void refuse_overwriting(const std::vector<fs::path>& outputs, const std::vector<fs::path>& inputs) {
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        if (outputs[i].empty()) continue;
        for (const fs::path& input : inputs) {
            if (input.empty() || !is_same(outputs[i], input)) continue;
            refuse_file(outputs[i], "is to be written and is read as " + input.string(),
                        "give the output another name");
        }
        for (std::size_t k = 0; k < i; ++k) {
            if (outputs[k].empty() || !is_same(outputs[i], outputs[k])) continue;
            refuse_file(outputs[i], "is to be written twice", "give each output a name of its own");
        }
    }
}

}  // namespace skinglow::detail
