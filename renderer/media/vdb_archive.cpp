#include "renderer/media/vdb_archive.h"

#include <algorithm>

#include "renderer/media/vdb_tree.h"

namespace brume::vdb {
namespace {

/// Calls parse(cursor) on ever longer pieces of the file from `begin` on, until it finds all it asks for.
template <class F> auto parse_at(InputFile& file, std::uint64_t begin, std::uint64_t end, const F& parse) {
  for (std::uint64_t piece = 64 << 10;; piece *= 8) {
    const auto data = file.read(begin, std::min(piece, end - begin));
    Cursor cursor(data);
    try {
      return parse(cursor);
    } catch (const EndsEarly&) {
      if (piece >= end - begin) throw;
    }
  }
}

}  // namespace

void refuse_damaged(const std::string& path, const std::string& grid, const Damaged& damaged) {
  refuse(in_quotes(path) + " cannot be read" + (grid.empty() ? "" : " (grid " + in_quotes(clamped(grid)) + ")") + ": " +
         damaged.what);
}

Archive::Archive(const std::string& path) : file_(path) {
  try {
    std::uint64_t at = 0;
    const FileHead head = parse_at(file_, 0, file_.size(), [&](Cursor& c) {
      FileHead h = read_file_head(c);
      at = c.position();
      return h;
    });
    head.has_offsets ? follow_offsets(head, at) : walk_stream(head, at);
  } catch (const Damaged& damaged) {
    refuse_damaged(path, "", damaged);
  }
  if (entries_.empty()) refuse(in_quotes(path) + " holds no grids");
}

const GridEntry& Archive::tree_of(const GridEntry& entry) const {
  if (entry.parent.empty()) return entry;
  for (const GridEntry& e : entries_)
    if (e.unique_name == entry.parent && e.parent.empty() && e.tree == entry.tree) return e;
  throw Damaged{"it shares the tree of a grid that is not in the file"};
}

GridHead Archive::head(const GridEntry& entry) {
  return parse_at(file_, entry.begin, entry.end, [](Cursor& c) { return read_grid_head(c); });
}

LargeArray<std::byte> Archive::bytes(const GridEntry& entry, bool topology_only, const LoadOptions& options) {
  return file_.read(entry.begin, (topology_only ? entry.blocks : entry.end) - entry.begin, options);
}

void Archive::follow_offsets(const FileHead& head, std::uint64_t at) {
  for (int i = 0; i < head.grids; ++i) {
    std::uint64_t behind = 0;
    GridEntry entry = parse_at(file_, at, file_.size(), [&](Cursor& c) {
      GridEntry e = read_grid_entry(c);
      behind = at + c.position();
      return e;
    });
    if (entry.end > file_.size())
      throw Damaged{"it is cut off, at " + std::to_string(file_.size()) + " of at least " + std::to_string(entry.end) +
                    " bytes"};
    if (!entry.parent.empty()) entry.blocks = entry.end;
    if (entry.begin < behind || entry.blocks < entry.begin || entry.end < entry.blocks)
      throw Damaged{"the places of its grids make no sense"};
    at = entry.end;
    entries_.push_back(std::move(entry));
  }
}

/// A file that was written as a stream tells no places: they are found by walking all trees.
void Archive::walk_stream(const FileHead& head, std::uint64_t at) {
  const auto data = file_.read(0, file_.size());
  Cursor c(data, at);
  for (int i = 0; i < head.grids; ++i) {
    GridEntry entry = read_grid_entry(c);
    entry.begin = c.position();
    const GridHead grid = read_grid_head(c);
    entry.blocks = entry.end = c.position();
    if (entry.parent.empty()) {
      const auto value = value_of_tree(entry.tree);
      if (!value)
        throw Damaged{"it was written as a stream, and grids of type " + clamped(entry.tree) +
                      " in it cannot be skipped"};
      const TreeFormat format{*value, entry.half, grid.compression};
      Tree tree = read_topology(c, format);
      entry.blocks = c.position();
      find_leaf_values(c, format, tree);
      entry.end = c.position();
    }
    entries_.push_back(std::move(entry));
  }
}

}  // namespace brume::vdb
