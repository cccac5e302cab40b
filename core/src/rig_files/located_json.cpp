#include "rig_files/located_json.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "rig_files/file_error.h"

namespace skinglow::detail {
namespace {

using nlohmann::json;

constexpr std::size_t max_json_bytes = std::size_t{64} << 20U;
constexpr std::size_t max_json_depth = 16;

/// Iterator that counts the bytes consumed, since nlohmann's SAX callbacks carry no position.
class WatchedIterator {
  public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    WatchedIterator(const char* place, std::size_t* consumed) : place_(place), consumed_(consumed) {}
    reference operator*() const { return *place_; }
    WatchedIterator& operator++() {
        ++place_;
        ++*consumed_;
        return *this;
    }
    WatchedIterator operator++(int) {
        WatchedIterator before = *this;
        ++*this;
        return before;
    }
    bool operator==(const WatchedIterator& other) const { return place_ == other.place_; }
    bool operator!=(const WatchedIterator& other) const { return place_ != other.place_; }

  private:
    const char* place_;
    std::size_t* consumed_;
};

/// Listens to the parser and notes the line of every value.
class LineListener : public nlohmann::json_sax<json> {
  public:
    LineListener(const std::filesystem::path& path, std::string_view text, const std::size_t& consumed)
        : path_(path), text_(text), consumed_(consumed) {}

    std::unordered_map<std::string, std::size_t> take_lines() { return std::move(lines_); }

    bool null() override { return note_value(); }
    bool boolean(bool) override { return note_value(); }
    bool number_integer(number_integer_t) override { return note_value(); }
    bool number_unsigned(number_unsigned_t) override { return note_value(); }
    bool number_float(number_float_t, const string_t&) override { return note_value(); }
    bool string(string_t&) override { return note_value(); }
    bool binary(binary_t&) override { return note_value(); }
    bool start_object(std::size_t) override { return open(false); }
    bool start_array(std::size_t) override { return open(true); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }

    bool key(string_t& name) override {
        const Level& level = levels_.back();
        next_ = level.name.empty() ? name : level.name + "." + name;
        if (!lines_.emplace(next_, line()).second) {
            refuse_file(path_, "is there twice", "remove one",
                        "key " + next_ + " (line " + std::to_string(line()) + ")");
        }
        return true;
    }

    bool parse_error(std::size_t position, const std::string&,
                     const nlohmann::detail::exception& error) override {
        // The library's text begins with its error number and place; what matters comes after.
        std::string reason = error.what();
        for (const std::string_view mark : {"] ", ": "}) {
            if (const std::size_t found = reason.find(mark); found != std::string::npos) {
                if (mark == ": " && !reason.starts_with("parse error at")) continue;
                reason.erase(0, found + mark.size());
            }
        }
        // Position counts from 1; the end of the file is one beyond the last character.
        const std::string_view before =
            text_.substr(0, std::min(position, text_.size() + 1) - (position > 0 ? 1 : 0));
        const auto lines = std::count(before.begin(), before.end(), '\n');
        const std::size_t line_start =
            before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
        refuse_file(path_, "is not JSON (" + reason + ")", "correct it there or just before",
                    "line " + std::to_string(lines + 1) + ", column " +
                        std::to_string(before.size() - line_start + 1));
    }

  private:
    struct Level {
        std::string name;
        bool is_array;
        std::size_t entries = 0;
    };

    /// Line of the character consumed last but for one that a number looks ahead. Advances with the text: one
    /// pass.
    std::size_t line() {
        const std::size_t end = consumed_ > 0 ? consumed_ - 1 : 0;
        if (end > counted_) {
            line_ +=
                static_cast<std::size_t>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(counted_),
                                                    text_.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
            counted_ = end;
        }
        return line_;
    }

    /// Name of the value that comes: the last key, or the next place in an array.
    std::string take_name() {
        if (levels_.empty()) return "";
        Level& level = levels_.back();
        if (!level.is_array) return next_;
        return level.name + "[" + std::to_string(level.entries++) + "]";
    }

    bool note_value() {
        lines_.emplace(take_name(), line());  // a key's own line stays
        return true;
    }

    bool open(bool is_array) {
        std::string name = take_name();
        lines_.emplace(name, line());
        if (levels_.size() >= max_json_depth) {
            refuse_file(path_, "is nested deeper than " + std::to_string(max_json_depth), "give a light rig",
                        "line " + std::to_string(line()));
        }
        levels_.push_back({std::move(name), is_array});
        return true;
    }

    bool close() {
        levels_.pop_back();
        return true;
    }

    const std::filesystem::path& path_;
    std::string_view text_;
    const std::size_t& consumed_;
    std::size_t counted_ = 0;
    std::size_t line_ = 1;
    std::unordered_map<std::string, std::size_t> lines_;
    std::vector<Level> levels_;
    std::string next_;
};

}  // namespace

LocatedJson::LocatedJson(const std::filesystem::path& path) : path_(path) {
    const std::string text = read_whole_file(path, max_json_bytes);
    std::size_t consumed = 0;
    LineListener listener(path_, text, consumed);
    json::sax_parse(WatchedIterator(text.data(), &consumed),
                    WatchedIterator(text.data() + text.size(), &consumed), &listener);
    lines_ = listener.take_lines();
    value_ = json::parse(text);
}

void LocatedJson::refuse(const std::string& name, std::string_view what, std::string_view remedy) const {
    const auto found = lines_.find(name);
    const std::string line = found == lines_.end() ? "" : "line " + std::to_string(found->second);
    std::string where = name.empty() ? line : "key " + name;
    if (!name.empty() && !line.empty()) where += " (" + line + ")";
    refuse_file(path_, what, remedy, where);
}

}  // namespace skinglow::detail
