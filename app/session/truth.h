// The reference of the scene that is open: found, rendered beside the pictures, kept.
#pragma once

#include <optional>
#include <thread>

#include "renderer/experiments/reference.h"

namespace brume {

/// What tells one reference from another.
struct TruthKey {
  std::string given;                             ///< picture that the description names; empty: it is rendered
  std::shared_ptr<const Scene> scene = nullptr;  ///< to be rendered; null: it is given, or there can be none
  int width = 0, height = 0;

  bool operator==(const TruthKey&) const = default;
};

/// What a description's reference is, as far as files and the scene tell.
struct FoundTruth {
  TruthKey key = {};
  std::string path = {};     ///< where it is kept; empty: nowhere
  Reference kept = {};       ///< from other sessions, or given; may have no picture
  std::string problem = {};  ///< why there is none; empty: there is, or may come
};

/// Reads files and commits: for the session's worker.
class TruthFinder {
 public:
  /// Nothing when it is the one that is known: an edit that leaves the truth alone reads no file.
  /// @param folder  where references are kept; empty: nowhere.  @param known  of this size, or nothing
  std::optional<FoundTruth> find(const Node& description, SceneCache& cache, const std::string& folder, int width,
                                 int height, std::uint64_t generation, const TruthKey& known);

 private:
  std::optional<Node> last_;  // the same truth as before goes on being rendered
  std::shared_ptr<const Scene> last_scene_;
};

/// The reference as it gets better. Belongs to the UI thread.
class Truth {
 public:
  void want(bool wanted);
  bool wanted() const { return wanted_; }

  void take(FoundTruth found);
  /// Of what was taken last.
  const TruthKey& key() const { return found_.key; }
  /// What the engine shall render for it; nothing when it is done or given.
  std::optional<Job> job() const;
  /// A picture of that job, as often as one likes.  @param time  processor seconds that it may have
  /// @return whether there is something new: reference() or job()
  bool see(const std::shared_ptr<const Picture>& picture, double time);

  /// Null while there is none.
  const std::shared_ptr<const Reference>& reference() const { return reference_; }
  /// It was not rendered here.
  bool given() const { return reference_ && !found_.key.scene; }
  /// Why there is none; empty when there is, or may come.
  const std::string& problem() const { return found_.problem; }

 private:
  bool wanted_ = false, done_ = false;
  FoundTruth found_;
  std::shared_ptr<const Picture> seen_;
  std::shared_ptr<const Reference> reference_;
  std::jthread keeper_;  // writes a reference that is done
};

}  // namespace brume
