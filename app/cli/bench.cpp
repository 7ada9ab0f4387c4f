#include "app/cli/bench.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/cli/console.h"
#include "app/cli/progress_line.h"
#include "app/cli/text_table.h"
#include "app/ui/ui_fonts.h"
#include "renderer/core/atomic_file.h"
#include "renderer/experiments/bench.h"

namespace brume {
namespace {

std::string json_of(const std::vector<BenchResult>& results) {
  auto list = nlohmann::ordered_json::array();
  const auto or_null = [](std::optional<double> v) {
    return v ? nlohmann::ordered_json(*v) : nlohmann::ordered_json(nullptr);
  };
  for (const BenchResult& r : results)
    list.push_back({{"name", r.name},
                    {"value", r.value},
                    {"unit", r.unit},
                    {"limit", or_null(r.limit)},
                    {"ratio", or_null(r.ratio())},
                    {"goal", or_null(r.goal)}});
  return list.dump(2) + "\n";
}

using Rows = std::vector<std::vector<std::string>>;

Rows cells_of(const std::vector<BenchResult>& results, int digits) {
  Rows rows{{"name", "value", "unit", "limit", "ratio", "goal"}};
  const auto or_blank = [&](std::optional<double> v) { return v ? short_number(*v, digits) : std::string(); };
  for (const BenchResult& r : results)
    rows.push_back({r.name, or_blank(r.value), r.unit, or_blank(r.limit), or_blank(r.ratio()), or_blank(r.goal)});
  return rows;
}

std::string markdown_of(const std::vector<BenchResult>& results) {
  std::string text;
  for (const auto& row : cells_of(results, 3)) {
    for (const std::string& cell : row) text += "| " + cell + " ";
    text += text.find('\n') == std::string::npos ? "|\n|---|---:|---|---:|---:|---:|\n" : "|\n";
  }
  return text;
}

std::string csv_of(const std::vector<BenchResult>& results) {
  std::string text;
  for (const auto& row : cells_of(results, 6))
    for (std::size_t i = 0; i < row.size(); ++i)
      text += (i == 0 ? "\"" + row[i] + "\"" : "," + row[i]) + (i + 1 < row.size() ? "" : "\n");
  return text;
}

}  // namespace

Result<ExitCode> run_bench_command(const BenchCommandOptions& options) {
  const std::filesystem::path smoke = find_shared_file("scenes/smoke.json");
  if (smoke.empty()) return bad_input("the scenes that come with Brume are missing");
  BenchOptions bench{.scenes = smoke.parent_path().string(), .only = options.only};
  ProgressLine line("measuring");
  bench.progress = [&](const std::string& name) { line.update({.done = name}); };
  const auto results = run_bench(bench);
  if (!results) return results.error();
  const std::string text = options.json       ? json_of(*results)
                           : options.markdown ? markdown_of(*results)
                                              : format_table(cells_of(*results, 3), "lrlrrr", 0);
  if (!options.csv_file.empty())
    if (auto done = write_text_atomically(options.csv_file, csv_of(*results)); !done) return done.error();
  if (auto done = print_result(text); !done) return done.error();
  return ExitCode::Ok;
}

}  // namespace brume
