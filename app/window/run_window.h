// The interactive program.
#pragma once

#include <optional>
#include <string>

namespace brume {

/// Opens the window with a scene, a grid file or a picture made by Brume; without one, with the scene that ships.
/// @return the exit code; errors go to stderr
int run_window(const std::optional<std::string>& file);

}  // namespace brume
