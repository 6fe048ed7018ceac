#pragma once
#include <string>
#include <utility>
#include <vector>

#include "report/published.h"
#include "report/text_table.h"
#include "store/record.h"

namespace carve::experiments {

using NamedResults = std::vector<std::pair<std::string, Results>>;  // with the spec's name

/// All results of a folder: first what makes tables and figures of the thesis again, in its order.
NamedResults load_all(const std::filesystem::path& results);

/// What a report says first: what ran, how it ended, of which program and where, and where each table and figure of the
/// thesis is.
struct Front {
  struct Place {
    std::string what;                  // "Fig. 4.9"
    std::vector<std::string> anchors;  // names of specs, or that of a published table (anchor_of)
  };
  std::vector<std::string> lines;
  TextTable runs;  // a row a spec, in their order
  std::vector<Place> thesis;
};

Front front_of(const NamedResults& specs, const std::vector<PublishedTable>& published);

/// Name of a published table in a page: "table-4-1".
std::string anchor_of(const PublishedTable& table);

}  // namespace carve::experiments
