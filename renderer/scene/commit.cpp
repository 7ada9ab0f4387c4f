#include <algorithm>

#include "renderer/lights/registry.h"
#include "renderer/lights/surface_light.h"
#include "renderer/phase/registry.h"
#include "renderer/scene/compare.h"
#include "renderer/scene/light_budget.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/volume.h"

namespace brume {

ParamTable scene_table(const Family& render_family) {
  return {"scene",
          "Scene",
          "Everything that a picture depends on.",
          {},
          {{"camera", "Camera", "Where the picture is taken from.", &camera_family()},
           {"film", "Film", "The size of the picture and how it is shown.", &film_family()},
           {"render", "Render", "How light is computed.", &render_family},
           {"volumes", "Volumes", "Smoke, fire, cloud and fog.", &volume_family(), true},
           {"surfaces", "Surfaces", "What stands among the volumes and stops light.", &surface_family(), true},
           {"lights", "Lights", "What lights the volumes.", &light_family(), true},
           {"compare", "Compare", "Variants of the scene that are rendered side by side.", &compare_family()}}};
}

namespace {

/// "volumes.plume" or "volumes.0"
std::string element_path(const char* list, std::size_t index, const Node& node) {
  const std::string& name = node.text("name");
  return std::string(list) + "." + (name.empty() ? std::to_string(index) : name);
}

using Volumes = std::vector<MadeVolume>;

Result<Volumes> make_volumes(const Node& description, Vec3d origin, SceneCache& cache, const LoadOptions& options) {
  Volumes volumes;
  const auto nodes = description.list("volumes");
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].flag("enabled")) continue;
    auto volume = make_volume(nodes[i], origin, cache, options);
    if (!volume) return under(element_path("volumes", i, nodes[i]), volume.error());
    volumes.push_back(std::move(*volume));
  }
  return volumes;
}

Bounds3 bounds_of(const Volumes& volumes) {
  Bounds3 all;
  for (const MadeVolume& v : volumes) all.add(v.bounds);
  return all;
}

/// A surface that shines is a light too; the camera sees it as a surface.
std::unique_ptr<Light> light_of(const MadeSurface& made) {
  if (!made.material.emits()) return nullptr;
  auto sampling = made.surface->sampling();
  if (!sampling) return nullptr;
  return std::make_unique<SurfaceLight>(made.surface, std::move(sampling), made.material.radiance,
                                        made.material.two_sided, SurfaceLight::Hiding::ByScene);
}

/// The enabled surfaces, and the lights that some of them are.
Result<void> add_surfaces(const Node& description, SceneCache& cache, Scene& scene) {
  std::vector<MadeSurface> surfaces;
  const auto nodes = description.list("surfaces");
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].flag("enabled")) continue;
    auto made = make_surface(nodes[i], scene.origin, cache.meshes);
    if (!made) return under(element_path("surfaces", i, nodes[i]), made.error());
    if (auto light = light_of(*made)) scene.lights.push_back(std::move(light));
    if (!is_grey(made->material.albedo)) scene.needs.channels = 3;
    surfaces.push_back(std::move(*made));
  }
  if (surfaces.empty()) return {};
  auto all = Surfaces::make(surfaces);
  if (!all) return all.error();
  scene.surfaces = std::move(*all);
  return {};
}

SceneNeeds needs_of(const Scene& scene) {
  SceneNeeds needs = scene.needs;
  needs.surfaces = scene.surfaces != nullptr;
  for (const Medium& m : scene.media) {
    if (!is_grey(m.sigma_t) || !is_grey(m.sigma_s)) needs.channels = 3;
    needs.emission |= m.emits();
    needs.lookups |= !m.traits.constant;
    needs.baked |= m.traits.baked;
  }
  needs.overlap = scene.media.size() > 1;
  for (const auto& light : scene.lights)
    needs.equiangular |= light->sample_point({0.5f, 0.5f}).kind == LightPoint::Kind::Finite;
  for (const auto& light : scene.lights)
    needs.large_lights |= is_large(light->largest_solid_angle(scene.bounds), scene.phase_peak);
  needs.product = needs.equiangular && scene.render.distance_sampling == DistanceSampling::Product;
  return needs;
}

