#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>

#include "files/mesh_builder.h"
#include "numerics/detail.h"
#include "rig_files/parse_number.h"

namespace skinglow::detail {

/// Words and numbers of a text file, one after the other; refuses naming the line.
class WordReader {
  public:
    WordReader(const std::filesystem::path& path, std::string_view text)
        : path_(path), text_(text), rest_(text) {}

    [[noreturn]] void refuse(const std::string& what) const {
        const std::string_view before = text_.substr(0, text_.size() - rest_.size());
        refuse_file(path_, what, damaged_mesh_remedy,
                    "line " + std::to_string(1 + std::count(before.begin(), before.end(), '\n')));
    }

    /// The next word; empty at the end.
    std::string_view take() {
        constexpr std::string_view blanks = " \t\r\n\v\f";
        rest_.remove_prefix(std::min(rest_.find_first_not_of(blanks), rest_.size()));
        const std::string_view word = rest_.substr(0, rest_.find_first_of(blanks));
        rest_.remove_prefix(word.size());
        return word;
    }

    double take_number() {
        const std::string_view word = take();
        if (word.empty()) refuse("ends too early");
        const auto number = parse_number(word);
        if (!number) refuse("has \"" + std::string(word.substr(0, 40)) + "\" where a number belongs");
        return *number;
    }

    void skip_line() { rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size())); }

  private:
    const std::filesystem::path& path_;
    std::string_view text_;
    std::string_view rest_;
};

}  // namespace skinglow::detail
