// Where the grids of a .vdb file lie, and their bytes.
#pragma once

#include "renderer/media/grid_file.h"
#include "renderer/media/vdb_layout.h"

namespace brume::vdb {

/// "path" cannot be read (grid "name"): what.
[[noreturn]] void refuse_damaged(const std::string& path, const std::string& grid, const Damaged& damaged);

/// An open file and the places of its grids. One thread at a time.
class Archive {
 public:
  /// Throws FileProblem: cannot be opened, is no .vdb file, cut off, damaged, without grids.
  explicit Archive(const std::string& path);

  const std::vector<GridEntry>& entries() const { return entries_; }
  /// The entry whose tree `entry` uses: mostly itself. Throws Damaged.
  const GridEntry& tree_of(const GridEntry& entry) const;
  /// Throws Damaged, FileProblem.
  GridHead head(const GridEntry& entry);
  /// The bytes of a grid, without the values of its leaves where `topology_only`. Throws FileProblem.
  LargeArray<std::byte> bytes(const GridEntry& entry, bool topology_only, const LoadOptions& options = {});

 private:
  void follow_offsets(const FileHead& head, std::uint64_t at);
  void walk_stream(const FileHead& head, std::uint64_t at);

  InputFile file_;
  std::vector<GridEntry> entries_;
};

}  // namespace brume::vdb
