#include "run/provenance.h"

#include <tbb/version.h>
#include <unistd.h>

#include <Eigen/Core>
#include <boost/process.hpp>
#include <boost/version.hpp>
#include <cstdlib>
#include <ctime>
#include <fstream>
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
          {"libraries", "Eigen " + version(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION) + ", Boost " +
                            version(BOOST_VERSION / 100000, BOOST_VERSION / 100 % 1000, BOOST_VERSION % 100) +
                            ", oneTBB " + version(TBB_VERSION_MAJOR, TBB_VERSION_MINOR, 0)},
          {"cpu", cpu()},
          {"cores", std::to_string(std::thread::hardware_concurrency())},
          {"date", date}};
}

}  // namespace carve::experiments
