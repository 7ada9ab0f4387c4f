// How a file says that it is a Brume scene.
#pragma once

namespace brume {

/// The first key of a scene file; its value is the version of the format.
inline constexpr const char* kSceneFormatKey = "brume";

/// The version written, and the newest one read. Raise it when older programs would misread newer files.
inline constexpr int kSceneFormat = 1;

}  // namespace brume
