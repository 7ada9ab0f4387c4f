// Where the program keeps what it can make again.
#pragma once

#include <string>

namespace brume {

/// "$XDG_CACHE_HOME/brume/references" (XDG Base Directory Specification), in ~/.cache where that is not set; empty,
/// which keeps nothing, without a home.
std::string reference_folder();

}  // namespace brume
