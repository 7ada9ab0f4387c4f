// The reference of scene files, as Markdown.
#pragma once

#include <string>

#include "renderer/params/node.h"

namespace brume {

/// A page with one section per kind of object that a scene can hold, and in it one table row per parameter: key, label,
/// type, default, range, unit, what a change restarts, and the doc; below it the choices and what "auto" does.
std::string reference_page(const Family& root);

}  // namespace brume
