#include <sys/resource.h>

#include <cmath>
#include <iostream>

#include "apps/command_line.h"
#include "carve/core/error.h"
#include "carve/core/file.h"
#include "report/compare.h"
#include "report/page.h"
#include "report/plot.h"
#include "report/table.h"
#include "run/cell.h"
#include "run/heat_maps.h"
#include "run/models.h"
#include "run/provenance.h"
#include "run/renders.h"
#include "run/runner.h"

namespace {
using namespace carve;
using namespace carve::experiments;
namespace fs = std::filesystem;

struct Arguments {
  std::vector<fs::path> specs;
  fs::path results = "results", other;
  RunnerOptions runner;
  ReportOptions report = {.published = CARVE_PUBLISHED, .three = CARVE_THREE};
  std::string shard = "0/1";
  std::string cell;
  int threads = 1;
};

std::vector<Cell> shard_of(const std::vector<Cell>& cells, const std::string& text) {
  int index = -1, count = 0;
  char slash = 0, rest = 0;
  std::istringstream in(text);
  in >> index >> slash >> count;
  if (!in || slash != '/' || in >> rest || count < 1 || index < 0 || index >= count)
    throw std::invalid_argument("--shard must be I/N with 0 <= I < N, got " + text);
  return shard(cells, index, count);
}

std::string clock_text(double seconds) {
  const int whole = static_cast<int>(std::lround(std::max(0.0, seconds)));
  return std::to_string(whole / 60) + ":" + (whole % 60 < 10 ? "0" : "") + std::to_string(whole % 60);
}

// Models that a spec names and this machine lacks must not be missed in silence.
void tell_missing(const Spec& spec) {
  for (const std::string& pattern : spec.models)
    if (expand_subjects({pattern}).empty())
      std::cerr << "carve-experiments: " << spec.name << ": this machine has no model " << pattern
                << " (datasets/prepare makes them); left out\n";
}

int plan_command(const Arguments& arguments) {
  for (const fs::path& path : arguments.specs) {
    const Spec spec = read_spec(path);
    tell_missing(spec);
    const std::vector<Cell> cells = plan(spec);
    int todo = 0;
    for (const Cell& cell : cells) {
      const bool done = finished(arguments.results, cell).has_value();
      todo += !done;
      std::cout << (done ? "done  " : "to do ") << cell.id.substr(0, 12) << "  " << cell.path.string() << '\n';
    }
    std::cout << spec.name << ": " << cells.size() << " runs, " << todo << " to do\n";
  }
  return kDone;
}

int run_command(const Arguments& arguments) {
  int failed = 0;
  export_commit();
  std::vector<Spec> specs;  // all are read first: what is wrong with the last one is said at once
  for (const fs::path& path : arguments.specs) specs.push_back(read_spec(path));
  for (const Spec& spec : specs) {
    tell_missing(spec);
    const std::vector<Cell> all = plan(spec);
    const std::vector<Cell> cells = shard_of(all, arguments.shard);
    fs::create_directories(arguments.results / spec.name);
    write_file(arguments.results / spec.name / kOverviewFile,
               [&](std::ostream& out) { out << to_json(overview(spec, all)); });
    RunnerOptions options = arguments.runner;
    options.seconds = spec.seconds;
    options.megabytes = spec.megabytes;
    const Progress end = run_all(arguments.results, spec.name, cells, options, [&](const Progress& p) {
      std::cerr << spec.name << ": " << p.skipped + p.done + p.absent + p.failed << "/" << p.total << " (" << p.failed
                << " failed), " << clock_text(p.seconds_left) << " left  " << p.last << '\n';
    });
    std::cout << spec.name << ": " << end.done << " done, " << end.skipped << " were there, " << end.failed
              << " failed";
    if (end.absent > 0) std::cout << ", " << end.absent << " not installed";
    std::cout << '\n';
    failed += end.failed;
    if (failed && options.fail_fast) break;
  }
  return failed ? kFailed : kDone;
}

int status_command(const Arguments& arguments) {
  for (const fs::path& path : arguments.specs) {
    const Spec spec = read_spec(path);
    int done = 0;
    const std::vector<Cell> cells = plan(spec);
    std::vector<std::string> complaints;
    std::map<std::string, std::string> status;
    for (const Record& record : load_records(arguments.results / spec.name, complaints))
      status[record.id] = record.status;
    for (const Cell& cell : cells) {
      const auto found = status.find(cell.id);
      done += found != status.end() && found->second == "done";
      if (found != status.end() && found->second != "done")
        std::cout << cell.path.string() << ": " << found->second << '\n';
    }
    for (const std::string& complaint : complaints) std::cout << complaint << '\n';
    std::cout << spec.name << ": " << done << " of " << cells.size() << " runs done\n";
  }
  return kDone;
}

// Tables read results only: the folders below the results that have an overview, or those of the named specs.
std::vector<std::string> specs_with_results(const Arguments& arguments) {
  if (arguments.specs.empty()) return specs_in(arguments.results);
  std::vector<std::string> names;
  for (const fs::path& path : arguments.specs) names.push_back(path.stem().string());
  return names;
}

int table_command(const Arguments& arguments) {
  for (const std::string& name : specs_with_results(arguments)) {
    const fs::path folder = arguments.results / name;
    const auto [overview, runs, rows, complaints] = load_results(folder);
    fs::create_directories(folder / "tables");
    const auto write = [&](const std::string& file, const std::string& text) {
      write_file(folder / "tables" / file, [&](std::ostream& out) { out << text; });
    };
    write("runs.csv", long_csv(runs));
    const TextTable means = summary(overview, rows);
    write("summary.md", markdown(means));
    write("summary.tex", latex(means));
    std::string all = markdown(means) + "\n";
    for (const RunMetric& metric : overview.metrics) {
      const Table table = make_table(overview, rows, metric);
      write(metric.name + ".md", to_markdown(table));
      write(metric.name + ".csv", to_csv(table));
      write(metric.name + ".tex", to_latex(table));
      all += to_markdown(table) + "\n";
    }
    for (const std::string& complaint : complaints) std::cerr << "carve-experiments: " << complaint << '\n';
    std::cout << all;
  }
  return kDone;
}

int plot_command(const Arguments& arguments) {
  for (const std::string& name : specs_with_results(arguments)) {
    const fs::path folder = arguments.results / name;
    const Results found = load_results(folder);
    for (const RunMetric& metric : found.overview.metrics)
      plot(folder / "plots", metric.name, found.overview, found.rows, metric);
    std::cout << (folder / "plots").string() << ": " << found.overview.metrics.size()
              << " figures as SVG, PDF, PNG, with CSV and script\n";
  }
  return kDone;
}

int pictures_command(const Arguments& arguments) {
  for (const std::string& name : specs_with_results(arguments)) {
    const fs::path folder = arguments.results / name;
    const Results found = load_results(folder);
    for (const auto draw : {draw_heat_maps_of, draw_renders_of})
      for (const fs::path& picture : draw(folder, found.overview, found.rows)) std::cout << picture.string() << '\n';
  }
  return kDone;
}

int report_command(const Arguments& arguments) {
  const auto write = [&](const char* name, const std::string& text) {
    write_file(arguments.results / name, [&](std::ostream& out) { out << text; });
    std::cout << (arguments.results / name).string() << '\n';
  };
  write("report.md", markdown_report(arguments.results, arguments.report));
  write("report.html", html_report(arguments.results, arguments.report));
  return kDone;
}

int compare_command(const Arguments& arguments) {
  bool any = false;
  for (const std::string& name : specs_in(arguments.results)) {
    const fs::path a = arguments.results / name, b = arguments.other / name;
    if (!fs::exists(b / kOverviewFile)) continue;
    any = true;
    const Results left = load_results(a), right = load_results(b);
    std::cout << compare(left.overview, left.records, right.records);
    for (const Results* side : {&left, &right})
      for (const std::string& said : side->complaints) std::cerr << "carve-experiments: " << said << '\n';
  }
  if (!any)
    throw IoError(arguments.other.string(), "has no results of a spec that " + arguments.results.string() + " has");
  return kDone;
}

int cell_command(const Arguments& arguments) {
#ifndef __SANITIZE_ADDRESS__  // which reserves more than any limit
  // Address space, not resident memory: the only limit on memory that the kernel lets a process set for itself.
  const auto bytes = static_cast<rlim_t>(arguments.runner.megabytes * 1e6);
  const rlimit limit{bytes, bytes};
  setrlimit(RLIMIT_AS, &limit);
#endif
  const auto [spec, cell] = cell_from_argument(arguments.cell);
  run_cell(arguments.results, spec, cell, arguments.threads);
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Experiments: models x methods x swept options, stated in TOML files (experiments/specs).",
               "carve-experiments");
  app.require_subcommand(1);
  app.footer(
      "Example:\n  carve-experiments run experiments/specs/accuracy.toml -o results --jobs 2\n"
      "  carve-experiments table -o results\n"
      "Exit codes: 0 done, 1 a run failed, 2 wrong usage or bad input.");
  int (*command)(const Arguments&) = nullptr;
  const auto add = [&](const char* name, const char* what, int (*function)(const Arguments&), bool needs_spec) {
    CLI::App* sub = app.add_subcommand(name, what);
    auto* specs = sub->add_option("specs", arguments.specs, "specs")->type_name("SPEC.toml");
    if (needs_spec) specs->required();
    sub->add_option("-o,--output", arguments.results, "folder of the results")
        ->type_name("RESULTS")
        ->capture_default_str();
    sub->callback([&command, function] { command = function; });
    return sub;
  };
  add("plan", "list the runs and whether they are done", plan_command, true);
  CLI::App* run = add("run", "do the runs that are not done", run_command, true);
  run->add_option("--jobs", arguments.runner.jobs, "runs at a time")->check(CLI::Range(1, 256))->capture_default_str();
  run->add_option("--shard", arguments.shard, "do only every N-th run, from the I-th")->type_name("I/N");
  run->add_flag("--force", arguments.runner.force, "do finished runs again");
  run->add_flag("--fail-fast", arguments.runner.fail_fast, "start nothing more after a failure");
  add("status", "what is done, what failed and why", status_command, true);
  add("table", "write and print tables (Markdown, CSV, LaTeX) from results", table_command, false);

