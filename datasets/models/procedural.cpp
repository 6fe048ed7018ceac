#include "models/procedural.h"

#include <algorithm>
#include <stdexcept>

namespace carve {

std::span<const ProceduralModel> procedural_models() {
  static const ProceduralModel all[] = {
      {"axe", "axe (Figures 4.1, 4.4)", axe},
      {"head", "head: brow over the nose in the top view (Figures 4.1, 4.3)", head},
      {"couch", "couch: the seat is hidden in the side view (Figures 3.5, 3.8, 4.13)", couch},
      {"armchair", "armchair (Figure 4.20)", armchair},
      {"stairs_5", "stairs of 5 steps, seen whole from the side", [] { return stairs(5, false); }},
      {"stairs_5_walled", "stairs of 5 steps between walls: several levels of depth (5.1)",
       [] { return stairs(5, true); }},
      {"stairs_8_walled", "stairs of 8 steps between walls", [] { return stairs(8, true); }},
      {"box", "a box: exact ground truth", plain_box},
      {"box_pockets", "a box with pockets of several depths in three faces", box_pockets},
      {"sphere", "a sphere: exact ground truth", sphere},
  };
  return all;
}

Model procedural_model(std::string_view name) {
  std::string known;
  for (const ProceduralModel& model : procedural_models()) {
    if (name == model.name) return model.make();
    known += std::string(known.empty() ? "" : "|") + model.name;
  }
  throw std::invalid_argument("model must be one of " + known + ", got " + std::string(name));
}

}  // namespace carve
