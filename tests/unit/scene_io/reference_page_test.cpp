#include "renderer/scene_io/reference_page.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "renderer/scene_io/families.h"
#include "tests/unit/scene_io/test_tables.h"

namespace brume {
namespace {

bool holds(const std::string& page, const std::string& text) { return page.find(text) != std::string::npos; }

TEST(ReferencePage, HoldsEveryKindKeyAndChoice) {
  const std::string page = reference_page(test_tables::studio_family());
  for (const Family* f : reachable_families(test_tables::studio_family())) {
    for (const ParamTable* t : f->tables) {
      EXPECT_TRUE(f->type_key.empty() || holds(page, "### " + t->label + "\n")) << t->label;
      EXPECT_TRUE(f->type_key.empty() || holds(page, "`\"" + f->type_key + "\": \"" + t->key + "\"`")) << t->key;
      for (const Param& p : t->params) {
        EXPECT_TRUE(holds(page, "| `" + p.key + "` | " + p.label + " |")) << p.key;
        for (const Choice& c : p.choices) EXPECT_TRUE(holds(page, "  - `" + c.key + "`")) << c.key;
      }
      for (const Slot& s : t->slots) EXPECT_TRUE(holds(page, "| `" + s.key + "` | " + s.label + " |")) << s.key;
    }
  }
}

TEST(ReferencePage, RowsSayAllThereIsToSay) {
  const std::string page = reference_page(test_tables::studio_family());
  EXPECT_TRUE(holds(page, "| `exposure` | Exposure | number | `0` | >= -20, <= 20 | stops | nothing |  |"));
  EXPECT_TRUE(holds(page, "| `file` | File | file | required |  |  | loading and the picture | The .vdb file. |"));
  EXPECT_TRUE(
      holds(page, "| `step` | Step | number or `\"auto\"` | `\"auto\"` | > 0 | world units | the picture |  |"));
  EXPECT_TRUE(holds(page, "| `resolution` | Resolution | two whole numbers | `[640, 480]` | >= 1, <= 16384 |"));
  EXPECT_TRUE(holds(page, "| `lights` | Lights | list of [light](#light) | `[]` |"));
  EXPECT_TRUE(holds(page, "| `phase` | Phase function | object: [phase function](#phase-function) | `isotropic` |"));
  EXPECT_TRUE(holds(page, "## Phase function\n"));
  EXPECT_TRUE(holds(page, "- `step`: `\"auto\"` is the voxel size.\n"));
  EXPECT_TRUE(holds(page, "\"brume\": 1"));
}

TEST(ReferencePage, TablesHaveTheSameColumnsInEveryRow) {
  std::istringstream lines(reference_page(test_tables::studio_family()));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("|")) continue;
    int bars = 0;
    for (std::size_t i = 0; i < line.size(); ++i) bars += line[i] == '|' && (i == 0 || line[i - 1] != '\\');
    EXPECT_EQ(bars, 9) << line;
  }
}

TEST(ReferencePage, EndsWithOneNewline) {
  const std::string page = reference_page(test_tables::studio_family());
  EXPECT_TRUE(page.ends_with("\n"));
  EXPECT_FALSE(page.ends_with("\n\n"));
}

}  // namespace
}  // namespace brume
