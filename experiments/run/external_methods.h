#pragma once
#include "run/methods.h"

namespace carve::experiments {

/// Methods that another program does, if it is on the PATH; what ran is in the record as "external".
/// COLMAP: features, matches of photos within external.angle, points at the known poses; planes' normals, Poisson.
MethodOutput colmap_arm(const MethodInput& input);
/// PMVS2 on the folder that write_pmvs makes; Poisson.
MethodOutput pmvs2_arm(const MethodInput& input);
/// The thesis's chain: cmvs selects photos and groups them by the features that patches() starts from (it wants the
/// points of a structure from motion), genOption writes the groups' options, PMVS2 runs on each; all points, Poisson.
MethodOutput cmvs_arm(const MethodInput& input);

}  // namespace carve::experiments
