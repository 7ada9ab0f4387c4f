#include "app/cli/flags.h"

namespace brume {
namespace {

class HelpFormatter : public CLI::Formatter {
 public:
  explicit HelpFormatter(std::string usage) : usage_("Usage: " + std::move(usage) + "\n") {
    column_width(30);
    label("Positionals", "Arguments");
  }
  std::string make_usage(const CLI::App*, std::string) const override { return usage_; }
  std::string make_option_name(const CLI::Option* option, bool positional) const override {
    const std::string name = CLI::Formatter::make_option_name(option, positional);  // "-o,--output"
    const auto comma = name.find(',');
    return comma == std::string::npos ? name : name.substr(0, comma) + ", " + name.substr(comma + 1);
  }

 private:
  std::string usage_;
};

/// "Samples per pixel (default 16)", from the flag's description, which its value is read and checked with as well.
std::string help_of(const Param& p) {
  std::vector<std::string> details;
  if (!p.unit.empty()) details.push_back(p.unit);
  std::string usual = p.automatic ? *p.automatic : format_value(p.default_value);
  if (p.type == ParamType::Resolution) {  // as people type it
    const Numbers& size = std::get<Numbers>(p.default_value);
    usual = format_value(size[0]) + "x" + format_value(size[1]);
  }
  details.push_back("default " + usual);
  return p.doc + " (" + join(details, "; ") + ")";
}

}  // namespace

std::shared_ptr<CLI::Formatter> help_formatter(const std::string& usage) {
  return std::make_shared<HelpFormatter>(usage);
}

CLI::App* add_command(CLI::App& root, const std::string& name, const std::string& doc, const std::string& usage,
                      const std::string& examples) {
  CLI::App* app = root.add_subcommand(name, doc);
  app->group("Commands");
  app->formatter(help_formatter("brume " + name + " " + usage));
  app->set_help_flag("-h,--help", "This text");
  if (!examples.empty()) app->footer(examples);
  return app;
}

void add_value(CLI::App& app, const std::string& placeholder, const Param& p,
               const std::function<void(const Value&)>& take) {
  const std::string flag = "--" + p.key;
  app.add_option_function<std::string>(
         flag,
         [p, flag, take](const std::string& text) {
           const auto value = parse_value(p, text);
           if (!value) throw BadFlag{bad_input(value.error().message, {"", 0, 0, flag})};
           if (!std::holds_alternative<Auto>(*value)) take(*value);
         },
         help_of(p))
      ->option_text(placeholder);
}

int to_int(const Value& value) { return static_cast<int>(std::get<std::int64_t>(value)); }

void add_threads(CLI::App& app, int& threads) {
  const Param p =
      param::integer("threads", "Threads", 1).between(1, 1024).auto_by_default("one per core").says("Render threads");
  add_value(app, "N", p, [&threads](const Value& v) { threads = to_int(v); });
}

void add_file(CLI::App& app, std::string& file) {
  app.add_option("FILE", file, "Scene (.json), grids (.vdb, .nvdb), or a picture that Brume wrote (.exr, .png)")
      ->required()
      ->option_text(" ");
}

void add_shorthand(CLI::App& app, SceneOptions& scene, const std::string& flag, const std::string& placeholder,
                   const std::string& key, const std::string& doc) {
  app.add_option_function<std::string>(
         flag,
         [&scene, flag, key](const std::string& text) {
           scene.settings.push_back({flag, key, text});
         },
         doc)
      ->option_text(placeholder);
}

void add_settings(CLI::App& app, SceneOptions& scene) {
  app.add_option_function<std::vector<std::string>>(
         "--set",
         [&scene](const std::vector<std::string>& texts) {
           for (const std::string& text : texts) {
             auto setting = parse_setting(text);
             if (!setting) throw BadFlag{setting.error()};
             scene.settings.push_back(std::move(*setting));
           }
         },
         "Changes a value of the scene, for example render.bounces=2\nor lights.key.intensity=40,40,40; may be "
         "repeated")
      ->option_text("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_seed(CLI::App& app, SceneOptions& scene) {
  add_shorthand(app, scene, "--seed", "N", "render.seed", "Seed of the random numbers (default: the scene's)");
}

}  // namespace brume
