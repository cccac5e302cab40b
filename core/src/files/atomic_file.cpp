#include "files/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>

#include "files/deferred_signals.h"
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

class Descriptor {
  public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    int number() const { return number_; }

  private:
    int number_;
};

/// Takes a file or folder away at its end, unless that was renamed.
class Cleanup {
  public:
    explicit Cleanup(fs::path path) : path_(std::move(path)) {}
    Cleanup(const Cleanup&) = delete;
    Cleanup& operator=(const Cleanup&) = delete;
    ~Cleanup() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }

  private:
    fs::path path_;
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
    const Descriptor descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (descriptor.number() < 0) refuse_write(path, errno, folder_remedy);
    flush(descriptor.number(), path);
}

void write_named(const fs::path& name, std::string_view bytes, const fs::path& path) {
    const Descriptor file(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, ordinary_file));
    if (file.number() < 0) refuse_write(path, errno, folder_remedy);
    write_all(file.number(), bytes, path);
    flush(file.number(), path);
}

/// Into a file without a name, which nothing is left of whatever happens, and then gives it one. False where
/// the file system has no such files.
bool write_unnamed(const fs::path& name, std::string_view bytes, const fs::path& path) {
    const Descriptor file(::open(folder_of(name).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, ordinary_file));
    if (file.number() < 0) return false;
    write_all(file.number(), bytes, path);
    flush(file.number(), path);
    const std::string link = "/proc/self/fd/" + std::to_string(file.number());
    return ::linkat(AT_FDCWD, link.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

bool swap_names(const fs::path& a, const fs::path& b, unsigned flags) {
    return ::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), flags) == 0;
}

/// Moves what the old folder has beside the files of the new one over into it.
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
    const Cleanup cleanup(name);
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
    const Cleanup cleanup(fresh);
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
        if (errno == EEXIST && swap_names(fresh, target, RENAME_EXCHANGE)) {
            keep_others(fresh, target, obsolete);
            break;
        }
        if ((errno != EEXIST && errno != ENOENT) || i + 1 == max_tries)
            refuse_write(path, errno, folder_remedy);
    }
    flush_folder(target.parent_path(), path);
}

}  // namespace skinglow::detail
