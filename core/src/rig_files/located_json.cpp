#include "rig_files/located_json.h"

#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

#include "rig_files/file_error.h"

namespace skinglow::detail {
namespace {

using nlohmann::json;
using Event = json::parse_event_t;

constexpr std::size_t max_json_bytes = std::size_t{64} << 20U;
constexpr std::size_t max_json_depth = 16;

/// Lines of all values by their names, noted while a parser reads them from the stream.
class LineIndex {
  public:
    LineIndex(const std::filesystem::path& path, std::istringstream& stream) : path_(path), stream_(stream) {}

    std::unordered_map<std::string, std::size_t> take_lines() { return std::move(lines_); }

    /// Bytes that the parser has taken; after a number one more than belongs to it.
    std::size_t consumed() const {
        return static_cast<std::size_t>(stream_.rdbuf()->pubseekoff(0, std::ios::cur, std::ios::in));
    }

    void note(Event event, const json& parsed) {
        if (event == Event::object_end || event == Event::array_end) {
            levels_.pop_back();
        } else if (event == Event::key) {
            note_key(parsed.get_ref<const std::string&>());
        } else {
            std::string name = take_name();
            lines_.emplace(name, line());  // a key's own line stays
            if (event == Event::value) return;
            if (levels_.size() >= max_json_depth) {
                refuse_file(path_, "is nested deeper than " + std::to_string(max_json_depth),
                            "give a light rig", "line " + std::to_string(line()));
            }
            levels_.push_back({std::move(name), event == Event::array_start});
        }
    }

  private:
    struct Level {
        std::string name;
        bool is_array;
        std::size_t entries = 0;
    };

    void note_key(const std::string& key) {
        const Level& level = levels_.back();
        next_ = level.name.empty() ? key : level.name + "." + key;
        if (!lines_.emplace(next_, line()).second) {
            refuse_file(path_, "is there twice", "remove one",
                        "key " + next_ + " (line " + std::to_string(line()) + ")");
        }
    }

    /// Name of the value that comes: the last key, or the next index of an array.
    std::string take_name() {
        if (levels_.empty()) return "";
        Level& level = levels_.back();
        if (!level.is_array) return next_;
        return level.name + "[" + std::to_string(level.entries++) + "]";
    }

    /// Line of the last character but for the one that a number looks ahead. Counts on from the last call.
    std::size_t line() {
        const std::size_t end = std::max<std::size_t>(consumed(), 1) - 1;
        if (end > counted_) {
            const std::string_view added = stream_.view().substr(counted_, end - counted_);
            line_ += static_cast<std::size_t>(std::count(added.begin(), added.end(), '\n'));
            counted_ = end;
        }
        return line_;
    }

    const std::filesystem::path& path_;
    std::istringstream& stream_;
    std::size_t counted_ = 0;
    std::size_t line_ = 1;
    std::unordered_map<std::string, std::size_t> lines_;
    std::vector<Level> levels_;
    std::string next_;
};

/// @param position  of the character at fault, from 1; beyond the end at most one
[[noreturn]] void refuse_syntax(const std::filesystem::path& path, std::string_view text,
                                std::size_t position, std::string reason) {
    // The library's text begins with its error number and the line; what matters comes after.
    reason.erase(0, reason.find("] ") + 2);
    if (reason.starts_with("parse error at")) reason.erase(0, reason.find(": ") + 2);
    const std::string_view before = text.substr(0, std::max<std::size_t>(position, 1) - 1);
    const auto lines = std::count(before.begin(), before.end(), '\n');
    const std::size_t column = before.size() - (before.rfind('\n') + 1) + 1;  // npos + 1 is 0
    refuse_file(path, "is not JSON (" + reason + ")", "correct it there or just before",
                "line " + std::to_string(lines + 1) + ", column " + std::to_string(column));
}

}  // namespace

LocatedJson::LocatedJson(const std::filesystem::path& path) : path_(path) {
    std::istringstream stream(read_whole_file(path, max_json_bytes));
    LineIndex index(path_, stream);
    try {
        value_ = json::parse(stream, [&](int /*depth*/, Event event, const json& parsed) {
            index.note(event, parsed);
            return true;
        });
    } catch (const json::parse_error& error) {
        refuse_syntax(path_, stream.view(), error.byte, error.what());
    } catch (const json::out_of_range& error) {
        // A number's end shows in the character after it, if there is one.
        refuse_syntax(path_, stream.view(), index.consumed() - (stream.eof() ? 0 : 1), error.what());
    }
    lines_ = index.take_lines();
}

void LocatedJson::refuse(const std::string& name, std::string_view what, std::string_view remedy) const {
    const auto found = lines_.find(name);
    const std::string line = found == lines_.end() ? "" : "line " + std::to_string(found->second);
    std::string where = name.empty() ? line : "key " + name;
    if (!name.empty() && !line.empty()) where += " (" + line + ")";
    refuse_file(path_, what, remedy, where);
}

}  // namespace skinglow::detail
