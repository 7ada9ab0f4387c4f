#include "renderer/core/simd.h"

#include <algorithm>
#include <cctype>
#include <cstdint>

#include "hwy/highway.h"

namespace brume {
namespace {

struct Level {
  std::int64_t target;  // Highway's bit
  std::string name;
};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Best first, for Highway gives better targets lower bits. Found once, before any force_simd_level() narrows what
/// Highway calls supported.
const std::vector<Level>& levels() {
  static const std::vector<Level> all = [] {
    std::vector<Level> found;
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
      found.push_back({target, lower(hwy::TargetName(target))});
    return found;
  }();
  return all;
}

}  // namespace

std::vector<std::string> simd_levels() {
  std::vector<std::string> names;
  for (const Level& level : levels()) names.push_back(level.name);
  return names;
}

std::string simd_level() {
  const std::vector<Level>& all = levels();
  const std::int64_t allowed = hwy::SupportedTargets();
  for (const Level& level : all)
    if (allowed & level.target) return level.name;
  return all.back().name;
}

Result<void> force_simd_level(const std::string& name) {
  const std::vector<Level>& all = levels();
  std::string wanted = lower(name);
  if (wanted.empty() || wanted == "auto") wanted = all.front().name;
  if (wanted == "avx512") wanted = "avx3";
  if (wanted == "sse2") wanted = all.back().name;

  std::string known;
  for (const Level& level : all) {
    if (level.name == wanted) {
      hwy::SetSupportedTargetsForTest(level.target);
      hwy::GetChosenTarget().Update(level.target);
      return {};
    }
    known += (known.empty() ? "" : ", ") + level.name;
  }
  return bad_input("SIMD level \"" + name + "\" is unknown or not supported by this processor; expected auto, " +
                   known);
}

}  // namespace brume
