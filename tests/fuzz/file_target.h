#pragma once

#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <string_view>

#include "require.h"
#include "rig_files/file_error.h"

namespace skinglow::fuzz {

/// A file of this process, in memory where the system has a folder for that.
inline std::filesystem::path scratch_file(const std::string& name) {
    static const std::filesystem::path folder = [] {
        const std::filesystem::path memory = "/dev/shm";
        const auto base = std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path();
        const auto made = base / ("skinglow-fuzz-" + std::to_string(::getpid()));
        std::filesystem::create_directories(made);
        static const struct Removal {
            std::filesystem::path path;
            ~Removal() {
                std::error_code ignored;
                std::filesystem::remove_all(path, ignored);
            }
        } removal{made};
        return made;
    }();
    return folder / name;
}

inline std::filesystem::path written(const std::string& name, const std::uint8_t* data, std::size_t size) {
    const std::filesystem::path path = scratch_file(name);
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    return path;
}

/// Runs an action that reads this file; a refusal must name the file, and one of the locations, unless there are none. Returns
/// whether it was read.
template <class Action>
bool reads(const std::filesystem::path& path, const Action& action,
           std::initializer_list<std::string_view> locations = {}) {
    try {
        action();
        return true;
    } catch (const detail::FileError& refusal) {
        const std::string text = refusal.what();
        require(text.find(path.filename().string()) != std::string::npos,
                "a refusal names the file: " + text);
        require(text.find('\n') == std::string::npos, "a refusal is one line: " + text);
        const auto named = [&](std::string_view location) {
            return text.find(location) != std::string::npos;
        };
        require(locations.size() == 0 || std::any_of(locations.begin(), locations.end(), named),
                "a refusal names the location: " + text);
        return false;
    }
}

}  // namespace skinglow::fuzz
