#include "run/provenance.h"

#include <CGAL/version.h>
#include <gnu/libc-version.h>
#include <link.h>
#include <toml++/toml.h>
#include <unistd.h>

#include <Eigen/Core>
#include <algorithm>
#include <boost/process.hpp>
#include <boost/version.hpp>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "run/hash.h"

namespace carve::experiments {
namespace bp = boost::process;
namespace {

constexpr const char* kCommit = "CARVE_COMMIT";
constexpr const char* kDirty = "CARVE_DIRTY";

// First line of what git says; empty where there is no git or no checkout.
std::string git(const std::vector<std::string>& arguments) {
  const auto program = bp::search_path("git");
  if (program.empty()) return "";
  bp::ipstream out;
  std::string line;
  bp::child child(program, bp::args = arguments, bp::start_dir = CARVE_SOURCE_FOLDER,
                  bp::std_in<bp::null, bp::std_err> bp::null, bp::std_out > out);
  std::getline(out, line);
  for (std::string rest; std::getline(out, rest);) {
  }
  child.wait();
  return line;
}

std::string cpu() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

std::string from_environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "unknown";
}

std::string version(int a, int b, int c) {
  return std::to_string(a) + "." + std::to_string(b) + "." + std::to_string(c);
}

// The shared libraries of this process by the names of their files, which hold their versions: "libtbb.so.12.8".
std::vector<std::string> loaded_libraries() {
  std::vector<std::string> names;
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* list) {
        std::error_code error;
        const auto file = std::filesystem::canonical(info->dlpi_name, error).filename().string();
        if (!error && file.find(".so") != std::string::npos)
          static_cast<std::vector<std::string>*>(list)->push_back(file);
        return 0;
      },
      &names);
  std::sort(names.begin(), names.end());
  return names;
}

// Those that leave nothing but their headers in the program, then those it loads.
std::string libraries() {
  std::string all = "Boost " + version(BOOST_VERSION / 100000, BOOST_VERSION / 100 % 1000, BOOST_VERSION % 100) +
                    ", CGAL " + CGAL_VERSION_STR + ", Eigen " +
                    version(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION) + ", nlohmann-json " +
                    version(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH) +
                    ", toml++ " + version(TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH) + ", glibc " +
                    gnu_get_libc_version();
  for (const std::string& name : loaded_libraries()) all += ", " + name;
  return all;
}

// Other work on the machine's cores when the run began: what its times may be trusted for.
std::string load() {
  double minute = 0;
  if (getloadavg(&minute, 1) != 1) return "unknown";
  char text[16];
  std::snprintf(text, sizeof text, "%.1f", minute);
  return text;
}

}  // namespace

void export_commit() {
  const std::string commit = git({"rev-parse", "HEAD"});
  setenv(kCommit, commit.empty() ? "unknown" : commit.c_str(), 1);
  setenv(kDirty,
         commit.empty()                                                   ? "unknown"
         : git({"status", "--porcelain", "--untracked-files=no"}).empty() ? "no"
                                                                          : "yes",
         1);
}

std::map<std::string, std::string> provenance() {
  char date[32];
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  std::strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &utc));
  return {{"commit", from_environment(kCommit)},
          {"dirty", from_environment(kDirty)},
          {"program", program_hash()},
          {"compiler", "g++ " __VERSION__},
          {"flags", CARVE_BUILD_FLAGS},
          {"libraries", libraries()},
          {"load", load()},
          {"cpu", cpu()},
          {"cores", std::to_string(std::thread::hardware_concurrency())},
          {"date", date}};
}

}  // namespace carve::experiments
