#pragma once

#include <filesystem>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Refuses to write over what was read: an output that is one of the inputs by any path, link or hard link,
/// or twice the same output. Empty paths are passed over. @throws FileError naming the output
void refuse_overwriting(const std::vector<std::filesystem::path>& outputs,
                        const std::vector<std::filesystem::path>& inputs);

}  // namespace skinglow::detail
