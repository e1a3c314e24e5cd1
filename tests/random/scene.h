// A scene as a list of blocks of a model file, so that it can be written, run, and made smaller block by block.
#pragma once

#include "mbd/model/model.h"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace steplap::random {

/// One [[body]], [[signal]], [[element]] or [[action]].
struct Block {
  std::string table, kind, name;
  std::string fields;            ///< lines "key = value"
  std::vector<std::string> uses; ///< names of blocks without which it makes no sense
};

struct Scene {
  std::uint64_t seed = 0;
  double end = 1.0, output_step = 0.005;
  double gravity = 9.81;
  std::vector<Block> blocks;
  std::map<std::string, std::string> files; ///< records: name -> CSV text
  std::set<std::string> cells;              ///< kinds of mechanisms in it

  /// The model file.
  [[nodiscard]] std::string text(const std::string& comment = {}) const;
  /// Without the named block and all that use it, and without signals that nothing uses.
  [[nodiscard]] Scene without(const std::string& name) const;
  [[nodiscard]] bool has(const std::string& kind) const;
};

/// Writes the model file, and its records beside it.
void write_scene(const Scene& scene, const std::string& path, const std::string& comment = {});

/// Reads the scene back as the program would; `folder` is where its records are written to.
[[nodiscard]] Model model_of(const Scene& scene, const std::string& folder);

} // namespace steplap::random
