#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "report/text_table.h"

namespace carve::experiments {

/// A table of the thesis \cite silva_2018 as printed, beside what was measured here or computed from its other tables.
struct PublishedTable {
  std::string title;
  TextTable table;
  std::vector<std::string> notes;  // contradictions and what they are computed from
};

/// Tables 4.1 to 4.3 and B from the CSV files of `folder` (papers/published). Measured columns come from the specs
/// below `results` that name a published table (Overview::published); Table 4.2 is recomputed from Appendix B and the
/// thesis's sentences (claims.csv) are compared with its tables. Empty if `folder` is. \throws IoError naming the file
std::vector<PublishedTable> published_tables(const std::filesystem::path& folder, const std::filesystem::path& results);

}  // namespace carve::experiments