/// Point lights inside the media or as near to them as a twentieth of their size.
std::vector<const Light*> lamps_inside(const Scene& scene) {
  std::vector<const Light*> lamps;
  if (scene.bounds.empty()) return lamps;
  const Vec3d margin(0.05 * scene.bounds.diagonal());
  const Vec3d low = scene.bounds.low - margin, high = scene.bounds.high + margin;
  for (const auto& light : scene.lights) {
    const LightPoint point = light->sample_point({0.5f, 0.5f});
    const Vec3d p(point.position);
    const bool inside = min(p, low) == low && max(p, high) == high;
    if (point.kind == LightPoint::Kind::Finite && light->solid_angle(point.position) == 0 && inside &&
        lamps.size() < Scene::kMaxLampsInside)
      lamps.push_back(light.get());
  }
  return lamps;
}

/// The finest scale of the media; any number where no medium is marched.
float automatic_step(const Scene& scene) {
  float step = std::numeric_limits<float>::infinity();
  for (const Medium& m : scene.media)
    if (m.traits.finest_scale) step = std::min(step, *m.traits.finest_scale);
  if (std::isfinite(step)) return step;
  return scene.bounds.empty() ? 1.0f : static_cast<float>(scene.bounds.diagonal() / 100);
}

}  // namespace

Result<std::shared_ptr<const Scene>> commit(const Node& description, SceneCache& cache, const CommitOptions& options) {
  if (const auto variants = variants_of(description); !variants) return variants.error();
  const LoadOptions load{.progress = options.progress, .cancel = options.cancel};
  auto scene = std::make_shared<Scene>();
  scene->generation = options.generation;
  scene->film = read_film_settings(description.child("film"));
  scene->render = read_render_settings(description.child("render"));

  auto volumes = make_volumes(description, {}, cache, load);
  if (!volumes) return volumes.error();
  scene->bounds = bounds_of(*volumes);
  // Near the world's origin coordinates stay as written.
  if (!scene->bounds.empty() && length(scene->bounds.center()) > 16 * scene->bounds.diagonal()) {
    scene->origin = scene->bounds.center();
    volumes = make_volumes(description, scene->origin, cache, load);
    if (!volumes) return volumes.error();
    scene->bounds = bounds_of(*volumes);
  }
  for (MadeVolume& v : *volumes) {
    scene->media.push_back(std::move(v.medium));
    scene->phases.push_back(std::move(v.phase));
    scene->warnings.insert(scene->warnings.end(), v.warnings.begin(), v.warnings.end());
  }

  const auto lights = description.list("lights");
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (!lights[i].flag("enabled")) continue;
    auto made = make_light(lights[i], {scene->origin, cache.pictures, cache.meshes});
    if (!made) return under(element_path("lights", i, lights[i]), made.error());
    scene->lights.push_back(std::move(made->light));
    scene->warnings.insert(scene->warnings.end(), made->warnings.begin(), made->warnings.end());
  }

  if (const auto added = add_surfaces(description, cache, *scene); !added) return added.error();

  auto camera = make_camera(description.child("camera"), scene->origin);
  if (!camera) return under("camera", camera.error());
  scene->camera = *camera;

  for (const auto& phase : scene->phases)
    scene->phase_peak = std::max({scene->phase_peak, phase->value(1), phase->value(-1)});
  scene->lamps_inside = lamps_inside(*scene);
  scene->majorants = Majorants(scene->media, scene->bounds, scene->render.majorant_cells);
  scene->needs = needs_of(*scene);
  scene->step_size = scene->render.step_size.value_or(automatic_step(*scene));
  scene->shadow_step_size = scene->render.shadow_step_size.value_or(scene->step_size);
  scene->light_samples = scene->render.light_samples.value_or(balanced_light_samples(*scene));
  return std::shared_ptr<const Scene>(std::move(scene));
}

std::string SceneNeeds::to_string() const {
  std::string text = channels == 1 ? "grey" : "chromatic";
  text += lookups ? ", heterogeneous" : ", homogeneous";
  if (baked) text += ", baked";
  if (overlap) text += ", overlapping";
  if (emission) text += ", glowing";
  if (large_lights) text += ", large lights";
  text += time ? ", moving" : ", static";
  text += surfaces ? ", surfaces (Embree)" : ", no surfaces";
  return text;
}

}  // namespace brume
