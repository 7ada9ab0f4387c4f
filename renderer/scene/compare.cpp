#include "renderer/scene/compare.h"

#include <algorithm>

namespace brume {

const Family& compare_family() {
  static const ParamTable variant_table{
      "variant",
      "Variant",
      "A scene of its own: the one around it with a few other settings.",
      {param::text("name", "Name").says("What the variant is called; its letter where it has none."),
       param::flag("enabled", "Enabled", true).says("Whether it is rendered."),
       param::settings("set", "Set").says("The settings in which the variant differs from the scene.")},
      {}};
  static const Family variant_family{"variant", "", {&variant_table}};
  static const ParamTable table{
      "compare",
      "Compare",
      "Variants of the scene that are rendered side by side, each against the same true picture.",
      {param::choice("share", "Share", "equal_time",
                     {{"equal_time", "Equal time", "every variant has had the same processor time"},
                      {"equal_samples", "Equal samples", "every variant has the same samples per pixel"}})
           .costs(Affects::Display)
           .says("How the variants share the threads."),
       param::file("reference", "Reference")
           .costs(Affects::Display)
           .says("A picture (.exr) taken as the truth; none: an unbiased integrator renders it."),
       param::number("reference_time", "Reference time", 60)
           .more_than(0)
           .log_slider(1, 3600)
           .in("seconds of all threads")
           .costs(Affects::Display)
           .says("How long a reference is rendered where none is given.")},
      {{"variants", "Variants", "What is compared, at most four.", &variant_family, true}}};
  static const Family family{"comparison", "", {&table}};
  return family;
}

std::string variant_name(const Node& variant, std::size_t index) {
  const std::string& name = variant.text("name");
  return name.empty() ? std::string(1, static_cast<char>('A' + index % 26)) : name;
}

bool is_common(const std::string& path) {
  for (const char* part : {"camera.", "film.", "compare."})
    if (path.starts_with(part)) return true;
  return path == "render.seed";  // the same seed for all: they differ by what they do, not by luck
}

namespace {

Result<void> apply(const Setting& setting, Node& scene) {
  if (is_common(setting.path))
    return bad_input(
        "found a setting of what variants have in common, expected one of render (not its seed), volumes, "
        "surfaces or lights",
        {"", 0, 0, setting.path});
  return set_by_path(scene, setting.path, setting.value);
}

}  // namespace

Node without_variants(Node description) {
  description.child("compare") = Node(*compare_family().tables.front());
  return description;
}

Node with_variants_of(Node settings, const Node& scene) {
  settings.child("compare") = scene.child("compare");
  return settings;
}

Result<Variant> variant_of(const Node& description, std::size_t variant) {
  const Node& node = description.child("compare").list("variants")[variant];
  const std::string& name = node.text("name");
  Variant made{variant_name(node, variant), without_variants(description)};
  for (const Setting& setting : node.settings("set"))
    if (const auto done = apply(setting, made.description); !done)
      return under("compare.variants." + (name.empty() ? std::to_string(variant) : name) + ".set", done.error());
  return made;
}

Result<std::vector<Variant>> variants_of(const Node& description) {
  const auto nodes = description.child("compare").list("variants");
  if (nodes.size() > kMaxVariants)
    return bad_input(
        "found " + std::to_string(nodes.size()) + " variants, expected at most " + std::to_string(kMaxVariants),
        {"", 0, 0, "compare.variants"});
  std::vector<Variant> variants;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].flag("enabled")) continue;
    auto variant = variant_of(description, i);
    if (!variant) return variant.error();
    variants.push_back(std::move(*variant));
  }
  if (!variants.empty()) return variants;
  return std::vector<Variant>{{"scene", without_variants(description)}};
}

namespace {

Node& variant_node(Node& description, std::size_t variant) {
  return description.child("compare").list("variants")[variant];
}

}  // namespace

void set_in_variant(Node& description, std::size_t variant, const std::string& path, const std::string& value) {
  Node& node = variant_node(description, variant);
  Settings settings = node.settings("set");
  const auto found = std::find_if(settings.begin(), settings.end(), [&](const Setting& s) { return s.path == path; });
  if (found != settings.end())
    found->value = value;
  else
    settings.push_back({path, value});
  static_cast<void>(node.set("set", std::move(settings)).ok());
}

void unset_in_variant(Node& description, std::size_t variant, const std::string& path) {
  Node& node = variant_node(description, variant);
  Settings settings = node.settings("set");
  std::erase_if(settings, [&](const Setting& s) { return s.path == path; });
  static_cast<void>(node.set("set", std::move(settings)).ok());
}

void drop_refused_settings(Node& description, std::size_t variant) {
  Node scene = without_variants(description);
  Node& node = variant_node(description, variant);
  Settings settings = node.settings("set");
  std::erase_if(settings, [&](const Setting& s) { return !apply(s, scene).ok(); });
  static_cast<void>(node.set("set", std::move(settings)).ok());
}

void rename_in_variants(Node& description, const std::string& from, const std::string& to) {
  for (Node& node : description.child("compare").list("variants")) {
    Settings settings = node.settings("set");
    for (Setting& s : settings)
      if (s.path.starts_with(from + ".")) s.path = to + s.path.substr(from.size());
    static_cast<void>(node.set("set", std::move(settings)).ok());
  }
}

}  // namespace brume
