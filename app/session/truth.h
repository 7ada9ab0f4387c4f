// The reference of the scene that is open: found, rendered beside the pictures, kept.
#pragma once

#include <optional>
#include <thread>

#include "renderer/experiments/reference.h"

namespace brume {

/// What a description's reference is, as far as files and the scene tell.
struct FoundTruth {
  std::shared_ptr<const Scene> scene;  ///< to be rendered; null: the picture is given, or there can be none
  std::string path;                    ///< where it is kept; empty: nowhere
  Reference kept;                      ///< from other sessions, or given; may have no picture
  int width = 0, height = 0;
  std::string problem;  ///< with a picture that is named; empty: none
};

/// Reads files and commits: for the session's worker.
class TruthFinder {
 public:
  /// @param folder  where references are kept; empty: nowhere
  FoundTruth find(const Node& description, SceneCache& cache, const std::string& folder, int width, int height,
                  std::uint64_t generation);

 private:
  std::optional<Node> last_;  // the same truth as before goes on being rendered
  std::shared_ptr<const Scene> last_scene_;
};

/// The reference as it gets better. Belongs to the UI thread.
class Truth {
 public:
  void want(bool wanted);
  bool wanted() const { return wanted_; }

  /// @return whether it is another than before
  bool take(FoundTruth found);
  /// What the engine shall render for it; nothing when it is done or given.
  std::optional<Job> job() const;
  /// A picture of that job, as often as one likes.  @param time  processor seconds that it may have
  /// @return whether there is something new: reference() or job()
  bool see(const std::shared_ptr<const Picture>& picture, double time);

  /// Null while there is none.
  const std::shared_ptr<const Reference>& reference() const { return reference_; }
  /// It was not rendered here.
  bool given() const { return reference_ && !found_.scene; }
  /// Why there is none; empty when there is, or may come.
  const std::string& problem() const { return found_.problem; }
  int width() const { return found_.width; }
  int height() const { return found_.height; }

 private:
  bool wanted_ = false, done_ = false;
  FoundTruth found_;
  std::shared_ptr<const Picture> seen_;
  std::shared_ptr<const Reference> reference_;
  std::jthread keeper_;  // writes a reference that is done
};

}  // namespace brume
