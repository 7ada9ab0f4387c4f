#include "app/cli/schema.h"

#include "app/cli/console.h"
#include "renderer/integrators/registry.h"
#include "renderer/scene_io/json_schema.h"

namespace brume {

Result<ExitCode> run_schema() {
  if (auto done = print_result(json_schema(scene_family())); !done) return done.error();
  return ExitCode::Ok;
}

}  // namespace brume
