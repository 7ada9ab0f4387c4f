// Scenes for tests, written as short as they are thought.
#pragma once

#include <memory>
#include <string>

#include "renderer/engine/engine.h"
#include "renderer/integrators/registry.h"
#include "tests/support/statistics.h"

namespace brume {

/// An empty scene description: default camera and render settings, no volume, no light.
Node empty_scene();

/// A scene that ships ("smoke"), from scenes/. One that cannot be read ends the program.
Node shipped_scene(const std::string& name);

/// Sets by path from text, as --set does ("render.bounces", "3"). A refusal ends the program: tests know their keys.
void set(Node& node, const std::string& path, const std::string& text);

/// A new volume ("homogeneous", "linear", ...) or light ("point", ...) at the end of the scene's list. The reference
/// lives until the next one is added.
Node& add_volume(Node& scene, const std::string& shader);
Node& add_light(Node& scene, const std::string& type);
Node& add_surface(Node& scene, const std::string& type);

/// The scene rendered by another integrator, which keeps the settings that both have.
Node with_integrator(Node scene, const std::string& key);

/// The committed scene; a refusal ends the program.
std::shared_ptr<const Scene> committed(const Node& description, std::uint64_t generation = 1);

/// Mean and standard error of many samples of one ray, per channel.
struct RayEstimate {
  RunningMean channel[3];
  std::uint64_t non_finite = 0;
  RayStatistics statistics;

  double mean(int c = 0) const { return channel[c].mean(); }
  double standard_error(int c = 0) const { return channel[c].standard_error(); }
  /// Standard deviation of one sample over the mean.
  double relative_deviation(int c = 0) const;
};

/// `samples` calls of the scene's integrator along `ray` (scene space), with the sampler, seed and settings of the
/// scene. Every sample is the mean of `passes` successive passes: 2 makes an honest unit of the two halves of MIS with
/// one light sample, which take turns.
RayEstimate estimate(const Scene& scene, const Ray& ray, int samples, int passes = 1, std::uint32_t pixel = 0);

/// (mean - expected) in standard errors.
double z_score(const RayEstimate& estimate, double expected, int channel = 0);

/// Difference of two independent estimates in its standard errors.
double z_score(const RayEstimate& a, const RayEstimate& b, int channel = 0);

}  // namespace brume
