#include "carve/core/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "carve/core/error.h"

namespace carve {
namespace fs = std::filesystem;
namespace {

// Removes the temporary file unless it was renamed.
struct Temporary {
  fs::path path;
  bool kept = false;
  ~Temporary() {
    std::error_code ignored;
    if (!kept) fs::remove(path, ignored);
  }
};

[[noreturn]] void fail(const fs::path& path, IoError::Side side) {
  throw IoError(path.string(), std::string("cannot write") + (errno ? std::string(": ") + std::strerror(errno) : ""),
                side);
}

}  // namespace

void write_file(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  std::error_code error;
  const auto status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw IoError(path.string(), "cannot write: not a regular file");

  std::string name = (path.parent_path() / ("." + path.filename().string() + ".XXXXXX")).string();
  errno = 0;
  const int descriptor = mkstemp(name.data());
  if (descriptor < 0) fail(path, IoError::Side::input);
  Temporary temporary{name};
  fchmod(descriptor, 0644);
  close(descriptor);

  std::ofstream out(name, std::ios::binary);
  if (!out) fail(path, IoError::Side::output);
  out.imbue(std::locale::classic());
  errno = 0;
  write(out);
  out.close();
  if (!out) fail(path, IoError::Side::output);
  fs::rename(name, path, error);
  if (error) throw IoError(path.string(), "cannot write: " + error.message(), IoError::Side::output);
  temporary.kept = true;
}

std::string read_file(const fs::path& path, std::uintmax_t limit) {
  std::error_code error;
  const auto status = fs::status(path, error);
  if (!fs::exists(status)) throw IoError(path.string(), "no such file");
  if (!fs::is_regular_file(status)) throw IoError(path.string(), "not a regular file");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) throw IoError(path.string(), "cannot read: " + error.message());
  if (size > limit)
    throw IoError(path.string(),
                  "file size must be at most " + std::to_string(limit) + " bytes, got " + std::to_string(size));
  std::ifstream in(path, std::ios::binary);
  std::string content(size, '\0');
  if (!in || !in.read(content.data(), static_cast<std::streamsize>(size)))
    throw IoError(path.string(), std::string("cannot read: ") + std::strerror(errno));
  return content;
}

}  // namespace carve
