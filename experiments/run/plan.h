#pragma once
#include "run/spec.h"

namespace carve::experiments {

/// One run: a model, a method, the swept options' values and a seed.
struct Cell {
  std::string model = {}, method = {}, arm = {};
  Settings swept = {};     // part of the path
  Settings settings = {};  // all that differ from the defaults, the swept ones included
  unsigned seed = 1;
  std::filesystem::path path =
      {};               // model/method/field=value,.../seed=N: the folder below the results is the run's parameters
  std::string id = {};  // of settings, seed, the model's and the program's bytes
};

/// Every run of a spec in a fixed order: model, sweep, method, seed.
/// \throws IoError if a model is not known
std::vector<Cell> plan(const Spec& spec);

/// What tables and plots need to know of a spec.
Overview overview(const Spec& spec, const std::vector<Cell>& cells);

/// The cells that shard i of n runs: every n-th, so that shards are alike.
std::vector<Cell> shard(const std::vector<Cell>& cells, int index, int count);

}  // namespace carve::experiments
