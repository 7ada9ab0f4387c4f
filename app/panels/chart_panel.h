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
  /// The sweep that is seen: what is rendered, or what a search has found.
  std::shared_ptr<const Sweep> sweep(const Session& session) const;
  bool shows_search(const Session& session) const { return searched_ && session.search().found(); }
  Chart chart(const Sweep& sweep, const Session& session, bool measured) const;
  void draw_search(Session& session);

  std::string error_ = "rmse_net";  // what is along y
  bool front_ = false;
  bool searched_ = true;                          // what was searched is seen, once it is there
  float width_ = 960, height_ = 560, font_ = 14;  // as drawn last
};

}  // namespace brume
