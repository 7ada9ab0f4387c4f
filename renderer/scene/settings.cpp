#include "renderer/scene/settings.h"

namespace brume {

std::vector<Param> march_params() {
  return {param::number("step_size", "Step size", 0.03)
              .more_than(0)
              .log_slider(0.001, 1)
              .in("world units")
              .auto_by_default("the smallest voxel or feature of the media")
              .says("Length of a march's segments on camera and scattered rays: short is right, long is fast."),
          param::number("shadow_step_size", "Shadow step", 0.03)
              .more_than(0)
              .log_slider(0.001, 1)
              .in("world units")
              .auto_by_default("the step size")
              .says("Length of the steps towards lights; longer than the step size lets light leak.")};
}

std::vector<Param> sampling_params() {
  return {param::choice(
              "distance_sampling", "Distance sampling", "product",
              {{"density", "Density", "in proportion to what the medium scatters: best for dense media and far lights"},
               {"equi_angular", "Equi-angular",
                "in proportion to 1/r^2 from the light: best for thin media and near lights"},
               {"mis", "MIS", "both, combined by multiple importance sampling"},
               {"product", "Product", "in proportion to both at once and to the phase function: the least noise"}})
              .says("How the distance of a light sample along the ray is drawn."),
          param::choice(
              "mis_heuristic", "MIS heuristic", "power",
              {{"power", "Power", "squares the densities"}, {"balance", "Balance", "takes the densities as they are"}})
              .says("How the two techniques are weighted in MIS.")};
}

namespace {

Param light_samples() { return param::integer("light_samples", "Light samples", 1).between(1, 256).slider(1, 16); }

Param light_selection() {
  return param::choice(
             "light_selection", "Light selection", "all",
             {{"all", "All", "every light gets its light samples"},
              {"one", "One", "every ray picks one light: in product sampling by what it may give, else all alike"}})
      .says("Which lights a ray is lit by.");
}

}  // namespace

std::vector<Param> light_params() {
  return {light_samples().says("Shadow rays for each light wherever light is sampled."), light_selection()};
}

std::vector<Param> balanced_light_params() {
  return {light_samples()
              .auto_by_default("on the camera's rays as many as balance the cost of their march, on scattered rays one")
              .says("Shadow rays per ray and light; in MIS half go to each technique, and of an odd number one "
                    "alternates between passes."),
          light_selection()};
}

std::vector<Param> majorant_params() {
  return {
      param::integer("majorant_cells", "Majorant cells", 32)
          .between(1, 256)
          .slider(1, 64)
          .says("Cells along the longest side, each with its own upper bound of the extinction; 1 is one for all.")};
}

std::vector<Param> shadow_map_params() {
  return {param::integer("shadow_map_resolution", "Shadow map", 64)
              .between(2, 256)
              .slider(16, 256)
              .says("Rays along each side of a light's map and values along each ray; memory grows with its cube.")};
}

std::vector<Param> path_params() {
  return {
      param::integer("bounces", "Bounces", 0)
          .between(0, 100000)
          .slider(0, 16)
          .says("Scattered rays traced per camera ray; 0 is single scattering, B gives orders 1 to B + 1 of the light "
                "of lamps."),
      param::flag("russian_roulette", "Russian roulette", true)
          .says("Ends faint paths early, from the third bounce on, and where shadow rays are marched leaves out those "
                "to lights too faint to see, without changing the mean.")};
}

std::vector<Param> random_params() {
  return {
      param::choice("sampler", "Sampler", "sobol",
                    {{"sobol", "Sobol'", "Owen-scrambled low-discrepancy points: less noise after the same passes"},
                     {"independent", "Independent", "independent random numbers: what statistics assume"}})
          .says("Where random numbers come from."),
      param::integer("seed", "Seed", 0).between(0, 4294967295.0).slider(0, 100).says("Another seed gives other noise."),
      param::number("time", "Time", 0).slider(0, 10).in("seconds").says("The moment at which the scene is rendered.")};
}

namespace {

/// The value of a parameter, or `none` where the integrator has no such parameter.
template <class T, class Read> T value_or(const Node& node, const char* key, T none, Read read) {
  return node.table().find(key) ? read(node) : none;
}

}  // namespace

RenderSettings read_render_settings(const Node& node) {
  RenderSettings s;
  s.integrator = node.kind();
  s.distance_sampling = value_or(node, "distance_sampling", DistanceSampling::Density, [](const Node& n) {
    const std::string& key = n.text("distance_sampling");
    return key == "mis"       ? DistanceSampling::Mis
           : key == "density" ? DistanceSampling::Density
           : key == "product" ? DistanceSampling::Product
                              : DistanceSampling::Equiangular;
  });
  s.mis_heuristic = value_or(node, "mis_heuristic", MisHeuristic::Power, [](const Node& n) {
    return n.text("mis_heuristic") == "power" ? MisHeuristic::Power : MisHeuristic::Balance;
  });
  const auto length_or_auto = [](const char* key) {
    return [key](const Node& n) {
      return n.is_auto(key) ? std::optional<float>() : std::optional<float>(static_cast<float>(n.number(key)));
    };
  };
  s.step_size = value_or(node, "step_size", std::optional<float>(), length_or_auto("step_size"));
  s.shadow_step_size = value_or(node, "shadow_step_size", std::optional<float>(), length_or_auto("shadow_step_size"));
  s.bounces = value_or(node, "bounces", 0, [](const Node& n) { return n.integer("bounces"); });
  s.light_samples = value_or(node, "light_samples", std::optional<int>(1), [](const Node& n) {
    return n.is_auto("light_samples") ? std::optional<int>() : std::optional<int>(n.integer("light_samples"));
  });
  s.light_selection = value_or(node, "light_selection", LightSelection::All, [](const Node& n) {
    return n.text("light_selection") == "all" ? LightSelection::All : LightSelection::One;
  });
  s.shadow_map_resolution =
      value_or(node, "shadow_map_resolution", 64, [](const Node& n) { return n.integer("shadow_map_resolution"); });
  s.majorant_cells = value_or(node, "majorant_cells", 1, [](const Node& n) { return n.integer("majorant_cells"); });
  s.russian_roulette =
      value_or(node, "russian_roulette", false, [](const Node& n) { return n.flag("russian_roulette"); });
  s.sampler = node.text("sampler") == "sobol" ? SamplerKind::Sobol : SamplerKind::Independent;
  s.seed = static_cast<std::uint64_t>(std::get<std::int64_t>(node.value("seed")));
  s.time = static_cast<float>(node.number("time"));
  return s;
}

const Family& film_family() {
  static const ParamTable table{
      "film",
      "Film",
      "The size of the picture and how it is shown.",
      {param::resolution("resolution", "Resolution", 640, 480)
           .between(1, 16384)
           .in("pixels")
           .says("Width and height of the picture that is rendered and saved; the window renders at its own size."),
       param::number("exposure", "Exposure", 0)
           .between(-20, 20)
           .slider(-8, 8)
           .in("stops")
           .costs(Affects::Display)
           .says("Brightness at display: each stop doubles it."),
       param::choice("curve", "Curve", "srgb",
                     {{"srgb", "sRGB", "the sRGB transfer curve; clips at 1"},
                      {"gamma", "Gamma", "a plain power"},
                      {"filmic", "Filmic", "a soft shoulder that keeps bright fire and lamps from clipping"}})
           .costs(Affects::Display)
           .says("How linear values become display values."),
       param::number("gamma", "Gamma", 2.2).between(1, 4).costs(Affects::Display).says("Exponent of the gamma curve.")},
      {}};
  static const Family family{"film", "", {&table}};
  return family;
}

FilmSettings read_film_settings(const Node& node) {
  const Numbers& r = node.numbers("resolution");
  return {static_cast<int>(r[0]), static_cast<int>(r[1])};
}

}  // namespace brume
