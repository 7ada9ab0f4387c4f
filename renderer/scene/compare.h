// Variants of a scene, to be rendered side by side.
#pragma once

#include <string>
#include <vector>

#include "renderer/params/node.h"

namespace brume {

/// Compared at a time; more are not told apart by eye.
inline constexpr std::size_t kMaxVariants = 4;

/// The family of a description's "compare": how threads are shared, the reference, and the list "variants", each a
/// name and the settings in which it differs from the scene around it.
const Family& compare_family();

/// A whole scene of its own.
struct Variant {
  std::string name;  ///< never empty: its own, or its letter
  Node description;  ///< the scene with the variant's settings, and nothing more to compare
};

/// The enabled variants of a description, or the scene itself, called "scene", where there are none.
/// Errors name the setting ("compare.variants.B.set.render.stp_size"): unknown, out of range, more than kMaxVariants,
/// or of what variants have in common: the camera, the film, the seed and what is compared.
Result<std::vector<Variant>> variants_of(const Node& description);

/// The scene with the settings of one variant of it, enabled or not.  @param variant  of its "compare.variants"
Result<Variant> variant_of(const Node& description, std::size_t variant);

/// The scene itself, with nothing to compare.
Node without_variants(Node description);

/// The settings of one scene, a variant perhaps, and what another one compares.
Node with_variants_of(Node settings, const Node& scene);

/// Whether a parameter is one that variants have in common.
bool is_common(const std::string& path);

/// What a variant of a description is called: its name or, where it has none, its letter, "A" for the first.
std::string variant_name(const Node& variant, std::size_t index);

/// Sets a parameter in a variant of `description` to what a person may type; other settings keep their order.
void set_in_variant(Node& description, std::size_t variant, const std::string& path, const std::string& value);
/// Takes away what cannot be set any more: settings of parts that another kind of object does not have.
void drop_refused_settings(Node& description, std::size_t variant);
/// Settings of the object at one path are those of the object at another: it was renamed.
void rename_in_variants(Node& description, const std::string& from, const std::string& to);
/// As in the scene again.
void unset_in_variant(Node& description, std::size_t variant, const std::string& path);

}  // namespace brume
