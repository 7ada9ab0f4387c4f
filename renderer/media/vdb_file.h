// Voxel grids from .vdb files, and from .nvdb files by the same functions.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "renderer/core/transform.h"
#include "renderer/media/brick_grid.h"

namespace brume {

/// One grid of a file, as far as it is known without loading it.
struct GridInfo {
  std::string name;        ///< unique in its file: "density", or "density[1]" where the file repeats a name
  std::string type;        ///< of the values: "float", "double", "int32", "bool", "mask", "vec3s", "Fp16", ...
  std::string grid_class;  ///< "fog volume", "level set", "staggered", "unknown"
  std::string codec;       ///< as OpenVDB writes it: "none", "zip + active values", "blosc", ...
  bool is_half = false;    ///< real values are kept in 16 bits in the file

  bool affine = true;  ///< false: a frustum, which Brume does not read
  Vec3d voxel_size;    ///< world units: lengths of the three index axes; 0 when not affine

  std::optional<std::uint64_t> active_voxels;  ///< nothing for types that Brume does not read, unless the file tells
  VoxelIndex index_min, index_max;             ///< box of the active voxels, both inclusive; only when there are any
  Bounds3 world_bounds;                        ///< round that box, half a voxel wider on each side; empty otherwise
  std::uint64_t memory_bytes = 0;              ///< estimate of what the loaded grid takes

  bool scanned = false;                        ///< the four below are known
  float min = 0, max = 0;                      ///< of the finite active values, as they are in the file
  std::uint64_t non_finite = 0, negative = 0;  ///< voxels that will be 0 instead (with inactive ones of the active box)

  bool usable = false;  ///< load_grid() can be expected to succeed
  std::string why_not;  ///< otherwise: completes "grid ... " in a sentence, "is of type vec3s, not a scalar"
};

struct LoadedGrid {
  std::shared_ptr<const BrickGrid> grid;
  Affined index_to_world;             ///< any invertible affine map: scaled, rotated, sheared, mirrored, offset
  GridInfo info;                      ///< scanned
  std::vector<std::string> warnings;  ///< one sentence each: what was changed in the data, and why it may matter
};

/// Lists what a .vdb or .nvdb file (told by its extension) holds, in the order of the file.
/// @param scan_values  false: reads descriptions, and tree structures where a description lacks the active box (some
///   milliseconds); true: decodes all scalar voxels too (seconds for large files).
/// Errors, one sentence with the file's name in quotes: missing, unreadable, not a regular file, not of this format,
/// cut off, damaged, no grids. Any thread. Nothing is kept of the file.
Result<std::vector<GridInfo>> list_grids(const std::string& path, bool scan_values = false);

/// Loads one grid. float, double, int32, int64; bool and mask as 0 and 1; level sets are turned into fog volumes.
/// Values that are negative or not finite become 0, with a warning; so does the background.
/// Errors as list_grids(), and: no such grid (lists those there are), not usable (says why, lists those that are),
/// empty, too large (see build_brick_grid()), cancelled. Any thread; uses all hardware threads.
Result<LoadedGrid> load_grid(const std::string& path, const std::string& grid_name, const LoadOptions& options = {});

/// The grid to take for smoke density when the user named none: "density", else one whose name says soot or smoke,
/// else the first fog volume, else the first scalar grid; never one that is named like something else (shadow,
/// temperature, flame, heat, velocity, ...). Only usable ones.
std::optional<std::string> guess_density_grid(std::span<const GridInfo> grids);

/// The grid to take for emission: the first that is named flame, flames, fire, emission, ... and usable.
std::optional<std::string> guess_emission_grid(std::span<const GridInfo> grids);

/// The grid that says how hot the fire is: the first that is named temperature or heat and usable.
std::optional<std::string> guess_temperature_grid(std::span<const GridInfo> grids);

}  // namespace brume
