#pragma once
#include <string>
#include <vector>

#include "store/record.h"

namespace carve::experiments {

/// The runs that one picture shows side by side: a model and swept values, one run a method, in the methods' order, of
/// the first seed there is.
struct Figure {
  std::string file;  // MODEL[,FIELD=VALUE].png
  std::vector<const Record*> runs;
};

/// One for every combination of swept values that the models have a result of.
std::vector<Figure> figures_of(const Overview& overview, const std::vector<Record>& records,
                               const std::vector<std::string>& models);

}  // namespace carve::experiments
