#pragma once
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "store/record.h"

namespace carve::experiments {

/// A program that a method needs is not on the PATH: its runs have no result, and nothing failed.
class NotInstalled : public std::runtime_error {
 public:
  explicit NotInstalled(const std::string& program) : std::runtime_error(kNotInstalled + (": " + program)) {}
};

/// Where a program lies on the PATH. \throws NotInstalled
std::filesystem::path find_program(const std::string& name);

/// Which program ran: its path, and what it says of its version after `arguments` (first line) or, without any, a hash
/// of its bytes.
std::string version_of(const std::filesystem::path& program, const std::vector<std::string>& arguments = {});

/// Runs a program in a process of its own in `folder`, its output in `folder`/log.txt; it dies with this one.
/// \throws std::runtime_error naming the program: still running after `seconds`, killed by a signal, ended with another
/// code than 0 (with the last line it printed)
void run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                 const std::filesystem::path& folder, double seconds);

/// A folder for one run's files, gone with the object.
class WorkFolder {
 public:
  WorkFolder();
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace carve::experiments
