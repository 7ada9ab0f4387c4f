// The flags that commands share, for CLI11.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "app/cli/exit_code.h"
#include "app/cli/scene_options.h"
#include "renderer/params/param.h"

namespace brume {

/// Thrown out of CLI11's parser by flags whose value is wrong; never leaves the command line.
struct BadFlag {
  Error error;
};

/// A subcommand, ready to be parsed; `run` reads the options that the parser filled in.
struct Command {
  CLI::App* app;
  std::function<Result<ExitCode>()> run;
};

/// CLI11's help with a usage line of our own and room for long flags.
std::shared_ptr<CLI::Formatter> help_formatter(const std::string& usage);

CLI::App* add_command(CLI::App& root, const std::string& name, const std::string& doc, const std::string& usage,
                      const std::string& examples = "");

/// "--samples N", described, read and checked by a parameter's table entry. `take` is not called for "auto".
void add_value(CLI::App& app, const std::string& placeholder, const Param& p,
               const std::function<void(const Value&)>& take);

int to_int(const Value& value);

void add_threads(CLI::App& app, int& threads);
void add_file(CLI::App& app, std::string& file);

/// A flag that is short for --set.
void add_shorthand(CLI::App& app, SceneOptions& scene, const std::string& flag, const std::string& placeholder,
                   const std::string& key, const std::string& doc);

/// --set, applied before the shorthands that are added after it.
void add_settings(CLI::App& app, SceneOptions& scene);
void add_seed(CLI::App& app, SceneOptions& scene);

}  // namespace brume
