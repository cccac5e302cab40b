#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <unordered_map>

#include "numerics/detail.h"

namespace skinglow::detail {

/// A JSON file that knows on which line each of its values stands, so that a message about a value can say
/// where. A value's name is its path: "lights[2].color[0]"; the whole document is "".
class LocatedJson {
  public:
    /// Throws FileError, naming line and column, where the file is unreadable, longer than 64 MiB, no JSON,
    /// nested deeper than 16, names a key twice or holds a number beyond the largest double.
    explicit LocatedJson(const std::filesystem::path& path);

    const nlohmann::json& value() const { return value_; }

    /// Refuses the value of that name: throws FileError "file ...: key NAME (line N): what: remedy".
    [[noreturn]] void refuse(const std::string& name, std::string_view what, std::string_view remedy) const;

  private:
    std::filesystem::path path_;
    nlohmann::json value_;
    std::unordered_map<std::string, std::size_t> lines_;
};

}  // namespace skinglow::detail
