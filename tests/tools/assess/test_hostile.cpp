// Inputs that nobody meant: every mutation of a file is read as something, or refused with a place; nothing else happens.
#include "driven_scene.h"

#include "tools/study/counter_random.h"

#include <doctest/doctest.h>

using namespace steplap;
using namespace steplap::assess;
using namespace assess_test;

namespace {

// A text with one to three places changed: a character, a line taken out or doubled, a number or a word put elsewhere.
std::string mutated(const std::string& text, std::uint64_t number) {
  const study::CounterRandom random(7, 1);
  std::uint32_t draw = 0;
  const auto next = [&](std::size_t below) {
    return static_cast<std::size_t>(random.uniform(number, draw++) * static_cast<double>(below));
  };
  static const std::vector<std::string> words = {"\"", "nan", "inf", "-1",   "1e400", "\"-z\"", "[[recorder]]\n", "[[criterion]]\n",
                                                 "\n", "=",   "[]",  "\"\"", "\xff",  "0",      "\"3 kg\"",       "name = \"x\"\n"};
  std::string changed = text;
  const std::size_t changes = 1 + next(3);
  for (std::size_t i = 0; i < changes && !changed.empty(); ++i) {
    const std::size_t at = next(changed.size()), line = changed.rfind('\n', at) == std::string::npos ? 0 : changed.rfind('\n', at) + 1;
    const std::size_t end = std::min(changed.find('\n', at), changed.size() - 1) + 1;
    switch (next(5)) {
    case 0: changed[at] = static_cast<char>(next(256)); break;
    case 1: changed.erase(line, end - line); break;
    case 2: changed.insert(line, changed.substr(line, end - line)); break;
    case 3: changed.insert(at, words[next(words.size())]); break;
    default:
      if (const std::size_t equals = changed.find('=', line); equals != std::string::npos && equals < end)
        changed.replace(equals + 1, end - equals - 2, " " + words[next(words.size())]);
    }
  }
  return changed;
}

} // namespace

TEST_CASE("mutated criteria are read, or refused with a place") {
  const std::string text = criteria_presets().front().toml;
  long read = 0, refused = 0;
  for (std::uint64_t i = 1; i <= 3000; ++i) {
    try {
      const DecisionCriteria criteria = parse_criteria(mutated(text, i), "mine.toml");
      for (const DecisionCriterion& c : criteria.criteria) { // what was taken can be judged by
        if (c.at_most) CHECK(std::isfinite(*c.at_most));
        if (c.quantity.ends_with("probability")) CHECK(c.at_most.has_value());
      }
      ++read;
    } catch (const ModelError& error) {
      ++refused;
      REQUIRE(!error.diagnostics().empty());
      CHECK_MESSAGE(error.diagnostics().front().where.line > 0, error.what());
    }
  }
  CHECK(read > 100);
  CHECK(refused > 100);
}

TEST_CASE("mutated recorders and uncertain numbers of a model are taken, or refused with a place") {
  const std::string head = block_text(0.3);
  const std::size_t from = head.find("[[recorder]]"), to = head.find("[[element]]");
  const std::string tables = head.substr(from, to - from) +
                             "[[uncertain]]\nname = \"floor\"\npaths = [\"element.floor.static_friction\"]\ndistribution = "
                             "\"lognormal\"\nmean = 0.3\ncov = 0.2\nlower = 0.1\nsource = \"assumed\"\nsource_text = \"a test\"\n";
  long read = 0, refused = 0;
  for (std::uint64_t i = 1; i <= 1500; ++i) {
    const std::string text = head.substr(0, from) + mutated(tables, i) + "\n" + head.substr(to);
    try {
      std::vector<DrivenModel> models;
      models.push_back(driven(text));
      const UncertainValues uncertain(models);
      if (!uncertain.empty())
        for (const double value : uncertain.draw(1, i)) CHECK(std::isfinite(value));
      ++read;
    } catch (const ModelError& error) {
      ++refused;
      REQUIRE(!error.diagnostics().empty());
      CHECK_MESSAGE(!error.diagnostics().front().where.file.empty(), error.what());
    }
  }
  CHECK(read > 50);
  CHECK(refused > 50);
}
