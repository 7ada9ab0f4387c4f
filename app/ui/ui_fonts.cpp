#include "app/ui/ui_fonts.h"

#include <filesystem>

namespace brume {
namespace fs = std::filesystem;

std::string find_shared_file(const std::string& relative_path) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  // The build tree has the shape of the installed one: bin/brume and share/brume.
  const fs::path candidate = (program.parent_path() / "../share/brume" / relative_path).lexically_normal();
  return fs::exists(candidate, error) ? candidate.string() : std::string();
}

std::vector<std::string> ui_font_paths() {
  const std::string font = find_shared_file("fonts/Roboto-Regular.ttf");
  return font.empty() ? std::vector<std::string>() : std::vector<std::string>{font};
}

}  // namespace brume