  add("plot", "draw figures from results (gnuplot)", plot_command, false);
  add("heatmaps", "draw the methods' distances to the reference and their meshes side by side", pictures_command,
      false);
  CLI::App* page = add("report", "write report.html and report.md from all results", report_command, false);
  page->add_option("--published", arguments.report.published, "folder of the thesis's tables; empty leaves them out")
      ->capture_default_str();
  page->add_option("--three", arguments.report.three, "folder of three.js, for the 3-D view")->capture_default_str();
  page->add_option("--mesh-megabytes", arguments.report.mesh_megabytes, "share of the page that the 3-D view may take")
      ->check(CLI::Range(0.1, 500.0))
      ->capture_default_str();
  CLI::App* both = app.add_subcommand("compare", "two folders of results side by side, paired by run");
  both->add_option("a", arguments.results, "results")->required()->type_name("RESULTS_A");
  both->add_option("b", arguments.other, "other results")->required()->type_name("RESULTS_B");
  both->callback([&] { command = compare_command; });

  CLI::App* cell = app.add_subcommand("cell", "one run; used by run")->group("");
  cell->add_option("cell", arguments.cell)->required();
  cell->add_option("-o,--output", arguments.results)->required();
  cell->add_option("--megabytes", arguments.runner.megabytes);
  cell->callback([&] { command = cell_command; });
  return run_program(app, argc, argv, [&] { return command(arguments); });
}
