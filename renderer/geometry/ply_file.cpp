#include "renderer/geometry/ply_file.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>

#include "renderer/core/input_file.h"

namespace brume {
namespace {

/// Why the file cannot be read; caught in read_ply().
struct Refusal {
  std::string message;
};

enum class Scalar { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float, Double };

Scalar scalar_named(const std::string& name) {
  static const std::pair<const char*, Scalar> names[] = {
      {"char", Scalar::Int8},   {"int8", Scalar::Int8},     {"uchar", Scalar::Uint8},   {"uint8", Scalar::Uint8},
      {"short", Scalar::Int16}, {"int16", Scalar::Int16},   {"ushort", Scalar::Uint16}, {"uint16", Scalar::Uint16},
      {"int", Scalar::Int32},   {"int32", Scalar::Int32},   {"uint", Scalar::Uint32},   {"uint32", Scalar::Uint32},
      {"float", Scalar::Float}, {"float32", Scalar::Float}, {"double", Scalar::Double}, {"float64", Scalar::Double},
  };
  for (const auto& [known, scalar] : names)
    if (name == known) return scalar;
  throw Refusal{"found the number type \"" + quoted_reason(name) + "\", expected float, int, uchar, ..."};
}

std::size_t size_of(Scalar s) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<int>(s)];
}

struct Property {
  std::string name;
  Scalar type;
  std::optional<Scalar> count_type = {};  // of a list
};

struct Element {
  std::string name;
  std::size_t count;
  std::vector<Property> properties;
};

/// What follows the header, number by number.
class Body {
 public:
  Body(const char* begin, const char* end, bool ascii, std::endian order)
      : at_(begin), end_(end), ascii_(ascii), swapped_(order != std::endian::native) {}

  double number(Scalar type) { return ascii_ ? word() : binary(type); }

  /// Far fewer than this can follow, whatever their type.
  std::size_t most_numbers_left() const { return static_cast<std::size_t>(end_ - at_); }

 private:
  double word() {
    while (at_ < end_ && std::strchr(" \t\r\n", *at_)) ++at_;
    if (at_ == end_) throw Refusal{"the file ends too early"};
    double value = 0;
    const auto [after, error] = std::from_chars(at_, end_, value);
    if (error != std::errc{}) throw Refusal{"found a word where a number was expected"};
    at_ = after;
    return value;
  }

  template <class T> double binary_as() {
    char bytes[sizeof(T)];
    std::memcpy(bytes, at_, sizeof(T));
    if (swapped_) std::reverse(bytes, bytes + sizeof(T));
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    at_ += sizeof(T);
    return static_cast<double>(value);
  }

  double binary(Scalar type) {
    if (most_numbers_left() < size_of(type)) throw Refusal{"the file ends too early"};
    switch (type) {
      case Scalar::Int8:
        return binary_as<std::int8_t>();
      case Scalar::Uint8:
        return binary_as<std::uint8_t>();
      case Scalar::Int16:
        return binary_as<std::int16_t>();
      case Scalar::Uint16:
        return binary_as<std::uint16_t>();
      case Scalar::Int32:
        return binary_as<std::int32_t>();
      case Scalar::Uint32:
        return binary_as<std::uint32_t>();
      case Scalar::Float:
        return binary_as<float>();
      case Scalar::Double:
        return binary_as<double>();
    }
    return 0;
  }

  const char* at_;
  const char* end_;
  bool ascii_, swapped_;
};

std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < line.size();) {
    const std::size_t begin = line.find_first_not_of(" \t\r", i);
    if (begin == std::string::npos) break;
    const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    i = end;
  }
  return words;
}

std::size_t count_of(const std::string& word) {
  std::size_t count = 0;
  const auto [after, error] = std::from_chars(word.data(), word.data() + word.size(), count);
  if (error != std::errc{} || after != word.data() + word.size())
    throw Refusal{"found \"" + quoted_reason(word) + "\", expected a count"};
  return count;
}

class PlyReader {
 public:
  explicit PlyReader(std::string content) : content_(std::move(content)) {}

  TriangleMesh read() {
    read_header();
    Body body(content_.data() + body_at_, content_.data() + content_.size(), ascii_, order_);
    TriangleMesh mesh;
    for (const Element& element : elements_) {
      if (element.count > body.most_numbers_left() && !element.properties.empty())
        throw Refusal{"the file ends too early"};
      if (element.name == "vertex")
        read_vertices(element, body, mesh);
      else
        read_rows(element, body, mesh);
    }
    return mesh;
  }

