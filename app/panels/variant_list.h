// The variants of the scene, and the settings in which they differ.
#pragma once

#include <optional>

#include "app/panels/node_path.h"
#include "app/session/session.h"

namespace brume {

/// @param target  of the description's variants: the one that the inspector edits; none: the scene
void draw_variant_list(Session& session, NodePath& selected, std::optional<std::size_t>& target);

/// A new variant at the end: a copy of `of`, or the scene itself; the first time the scene as it is becomes a variant
/// too, to compare with. Nothing when there are as many as can be.
/// @return the index of the new one, or `of`
std::optional<std::size_t> duplicate_as_variant(Session& session, std::optional<std::size_t> of);

}  // namespace brume
