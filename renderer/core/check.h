// Assertions about our own logic; nothing a user can type or load may reach one.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace brume::detail {

template <class A, class B>
[[noreturn]] void check_failed(const char* file, int line, const char* text, const A& a, const B& b) {
  std::ostringstream message;
  message << file << ':' << line << ": CHECK(" << text << ") failed: " << a << " against " << b << '\n';
  std::fputs(message.str().c_str(), stderr);
  std::abort();
}

}  // namespace brume::detail

/// Stops the program when `a op b` does not hold, in every build; prints both operands.
#define BRUME_CHECK(a, op, b)                                                                   \
  do {                                                                                          \
    const auto& check_a_ = (a);                                                                 \
    const auto& check_b_ = (b);                                                                 \
    if (!(check_a_ op check_b_))                                                                \
      ::brume::detail::check_failed(__FILE__, __LINE__, #a " " #op " " #b, check_a_, check_b_); \
  } while (false)

/// The same, in debug builds only.
#ifdef NDEBUG
#define BRUME_DCHECK(a, op, b) static_cast<void>(0)
#else
#define BRUME_DCHECK(a, op, b) BRUME_CHECK(a, op, b)
#endif
