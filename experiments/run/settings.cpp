#include "run/settings.h"

#include <algorithm>
#include <stdexcept>

namespace carve::experiments {

std::vector<Field> fields(RunOptions& options) {
  std::vector<Field> all = carve::fields(options.pipeline);
  add_fields(all, "synthesize", options.synthesize);
  add_fields(all, "degrade", options.degrade);
  add_fields(all, "evaluate", options.evaluate);
  add_fields(all, "rig", options.rig);
  add_fields(all, "pose_noise", options.pose_noise);
  add_fields(all, "photograph", options.photograph);
  add_fields(all, "solid_texture", options.solid_texture);
  add_fields(all, "space_carving", options.space_carving);
  add_fields(all, "stereo", options.stereo);
  add_fields(all, "patches", options.patches);
  add_fields(all, "external", options.external);
  add_fields(all, "pmvs", options.pmvs);
  return all;
}

namespace {

const Field& named(const std::vector<Field>& all, const std::string& name) {
  const auto field = std::find_if(all.begin(), all.end(), [&](const Field& f) { return f.name == name; });
  if (field == all.end()) throw std::invalid_argument("unknown option " + name);
  return *field;
}

}  // namespace

void apply(RunOptions& options, const Settings& settings) {
  const std::vector<Field> all = fields(options);
  for (const auto& [name, value] : settings) named(all, name).set(value);
}

std::string switched_off(const std::string& name) {
  RunOptions scratch;
  const std::vector<Field> all = fields(scratch);
  const Field& field = named(all, name);
  for (const char* off : {"none", "off", "0"}) {
    try {
      field.set(off);
      return off;
    } catch (const std::invalid_argument&) {
    }
  }
  throw std::invalid_argument(name + " cannot be switched off: none of none, off, 0 is in " + field.range);
}

}  // namespace carve::experiments
