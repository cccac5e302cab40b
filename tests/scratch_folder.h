#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace skinglow::test {

/// A folder of one test, gone after it.
class ScratchFolder {
  public:
    ScratchFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "skinglow-test-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no scratch folder");
        path_ = name;
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }

    std::filesystem::path write(const std::string& name, const std::string& content) const {
        std::ofstream(path_ / name, std::ios::binary) << content;
        return path_ / name;
    }
    std::vector<std::string> names() const {
        std::vector<std::string> found;
        for (const auto& entry : std::filesystem::directory_iterator(path_))
            found.push_back(entry.path().filename());
        return found;
    }

  private:
    std::filesystem::path path_;
};

inline std::string read_bytes(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

inline std::filesystem::path data_file(const std::string& name) {
    return std::filesystem::path(SKINGLOW_TEST_DATA) / name;
}

/// Expects an Error whose text has each of the parts, in any order.
template <class Error, class Action>
void expect_refused(Action action, const std::vector<std::string>& parts) {
    try {
        action();
        ADD_FAILURE() << "nothing was refused";
    } catch (const Error& error) {
        const std::string text = error.what();
        for (const std::string& part : parts) {
            EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" is not in: " << text;
        }
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    }
}

}  // namespace skinglow::test
