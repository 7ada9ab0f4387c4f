// Errors of input: what was found, what was expected, and where.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace brume {

/// Exit codes of the command line are derived from these.
enum class ErrorCode {
  BadInput,   ///< a file, scene, flag or parameter that the user can mend (exit code 2)
  Internal,   ///< everything else (exit code 1)
  Cancelled,  ///< the work was given up on request; not shown
};

/// Where in the input the mistake sits. Unknown parts are empty or 0.
struct ErrorSource {
  std::string file;
  int line = 0;     ///< counted from 1
  int column = 0;   ///< counted from 1, in bytes
  std::string key;  ///< "lights.key.intensity"
};

struct Error {
  ErrorCode code = ErrorCode::BadInput;
  std::string message;  ///< one sentence: what was found, what was expected, how to mend it
  ErrorSource source = {};

  /// "scene.json:12:7: render.step_size: found -1, expected a number greater than 0"
  std::string to_string() const;
};

inline Error bad_input(std::string message, ErrorSource source = {}) {
  return {ErrorCode::BadInput, std::move(message), std::move(source)};
}

/// The error with its key below another: "bounds" and "file" are "bounds.file".
inline Error under(const std::string& key, Error error) {
  error.source.key = error.source.key.empty() ? key : key + "." + error.source.key;
  return error;
}

/// A value or the reason why there is none.
template <class T> class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  /// Only when ok().
  T& value() & { return std::get<0>(state_); }
  const T& value() const& { return std::get<0>(state_); }
  T&& value() && { return std::get<0>(std::move(state_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  /// Only when not ok().
  const Error& error() const { return std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
};

/// Success, or the reason of failure.
template <> class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}
  bool ok() const { return !error_; }
  explicit operator bool() const { return ok(); }
  const Error& error() const { return *error_; }

 private:
  std::optional<Error> error_;
};

}  // namespace brume
