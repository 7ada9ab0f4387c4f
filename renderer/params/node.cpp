#include "renderer/params/node.h"

#include <algorithm>
#include <charconv>

#include "renderer/core/check.h"

namespace brume {

const Param* ParamTable::find(std::string_view param_key) const {
  const auto it = std::find_if(params.begin(), params.end(), [&](const Param& p) { return p.key == param_key; });
  return it == params.end() ? nullptr : &*it;
}

const Slot* ParamTable::find_slot(std::string_view slot_key) const {
  const auto it = std::find_if(slots.begin(), slots.end(), [&](const Slot& s) { return s.key == slot_key; });
  return it == slots.end() ? nullptr : &*it;
}

const ParamTable* Family::find(std::string_view kind) const {
  const auto it = std::find_if(tables.begin(), tables.end(), [&](const ParamTable* t) { return t->key == kind; });
  return it == tables.end() ? nullptr : *it;
}

std::vector<std::string> Family::kinds() const {
  std::vector<std::string> out;
  for (const ParamTable* t : tables) out.push_back(t->key);
  return out;
}

Node::Node(const ParamTable& table) : table_(&table) {
  for (const Param& p : table.params) values_.push_back(p.default_value);
  for (const Slot& s : table.slots) {
    children_.emplace_back();
    if (!s.list) children_.back().emplace_back(*s.family->tables.front());
  }
}

const Value& Node::value(std::string_view key) const {
  const Param* p = table_->find(key);
  if (!p) BRUME_CHECK(std::string(key), ==, "a parameter of " + table_->key);
  return values_[static_cast<std::size_t>(p - table_->params.data())];
}

Result<void> Node::set(std::string_view key, Value value) {
  const Param* p = table_->find(key);
  if (!p) BRUME_CHECK(std::string(key), ==, "a parameter of " + table_->key);
  if (auto ok = validate(*p, value); !ok) return ok;
  values_[static_cast<std::size_t>(p - table_->params.data())] = std::move(value);
  return {};
}

bool Node::is_auto(std::string_view key) const { return std::holds_alternative<Auto>(value(key)); }
bool Node::flag(std::string_view key) const { return std::get<bool>(value(key)); }
int Node::integer(std::string_view key) const { return static_cast<int>(std::get<std::int64_t>(value(key))); }
double Node::number(std::string_view key) const { return std::get<double>(value(key)); }
const std::string& Node::text(std::string_view key) const { return std::get<std::string>(value(key)); }
const Numbers& Node::numbers(std::string_view key) const { return std::get<Numbers>(value(key)); }
const Settings& Node::settings(std::string_view key) const { return std::get<Settings>(value(key)); }

Vec3d Node::vec3(std::string_view key) const {
  const Numbers& v = numbers(key);
  return {v[0], v[1], v[2]};
}

Color Node::color(std::string_view key) const {
  const Numbers& v = numbers(key);
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

std::size_t Node::slot_index(std::string_view slot) const {
  const Slot* s = table_->find_slot(slot);
  if (!s) BRUME_CHECK(std::string(slot), ==, "a slot of " + table_->key);
  return static_cast<std::size_t>(s - table_->slots.data());
}

const Node& Node::child(std::string_view slot) const { return children_[slot_index(slot)].front(); }
Node& Node::child(std::string_view slot) { return children_[slot_index(slot)].front(); }
std::span<const Node> Node::list(std::string_view slot) const { return children_[slot_index(slot)]; }
std::vector<Node>& Node::list(std::string_view slot) { return children_[slot_index(slot)]; }

Node Node::converted_to(const ParamTable& kind) const {
  Node out(kind);
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const Param* p = kind.find(table_->params[i].key);
    // What nobody has changed takes the new kind's default; so does a value that the new kind would refuse.
    if (p && p->type == table_->params[i].type && values_[i] != table_->params[i].default_value)
      static_cast<void>(out.set(p->key, values_[i]).ok());
  }
  for (std::size_t i = 0; i < children_.size(); ++i) {
    const Slot* s = kind.find_slot(table_->slots[i].key);
    if (s && s->family == table_->slots[i].family) out.children_[out.slot_index(s->key)] = children_[i];
  }
  return out;
}

namespace {

struct Place {
  Node* node;                  // the object that holds the last word
  const Family* family;        // of `node`; null for the root
  std::string_view last_word;  // parameter or type key
};

Error unknown_word(std::string_view path, std::string_view word, const std::string& what,
                   const std::vector<std::string>& valid) {
  return bad_input(unknown_name(what, word, valid), {"", 0, 0, std::string(path)});
}

std::vector<std::string> words_of(const Node& node, const Family* family) {
  std::vector<std::string> words;
  if (family && !family->type_key.empty()) words.push_back(family->type_key);
  for (const Param& p : node.table().params) words.push_back(p.key);
  for (const Slot& s : node.table().slots) words.push_back(s.key);
  return words;
}

/// Elements of a list are named by their "name", or counted from 0 where they have none.
std::string name_of(const Node& element) { return element.table().find("name") ? element.text("name") : ""; }

std::vector<std::string> words_of(std::span<const Node> list) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string name = name_of(list[i]);
    words.push_back(name.empty() ? std::to_string(i) : name);
  }
  return words;
}

