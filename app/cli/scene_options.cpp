#include "app/cli/scene_options.h"

#include <filesystem>

namespace brume {
namespace {

/// Makes a file parameter that was just set absolute.
void resolve_file(Node& description, const std::string& key) {
  const auto ref = find_param(description, key);
  if (!ref || ref->param->type != ParamType::File) return;
  const std::filesystem::path path = ref->node->text(ref->param->key);
  if (path.empty() || path.is_absolute()) return;
  std::error_code unknown;
  const auto absolute = std::filesystem::absolute(path, unknown);
  // A path cannot be refused where another path was accepted.
  if (!unknown) static_cast<void>(ref->node->set(ref->param->key, absolute.lexically_normal().string()).ok());
}

}  // namespace

Result<FlagSetting> parse_setting(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    return bad_input("found \"" + text + "\", expected key=value, for example --set render.bounces=2",
                     {"", 0, 0, "--set"});
  const std::string key = text.substr(0, equals);
  return FlagSetting{"--set " + key, key, text.substr(equals + 1)};
}

Result<void> apply_setting(Node& description, const FlagSetting& setting) {
  if (auto done = set_by_path(description, setting.key, setting.text); !done)
    return bad_input(done.error().message, {"", 0, 0, setting.flag});
  resolve_file(description, setting.key);
  return {};
}

Result<LoadedScene> load_scene(const SceneOptions& options, SceneCache& cache, const LoadOptions& load_options) {
  auto scene = load_scene(options.file, cache, load_options);
  if (!scene) return scene;
  for (const FlagSetting& setting : options.settings)
    if (auto done = apply_setting(scene->description, setting); !done) return done.error();
  return scene;
}

}  // namespace brume
