#include "app/window/run_window.h"

#include <cstdio>

#include "app/panels/main_window.h"
#include "app/session/user_folders.h"
#include "app/ui/ui_fonts.h"
#include "app/window/glfw_window.h"

namespace brume {

int run_window(const std::optional<std::string>& file) {
  auto window = Window::create("Brume", 1400, 900, {.font_paths = ui_font_paths()});
  if (!window) {
    std::fprintf(stderr, "brume: error: %s\n", window.error().to_string().c_str());
    return window.error().code == ErrorCode::BadInput ? 2 : 1;
  }
  Session session({.on_news = [&] { (*window)->wake(); }, .reference_folder = reference_folder()});
  const std::string first = file ? *file : find_shared_file("scenes/smoke.json");
  if (!first.empty()) session.open(first);

  MainWindow ui(session, (*window)->gl());
  (*window)->on_drop([&](const std::vector<std::string>& paths) { ui.drop(paths); });
  (*window)->on_close([&] {
    if (!ui.may_quit()) ui.request_quit();
    return ui.may_quit();
  });

  std::vector<std::shared_ptr<const Picture>> drawn;
  std::string title;
  while ((*window)->frame([&](const Gl&) { ui.draw(); })) {
    const std::string now = session.title() + (session.modified() ? " * - Brume" : " - Brume");
    if (now != title) (*window)->set_title(title = now);
    if (ui.may_quit()) (*window)->request_close();
    std::vector<std::shared_ptr<const Picture>> pictures;
    for (std::size_t i = 0; i < session.shown().size(); ++i) pictures.push_back(session.picture(i));
    const bool nothing_new = pictures == drawn && session.idle();
    drawn = std::move(pictures);
    (*window)->wait_or_poll(nothing_new);
  }
  return 0;
}

}  // namespace brume
