#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "numerics/detail.h"

namespace skinglow::detail {

/// Writes a file whole or not at all: into one without a name in the same folder, which is flushed to the
/// disk (fsync) and then takes the place of `path`. When anything fails or a signal comes, what stood at
/// `path` before stands there still and nothing else is left. Links are followed.
/// @throws FileError where the folder is missing or cannot be written, or where `path` is no regular
///         file (a rename over /dev/stdout would replace the device)
void write_atomically(const std::filesystem::path& path, std::string_view bytes);

/// Writes a folder of files, by name, as a whole or not at all: into a new folder beside it, which then
/// is exchanged with it in one step. Also with two writers at once it holds the files of one of them. What
/// else it held stays, but for `obsolete` names.
/// @param obsolete  files of an earlier writing that are to go where `files` has none of that name
/// @throws FileError where it cannot be written, is no folder or is the working directory, which
///         would be lost under the feet of the shell
void replace_folder(const std::filesystem::path& path, const std::map<std::string, std::string>& files,
                    const std::set<std::string>& obsolete);

/// Where the links lead, also where nothing is yet: std::filesystem::canonical wants a file at the end.
std::filesystem::path follow_links(std::filesystem::path path);

/// Refuses an output whose folder is missing or closed, or whose ending is none of `endings` (small, with the dot),
/// before anything is worked out and before another output of the same command is written. An empty path is passed
/// over.
/// @param what  what the file is to hold, for the message
/// @throws FileError naming the output and the remedy
void require_writable(const std::filesystem::path& output, std::string_view what,
                      const std::vector<std::string>& endings);

/// Refuses to write over what was read: an output that is one of the inputs by any path, link or hard link,
/// or twice the same output. Empty paths are passed over.
/// @throws FileError naming the output
void refuse_overwriting(const std::vector<std::filesystem::path>& outputs,
                        const std::vector<std::filesystem::path>& inputs);

}  // namespace skinglow::detail
