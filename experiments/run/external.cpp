#include "run/external.h"

#include <sys/wait.h>

#include <boost/process.hpp>
#include <chrono>
#include <cstring>
#include <optional>
#include <thread>

#include "carve/core/error.h"
#include "carve/core/file.h"
#include "run/die_with_parent.h"
#include "run/hash.h"

namespace carve::experiments {
namespace bp = boost::process;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
namespace {

constexpr double kVersionSeconds = 20;
constexpr std::uintmax_t kLongestLog = 1 << 26;

// Programs that use Qt look for a display otherwise.
bp::environment without_display() {
  bp::environment all = boost::this_process::environment();
  all["QT_QPA_PLATFORM"] = "offscreen";
  return all;
}

// Exit code, negative for a signal, nothing if it was stopped.
std::optional<int> outcome(const fs::path& program, const std::vector<std::string>& arguments, const fs::path& folder,
                           double seconds) {
  bp::child child(program.string(), bp::args = arguments, bp::start_dir = folder.string(), without_display(),
                  bp::std_in<bp::null, (bp::std_out & bp::std_err)>(folder / "log.txt").string(), DieWithParent{});
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  std::error_code error;
  while (child.running(error)) {
    if (Clock::now() > end) {
      kill(child.id(), SIGKILL);
      child.wait(error);
      return {};
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const int code = child.native_exit_code();
  return WIFSIGNALED(code) ? -WTERMSIG(code) : WEXITSTATUS(code);
}

std::string line_of(const fs::path& log, bool last) {
  std::string text;
  try {
    text = read_file(log, kLongestLog);
  } catch (const IoError&) {
    return "";
  }
  while (!text.empty() && text.back() == '\n') text.pop_back();
  text = last ? text.substr(text.rfind('\n') + 1) : text.substr(0, text.find('\n'));
  return text.substr(0, 200);
}

}  // namespace

fs::path find_program(const std::string& name) {
  const fs::path found = bp::search_path(name).string();
  if (found.empty()) throw NotInstalled(name);
  return found;
}

std::string version_of(const fs::path& program, const std::vector<std::string>& arguments) {
  if (arguments.empty()) return program.string() + ", hash " + Hash().add(read_file(program)).hex();
  const WorkFolder folder;
  outcome(program, arguments, folder.path(), kVersionSeconds);
  return program.string() + ", " + line_of(folder.path() / "log.txt", false);
}

void run_program(const fs::path& program, const std::vector<std::string>& arguments, const fs::path& folder,
                 double seconds) {
  std::string name = program.filename().string();
  if (!arguments.empty() && arguments[0].find('/') == std::string::npos) name += " " + arguments[0];
  const std::optional<int> code = outcome(program, arguments, folder, seconds);
  if (!code) {
    char limit[32];
    std::snprintf(limit, sizeof limit, "%g", seconds);
    throw std::runtime_error(name + ": stopped after " + limit + " s");
  }
  if (*code < 0) throw std::runtime_error(name + ": crashed: " + strsignal(-*code));
  if (*code > 0)
    throw std::runtime_error(name + ": ended with code " + std::to_string(*code) + ": " +
                             line_of(folder / "log.txt", true));
}

WorkFolder::WorkFolder() {
  std::string name = (fs::temp_directory_path() / "carve-XXXXXX").string();
  if (!mkdtemp(name.data())) throw IoError(name, "cannot make a folder", IoError::Side::output);
  path_ = name;
}

WorkFolder::~WorkFolder() {
  std::error_code error;
  fs::remove_all(path_, error);
}

}  // namespace carve::experiments
