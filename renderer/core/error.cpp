#include "renderer/core/error.h"

namespace brume {

std::string Error::to_string() const {
  std::string text;
  if (!source.file.empty()) {
    text += source.file;
    if (source.line > 0) text += ":" + std::to_string(source.line) + ":" + std::to_string(source.column);
    text += ": ";
  }
  if (!source.key.empty()) text += source.key + ": ";
  return text + message;
}

}  // namespace brume
