#include "app/session/user_folders.h"

#include <cstdlib>

namespace brume {

std::string reference_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  const std::string base = cache && *cache == '/' ? std::string(cache)
                           : home && *home        ? std::string(home) + "/.cache"
                                                  : "";
  return base.empty() ? "" : base + "/brume/references";
}

}  // namespace brume
