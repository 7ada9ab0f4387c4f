#include "renderer/geometry/triangle_scene.h"

#if BRUME_EMBREE_VERSION >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>

namespace brume {
namespace {

// Embree 3 asks for a context that Embree 4 has dropped; these two functions are all that differs.
void intersect1(RTCScene scene, RTCRayHit& hit) {
#if BRUME_EMBREE_VERSION >= 4
  rtcIntersect1(scene, &hit);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &hit);
#endif
}

void occluded1(RTCScene scene, RTCRay& ray) {
#if BRUME_EMBREE_VERSION >= 4
  rtcOccluded1(scene, &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
#endif
}

RTCRay to_embree(const Ray& ray) {
  RTCRay out{};
  out.org_x = ray.origin.x, out.org_y = ray.origin.y, out.org_z = ray.origin.z;
  out.dir_x = ray.direction.x, out.dir_y = ray.direction.y, out.dir_z = ray.direction.z;
  out.tnear = ray.span.begin, out.tfar = ray.span.end;
  out.mask = 0xFFFFFFFFu;  // Debian builds Embree with ray masks on
  return out;
}

}  // namespace

struct TriangleScene::State {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  ~State() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
};

TriangleScene::TriangleScene(std::unique_ptr<State> state) : state_(std::move(state)) {}
TriangleScene::~TriangleScene() = default;

Result<std::shared_ptr<const TriangleScene>> TriangleScene::make(const std::vector<TriangleMesh>& meshes) {
  auto state = std::make_unique<State>();
  state->device = rtcNewDevice(nullptr);
  if (!state->device) return Error{ErrorCode::Internal, "Embree could not be started", {}};
  state->scene = rtcNewScene(state->device);
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const TriangleMesh& mesh = meshes[m];
    const std::string name = "mesh " + std::to_string(m);
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t index : triangle)
        if (index >= mesh.vertices.size())
          return bad_input(name + ": found vertex number " + std::to_string(index) + ", expected less than " +
                           std::to_string(mesh.vertices.size()));
    if (!std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [](Vec3 v) { return is_finite(v); }))
      return bad_input(name + ": found a vertex that is not finite");
    const RTCGeometry geometry = rtcNewGeometry(state->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 sizeof(Vec3), mesh.vertices.size()));
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
    if (vertices)
      for (const Vec3 v : mesh.vertices) *vertices++ = v.x, *vertices++ = v.y, *vertices++ = v.z;
    if (indices)
      for (const auto& triangle : mesh.triangles) indices = std::copy(triangle.begin(), triangle.end(), indices);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(state->scene, geometry, static_cast<unsigned>(m));
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(state->scene);
  if (rtcGetDeviceError(state->device) != RTC_ERROR_NONE)
    return Error{ErrorCode::Internal, "Embree could not build its acceleration structure: out of memory?", {}};
  return std::shared_ptr<const TriangleScene>(new TriangleScene(std::move(state)));
}

std::optional<TriangleHit> TriangleScene::intersect(const Ray& ray) const {
  RTCRayHit hit{};
  hit.ray = to_embree(ray);
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  intersect1(state_->scene, hit);
  if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return TriangleHit{hit.ray.tfar, normalize(Vec3(hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z)), hit.hit.geomID,
                     hit.hit.primID};
}

bool TriangleScene::occluded(const Ray& ray) const {
  RTCRay query = to_embree(ray);
  occluded1(state_->scene, query);
  return query.tfar < 0;  // Embree's mark of a hit: minus infinity
}

}  // namespace brume
