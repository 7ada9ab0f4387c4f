// Typed settings of a scene, read from its description.
#pragma once

#include <optional>
#include <string>

#include "renderer/params/node.h"
#include "renderer/sampling/sampler.h"

namespace brume {

/// Which densities the distances of light samples are drawn from.
enum class DistanceSampling { Density, Equiangular, Mis, Product };

enum class MisHeuristic { Balance, Power };

enum class LightSelection {
  All,  ///< every light gets light_samples shadow rays
  One,  ///< every shadow ray picks one light, all with the same probability
};

struct RenderSettings {
  std::string integrator;
  DistanceSampling distance_sampling;
  MisHeuristic mis_heuristic;
  std::optional<float> step_size;         ///< world units; none: the finest scale of the media
  std::optional<float> shadow_step_size;  ///< world units; none: the step size
  int bounces;
  std::optional<int> light_samples;  ///< none: as many as balance the march
  LightSelection light_selection;
  bool russian_roulette;
  int shadow_map_resolution;
  int majorant_cells;  ///< along the longest side of the scene; 1: one majorant for all of it
  SamplerKind sampler;
  std::uint64_t seed;
  float time;  ///< seconds
};

struct FilmSettings {
  int width, height;
};

/// The parameters that integrators of the decoupled kind share; an integrator's table is made of what it uses.
std::vector<Param> march_params();           ///< step_size, shadow_step_size
std::vector<Param> sampling_params();        ///< distance_sampling, mis_heuristic
std::vector<Param> light_params();           ///< light_samples, light_selection
std::vector<Param> balanced_light_params();  ///< the same, with as many samples as balance the march by default
std::vector<Param> majorant_params();        ///< majorant_cells
std::vector<Param> shadow_map_params();      ///< shadow_map_resolution
std::vector<Param> path_params();            ///< bounces, russian_roulette
std::vector<Param> random_params();          ///< sampler, seed, time

/// @param node  of an integrator's table; parameters that it does not have get the value that means "none"
RenderSettings read_render_settings(const Node& node);

const Family& film_family();
FilmSettings read_film_settings(const Node& node);

}  // namespace brume
