#include "run/runner.h"

#include <sys/wait.h>

#include <boost/process.hpp>
#include <chrono>
#include <csignal>
#include <cstring>
#include <nlohmann/json.hpp>
#include <thread>

#include "carve/core/error.h"
#include "carve/core/file.h"
#include "run/die_with_parent.h"
#include "run/external.h"
#include "run/provenance.h"

namespace carve::experiments {
namespace bp = boost::process;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
namespace {

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

struct Running {
  Cell cell;
  bp::child process;
  Clock::time_point start;
  bool timed_out = false;
};

class Runner {
 public:
  Runner(const fs::path& results, const std::string& spec, const RunnerOptions& options,
         const std::function<void(const Progress&)>& tell)
      : results_(results), spec_(spec), options_(options), tell_(tell) {}

  Progress run(const std::vector<Cell>& cells) {
    std::vector<const Cell*> waiting;
    progress_.total = static_cast<int>(cells.size());
    for (const Cell& cell : cells) {
      if (!options_.force && finished(results_, cell))
        ++progress_.skipped;
      else
        waiting.push_back(&cell);
    }
    tell_(progress_);
    std::size_t next = 0;
    while (next < waiting.size() || !running_.empty()) {
      const bool stop = options_.fail_fast && progress_.failed > 0;
      while (!stop && next < waiting.size() && running_.size() < static_cast<std::size_t>(options_.jobs))
        start(*waiting[next++]);
      if (stop && running_.empty()) break;
      collect(waiting.size());
      std::this_thread::sleep_for(std::chrono::milliseconds(4));
    }
    return progress_;
  }

 private:
  void start(const Cell& cell) {
    const fs::path folder = results_ / cell.path;
    fs::remove_all(folder);  // what is there is of another version, or failed, or half done
    fs::create_directories(folder);
    running_.push_back(
        {cell,
         bp::child("/proc/self/exe", "cell", cell_argument(spec_, cell), "-o", results_.string(), "--megabytes",
                   std::to_string(options_.megabytes), bp::std_in<bp::null, bp::std_out> bp::null,
                   bp::std_err > (folder / "log.txt").string(), DieWithParent{}),
         Clock::now()});
    ++progress_.running;
  }

  void collect(std::size_t to_do) {
    for (std::size_t i = 0; i < running_.size();) {
      Running& run = running_[i];
      std::error_code error;
      if (run.process.running(error)) {
        if (seconds_since(run.start) > options_.seconds && !run.timed_out) {
          run.timed_out = true;
          kill(run.process.id(), SIGKILL);
        }
        ++i;
        continue;
      }
      end(run, to_do);
      running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  void end(Running& run, std::size_t to_do) {
    const bool absent = !run.timed_out && left_out(results_, run.cell);
    const std::string why = absent ? kNotInstalled : outcome(run);
    if (!why.empty() && !absent) store_record(results_, run.cell, record_of(spec_, run.cell, why));
    --progress_.running;
    ++(why.empty() ? progress_.done : absent ? progress_.absent : progress_.failed);
    const double ended = progress_.done + progress_.absent + progress_.failed;
    progress_.seconds_left = seconds_since(begin_) / ended * (static_cast<double>(to_do) - ended);
    progress_.last = run.cell.path.string() + ": " + (why.empty() ? "done" : why);
    tell_(progress_);
  }

  // Empty if the run left a result, else why it did not.
  std::string outcome(Running& run) const {
    if (run.timed_out) return "stopped after " + std::to_string(static_cast<int>(options_.seconds)) + " s";
    const int code = run.process.native_exit_code();
    if (WIFSIGNALED(code)) return std::string("crashed: ") + strsignal(WTERMSIG(code));
    if (finished(results_, run.cell)) return "";
    std::string said;
    try {
      said = read_file(results_ / run.cell.path / "log.txt", 1 << 20);
    } catch (const IoError&) {
    }
    while (!said.empty() && said.back() == '\n') said.pop_back();
    return said.empty() ? "ended with code " + std::to_string(run.process.exit_code()) : said.substr(0, 300);
  }

  fs::path results_;
  std::string spec_;
  RunnerOptions options_;
  const std::function<void(const Progress&)>& tell_;
  Progress progress_;
  Clock::time_point begin_ = Clock::now();
  std::vector<Running> running_;
};

}  // namespace

Progress run_all(const fs::path& results, const std::string& spec, const std::vector<Cell>& cells,
                 const RunnerOptions& options, const std::function<void(const Progress&)>& tell) {
  return Runner(results, spec, options, tell).run(cells);
}

namespace {

std::optional<Record> own_record(const fs::path& results, const Cell& cell) {
  const fs::path file = results / cell.path / kRecordFile;
  if (!fs::exists(file)) return std::nullopt;
  try {
    Record record = record_from_json(read_file(file), file.string());
    if (record.id == cell.id) return record;
  } catch (const IoError&) {  // a record that cannot be read is none: the run is done again
  }
  return std::nullopt;
}

}  // namespace

std::optional<Record> finished(const fs::path& results, const Cell& cell) {
  std::optional<Record> record = own_record(results, cell);
  return record && record->done() ? record : std::nullopt;
}

bool left_out(const fs::path& results, const Cell& cell) {
  const std::optional<Record> record = own_record(results, cell);
  return record && record->status.starts_with(kNotInstalled);
}

void store_record(const fs::path& results, const Cell& cell, const Record& record) {
  fs::create_directories(results / cell.path);
  write_file(results / cell.path / kRecordFile, [&](std::ostream& out) { out << to_json(record); });
}

Record record_of(const std::string& spec, const Cell& cell, const std::string& status) {
  return {.id = cell.id,
          .spec = spec,
          .model = cell.model,
          .method = cell.method,
          .arm = cell.arm,
          .status = status,
          .swept = cell.swept,
          .settings = cell.settings,
          .seed = cell.seed,
          .provenance = provenance()};
}

std::string cell_argument(const std::string& spec, const Cell& cell) {
  return nlohmann::json{{"spec", spec},      {"model", cell.model},        {"method", cell.method},
                        {"arm", cell.arm},   {"swept", cell.swept},        {"settings", cell.settings},
                        {"seed", cell.seed}, {"path", cell.path.string()}, {"id", cell.id}}
      .dump();
}

std::pair<std::string, Cell> cell_from_argument(const std::string& argument) {
  try {
    const auto json = nlohmann::json::parse(argument);
    Cell cell{.model = json.at("model"), .method = json.at("method"), .arm = json.at("arm"), .seed = json.at("seed")};
    json.at("swept").get_to(cell.swept);
    json.at("settings").get_to(cell.settings);
    cell.path = json.at("path").get<std::string>();
    cell.id = json.at("id");
    return {json.at("spec"), cell};
  } catch (const nlohmann::json::exception& error) {
    throw std::invalid_argument(std::string("not a cell: ") + error.what());
  }
}

}  // namespace carve::experiments
