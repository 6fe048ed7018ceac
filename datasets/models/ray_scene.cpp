#include "models/ray_scene.h"

#include <embree3/rtcore.h>

#include <limits>
#include <stdexcept>

namespace carve {
namespace {

// One builder thread: the tree, and with it the answer to a tie, must not depend on timing.
RTCDevice device() {
  static const std::shared_ptr<RTCDeviceTy> shared(rtcNewDevice("threads=1,set_affinity=0"), rtcReleaseDevice);
  if (!shared) throw std::runtime_error("Embree: no device");
  return shared.get();
}

RTCScene scene_of(const std::shared_ptr<void>& scene) { return static_cast<RTCScene>(scene.get()); }

RTCRay ray(const Vec3& origin, const Vec3& direction, double reach) {
  RTCRay r{};
  r.org_x = static_cast<float>(origin.x()), r.org_y = static_cast<float>(origin.y());
  r.org_z = static_cast<float>(origin.z());
  r.dir_x = static_cast<float>(direction.x()), r.dir_y = static_cast<float>(direction.y());
  r.dir_z = static_cast<float>(direction.z());
  r.tfar = static_cast<float>(reach);
  r.mask = ~0u;
  return r;
}

}  // namespace

RayScene::RayScene(const Mesh& mesh) {
  RTCScene scene = rtcNewScene(device());
  scene_ = std::shared_ptr<void>(scene, [](void* s) { rtcReleaseScene(static_cast<RTCScene>(s)); });
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* p = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                        3 * sizeof(float), mesh.positions.size()));
  auto* t = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                           3 * sizeof(unsigned), mesh.triangles.size()));
  if ((!p && !mesh.positions.empty()) || (!t && !mesh.triangles.empty())) throw std::bad_alloc();
  for (const Vec3& position : mesh.positions)
    for (int i = 0; i < 3; ++i) *p++ = static_cast<float>(position[i]);
  for (const Triangle& triangle : mesh.triangles)
    for (const int corner : triangle) *t++ = static_cast<unsigned>(corner);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
}

int RayScene::first_hit(const Vec3& origin, const Vec3& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray = ray(origin, direction, std::numeric_limits<float>::infinity());
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_of(scene_), &context, &query);
  return query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? -1 : static_cast<int>(query.hit.primID);
}

bool RayScene::clear(const Vec3& origin, const Vec3& direction, double reach) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay query = ray(origin, direction, reach);
  rtcOccluded1(scene_of(scene_), &context, &query);
  return query.tfar >= 0;
}

}  // namespace carve
