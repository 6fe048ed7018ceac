#include "models/procedural.h"

#include <algorithm>
#include <stdexcept>

namespace carve {

std::span<const ProceduralModel> procedural_models() {
  static const ProceduralModel all[] = {
      {"axe", "axe (Figures 4.1, 4.4, 4.11; Table 4.3)", axe},
      {"dog", "dog (Figures 4.1, 4.2, 4.4, 4.11; Tables 4.2, 4.3)", dog},
      {"head", "head: brow over the nose in the top view (Figures 4.1, 4.3, 4.4, 4.8, 4.11; Tables 4.2, 4.3)", head},
      {"robot", "robot (Figures 4.1, 4.4, 4.11; Table 4.3)", robot},
      {"airplane", "airplane (Figure 4.12)", airplane},
      {"couch", "couch: the arm hides the seat in the side view (Figures 3.5, 3.8, 4.13; Table 4.3)", couch},
      {"wagon", "wagon: the sides hide the floor in the side view (Figure 4.14; Table 4.3)", wagon},
      {"spaceship", "X-wing spaceship (Figure 4.15; Tables 4.2, 4.3)", spaceship},
      {"car", "car (Figure 4.16)", car},
      {"handgun", "handgun (Figure 4.17)", handgun},
      {"dragon", "dragon (Figure 4.18)", dragon},
      {"jet", "jet (Figure 4.19)", jet},
      {"armchair", "armchair: the arm hides the seat in the side view (Figure 4.20)", armchair},
      {"stairs_5", "stairs of 5 steps, each seen from the side", [] { return stairs(5, false); }},
      {"stairs_3_walled", "stairs of 3 steps between walls", [] { return stairs(3, true); }},
      {"stairs_5_walled", "stairs of 5 steps between walls: several levels of depth (Section 5.1)",
       [] { return stairs(5, true); }},
      {"stairs_8_walled", "stairs of 8 steps between walls", [] { return stairs(8, true); }},
      {"box", "a box: every arm must be exact", plain_box},
      {"box_pockets", "a box with pockets 5, 14 and 30 % deep in side, top and front", box_pockets},
      {"bowl", "a bowl: a curved hollow that only the top shows", bowl},
      {"sphere", "a sphere: no strokes but the outline", sphere},
      {"torus", "a torus: genus 1", ring},
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
