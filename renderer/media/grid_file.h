// What the readers of .vdb and .nvdb files share. Internal to renderer/media.
#pragma once

#include <cstddef>
#include <exception>
#include <fstream>
#include <new>

#include "renderer/media/vdb_file.h"

namespace brume {

/// Thrown inside the readers, caught by guard_file().
struct FileProblem {
  Error error;
};

/// "path" in double quotes, for messages.
std::string in_quotes(const std::string& text);
/// At most 300 bytes of text from a file or a library.
std::string clamped(std::string text);
/// grid "name" of "path", to begin a sentence.
std::string name_of(const GridInfo& grid, const std::string& path);
[[noreturn]] void refuse(std::string message);
void stop_if_cancelled(const LoadOptions& options);

/// Runs f() and turns whatever it throws into an error that names the file.
template <class F> auto guard_file(const std::string& path, const F& f) -> decltype(f()) {
  try {
    return f();
  } catch (const FileProblem& problem) {
    return problem.error;
  } catch (const std::bad_alloc&) {
    return bad_input(in_quotes(path) + " does not fit in the free memory");
  } catch (const std::exception& e) {
    return bad_input(in_quotes(path) + " cannot be read: " + clamped(e.what()));
  } catch (...) {
    return bad_input(in_quotes(path) + " cannot be read, for an unknown reason");
  }
}

/// A regular file, open for reading.
class InputFile {
 public:
  /// Throws FileProblem: missing, a directory, unreadable, empty, ...
  explicit InputFile(const std::string& path);

  std::uint64_t size() const { return size_; }
  /// `bytes` bytes from `offset` on, fewer at the end of the file. Throws FileProblem; can be cancelled.
  LargeArray<std::byte> read(std::uint64_t offset, std::uint64_t bytes, const LoadOptions& options = {});

 private:
  std::string path_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;
};

/// Fills what follows from the transform and the active box: voxel_size, world_bounds, usable, why_not (unless that is
/// set already). `active_voxels` and `index_min`, `index_max` must be set.
void complete_info(GridInfo& info, const Affined& index_to_world);

/// Fills min, max, non_finite and negative from the active voxels.
void scan_values(const VoxelBlocks& blocks, GridInfo& info);

/// Takes 0 for the background: wherever inactive voxels of leaves show it. (The blocks list no tiles of the
/// background.)
void clear_background(VoxelBlocks& blocks, float background);
std::string background_warning(const std::string& path, const GridInfo& info, float background);

/// Equality that also holds between NaNs: some writers use NaN as the background.
inline bool same_value(float a, float b) { return a == b || (a != a && b != b); }

/// Index in `grids` of the one that the user means. Throws FileProblem when there is none or it is not usable.
std::size_t choose_grid(const std::string& path, std::span<const GridInfo> grids, const std::string& name);

/// Lays the voxels out as bricks and adds the warnings that come of it.
Result<LoadedGrid> finish_grid(const std::string& path, VoxelBlocks blocks, GridInfo info,
                               const Affined& index_to_world, std::vector<std::string> warnings,
                               const LoadOptions& options);

}  // namespace brume
