#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "store/record.h"

namespace carve::experiments {

/// A named variant: one entry of run/methods.h's table and the options it overrides. One that states a swept field
/// itself does not follow the sweep of that field: it is run once, and its result stands in every row.
struct MethodSpec {
  std::string name;
  std::string arm = "carve";
  Settings settings = {};
};

/// An experiment: models x methods x swept options x seeds, stated in one TOML file:
///
///   title    = "Grid size against accuracy"
///   thesis   = ["Fig. 4.9"]                               # tables and figures that it makes again
///   models   = ["axe", "stairs_*", "set:thesis"]          # names, globs, sets of run/models.h
///   baseline = "hull"                                     # methods are compared with this one, paired by model
///   metrics  = ["c2m_thesis", "volume_iou", "seconds"]    # columns; all are computed
///   seeds    = [1]
///   options  = { grid = 128 }                             # for every method
///   sweep    = { grid = [32, 64, 128, 256] }              # every combination, for methods that do not state the field
///   all_minus = ["intersections", "smooth.steps"]         # adds "all" and "all - FIELD" with that field switched off
///   limits   = { seconds = 120, megabytes = 4000 }        # of one run
///   heat_map = { models = ["dog"], range = 2.0 }          # % of the diagonal
///   renders  = ["dog"]                                    # models whose drawings and meshes are pictured
///   published = { table = "table_4_3", method = "ours", columns = { total = "seconds" } }  # papers/published, column
///   -> metric
///   [[method]]
///   name = "hull"
///   options = { consistency = "none", smooth = { steps = 0 } }
struct Spec {
  std::string name;  // the file's
  std::string title;
  std::vector<std::string> thesis, models, metrics, heat_map_models, render_models;
  std::string baseline;
  std::vector<MethodSpec> methods;
  Settings options;
  std::vector<std::pair<std::string, std::vector<std::string>>> sweep;
  std::vector<unsigned> seeds = {1};
  double seconds = 300, megabytes = 6000, heat_map_range = 2;
  Published published = {};
};

/// \throws IoError "file:line: ..." on a key that is not known, a value out of its range, or a method named twice
Spec read_spec(const std::filesystem::path& path);

}  // namespace carve::experiments
