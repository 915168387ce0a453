// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <vector>

#include "zoneplate/ray/casters_for_test.h"

namespace zoneplate {

/// Rays in packets of 16, as Embree reads and changes them. The last ray fills up the last packet.
inline std::vector<RTCRayHit16> embree_packets(std::span<const Ray> rays) {
  std::vector<RTCRayHit16> packets((rays.size() + 15) / 16);
  for (std::size_t i = 0; i < 16 * packets.size(); ++i) {
    const Ray& ray = rays[std::min(i, rays.size() - 1)];
    RTCRay16& out = packets[i / 16].ray;
    const std::size_t k = i % 16;
    out.org_x[k] = ray.origin[0], out.org_y[k] = ray.origin[1], out.org_z[k] = ray.origin[2];
    out.dir_x[k] = ray.direction[0], out.dir_y[k] = ray.direction[1], out.dir_z[k] = ray.direction[2];
    out.tnear[k] = out.time[k] = 0, out.tfar[k] = ray.end;
    out.mask[k] = ~0u, out.id[k] = out.flags[k] = 0;
    packets[i / 16].hit.geomID[k] = packets[i / 16].hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
  }
  return packets;
}

/// A mesh in Embree, in its robust mode, on one thread.
class EmbreeScene {
 public:
  explicit EmbreeScene(const TestMesh& mesh) : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(float3),
                                             mesh.position.size());
    std::memcpy(vertices, mesh.position.data(), mesh.position.size() * sizeof(float3));
    void* indices =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.index.size() / 3);
    std::memcpy(indices, mesh.index.data(), mesh.index.size() * sizeof(std::uint32_t));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeScene() { rtcReleaseScene(scene_), rtcReleaseDevice(device_); }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  bool is_visible(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay out = ray_of(ray);
    rtcOccluded1(scene_, &context, &out);
    return out.tfar >= 0;
  }
  RayHit nearest(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit out{};
    out.ray = ray_of(ray);
    out.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &out);
    if (out.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {0, out.hit.primID, out.ray.tfar, out.hit.u, out.hit.v};
  }

  /// Sets tfar below 0 for the rays that meet a triangle. Coherent: rays take similar ways.
  void occlude(RTCRay16& rays, bool is_coherent) const {
    RTCIntersectContext context = context_of(is_coherent);
    rtcOccluded16(all_16, scene_, &context, &rays);
  }
  void intersect(RTCRayHit16& rays, bool is_coherent) const {
    RTCIntersectContext context = context_of(is_coherent);
    rtcIntersect16(all_16, scene_, &context, &rays);
  }

 private:
  alignas(64) static constexpr int all_16[16] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};

  static RTCIntersectContext context_of(bool is_coherent) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (is_coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return context;
  }
  static RTCRay ray_of(const Ray& ray) {
    RTCRay out{};
    out.org_x = ray.origin[0], out.org_y = ray.origin[1], out.org_z = ray.origin[2];
    out.dir_x = ray.direction[0], out.dir_y = ray.direction[1], out.dir_z = ray.direction[2];
    out.tfar = ray.end, out.mask = ~0u;
    return out;
  }

  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace zoneplate
