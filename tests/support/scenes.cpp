#include "tests/support/scenes.h"

#include <cstdio>
#include <cstdlib>

#include "renderer/lights/registry.h"
#include "renderer/scene/volume.h"
#include "renderer/scene_io/scene_file.h"
#include "renderer/surfaces/registry.h"

namespace brume {
namespace {

template <class T> T must(Result<T> result) {
  if (!result.ok()) {
    std::fprintf(stderr, "a test's scene was refused: %s\n", result.error().to_string().c_str());
    std::abort();
  }
  return std::move(result.value());
}

void must(const Result<void>& result) {
  if (result.ok()) return;
  std::fprintf(stderr, "a test's scene was refused: %s\n", result.error().to_string().c_str());
  std::abort();
}

Node& add(Node& scene, const char* list, const Family& family, const std::string& kind) {
  const ParamTable* table = family.find(kind);
  if (!table) must(Result<void>(bad_input("no such " + family.noun + ": " + kind)));
  return scene.list(list).emplace_back(*table);
}

}  // namespace

Node empty_scene() {
  Node scene(*scene_family().tables.front());
  // One sample by the talk's technique: tests that want others say so.
  set(scene, "render.distance_sampling", "mis");
  set(scene, "render.light_samples", "1");
  return scene;
}

Node shipped_scene(const std::string& name) {
  return must(read_scene_file(BRUME_SOURCE_DIR "/scenes/" + name + ".json", scene_family()));
}

void set(Node& node, const std::string& path, const std::string& text) { must(set_by_path(node, path, text)); }

Node& add_volume(Node& scene, const std::string& shader) { return add(scene, "volumes", volume_family(), shader); }
Node& add_light(Node& scene, const std::string& type) { return add(scene, "lights", light_family(), type); }

Node& add_surface(Node& scene, const std::string& type) { return add(scene, "surfaces", surface_family(), type); }

Node with_integrator(Node scene, const std::string& key) {
  const ParamTable* table = scene_family().tables.front()->find_slot("render")->family->find(key);
  if (!table) must(Result<void>(bad_input("no such integrator: " + key)));
  scene.child("render") = scene.child("render").converted_to(*table);
  return scene;
}

std::shared_ptr<const Scene> committed(const Node& description, std::uint64_t generation) {
  SceneCache cache;
  CommitOptions options;
  options.generation = generation;
  return must(commit(description, cache, options));
}

double RayEstimate::relative_deviation(int c) const { return std::sqrt(channel[c].variance()) / channel[c].mean(); }

RayEstimate estimate(const Scene& scene, const Ray& ray, int samples, int passes, std::uint32_t pixel) {
  RayEstimate out;
  Arena arena;
  const auto integrator = make_integrator(scene);
  for (int i = 0; i < samples; ++i) {
    double sum[3] = {};
    bool finite = true;
    for (int p = 0; p < passes; ++p) {
      const Sampler sampler(scene.render.sampler, scene.render.seed, pixel, static_cast<std::uint32_t>(i * passes + p));
      SampleContext context{scene, sampler, arena, out.statistics};
      const Color c = integrator->radiance(ray, context);
      finite &= is_finite(c);
      for (int k = 0; k < 3; ++k) sum[k] += static_cast<double>(c[k]);
    }
    if (!finite) {
      ++out.non_finite;
      continue;
    }
    for (int k = 0; k < 3; ++k) out.channel[k].add(sum[k] / passes);
  }
  return out;
}

double z_score(const RayEstimate& e, double expected, int channel) {
  return (e.mean(channel) - expected) / e.standard_error(channel);
}

double z_score(const RayEstimate& a, const RayEstimate& b, int channel) {
  return (a.mean(channel) - b.mean(channel)) / std::hypot(a.standard_error(channel), b.standard_error(channel));
}

}  // namespace brume
