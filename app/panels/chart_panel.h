// Error against time of what is rendered, live.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "app/session/session.h"
#include "renderer/analysis/chart.h"

namespace brume {

/// Draws the same chart as `brume chart`, of the pictures in the window.
class ChartPanel {
 public:
  /// Fills the rest of the current window.
  /// @param measured  false leaves out the numbers, which differ between runs
  /// @return true when the user wants to export
  bool draw(Session& session, bool measured);

  /// Writes the chart as it is seen (.svg, .png) or its numbers (.csv).
  Result<void> write(const Session& session, const std::string& path) const;

 private:
  Chart chart(const Sweep& sweep, const Session& session, bool measured) const;

  std::string error_ = "rmse_net";  // what is along y
  bool front_ = false;
  float width_ = 960, height_ = 560, font_ = 14;  // as drawn last
};

}  // namespace brume
