#include "app/panels/edit_target.h"

#include <algorithm>

namespace brume {

EditTarget::EditTarget(Session& session, std::optional<std::size_t> variant) : session_(session) {
  if (variant && *variant < session.description().child("compare").list("variants").size()) variant_ = variant;
  resolve();
}

void EditTarget::resolve() {
  resolved_.reset();
  if (!variant_) return;
  // What is compared is still that of the scene.
  if (auto made = variant_of(session_.description(), *variant_))
    resolved_ = with_variants_of(std::move(made->description), session_.description());
}

void EditTarget::change(const std::function<void(Node&)>& edit) {
  session_.change(edit);
  resolve();
}

std::string EditTarget::path_of(const NodePath& object, const std::string& key) const {
  return object.to_text(session_.description()) + "." + key;
}

bool EditTarget::goes_to_variant(const NodePath& object, const std::string& key) const {
  // Names too are common: settings find objects by them.
  return variant_ && key != "name" && !is_common(path_of(object, key));
}

bool EditTarget::is_set(const NodePath& object, const std::string& key) const {
  if (!variant_) return false;
  const std::string path = path_of(object, key);
  const Settings& settings = session_.description().child("compare").list("variants")[*variant_].settings("set");
  return std::any_of(settings.begin(), settings.end(), [&](const Setting& s) { return s.path == path; });
}

void EditTarget::set(const NodePath& object, const Param& param, const Value& value) {
  if (goes_to_variant(object, param.key)) {
    const std::string path = path_of(object, param.key);
    change([&](Node& d) { set_in_variant(d, *variant_, path, format_value(value)); });
    return;
  }
  change([&](Node& d) {
    const std::string before = object.to_text(d);
    // Refused values (a widget cannot know every rule) leave the description as it was.
    if (Node* n = object.find(d)) static_cast<void>(n->set(param.key, value).ok());
    if (param.key == "name") rename_in_variants(d, before, object.to_text(d));
  });
}

void EditTarget::set_kind(const NodePath& object, const Family& family, const ParamTable& kind) {
  if (goes_to_variant(object, family.type_key)) {
    const std::string path = path_of(object, family.type_key);
    change([&](Node& d) {
      set_in_variant(d, *variant_, path, kind.key);
      drop_refused_settings(d, *variant_);
    });
    return;
  }
  change([&](Node& d) {
    if (Node* n = object.find(d)) *n = n->converted_to(kind);
  });
}

void EditTarget::reset(const NodePath& object, const Param& param) {
  if (!goes_to_variant(object, param.key)) return set(object, param, param.default_value);
  const std::string path = path_of(object, param.key);
  change([&](Node& d) { unset_in_variant(d, *variant_, path); });
}

}  // namespace brume
