// The phase functions a scene file can name.
#pragma once

#include <memory>

#include "renderer/params/node.h"
#include "renderer/phase/phase_function.h"

namespace brume {

struct PhaseType {
  const ParamTable* table;
  std::unique_ptr<const PhaseFunction> (*make)(const Node&);
};

const std::vector<PhaseType>& phase_types();
const Family& phase_family();

/// @param node  of one of phase_types()
std::unique_ptr<const PhaseFunction> make_phase(const Node& node);

}  // namespace brume
