#pragma once
#include <span>
#include <string_view>

#include "models/model.h"

namespace carve {

/// A base model made in code, as the artist's models of the thesis are not published. Facing +Z, in object units, every
/// shell closed and outward oriented, no face in one plane with another's of a different colour.
struct ProceduralModel {
  const char* name;
  const char* stands_for;  // the object of the thesis, or what the shape tests
  Model (*make)();
};

std::span<const ProceduralModel> procedural_models();

/// \throws std::invalid_argument naming the models there are
Model procedural_model(std::string_view name);

// One file a family; all are in the table.
Model couch();
Model armchair();
Model stairs(int steps, bool walled);
Model axe();
Model handgun();
Model head();
Model dog();
Model dragon();
Model robot();
Model airplane();
Model jet();
Model spaceship();
Model car();
Model wagon();
Model plain_box();
Model box_pockets();
Model bowl();
Model sphere();
Model ring();

}  // namespace carve
