#include "files/output_guard.h"

#include <system_error>

#include "files/atomic_file.h"
#include "rig_files/file_error.h"

namespace skinglow::detail {
namespace {

namespace fs = std::filesystem;

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
