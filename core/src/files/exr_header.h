#pragma once

#include <filesystem>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Refuses an EXR with an attribute that is longer than the rest of the file: OpenEXR 3.1 makes room for it before it reads, up
/// to 2 GB. Other formats pass, and so does what OpenEXR refuses by itself. @throws FileError
void check_exr_header(const std::filesystem::path& path);

}  // namespace skinglow::detail