/// For a path that leads to an object, a list or a kind instead of a parameter.
Error no_param(std::string_view path, const std::string& what, const std::vector<std::string>& words) {
  const std::string valid =
      words.empty() ? "a path to a parameter, of which it has none" : "one of its keys: " + join(words);
  return bad_input("found " + what + ", expected " + valid, {"", 0, 0, std::string(path)});
}

struct Element {
  Node* node;          // null when there is none
  std::size_t length;  // of the word in the path
};

/// The element that `rest` begins with. Names may hold dots, so the longest name that fits wins, then the number.
Element find_element(std::vector<Node>& list, std::string_view rest) {
  Element best{nullptr, 0};
  for (Node& n : list) {
    const std::string name = name_of(n);
    const bool fits = rest.starts_with(name) && (rest.size() == name.size() || rest[name.size()] == '.');
    if (fits && name.size() > best.length) best = {&n, name.size()};
  }
  if (best.node) return best;
  const std::string_view word = rest.substr(0, rest.find('.'));
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
  const bool number = error == std::errc() && end == word.data() + word.size();
  return {number && index < list.size() ? &list[index] : nullptr, word.size()};
}

Result<Place> find_place(Node& root, std::string_view path) {
  Node* node = &root;
  const Family* family = nullptr;
  std::string_view rest = path;
  while (true) {
    const auto dot = rest.find('.');
    const std::string_view word = rest.substr(0, dot);
    const Slot* slot = node->table().find_slot(word);
    if (dot == std::string_view::npos) {
      if (!slot) return Place{node, family, word};
      if (slot->list) return no_param(path, "a whole list", words_of(node->list(slot->key)));
      return no_param(path, "a whole " + slot->family->noun, words_of(node->child(slot->key), slot->family));
    }
    if (!slot && node->table().find(word))
      return bad_input("found more behind the parameter \"" + std::string(word) + "\", expected the path to end there",
                       {"", 0, 0, std::string(path)});
    if (!slot) return unknown_word(path, word, "key", words_of(*node, family));
    rest = rest.substr(dot + 1);
    if (slot->list) {
      std::vector<Node>& list = node->list(slot->key);
      const Element element = find_element(list, rest);
      if (!element.node) return unknown_word(path, rest.substr(0, element.length), slot->family->noun, words_of(list));
      if (element.length == rest.size())
        return no_param(path, "a whole " + slot->family->noun, words_of(*element.node, slot->family));
      rest = rest.substr(element.length + 1);
      node = element.node;
    } else {
      node = &node->child(slot->key);
    }
    family = slot->family;
  }
}

}  // namespace

Result<ParamRef> find_param(Node& root, std::string_view path) {
  const auto place = find_place(root, path);
  if (!place) return place.error();
  const Param* p = place->node->table().find(place->last_word);
  if (p) return ParamRef{place->node, p};
  if (place->family && place->last_word == place->family->type_key)
    return no_param(path, "the kind of a " + place->family->noun, words_of(*place->node, nullptr));
  return unknown_word(path, place->last_word, "key", words_of(*place->node, place->family));
}

namespace {

bool names_kind(const Place& place) {
  return place.family && !place.family->type_key.empty() && place.last_word == place.family->type_key;
}

}  // namespace

Result<std::string> text_by_path(Node& root, std::string_view path) {
  const auto place = find_place(root, path);
  if (!place) return place.error();
  if (names_kind(*place)) return place->node->kind();
  const auto ref = find_param(root, path);
  if (!ref) return ref.error();
  return format_value(ref->node->value(ref->param->key));
}

Result<void> set_by_path(Node& root, std::string_view path, std::string_view text) {
  const auto place = find_place(root, path);
  if (!place) return place.error();
  if (names_kind(*place)) {
    const ParamTable* kind = place->family->find(text);
    if (!kind) return unknown_word(path, text, place->family->noun, place->family->kinds());
    *place->node = place->node->converted_to(*kind);
    return {};
  }
  const auto ref = find_param(root, path);
  if (!ref) return ref.error();
  auto value = parse_value(*ref->param, text);
  Result<void> done = value ? ref->node->set(ref->param->key, std::move(*value)) : Result<void>(value.error());
  if (!done) return bad_input(done.error().message, {"", 0, 0, std::string(path)});
  return done;
}

}  // namespace brume
