#pragma once

#include <filesystem>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Refuses an EXR with an attribute that is longer than the rest of the file, or than its type is: OpenEXR 3.1 makes room for up to
/// 2 GB before it reads, and takes what follows a wrong length for a header. Other formats pass, and so does what OpenEXR refuses
/// by itself. @throws FileError
void check_exr_header(const std::filesystem::path& path);

}  // namespace skinglow::detail
