#include "app/session/load_scene.h"

#include <filesystem>

#include "app/session/display.h"
#include "renderer/core/input_file.h"
#include "renderer/engine/first_look.h"
#include "renderer/film/image_io.h"
#include "renderer/integrators/registry.h"
#include "renderer/scene_io/scene_file.h"

namespace brume {
namespace {

std::string absolute(const std::string& path) {
  std::error_code unknown;
  const auto full = std::filesystem::absolute(std::filesystem::path(path), unknown);
  return unknown ? path : full.lexically_normal().string();
}

Result<LoadedScene> from_picture(const std::string& path, const Result<ImageMetadata>& metadata) {
  if (!metadata) return metadata.error();
  if (metadata->scene_json.empty())
    return bad_input("found a picture without a scene, expected one that Brume wrote", {path, 0, 0, ""});
  const std::string folder = std::filesystem::path(absolute(path)).parent_path().string();
  auto description = read_scene_text(metadata->scene_json, path, folder, scene_family());
  if (!description) return description.error();
  return LoadedScene{std::move(*description), path, "", {"scene restored from the picture " + path}};
}

template <class File> Result<ImageMetadata> metadata_of(const Result<File>& file) {
  if (!file) return file.error();
  return file->metadata;
}

}  // namespace

Result<LoadedScene> load_scene(const std::string& path, SceneCache& cache, const LoadOptions& options) {
  const std::string kind = lower_case_extension(path);
  if (kind == ".vdb" || kind == ".nvdb") {
    auto look = first_look(absolute(path), cache, options);
    if (!look) return look.error();
    return LoadedScene{std::move(look->description), path, "", std::move(look->notes)};
  }
  if (kind == ".exr") return from_picture(path, metadata_of(read_exr(path)));
  if (kind == ".png") return from_picture(path, metadata_of(read_png(path)));
  auto description = read_scene_file(path, scene_family());
  if (!description) return description.error();
  return LoadedScene{std::move(*description), path, absolute(path), {}};
}

Result<std::shared_ptr<const Scene>> commit_loaded(const LoadedScene& loaded, SceneCache& cache,
                                                   const CommitOptions& options) {
  auto scene = commit(loaded.description, cache, options);
  if (scene) return scene;
  Error error = scene.error();
  if (error.source.file.empty()) error.source.file = loaded.file;
  return error;
}

Result<void> write_picture(const std::string& path, const Picture& picture, const Node& description) {
  const std::string folder = std::filesystem::path(absolute(path)).parent_path().string();
  ImageMetadata metadata;
  auto scene_json = write_scene_text(description, folder);
  if (!scene_json) {
    Error error = scene_json.error();
    error.source.file = path;
    return error;
  }
  metadata.scene_json = std::move(*scene_json);
  metadata.extra["samples_per_pixel"] = std::to_string(picture.statistics.samples_per_pixel);
  const std::string kind = lower_case_extension(path);
  if (kind == ".exr") return write_exr(path, picture.image, metadata);
  if (kind == ".png")
    return write_png(path, to_display(picture.image, display_settings(description.child("film"))), metadata);
  return bad_input("found the extension \"" + kind + "\", expected .exr or .png", {path, 0, 0, ""});
}

}  // namespace brume
