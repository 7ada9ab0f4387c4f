// The picture that is taken for the truth.
#pragma once

#include <functional>
#include <string>

#include "renderer/engine/engine.h"
#include "renderer/params/node.h"

namespace brume {

/// A picture by an unbiased integrator, or one that somebody gave.
struct Reference {
  Image image;
  /// Squared error that is to be expected of it, mean over pixels and channels; 0 where nobody knows.
  double variance = 0;
  int samples_per_pixel = 0;  ///< 0 where nobody knows
  double cpu_seconds = 0;     ///< spent on it
};

/// The scene as its reference is rendered: by null scattering (unbiased, no steps), with independent numbers and
/// another seed, so that its errors have nothing to do with those it judges. Bounces and all that is lit stay as they
/// are.
Node reference_description(const Node& scene);

struct ReferenceOptions {
  int width = 0, height = 0;
  double cpu_seconds = 60;                    ///< of all threads together, over all sessions
  std::string folder;                         ///< where references are kept between sessions; empty: nowhere
  std::function<void(double)> progress = {};  ///< fraction of the time, from the caller's thread
  std::stop_token cancel = {};
};

/// What the folder holds of this scene, if anything, and as much more of it as there is time left for; kept for the
/// next time, better each time more is asked for. A reference is found by a hash of its description, its size and the
/// files that it names. What cannot be read or kept is rendered anew each time.
/// Errors: the scene cannot be committed; cancelled before the first pass.
Result<Reference> make_reference(const Node& scene, SceneCache& cache, WorkerPool& pool,
                                 const ReferenceOptions& options);

/// Two independent parts of one reference, each weighted by its samples.
Reference merged(const Reference& a, const Reference& b);

/// Where a folder keeps the reference of a description of reference_description(); empty for no folder.
std::string reference_path(const std::string& folder, const Node& description, int width, int height);
/// What is kept there, or a reference without samples.
Reference read_reference(const std::string& path, int width, int height);
/// Keeps it there; where that cannot be, it is rendered anew the next time.
void keep_reference(const std::string& path, const Reference& reference);

/// The hash, 32 hexadecimal digits.  @param description  of reference_description()
std::string reference_key(const Node& description, int width, int height);

/// A picture of somebody else's (.exr).  Errors: as read_exr(); not of this size; not finite.
Result<Reference> load_reference(const std::string& path, int width, int height);

}  // namespace brume
