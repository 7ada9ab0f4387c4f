#include "renderer/geometry/ray_scene.h"

#if BRUME_EMBREE_VERSION >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>

#include "renderer/geometry/surface.h"

namespace brume {
namespace {

// What differs between Embree 3 and 4: how the context of a query is handed in.
#if BRUME_EMBREE_VERSION >= 4
using QueryContext = RTCRayQueryContext;
constexpr RTCSceneFlags kFilterFlag = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;

void intersect1(RTCScene scene, RTCRayHit& hit) { rtcIntersect1(scene, &hit); }
void occluded1(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray); }
void intersect_all(RTCScene scene, RTCRayHit& hit, QueryContext& context, RTCFilterFunctionN filter) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  rtcInitRayQueryContext(&context);
  arguments.context = &context;
  arguments.filter = filter;
  arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  rtcIntersect1(scene, &hit, &arguments);
}
#else
using QueryContext = RTCIntersectContext;
constexpr RTCSceneFlags kFilterFlag = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;

void intersect1(RTCScene scene, RTCRayHit& hit) {
  QueryContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &hit);
}
void occluded1(RTCScene scene, RTCRay& ray) {
  QueryContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
}
void intersect_all(RTCScene scene, RTCRayHit& hit, QueryContext& context, RTCFilterFunctionN filter) {
  rtcInitIntersectContext(&context);
  context.filter = filter;
  rtcIntersect1(scene, &context, &hit);
}
#endif

RTCRay to_embree(const Ray& ray) {
  RTCRay out{};
  out.org_x = ray.origin.x, out.org_y = ray.origin.y, out.org_z = ray.origin.z;
  out.dir_x = ray.direction.x, out.dir_y = ray.direction.y, out.dir_z = ray.direction.z;
  out.tnear = ray.span.begin, out.tfar = ray.span.end;
  out.mask = 0xFFFFFFFFu;  // Debian builds Embree with ray masks on
  return out;
}

RTCRayHit query(const Ray& ray) {
  RTCRayHit hit{};
  hit.ray = to_embree(ray);
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return hit;
}

Ray from_embree(const RTCRay& ray) {
  return {{ray.org_x, ray.org_y, ray.org_z}, {ray.dir_x, ray.dir_y, ray.dir_z}, {ray.tnear, ray.tfar}};
}

// ---- Surfaces as Embree's user geometry: single rays only, so that N is always 1 ------------------------------------

const Surface& surface(void* all, unsigned index) {
  return **(static_cast<const std::shared_ptr<const Surface>*>(all) + index);
}

void surface_bounds(const RTCBoundsFunctionArguments* a) {
  const Bounds3 b = surface(a->geometryUserPtr, a->primID).bounds();
  // Rounded outwards by a little more than a float's precision.
  const Vec3d margin(1e-6 * (b.diagonal() + length(b.center())));
  const Vec3 low(b.low - margin), high(b.high + margin);
  *a->bounds_o = {low.x, low.y, low.z, 0, high.x, high.y, high.z, 0};
}

void surface_intersect(const RTCIntersectFunctionNArguments* a) {
  if (!a->valid[0]) return;
  auto& hit = *reinterpret_cast<RTCRayHit*>(a->rayhit);
  const auto crossing = surface(a->geometryUserPtr, a->primID).intersect(from_embree(hit.ray));
  if (!crossing) return;
  hit.ray.tfar = crossing->t;
  hit.hit.Ng_x = crossing->normal.x, hit.hit.Ng_y = crossing->normal.y, hit.hit.Ng_z = crossing->normal.z;
  hit.hit.primID = a->primID;
  hit.hit.geomID = a->geomID;
}

void surface_occluded(const RTCOccludedFunctionNArguments* a) {
  if (!a->valid[0]) return;
  auto& ray = *reinterpret_cast<RTCRay*>(a->ray);
  if (surface(a->geometryUserPtr, a->primID).occluded(from_embree(ray)))
    ray.tfar = -std::numeric_limits<float>::infinity();  // Embree's mark of a hit
}

// ---- All crossings, gathered by a filter that accepts none ----------------------------------------------------------

struct Crossings {
  QueryContext context;  // Embree hands back a pointer to this, which is also one to the whole
  std::span<MeshCrossing> found;
  std::size_t count = 0;
};

