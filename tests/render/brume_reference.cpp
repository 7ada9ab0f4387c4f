// brume-reference: renders reference cases and judges the values.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "renderer/core/atomic_file.h"
#include "tests/support/reference_table.h"

int main(int argc, char** argv) {
  using namespace brume;
  CLI::App app{"Renders reference cases and holds them against their values. Exit code 3: some do not hold."};
  std::vector<std::string> files;
  std::string only, integrator, json, table;
  std::uint64_t samples = 0;
  ReferenceOptions options;
  app.add_option("FILE", files, "Files of cases (tests/render/reference/*.json)")->required();
  app.add_option("--only", only, "The case of this id");
  app.add_option("--integrator", integrator,
                 "An integrator, or one mode: decoupled:mis (default: null_scattering and decoupled in all modes)");
  app.add_option("--samples", samples, "Samples per comparison (default: as many as --seconds allow)");
  app.add_option("--seconds", options.seconds, "CPU seconds per comparison, roughly")->capture_default_str();
  app.add_flag("--everything", options.everything, "All orders and rays of every case, not a choice");
  app.add_option("--json", json, "Writes every comparison to this file");
  app.add_option("--table", table, "Writes the README's table to this file");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    const int code = app.exit(e);
    return code == 0 ? 0 : 2;
  }
  if (samples > 0) options.samples = samples;
  const auto fail = [](const Error& error) {
    std::fprintf(stderr, "brume-reference: error: %s\n", error.to_string().c_str());
    return error.code == ErrorCode::BadInput ? 2 : 1;
  };
  if (!integrator.empty()) {
    auto methods = reference_methods(integrator);
    if (!methods) return fail(methods.error());
    options.methods = *methods;
  }
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const auto outcomes = run_references(files, only, options, [&](int done, int all) {
    if (terminal) std::fprintf(stderr, "\r%d of %d", done, all);
  });
  if (terminal) std::fprintf(stderr, "\r\033[K");
  if (!outcomes) return fail(outcomes.error());
  std::fputs(format_outcomes(*outcomes).c_str(), stdout);
  std::fputs(format_summary(*outcomes).c_str(), stdout);
  if (!json.empty())
    if (auto done = write_text_atomically(json, format_json(*outcomes)); !done) return fail(done.error());
  if (!table.empty())
    if (auto done = write_text_atomically(table, format_table(*outcomes)); !done) return fail(done.error());
  for (const ReferenceOutcome& o : *outcomes)
    if (o.unsupported.empty() && o.expected_failure.empty() && !o.passed()) return 3;
  return 0;
}
