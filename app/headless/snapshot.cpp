#include "app/headless/snapshot.h"

#include <chrono>
#include <filesystem>
#include <thread>

#include "app/panels/main_window.h"
#include "app/session/user_folders.h"
#include "app/ui/stage.h"
#include "app/ui/ui_fonts.h"
#include "renderer/film/image_io.h"

namespace brume {
namespace {

Image8 as_image(const Stage& stage) {
  Image8 image(stage.width(), stage.height(), 4);
  image.bytes = stage.pixels();
  return image;
}

}  // namespace

Result<void> run_snapshot(LoadedScene scene, const SnapshotOptions& options) {
  auto stage = Stage::create({.width = options.width, .height = options.height, .font_paths = ui_font_paths()});
  if (!stage) return stage.error();
  Session session({.max_samples = options.samples, .reference_folder = reference_folder()});
  session.start(std::move(scene.description), scene.scene_path);
  MainWindow window(session, (*stage)->gl(), {.chart = options.chart || options.search, .probe = options.probe});
  if (options.search) session.search_settings();
  const auto draw = [&](const Gl&) { window.draw(); };

  // Frames go on, as in a window, until the picture has all its samples and has been drawn.
  for (bool finished = false; !finished;) {
    const Truth& truth = session.truth();
    const bool known = (truth.reference() && !truth.job()) || !truth.problem().empty();
    const auto probe = session.probe();
    const bool probed = probe && probe->samples + probe->non_finite >= std::min(options.samples, 16);
    finished =
        session.finished() && (!options.chart || known) && (!options.probe || probed) && !session.search().progress();
    (*stage)->frame(draw);
    if (!session.problem().empty()) return bad_input(session.problem());
    if (!finished) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  (*stage)->frame(draw);
  return write_png(options.output, as_image(**stage));
}

}  // namespace brume
