#pragma once
#include <optional>
#include <string>
#include <vector>

#include "carve/photo/camera.h"

namespace carve {

/// Thesis 4.1.2: 36 cameras at ground level, one every 10 degrees, and one above.
struct RigOptions {
  int views = 37;
  bool top = true;
  std::optional<double> step = {};
  std::vector<std::string> elevations = {"0"};
  int size = 512;
  double field_of_view = 30;
};
template <class Visitor>
void visit_fields(RigOptions& o, Visitor&& field) {
  field("views", o.views, 1, 10000, "cameras, the one above included");
  field("top", o.top, "one camera looks straight down");
  field("step", o.step, 0.01, 360.0,
        "degrees from one camera of the ring to the next; auto: evenly around, but not more than 90");
  field("elevations", o.elevations, "heights of the ring's cameras in degrees, in turn; each in [-89, 89]");
  field("size", o.size, 16, 4096, "width and height of a picture in pixels");
  field("field_of_view", o.field_of_view, 1.0, 120.0, "degrees across a picture");
}

/// Cameras around a box, looking at its middle from where its circumscribed sphere just fills the picture. The first
/// sees the front as the front drawing does (views/frame.h), the next turns towards the side drawing's view; the one
/// above comes last, with the front drawing's side at the bottom of its picture.
/// \throws std::invalid_argument on an option out of range or a box without extent
std::vector<Camera> rig(const Vec3& low, const Vec3& high, const RigOptions& options = {});

/// What calibration does wrong. 0 = nothing.
struct PoseNoiseOptions {
  double rotation = 0;  // degrees
  double position = 0;  // % of the distance
  int seed = 1;
};
template <class Visitor>
void visit_fields(PoseNoiseOptions& o, Visitor&& field) {
  field("rotation", o.rotation, 0.0, 45.0, "cameras are turned about a random axis, standard deviation in degrees");
  field("position", o.position, 0.0, 50.0,
        "cameras are moved, standard deviation in % of the distance from `target` along each axis");
  field("seed", o.seed, 0, 2147483647, "which errors");
}

/// The cameras as a calibration with errors would have them. A camera's error depends on its place in the list and the
/// seed only. \throws std::invalid_argument on an option out of range
std::vector<Camera> with_pose_noise(std::vector<Camera> cameras, const Vec3& target,
                                    const PoseNoiseOptions& options = {});

}  // namespace carve
