#pragma once
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>

namespace carve {

/// Writes a file whole or not at all: `write` fills a temporary file beside `path`, which is then renamed over it.
/// \throws IoError: side input if no such file can be made there (missing folder, no permission, not a regular file),
/// side
///         output if the disk is full; the temporary file is gone then and what stood at `path` is untouched.
void write_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// The whole file. \throws IoError if it is missing, not a regular file, or larger than `limit` bytes.
std::string read_file(const std::filesystem::path& path, std::uintmax_t limit = std::uintmax_t{1} << 32);

}  // namespace carve
