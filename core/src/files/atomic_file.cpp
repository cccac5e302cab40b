#include "files/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <random>
#include <string>
#include <system_error>

#include "rig_files/file_error.h"

namespace skinglow {
namespace {

namespace fs = std::filesystem;

constexpr const char* folder_remedy = "choose a folder that exists and that you may write to";

[[noreturn]] void refuse_write(const fs::path& path, int error_number, std::string_view remedy) {
    refuse_file(path, "cannot be written: " + system_error_text(error_number), remedy);
}

fs::path folder_of(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// A file that is removed when its owner goes, unless it was renamed away before.
class TemporaryFile {
  public:
    explicit TemporaryFile(const fs::path& target) {
        std::random_device random;
        int descriptor = -1;
        while (descriptor < 0) {
            path_ =
                folder_of(target) / (".skinglow-" + std::to_string(random()) + target.extension().string());
            // With the permissions of an ordinary new file, which mkstemp does not give: the kernel applies
            // the umask, and nobody has to ask for it by changing it.
            descriptor = ::open(path_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
            if (descriptor < 0 && errno != EEXIST) refuse_write(target, errno, folder_remedy);
        }
        ::close(descriptor);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        std::error_code ignored;
        fs::remove(path_, ignored);  // after a rename there is nothing left to remove
    }
    const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

void flush_to_disk(const fs::path& path, const fs::path& target, int flags) {
    const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
    if (descriptor < 0) refuse_write(target, errno, folder_remedy);
    const int failed = ::fsync(descriptor);
    const int error_number = errno;
    ::close(descriptor);
    // EINVAL: the file system does not flush (some network and FUSE mounts); the rename is whole all the
    // same.
    if (failed != 0 && error_number != EINVAL)
        refuse_write(target, error_number, "check the disk and its free space");
}

/// Where the links lead, also where nothing is yet: fs::canonical wants a file at the end.
fs::path follow_links(fs::path path) {
    constexpr int max_links = 40;  // as many as Linux follows
    std::error_code ignored;
    for (int i = 0; i < max_links && fs::is_symlink(path, ignored); ++i) {
        path = path.parent_path() / fs::read_symlink(path, ignored);  // an absolute link replaces the folder
    }
    return path;
}

}  // namespace

void write_atomically(const fs::path& path, const std::function<void(const fs::path&)>& write) {
    std::error_code ignored;
    const fs::path target = follow_links(path);
    if (fs::exists(target, ignored) && !fs::is_regular_file(target, ignored)) {
        refuse_file(path, "cannot be written: it is not a regular file", "give the name of a file");
    }
    const TemporaryFile temporary(target);
    write(temporary.path());
    flush_to_disk(temporary.path(), path, O_RDONLY);
    if (::rename(temporary.path().c_str(), target.c_str()) != 0) refuse_write(path, errno, folder_remedy);
    flush_to_disk(folder_of(target), path, O_RDONLY | O_DIRECTORY);
}

void write_text_atomically(const fs::path& path, std::string_view text) {
    write_atomically(path, [&](const fs::path& temporary) {
        std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
        stream.write(text.data(), static_cast<std::streamsize>(text.size()));
        stream.close();
        if (!stream) refuse_write(path, errno, "check the disk and its free space");
    });
}

}  // namespace skinglow
