// The three methods compared on many inputs, by hand: hull_agreement FIRST LAST PIXELS. Random silhouettes of seeds
// FIRST to LAST - 1, then every procedural model drawn at PIXELS (0: none). Exit code 3 if any differs.
#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "carve/hull/contours.h"
#include "hull/agreement.h"
#include "hull/polygons.h"
#include "models/procedural.h"
#include "synthesize/synthesize.h"

int main(int argc, char** argv) {
  using namespace carve;
  const unsigned first = argc > 1 ? std::atoi(argv[1]) : 0, last = argc > 2 ? std::atoi(argv[2]) : 300;
  const int pixels = argc > 3 ? std::atoi(argv[3]) : 64;
  int same = 0, empty = 0, refused = 0, different = 0;
  const auto compare = [&](const std::string& name, const Silhouettes& silhouettes) {
    try {
      const Agreement agreement = compare_methods(silhouettes);
      empty += agreement.empty;
      refused += agreement.not_representable;
      if (agreement.not_representable) std::cout << name << ": corefinement cannot represent the result\n";
      (agreement.differences.empty() ? same : different)++;
      if (!agreement.differences.empty()) std::cout << name << ": " << agreement.differences;
    } catch (const std::exception& error) {
      ++different;
      std::cout << name << ": " << error.what() << '\n';
    }
  };
  for (unsigned seed = first; seed < last; ++seed) compare("seed " + std::to_string(seed), random_silhouettes(seed));
  if (pixels > 0)
    for (const ProceduralModel& model : procedural_models()) {
      std::map<View, Drawing> drawings;
      for (auto& [view, picture] : synthesize(model.make(), {.size = pixels}))
        drawings.emplace(view, understand_drawing(std::move(picture)));
      compare(model.name, pixel_contours(align(std::move(drawings))));
      std::cout << model.name << std::endl;
    }
  std::cout << same << " agree (" << empty << " of them empty, " << refused << " without corefinement), " << different
            << " differ\n";
  return different == 0 ? 0 : 3;
}
