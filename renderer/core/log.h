// Where messages go: the library never prints.
#pragma once

#include <functional>
#include <string>

namespace brume {

enum class LogLevel { Info, Warning, Error };

/// May be called from any thread; an empty function drops messages.
using LogSink = std::function<void(LogLevel, const std::string&)>;

}  // namespace brume
