#include "app/cli/docs.h"

#include "app/cli/console.h"
#include "renderer/integrators/registry.h"
#include "renderer/scene_io/reference_page.h"

namespace brume {

Result<ExitCode> run_docs() {
  if (auto done = print_result(reference_page(scene_family())); !done) return done.error();
  return ExitCode::Ok;
}

}  // namespace brume
