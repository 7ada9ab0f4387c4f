#include "app/cli/command_line.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <sstream>

#include "app/cli/bench.h"
#include "app/cli/chart.h"
#include "app/cli/compare.h"
#include "app/cli/console.h"
#include "app/cli/docs.h"
#include "app/cli/flags.h"
#include "app/cli/info.h"
#include "app/cli/probe.h"
#include "app/cli/render.h"
#include "app/cli/schema.h"
#include "app/cli/snapshot.h"
#include "app/window/run_window.h"
#include "renderer/analysis/metric.h"
#include "renderer/core/simd.h"
#include "renderer/experiments/sweep_chart.h"

namespace brume {
namespace {

Command make_render(CLI::App& root) {
  auto o = std::make_shared<RenderOptions>();
  CLI::App* app = add_command(root, "render", "Renders a scene to a picture", "FILE -o OUT.exr|OUT.png [OPTIONS]",
                              "Same scene, seed and samples give the same bits at any number of threads.\n"
                              "Ctrl+C finishes the pass under way and saves the picture.\n\n"
                              "Examples:\n"
                              "  brume render scenes/smoke.json -o smoke.exr --spp 64\n"
                              "  brume render smoke.vdb -o smoke.png --time 10 --size 1280x720\n"
                              "  brume render smoke.png -o more.png --set render.bounces=4 --stats more.json");
  add_file(*app, o->scene.file);
  app->add_option("-o,--output", o->output,
                  "Picture to write: .exr (linear values) or .png (display values);\nthe scene is kept inside")
      ->required()
      ->option_text("OUT");
  add_value(*app, "N", param::integer("spp", "Samples", kDefaultSamples).between(1, 1 << 24).says("Samples per pixel"),
            [o](const Value& v) { o->samples = to_int(v); });
  add_value(*app, "SECONDS",
            param::number("time", "Time", 1)
                .between(1e-3, 1e7)
                .auto_by_default("--spp decides")
                .in("seconds of rendering")
                .says("Renders for about this long"),
            [o](const Value& v) { o->seconds = std::get<double>(v); });
  add_settings(*app, o->scene);
  add_shorthand(*app, o->scene, "--size", "WxH", "film.resolution",
                "Size of the picture in pixels (default: the scene's)");
  add_seed(*app, o->scene);
  add_threads(*app, o->threads);
  app->add_option("--stats", o->statistics_file,
                  "Writes what it took as JSON: times in seconds, counts, memory in bytes")
      ->option_text("FILE.json");
  return {app, [o]() -> Result<ExitCode> {
            if (o->samples && o->seconds)
              return bad_input("found --spp as well, expected one of the two", {"", 0, 0, "--time"});
            return run_render(*o);
          }};
}

Command make_probe(CLI::App& root) {
  auto o = std::make_shared<ProbeOptions>();
  CLI::App* app = add_command(
      root, "probe", "Measures the light along one ray, as JSON", "FILE --ray=ox,oy,oz,dx,dy,dz [OPTIONS]",
      "Samples are independent whatever sampler the scene names, so that the standard errors mean what they say.\n"
      "Radiance in W/(sr m^2); segments are those of the ray; lookups, rays and shadow_rays are means per sample\n"
      "and count scattered rays too.\n\n"
      "Example:\n"
      "  brume probe scenes/fog.json --ray=0,-6,1,0,1,0 --samples 65536 --set render.bounces=0");
  add_file(*app, o->scene.file);
  app->add_option_function<std::string>(
         "--ray",
         [o](const std::string& text) {
           if (const auto done = parse_ray(text, *o); !done) throw BadFlag{done.error()};
         },
         "Origin and direction, world units; the direction is normalised")
      ->required()
      ->option_text("OX,OY,OZ,DX,DY,DZ");
  add_value(*app, "T",
            param::number("tmin", "Begin", 0).between(0, 1e15).in("world units").says("Where the ray begins"),
            [o](const Value& v) { o->t_min = std::get<double>(v); });
  add_value(*app, "T",
            param::number("tmax", "End", 1)
                .between(0, 1e15)
                .auto_by_default("no end")
                .in("world units")
                .says("Where the ray ends"),
            [o](const Value& v) { o->t_max = std::get<double>(v); });
  add_value(*app, "N",
            param::integer("samples", "Samples", static_cast<std::int64_t>(o->samples))
                .between(1, 0x1p32)
                .says("Samples; an odd number is rounded up"),
            [o](const Value& v) { o->samples = static_cast<std::uint64_t>(std::get<std::int64_t>(v)); });
  add_settings(*app, o->scene);
  add_seed(*app, o->scene);
  add_threads(*app, o->threads);
  return {app, [o] { return run_probe(*o); }};
}

Command make_snapshot(CLI::App& root) {
  struct Options {
    SceneOptions scene;
    SnapshotOptions snapshot;
  };
  auto o = std::make_shared<Options>();
  CLI::App* app = add_command(root, "snapshot", "Draws the whole interface into a PNG, without a display",
                              "FILE -o UI.png [OPTIONS]",
                              "Example:\n  brume snapshot scenes/smoke.json -o smoke_ui.png --size 1920x1080 --spp 64");
  add_file(*app, o->scene.file);
  app->add_option("-o,--output", o->snapshot.output, "Picture to write (.png)")->required()->option_text("UI.png");
  add_value(*app, "WxH",
            param::resolution("size", "Size", o->snapshot.width, o->snapshot.height)
                .between(64, 8192)
                .in("pixels")
                .says("Size of the interface"),
            [o](const Value& v) {
              o->snapshot.width = static_cast<int>(std::get<Numbers>(v)[0]);
              o->snapshot.height = static_cast<int>(std::get<Numbers>(v)[1]);
            });
  add_value(*app, "N",
            param::integer("spp", "Samples", o->snapshot.samples)
                .between(1, 1 << 24)
                .says("Samples per pixel of the rendered view"),
            [o](const Value& v) { o->snapshot.samples = to_int(v); });
  app->add_flag("--chart", o->snapshot.chart, "With the chart of errors against time");
  app->add_flag("--search", o->snapshot.search, "With the chart of a search for the cheapest settings");
  app->add_flag("--probe", o->snapshot.probe, "With the probe of the pixel in the middle");
  add_settings(*app, o->scene);
  return {app, [o] { return run_snapshot_command(o->scene, o->snapshot); }};
}

Command make_info(CLI::App& root) {
  auto o = std::make_shared<InfoOptions>();
  CLI::App* app = add_command(
      root, "info", "Tells what a scene or a grid file holds", "FILE [--json]",
      "Lengths are in world units.\n\nExamples:\n  brume info smoke.vdb\n  brume info scenes/smoke.json --json");
  add_file(*app, o->file);
  app->add_flag("--json", o->json, "As JSON");
  return {app, [o] { return run_info(*o); }};
}

Command make_bench(CLI::App& root) {
  auto o = std::make_shared<BenchCommandOptions>();
  CLI::App* app =
      add_command(root, "bench", "Measures how fast this machine renders", "[OPTIONS]",
                  "Of the inner loops it also tells how fast they could be here (limit), from kernels that\n"
                  "do the least possible work in the same process.\n\n"
                  "Examples:\n  brume bench\n  brume bench --json --only smoke");
  app->add_option("--only", o->only, "Only what has this in its name")->option_text("TEXT");
  CLI::Option* json = app->add_flag("--json", o->json, "As a JSON list of {name, value, unit, limit, ratio, goal}");
  app->add_flag("--markdown", o->markdown, "As a Markdown table")->excludes(json);
  app->add_option("--csv", o->csv_file, "Also writes them to this file")->option_text("FILE.csv");
  return {app, [o] { return run_bench_command(*o); }};
}

Command make_compare(CLI::App& root) {
  auto o = std::make_shared<CompareOptions>();
  CLI::App* app = add_command(root, "compare", "Tells how far one picture is from another",
                              "TEST REFERENCE [--metric METRIC] [OPTIONS]",
                              "Pictures are .exr, or .png taken as sRGB. Exit code 3: beyond the threshold.\n\n"
                              "Examples:\n  brume compare smoke.exr reference.exr -o difference.png\n"
                              "  brume compare smoke.exr reference.exr --metric rmse --threshold 0.01");
  app->add_option("TEST", o->test, "Picture that is judged")->required()->option_text(" ");
  app->add_option("REFERENCE", o->reference, "Picture that is right")->required()->option_text(" ");
  app->add_option("--metric", o->metrics, "One of " + join(metric_keys()) + "\n(default: all; may be repeated)")
      ->option_text("METRIC")
      ->allow_extra_args(false);
  app->add_option("-o,--output", o->output, "Writes what a person would see of the difference (FLIP)")
      ->option_text("DIFF.png");
  add_value(*app, "X",
            param::number("threshold", "Threshold", 0)
                .at_least(0)
                .auto_by_default("none")
                .says("Most that the size of the one metric may be"),
            [o](const Value& v) { o->threshold = std::get<double>(v); });
  add_value(*app, "STOPS",
            param::number("exposure", "Exposure", 0).between(-20, 20).in("stops").says("Exposure of what is seen"),
            [o](const Value& v) { o->viewing.exposure = static_cast<float>(std::get<double>(v)); });
  const auto end_of_range = [&](const char* key, const char* label, const char* doc, std::optional<float>& end) {
    add_value(
        *app, "STOPS",
        param::number(key, label, 0).between(-200, 200).in("stops").auto_by_default("from the reference").says(doc),
        [o, &end](const Value& v) { end = static_cast<float>(std::get<double>(v)); });
  };
  end_of_range("start-exposure", "Start exposure", "Darkest exposure of HDR-FLIP", o->viewing.start_exposure);
  end_of_range("stop-exposure", "Stop exposure", "Brightest exposure of HDR-FLIP", o->viewing.stop_exposure);
  app->add_flag("--json", o->json, "As JSON");
  return {app, [o] { return run_compare(*o); }};
}

/// "--steps 0.1,0.2": a list, checked by whoever uses it.
void add_list(CLI::App& app, const std::string& flag, const std::string& placeholder, std::vector<std::string>& list,
              const std::string& doc) {
  app.add_option(flag, list, doc)->delimiter(',')->allow_extra_args(false)->option_text(placeholder);
}

Command make_chart(CLI::App& root) {
  auto o = std::make_shared<ChartOptions>();
  CLI::App* app = add_command(
      root, "chart", "Measures speed against accuracy and charts one against the other",
      "FILE -o CHART.svg|.png|.csv [OPTIONS]",
      "Charts the variants that the scene file compares, or the methods that are named, each against a reference\n"
      "rendered by an unbiased integrator, which is kept for the next time. Time is processor time of the variant's\n"
      "own work.\n\n"
      "Examples:\n"
      "  brume chart scenes/smoke.json --methods all -o smoke.svg -o smoke.csv\n"
      "  brume chart scenes/smoke.json --methods product,ray_march --steps 0.02,0.05,0.1 --x step_size\n"
      "      --y relative_mean_bias -o bias.svg\n"
      "  brume chart smoke.vdb --methods all --light-samples 1,2,4 --pareto --apply-best fast.json -o front.png");
  add_file(*app, o->scene.file);
  app->add_option("-o,--output", o->outputs, "Chart (.svg, .png) or its numbers (.csv); may be repeated")
      ->required()
      ->option_text("OUT")
      ->allow_extra_args(false);
  add_list(*app, "--variants", "A,B,...", o->variants, "Variants of the scene file, by name (default: all)");
  add_list(*app, "--methods", "all|M,...", o->methods,
           "Methods instead: all, integrators by key, or the decoupled one\nby its distance sampling");
  add_list(*app, "--steps", "S,...", o->steps, "Each with every one of these step sizes");
  add_list(*app, "--light-samples", "N,...", o->light_samples, "Each with every one of these numbers of light samples");
  add_list(*app, "--bounces", "N,...", o->bounces, "Each with every one of these numbers of bounces");
  app->add_option("--x", o->x, "What is along x (default: cpu_seconds): one of\n" + join(sweep_axis_keys()))
      ->option_text("QUANTITY");
  app->add_option("--y", o->y, "What is along y (default: rmse)")->option_text("QUANTITY");
  app->add_option("--title", o->title, "Title of the chart")->option_text("TEXT");
  add_value(*app, "SECONDS",
            param::number("budget", "Budget", o->seconds)
                .between(0.01, 1e6)
                .in("CPU seconds")
                .says("Time for each variant; the pass under way is ended"),
            [o](const Value& v) { o->seconds = std::get<double>(v); });
  add_value(*app, "N",
            param::integer("spp", "Samples", 1)
                .between(1, 1 << 24)
                .auto_by_default("--budget decides")
                .says("Most samples per pixel"),
            [o](const Value& v) { o->samples = to_int(v); });
  app->add_option("--reference", o->reference, "Picture taken as the truth (default: one is rendered)")
      ->option_text("EXR");
  add_value(*app, "SECONDS",
            param::number("reference-time", "Reference time", o->reference_seconds)
                .between(0.01, 1e6)
                .in("CPU seconds")
                .says("Time for the reference, over all calls"),
            [o](const Value& v) { o->reference_seconds = std::get<double>(v); });
  app->add_flag("--pareto", o->front, "Marks the cheapest for their error, and the best");
  add_value(*app, "ERROR",
            param::number("target", "Target", 1)
                .more_than(0)
                .auto_by_default("none")
                .says("The best is the cheapest with at most this error; exit code 3 where none is"),
            [o](const Value& v) { o->target = std::get<double>(v); });
  app->add_option("--apply-best", o->best, "Writes the scene with the settings of the best")->option_text("OUT.json");
  app->add_flag("!--dark", o->light, "On a dark ground");
  add_value(*app, "WxH",
            param::resolution("chart-size", "Chart size", o->width, o->height)
                .between(200, 8192)
                .in("pixels")
                .says("Size of the chart"),
            [o](const Value& v) {
              o->width = static_cast<int>(std::get<Numbers>(v)[0]);
              o->height = static_cast<int>(std::get<Numbers>(v)[1]);
            });
  add_settings(*app, o->scene);
  add_shorthand(*app, o->scene, "--size", "WxH", "film.resolution", "Size of the pictures (default: the scene's)");
  add_threads(*app, o->threads);
  return {app, [o] { return run_chart(*o); }};
}

std::vector<Command> make_commands(CLI::App& root) {
  std::vector<Command> commands{make_render(root),  make_probe(root), make_snapshot(root), make_info(root),
                                make_compare(root), make_chart(root), make_bench(root)};
  commands.push_back(
      {add_command(root, "schema", "Prints the JSON Schema of scene files, for editors", "> brume.schema.json"),
       run_schema});
  commands.push_back(
      {add_command(root, "docs", "Prints every parameter of a scene, as Markdown", "> parameters.md"), run_docs});
  return commands;
}

// ---- What was typed wrongly -----------------------------------------------------------------------------------------

std::string see_help(const CLI::App* chosen) {
  return "; see brume " + (chosen ? chosen->get_name() + " " : "") + "--help";
}

/// @param arguments  that nobody wanted, not empty
Error unexpected(const CLI::App& app, const std::vector<std::string>& arguments, const CLI::App* chosen) {
  const std::string& first = arguments.front();
  if (!first.starts_with('-') || first == "-")
    return bad_input("found \"" + first + "\", expected nothing more" + see_help(chosen));
  std::vector<std::string> flags;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
    for (const std::string& name : option->get_snames()) flags.push_back("-" + name);
  }
  return bad_input(unknown_name("flag", first.substr(0, first.find('=')), flags) + see_help(chosen));
}

Error usage_error(const CLI::App& root, const CLI::ParseError& e, const CLI::App* chosen) {
  const CLI::App& app = chosen ? *chosen : root;
  if (const auto extras = app.remaining(true); !extras.empty()) return unexpected(app, extras, chosen);
  std::string message = e.what();  // "--output is required", "--spp: At Most 1 required but received 2"
  if (e.get_name() == "ArgumentMismatch") message = message.substr(0, message.find(':')) + ": expected one value";
  while (message.ends_with('\n') || message.ends_with('.')) message.pop_back();
  return bad_input(message + see_help(chosen));
}

/// A first word that is neither a command nor a file; it may be meant as either.
Result<void> check_file(const std::string& file, const std::vector<Command>& commands) {
  std::error_code unknown;
  if (std::filesystem::exists(file, unknown)) return {};
  if (std::filesystem::path(file).has_extension() || file.find('/') != std::string::npos)
    return bad_input("there is no such file", {file, 0, 0, ""});
  std::vector<std::string> names;
  for (const Command& command : commands) names.push_back(command.app->get_name());
  return bad_input(unknown_name("command", file, names) + ", and there is no such file" + see_help(nullptr));
}

Result<ExitCode> parse_and_run(int argc, char** argv) {
  CLI::App root("Brume lights smoke, fire, cloud and fog by decoupled ray-marching.");
  root.formatter(
      help_formatter("brume [FILE]                     opens the window\n"
                     "       brume COMMAND FILE [OPTIONS]"));
  root.set_help_flag("-h,--help", "This text; brume COMMAND --help tells more");
  root.set_version_flag("--version", "brume " BRUME_VERSION, "The program's version");
  std::string file;
  root.add_option("FILE", file, "Scene (.json) or grids (.vdb, .nvdb) to open")->option_text(" ");
  root.require_subcommand(0, 1);
  const std::vector<Command> commands = make_commands(root);
  // After the commands, which would take the text over.
  root.footer(
      "Examples:\n"
      "  brume smoke.vdb\n"
      "  brume render scenes/smoke.json -o smoke.png\n\n"
      "Exit codes: 0 done, 1 internal error, 2 bad input, 3 a check did not hold, 130 interrupted by Ctrl+C.\n"
      "The environment variable BRUME_SIMD names the vector instructions to use: " +
      join(simd_levels()) + ".");

  const auto chosen = [&]() -> const Command* {
    for (const Command& command : commands)
      if (command.app->parsed()) return &command;
    return nullptr;
  };
  try {
    root.parse(argc, argv);
  } catch (const CLI::Success& e) {  // --help, --version
    std::ostringstream text;
    root.exit(e, text, text);
    if (auto done = print_result(text.str()); !done) return done.error();
    return ExitCode::Ok;
  } catch (const CLI::ParseError& e) {
    const Command* command = chosen();
    if (!command && !file.empty())
      if (auto done = check_file(file, commands); !done) return done.error();
    return usage_error(root, e, command ? command->app : nullptr);
  } catch (const BadFlag& bad) {
    return bad.error;
  }

  if (const Command* command = chosen()) {
    if (!file.empty())
      return bad_input("found \"" + file + "\" before " + command->app->get_name() + ", expected one of the two");
    return command->run();
  }
  if (file.empty()) return static_cast<ExitCode>(run_window(std::nullopt));
  if (auto done = check_file(file, commands); !done) return done.error();
  return static_cast<ExitCode>(run_window(file));
}

}  // namespace

int run_command_line(int argc, char** argv) {
  Result<ExitCode> result = ExitCode::Ok;
  try {
    result = parse_and_run(argc, argv);
  } catch (const std::bad_alloc&) {
    result = Error{ErrorCode::Internal, "the machine has not enough memory for this"};
  } catch (const std::exception& e) {
    result = Error{ErrorCode::Internal, e.what()};
  }
  if (result) return static_cast<int>(*result);
  print_error(result.error());
  return static_cast<int>(exit_code_of(result.error()));
}

}  // namespace brume
