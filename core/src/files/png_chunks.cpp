#include "files/png_chunks.h"

#include <algorithm>
#include <system_error>

#include "files/number_bytes.h"
#include "rig_files/file_error.h"

namespace skinglow::detail {
namespace {

constexpr std::size_t word = 4;  // bytes of a length, a name and a checksum

}  // namespace

PngChunks::PngChunks(const std::filesystem::path& path) : file_(path, std::ios::binary) {
    const std::string signature = "\x89PNG\r\n\x1a\n";
    std::string start(signature.size(), '\0');
    std::error_code error;
    end_ = std::filesystem::file_size(path, error);
    if (error || !file_.read(start.data(), static_cast<std::streamsize>(start.size()))) return;
    is_png_ = start == signature;
    next_ = is_png_ ? signature.size() : end_;
}

std::optional<std::string> PngChunks::next() {
    std::string head(2 * word, '\0');
    if (!is_png_ || end_ - next_ < head.size() + word) return std::nullopt;
    file_.seekg(static_cast<std::streamoff>(next_));
    if (!file_.read(head.data(), static_cast<std::streamsize>(head.size()))) return std::nullopt;
    length_ = raw_number<std::uint32_t, true>(head.data());
    data_ = next_ + head.size();
    if (end_ - data_ < std::uintmax_t{length_} + word) return std::nullopt;
    next_ = data_ + length_ + word;
    return head.substr(word);
}

std::string PngChunks::data(std::size_t most) {
    std::string data(std::min<std::size_t>(length_, most), '\0');
    file_.seekg(static_cast<std::streamoff>(data_));
    file_.read(data.data(), static_cast<std::streamsize>(data.size()));
    return data;
}

void check_png_is_whole(const std::filesystem::path& path) {
    PngChunks chunks(path);
    if (!chunks.is_png()) return;
    std::string last = "its start";
    while (const auto name = chunks.next()) {
        if (*name == "IEND") return;
        last = "chunk " + *name;
    }
    refuse_file(path, "ends before a PNG does",
                "the file is damaged or was not written to its end; make it anew", "after " + last);
}

}  // namespace skinglow::detail
