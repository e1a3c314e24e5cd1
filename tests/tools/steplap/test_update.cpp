// steplap check --update: a file gets `format = 1` and present names; all else in it stays.
#include "tests/tools/steplap/workbench.h"
#include "tools/steplap/model_update.h"

#include <doctest/doctest.h>

using namespace steplap;
using namespace steplap::testing;

namespace {

Model model_without_format() {
  Model model;
  model.files_without_format = {"m.toml"};
  return model;
}

std::string with_format(const std::string& text) { return updated(text, "m.toml", model_without_format()).text; }

} // namespace

TEST_CASE("the format is the first statement of a file, behind its leading comments") {
  CHECK(with_format("title = \"a\"\n") == "format = 1\ntitle = \"a\"\n");
  CHECK(with_format("# about\n\n# more\ntitle = \"a\"\n") == "# about\n\n# more\nformat = 1\ntitle = \"a\"\n");
  CHECK(with_format("# about\n[simulation]\nend = 1\n") == "# about\nformat = 1\n\n[simulation]\nend = 1\n");
  CHECK(with_format("# about\r\ntitle = \"a\"\r\n") == "# about\r\nformat = 1\r\ntitle = \"a\"\r\n");
  CHECK(with_format("") == "format = 1\n");
  CHECK(with_format("# about") == "# about\nformat = 1\n");
  CHECK(updated("title = \"a\"\n", "other.toml", model_without_format()).text == "title = \"a\"\n");
}

TEST_CASE("renamed keys get their present names where they stand, also behind letters of several bytes") {
  Model model;
  const auto renamed = [&](int line, int column) {
    model.renamed_keys.push_back({{"m.toml", line, column}, "rate", "stiffness", "strut"});
  };
  renamed(1, 1);
  renamed(2, 18);
  renamed(3, 1);
  const std::string text = "rate = 1 # rate\nx = { n = \"µµµ\", rate = 2 }\n\"rate\" = 3\n";
  const ModelUpdate update = updated(text, "m.toml", model);
  CHECK(update.text == "stiffness = 1 # rate\nx = { n = \"µµµ\", stiffness = 2 }\n\"stiffness\" = 3\n");
  CHECK(update.renamed_keys == 3);
  CHECK_FALSE(update.adds_format);

  renamed(2, 3); // another text is there
  renamed(9, 1); // beyond the end
  model.renamed_keys.push_back({{"base.toml", 1, 1}, "rate", "stiffness", "strut"});
  CHECK(updated(text, "m.toml", model).text == update.text);
  CHECK(updated(text, "m.toml", model).missing_keys == 3);
}

TEST_CASE("check --update rewrites a file once and keeps its model") {
  const Workbench bench;
  const std::string file = bench.write("m.toml", std::string("# a scene\n") + k_oscillator);
  const Outcome before = steplap_does({"check", file});
  CHECK(has(before.out, "note: " + file + " does not say `format = 1`"));
  const Outcome update = steplap_does({"check", "--update", file});
  CHECK(update.code == 0);
  CHECK(update.out == file + ": format = 1 added\n");
  CHECK(text_of(file) == std::string("# a scene\nformat = 1\n") + k_oscillator);
  const Outcome after = steplap_does({"check", file});
  CHECK_FALSE(has(after.out, "format"));
  CHECK(has(after.out, ": fine"));
  CHECK(steplap_does({"check", "--update", file}).out == file + ": up to date\n");

  const std::string wrong = bench.write("wrong.toml", "[[body]]\nname = 3\n");
  CHECK(steplap_does({"check", "--update", wrong}).code == 3);
  CHECK(text_of(wrong) == "[[body]]\nname = 3\n"); // a file with errors stays as it is
  CHECK(steplap_does({"check", "--update", "-"}).code == 2);
  CHECK(steplap_does({"check", "--update", "--set", "simulation.end=1", file}).code == 2);
}

TEST_CASE("the note on the format comes once for several models") {
  const Workbench bench;
  const std::string a = bench.write("a.toml", k_oscillator), b = bench.write("b.toml", k_bouncer);
  const std::string said = steplap_does({"check", a, b}).out;
  CHECK(has(said, "note: " + a + " and 1 other file do not say `format = 1`"));
  CHECK(said.find("format = 1") == said.rfind("format = 1"));
}