 private:
  std::string next_line() {
    const std::size_t end = content_.find('\n', body_at_);
    if (end == std::string::npos) throw Refusal{"the header ends too early, expected \"end_header\""};
    std::string line = content_.substr(body_at_, end - body_at_);
    body_at_ = end + 1;
    return line;
  }

  void read_header() {
    if (words_of(content_.substr(0, content_.find('\n'))) != std::vector<std::string>{"ply"})
      throw Refusal{"found another kind of file, expected a mesh that begins with \"ply\""};
    next_line();
    for (;;) {
      const std::vector<std::string> words = words_of(next_line());
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") return;
      read_header_line(words);
    }
  }

  void read_header_line(const std::vector<std::string>& words) {
    if (words[0] == "format" && words.size() >= 2) {
      ascii_ = words[1] == "ascii";
      order_ = words[1] == "binary_big_endian" ? std::endian::big : std::endian::little;
      if (!ascii_ && words[1] != "binary_little_endian" && words[1] != "binary_big_endian")
        throw Refusal{"found the format \"" + quoted_reason(words[1]) + "\", expected ascii or binary"};
    } else if (words[0] == "element" && words.size() == 3) {
      elements_.push_back({words[1], count_of(words[2]), {}});
    } else if (words[0] == "property" && !elements_.empty() && words.size() == 3) {
      elements_.back().properties.push_back({words[2], scalar_named(words[1])});
    } else if (words[0] == "property" && !elements_.empty() && words.size() == 5 && words[1] == "list") {
      elements_.back().properties.push_back({words[4], scalar_named(words[3]), scalar_named(words[2])});
    } else {
      throw Refusal{"found \"" + quoted_reason(words[0]) + "\" in the header, expected format, element or property"};
    }
  }

  void read_vertices(const Element& element, Body& body, TriangleMesh& mesh) {
    for (std::size_t i = 0; i < element.count; ++i) {
      Vec3 v;
      for (const Property& p : element.properties) {
        const std::vector<double>& values = read_property(p, body);
        for (int axis = 0; axis < 3; ++axis)
          if (p.name == std::string(1, "xyz"[axis]) && !p.count_type) v[axis] = static_cast<float>(values[0]);
      }
      mesh.vertices.push_back(v);
    }
  }

  /// Faces, which are taken, and anything else, which is skipped.
  void read_rows(const Element& element, Body& body, TriangleMesh& mesh) {
    if (element.properties.empty()) return;
    for (std::size_t i = 0; i < element.count; ++i)
      for (const Property& p : element.properties) {
        const std::vector<double>& values = read_property(p, body);
        if (element.name == "face" && (p.name == "vertex_indices" || p.name == "vertex_index")) add_fan(values, mesh);
      }
  }

  static void add_fan(const std::vector<double>& corners, TriangleMesh& mesh) {
    const auto index = [&](std::size_t k) {
      const double value = corners[k];
      if (!(value >= 0 && value < 4294967295.0)) throw Refusal{"found a negative vertex number"};
      return static_cast<std::uint32_t>(value);
    };
    for (std::size_t k = 2; k < corners.size(); ++k) mesh.triangles.push_back({index(0), index(k - 1), index(k)});
  }

  const std::vector<double>& read_property(const Property& p, Body& body) {
    std::size_t count = 1;
    if (p.count_type) {
      const double found = body.number(*p.count_type);
      if (!(found >= 0 && found <= static_cast<double>(body.most_numbers_left())))
        throw Refusal{"found a list that is longer than the file"};
      count = static_cast<std::size_t>(found);
    }
    values_.clear();
    for (std::size_t k = 0; k < count; ++k) values_.push_back(body.number(p.type));
    return values_;
  }

  std::string content_;
  std::size_t body_at_ = 0;
  bool ascii_ = true;
  std::endian order_ = std::endian::little;
  std::vector<Element> elements_;
  std::vector<double> values_;
};

}  // namespace

Result<TriangleMesh> read_ply(const std::string& path) {
  if (const auto readable = check_readable(path); !readable) return readable.error();
  std::ifstream file(path, std::ios::binary);
  try {
    return PlyReader({std::istreambuf_iterator<char>(file), {}}).read();
  } catch (const Refusal& refusal) {
    return file_error(path, refusal.message);
  }
}

}  // namespace brume
