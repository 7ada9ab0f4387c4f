#include "app/cli/scene_info.h"

#include <nlohmann/json.hpp>

#include "app/cli/text_table.h"
#include "renderer/integrators/registry.h"
#include "renderer/scene/volume.h"
#include "renderer/scene_io/write_node.h"

namespace brume {
namespace {

using Json = nlohmann::ordered_json;
using Rows = std::vector<std::vector<std::string>>;

enum class Values {
  All,
  Changed,  ///< those that are not the default
};

/// "phase.g 0.2". The name of a node and whether it is on are shown elsewhere.
void add_values(const Node& node, const std::string& prefix, Values which, std::vector<std::string>& out) {
  for (const Param& p : node.table().params) {
    if (p.key == "name" || p.key == "enabled") continue;
    if (which == Values::Changed && node.value(p.key) == p.default_value) continue;
    out.push_back(prefix + p.key + " " + format_value(node.value(p.key)));
  }
  for (const Slot& slot : node.table().slots) {
    if (slot.list) continue;
    const Node& child = node.child(slot.key);
    if (&child.table() != slot.family->tables.front())
      out.push_back(prefix + slot.key + "." + slot.family->type_key + " " + child.kind());
    add_values(child, prefix + slot.key + ".", which, out);
  }
}

std::string values_text(const Node& node, Values which) {
  std::vector<std::string> values;
  add_values(node, "", which, values);
  return values.empty() ? "all defaults" : join(values);
}

std::string name_of(const Node& node, std::size_t index) {
  const std::string& name = node.text("name");
  return (name.empty() ? std::to_string(index) : name) + (node.flag("enabled") ? "" : " (off)");
}

std::string vector_text(Vec3d v) {
  return "[" + short_number(v.x) + ", " + short_number(v.y) + ", " + short_number(v.z) + "]";
}

std::string bounds_text(const Bounds3& b) {
  return b.empty() ? "-" : vector_text(b.low) + " .. " + vector_text(b.high);
}

std::string steps_text(const Scene& scene) {
  if (!scene.needs.lookups && !scene.needs.product) return "none: rays cross homogeneous media in one segment";
  return short_number(scene.step_size) + (scene.render.step_size ? "" : " (auto)") + ", towards lights " +
         short_number(scene.shadow_step_size) + (scene.render.shadow_step_size ? "" : " (auto)") + " world units";
}

Json bounds_json(const Bounds3& b) {
  if (b.empty()) return Json();
  return {{"min", {b.low.x, b.low.y, b.low.z}}, {"max", {b.high.x, b.high.y, b.high.z}}};
}

Json needs_json(const SceneNeeds& n) {
  return {{"text", n.to_string()},  {"channels", n.channels}, {"emission", n.emission},       {"overlap", n.overlap},
          {"lookups", n.lookups},   {"baked", n.baked},       {"equiangular", n.equiangular}, {"product", n.product},
          {"surfaces", n.surfaces}, {"time", n.time}};
}

}  // namespace

Result<SceneInfo> examine_scene(const LoadedScene& loaded, SceneCache& cache) {
  const auto scene = commit_loaded(loaded, cache);
  if (!scene) return scene.error();
  SceneInfo info{loaded, *scene, {}};
  for (const Node& volume : loaded.description.list("volumes")) {
    Bounds3 bounds;
    if (volume.flag("enabled"))
      if (const auto made = make_volume(volume, {}, cache, {})) bounds = made->bounds;
    info.volume_bounds.push_back(bounds);
  }
  return info;
}

std::string scene_as_text(const SceneInfo& info) {
  const Node& d = info.loaded.description;
  const Scene& scene = *info.scene;
  std::string text = info.loaded.file + "\n\n";
  Rows rows{{"camera", values_text(d.child("camera"), Values::All)},
            {"film", values_text(d.child("film"), Values::All)},
            {"render", scene.render.integrator + "; " + values_text(d.child("render"), Values::Changed)},
            {"step", steps_text(scene)},
            {"needs", scene.needs.to_string()}};
  text += format_table(rows, "ll", 2);

  const auto volumes = d.list("volumes");
  text += "\nvolumes: " + std::to_string(volumes.size()) + "\n";
  rows.clear();
  for (std::size_t i = 0; i < volumes.size(); ++i)
    rows.push_back({name_of(volumes[i], i), volumes[i].kind(), bounds_text(info.volume_bounds[i]),
                    values_text(volumes[i], Values::Changed)});
  text += format_table(rows, "llll", 2);

  for (const char* list : {"surfaces", "lights"}) {
    const auto nodes = d.list(list);
    text += "\n" + std::string(list) + ": " + std::to_string(nodes.size()) + "\n";
    rows.clear();
    for (std::size_t i = 0; i < nodes.size(); ++i)
      rows.push_back({name_of(nodes[i], i), nodes[i].kind(), values_text(nodes[i], Values::All)});
    text += format_table(rows, "lll", 2);
  }

  for (const std::string& note : info.loaded.notes) text += "\nnote: " + note;
  for (const std::string& warning : scene.warnings) text += "\nwarning: " + warning;
  if (!info.loaded.notes.empty() || !scene.warnings.empty()) text += "\n";
  return text;
}

std::string scene_as_json(const SceneInfo& info) {
  const Scene& scene = *info.scene;
  Json json;
  json["file"] = info.loaded.file;
  json["description"] =
      Json::parse(write_node(info.loaded.description, scene_family(), {.target_dir = "", .all = true}));
  Json& resolved = json["resolved"];
  resolved["step_size"] = scene.step_size;
  resolved["shadow_step_size"] = scene.shadow_step_size;
  resolved["needs"] = needs_json(scene.needs);
  resolved["volumes"] = Json::array();
  const auto volumes = info.loaded.description.list("volumes");
  for (std::size_t i = 0; i < volumes.size(); ++i)
    resolved["volumes"].push_back({{"name", volumes[i].text("name")},
                                   {"enabled", volumes[i].flag("enabled")},
                                   {"bounds", bounds_json(info.volume_bounds[i])}});
  resolved["enabled_lights"] = scene.lights.size();
  json["notes"] = info.loaded.notes;
  json["warnings"] = scene.warnings;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace brume