void gather(const RTCFilterFunctionNArguments* a) {
  if (a->valid[0] != -1) return;
  a->valid[0] = 0;
  auto& all = *reinterpret_cast<Crossings*>(a->context);
  const auto& ray = *reinterpret_cast<const RTCRay*>(a->ray);
  const auto& hit = *reinterpret_cast<const RTCHit*>(a->hit);
  const float along = hit.Ng_x * ray.dir_x + hit.Ng_y * ray.dir_y + hit.Ng_z * ray.dir_z;
  if (all.count < all.found.size()) all.found[all.count] = {ray.tfar, along < 0};
  ++all.count;
}

/// Two triangles that share an edge may both be hit there.
std::span<const MeshCrossing> without_repetitions(std::span<MeshCrossing> sorted) {
  std::size_t kept = 0;
  for (const MeshCrossing& c : sorted) {
    const bool again =
        kept > 0 && sorted[kept - 1].entering == c.entering && c.t - sorted[kept - 1].t <= 1e-6f * std::abs(c.t);
    if (!again) sorted[kept++] = c;
  }
  return sorted.first(kept);
}

}  // namespace

struct RayScene::State {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<std::shared_ptr<const Surface>> surfaces;

  State() : device(rtcNewDevice(nullptr)) {
    if (!device) return;
    scene = rtcNewScene(device);
    // Robust: no ray slips through the edge between two triangles.
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | kFilterFlag);
  }
  ~State() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }

  void attach(RTCGeometry geometry) const {
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }

  static Result<std::shared_ptr<const RayScene>> commit(std::unique_ptr<State> state) {
    rtcCommitScene(state->scene);
    if (rtcGetDeviceError(state->device) != RTC_ERROR_NONE)
      return Error{ErrorCode::Internal, "Embree could not build its acceleration structure: out of memory?", {}};
    return std::shared_ptr<const RayScene>(new RayScene(std::move(state)));
  }
};

RayScene::RayScene(std::unique_ptr<State> state) : state_(std::move(state)) {}
RayScene::~RayScene() = default;

Result<std::shared_ptr<const RayScene>> RayScene::of(const TriangleMesh& mesh) {
  auto state = std::make_unique<State>();
  if (!state->device) return Error{ErrorCode::Internal, "Embree could not be started", {}};
  const RTCGeometry geometry = rtcNewGeometry(state->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               sizeof(Vec3), mesh.vertices.size()));
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
  if (vertices)
    for (const Vec3 v : mesh.vertices) *vertices++ = v.x, *vertices++ = v.y, *vertices++ = v.z;
  if (indices)
    for (const auto& triangle : mesh.triangles) indices = std::copy(triangle.begin(), triangle.end(), indices);
  state->attach(geometry);
  return State::commit(std::move(state));
}

Result<std::shared_ptr<const RayScene>> RayScene::of(std::vector<std::shared_ptr<const Surface>> surfaces) {
  auto state = std::make_unique<State>();
  if (!state->device) return Error{ErrorCode::Internal, "Embree could not be started", {}};
  state->surfaces = std::move(surfaces);
  const RTCGeometry geometry = rtcNewGeometry(state->device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(state->surfaces.size()));
  rtcSetGeometryUserData(geometry, state->surfaces.data());
  rtcSetGeometryBoundsFunction(
      geometry, [](const RTCBoundsFunctionArguments* a) { surface_bounds(a); }, nullptr);
  rtcSetGeometryIntersectFunction(geometry, surface_intersect);
  rtcSetGeometryOccludedFunction(geometry, surface_occluded);
  state->attach(geometry);
  return State::commit(std::move(state));
}

std::optional<RayHit> RayScene::intersect(const Ray& ray) const {
  RTCRayHit hit = query(ray);
  intersect1(state_->scene, hit);
  if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return RayHit{hit.ray.tfar, normalize(Vec3(hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z)), hit.hit.primID};
}

bool RayScene::occluded(const Ray& ray) const {
  RTCRay shadow = to_embree(ray);
  occluded1(state_->scene, shadow);
  return shadow.tfar < 0;
}

std::span<const MeshCrossing> RayScene::crossings(const Ray& ray, Arena& arena) const {
  Crossings all;
  for (std::size_t room = 16;; room = all.count) {
    all.found = arena.alloc_span<MeshCrossing>(room);
    all.count = 0;
    RTCRayHit hit = query(ray);
    intersect_all(state_->scene, hit, all.context, gather);
    if (all.count <= all.found.size()) break;  // else once more, with room for all of them
  }
  const auto found = all.found.first(all.count);
  std::sort(found.begin(), found.end(), [](const MeshCrossing& a, const MeshCrossing& b) { return a.t < b.t; });
  return without_repetitions(found);
}

}  // namespace brume
