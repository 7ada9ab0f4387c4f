#include "app/cli/console.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace brume {
namespace {

void print_line(const std::string& text) {
  std::string line = "brume: " + text;
  for (char& c : line)
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
  line += '\n';
  std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace

void print_error(const Error& error) { print_line("error: " + error.to_string()); }
void print_warning(const std::string& text) { print_line("warning: " + text); }
void print_note(const std::string& text) { print_line(text); }

Result<void> print_result(std::string_view text) {
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (written && std::fflush(stdout) == 0) return {};
  const std::string reason = std::generic_category().message(errno ? errno : EIO);
  return Error{ErrorCode::Internal, "cannot write to the standard output: " + reason};
}

bool stderr_is_terminal() { return isatty(STDERR_FILENO) == 1; }

}  // namespace brume
