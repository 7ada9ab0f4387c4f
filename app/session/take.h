// A picture that was kept, with the scene that made it.
#pragma once

#include <memory>
#include <string>

#include "renderer/engine/engine.h"
#include "renderer/params/node.h"

namespace brume {

struct Take {
  int number;        ///< 1 is the first of the session
  std::string name;  ///< "smoke.json", with the name of the variant where there are several
  Node description;  ///< the whole document
  std::shared_ptr<const Picture> picture;
};

}  // namespace brume
