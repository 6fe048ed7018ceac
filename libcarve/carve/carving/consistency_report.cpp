#include "carve/carving/consistency_report.h"

#include "carve/carving/patch_labels.h"
#include "carve/grid/shadow.h"

namespace carve {

std::vector<ViewAgreement> agreement(const VoxelGrid& solid, const ViewSet& views) {
  std::vector<ViewAgreement> result;
  for (const AlignedView& view : views.views) {
    const Mask drawn = patch_labels(view, solid).inside, reached = shadow(solid, view.view);
    ViewAgreement a{view.view};
    std::int64_t both = 0;
    for (std::size_t i = 0; i < drawn.pixels.size(); ++i) {
      both += drawn.pixels[i] & reached.pixels[i];
      a.uncovered += drawn.pixels[i] & ~reached.pixels[i] & 1;
      a.extra += reached.pixels[i] & ~drawn.pixels[i] & 1;
    }
    const std::int64_t either = both + a.uncovered + a.extra;
    a.silhouette_iou = either == 0 ? 1 : static_cast<double>(both) / static_cast<double>(either);
    result.push_back(a);
  }
  return result;
}

}  // namespace carve
