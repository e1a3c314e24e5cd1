// Docs that say what the program says: the generated reference, and the messages of the guide's exercise.
#include "tests/tools/workbench.h"

#include <doctest/doctest.h>

#include <vector>

using namespace steplap::testing;

namespace {

struct Block {
  std::string language, text;
};

// Fenced blocks of a Markdown text, in their order.
std::vector<Block> blocks_of(const std::string& markdown) {
  std::vector<Block> blocks;
  std::istringstream lines(markdown);
  bool is_inside = false;
  for (std::string line; std::getline(lines, line);) {
    const bool is_fence = line.rfind("```", 0) == 0;
    if (is_fence && !is_inside) blocks.push_back({line.substr(3), ""});
    else if (!is_fence && is_inside) blocks.back().text += line + "\n";
    if (is_fence) is_inside = !is_inside;
  }
  return blocks;
}

// "-old" lines replaced by the "+new" lines that follow them; each old line stands in `text` once.
std::string replaced(std::string text, const std::string& difference) {
  std::istringstream lines(difference);
  std::string removed;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("-", 0) == 0) removed = line.substr(1) + "\n";
    if (line.rfind("+", 0) != 0) continue;
    const std::size_t place = text.find(removed);
    REQUIRE(place != std::string::npos);
    text.replace(place, removed.size(), line.substr(1) + "\n");
  }
  return text;
}

std::string without(std::string text, const std::string& part) {
  for (std::size_t i = text.find(part); i != std::string::npos; i = text.find(part, i))
    text.erase(i, part.size());
  return text;
}

} // namespace

TEST_CASE("docs/reference/models.md is what the program would write now") {
  // If not: steplap elements --markdown > docs/reference/models.md
  CHECK(text_of(STEPLAP_SOURCE "/docs/reference/models.md") == steplap_does({"elements", "--markdown"}).out);
}

// Each ```toml block is a state of the exercise's file, or with "# low_loader.toml, continued" what is added
// to the state before; each ```diff block replaces lines of the last state. The ```text block that follows is
// what steplap check says.
TEST_CASE("the exercise of the guide: every message is the program's") {
  const Workbench bench;
  const std::vector<Block> blocks = blocks_of(text_of(STEPLAP_SOURCE "/docs/tutorials/guide.md"));
  std::string state;
  int states = 0;
  for (std::size_t i = 0; i + 1 < blocks.size(); ++i) {
    const Block& block = blocks[i];
    if (block.language != "toml" && block.language != "diff") continue;
    REQUIRE(blocks[i + 1].language == "text");
    CAPTURE(block.text);
    std::string text = block.text;
    if (block.language == "diff") text = replaced(state, block.text);
    else if (text.rfind("# low_loader.toml, continued\n", 0) == 0) text = state += block.text;
    else state = text;
    const Outcome outcome = steplap_does({"check", bench.write("low_loader.toml", text)});
    CHECK(without(outcome.err + outcome.out, bench.at("")) == blocks[i + 1].text);
    ++states;
  }
  CHECK(states == 7);
}

TEST_CASE("the exercise's machine runs and holds, as the guide says") {
  const Workbench bench;
  std::string state;
  for (const Block& block : blocks_of(text_of(STEPLAP_SOURCE "/docs/tutorials/guide.md")))
    if (block.language == "toml")
      state = block.text.rfind("# low_loader.toml, continued\n", 0) == 0 ? state + block.text : block.text;
  const Outcome outcome = steplap_does({"simulate", "-v", bench.write("low_loader.toml", state), "-o", bench.at("out"), "--require-hold"});
  CHECK(outcome.code == 0);
  for (const char* part : {"floor friction  slips forward", "rear foot       opens", "rear foot       closes"})
    CHECK_MESSAGE(has(outcome.out, part), part);
}
