#include "tests/random/scene.h"

#include "mbd/io/reader.h"
#include "tests/random/random_number.h"
#include "transformer/catalog.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace steplap::random {

namespace {

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream out(path);
  out << text;
  if (!out) throw std::runtime_error("cannot write " + path.string());
}

bool uses_any(const Block& block, const std::set<std::string>& names) {
  return std::any_of(block.uses.begin(), block.uses.end(), [&](const std::string& n) { return names.count(n) > 0; });
}

void remove_unused_signals(std::vector<Block>& blocks) {
  const auto is_unused = [&blocks](const Block& b) {
    return b.table == "signal" && std::none_of(blocks.begin(), blocks.end(), [&](const Block& other) {
             return std::find(other.uses.begin(), other.uses.end(), b.name) != other.uses.end();
           });
  };
  // What is made of others goes first, then they.
  for (;;) {
    const auto unused = std::find_if(blocks.begin(), blocks.end(), is_unused);
    if (unused == blocks.end()) return;
    blocks.erase(unused);
  }
}

} // namespace

std::string Scene::text(const std::string& comment) const {
  std::string text = comment;
  text += "title = \"random scene " + std::to_string(seed) + "\"\ngravity = " + pair(0.0, -gravity) +
          "\n\n[simulation]\nend = " + number(end) + "\n\n[output]\nstep = " + number(output_step) + "\n";
  for (const Block& block : blocks) {
    text += "\n[[" + block.table + "]]\n";
    if (!block.kind.empty()) text += "kind = \"" + block.kind + "\"\n";
    text += "name = \"" + block.name + "\"\n" + block.fields;
  }
  return text;
}

Scene Scene::without(const std::string& name) const {
  Scene rest = *this;
  std::set<std::string> gone{name};
  for (bool is_more = true; is_more;) {
    is_more = false;
    for (const Block& block : rest.blocks)
      if (uses_any(block, gone)) is_more = gone.insert(block.name).second || is_more;
  }
  std::erase_if(rest.blocks, [&](const Block& b) { return gone.count(b.name) > 0; });
  remove_unused_signals(rest.blocks);
  return rest;
}

bool Scene::has(const std::string& kind) const {
  return std::any_of(blocks.begin(), blocks.end(), [&](const Block& b) { return b.kind == kind; });
}

void write_scene(const Scene& scene, const std::string& path, const std::string& comment) {
  const std::filesystem::path place(path);
  if (place.has_parent_path()) std::filesystem::create_directories(place.parent_path());
  for (const auto& [name, text] : scene.files) write_text(place.parent_path() / name, text);
  write_text(place, scene.text(comment));
}

Model model_of(const Scene& scene, const std::string& folder) {
  for (const auto& [name, text] : scene.files) write_text(std::filesystem::path(folder) / name, text);
  return parse_model(scene.text(), folder + "/random_" + std::to_string(scene.seed) + ".toml", transformer_catalog());
}

} // namespace steplap::random
