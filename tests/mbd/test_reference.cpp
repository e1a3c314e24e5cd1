// The reference and the schema that are generated from field tables.
#include "mbd/io/json_schema.h"
#include "mbd/io/reference.h"
#include "tests/mbd/small_catalogue.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

using namespace steplap;
using steplap::testing::small_catalogue;

TEST_CASE("the reference of a kind shows every field") {
  const KindReference pair = kind_references(small_catalogue(), "pair").front();
  CHECK(pair.heading == "[[pair]]");
  CHECK(pair.doc == "Two equal bodies side by side.");
  CHECK(pair.fields == ReferenceRows{{"field", "type", "unit", "default", "range", "meaning"},
                                     {"name", "text", "", "required", "", "unique name"},
                                     {"spacing", "number", "m", "1", "> 0", "distance of the two"},
                                     {"carrier", "body", "", "\"ground\"", "", "what carries them"}});
  CHECK(pair.channels.empty());
  const KindReference spring = kind_references(small_catalogue(), "spring").front();
  CHECK(spring.heading == "[[element]] of kind \"spring\"");
  const std::vector<std::string> names = testing::spring_kind().fields.names();
  REQUIRE(spring.fields.size() == names.size() + 2); // the heads, and the name
  CHECK(spring.fields[1].front() == "name");
  for (std::size_t i = 0; i < names.size(); ++i) CHECK(spring.fields[i + 2].front() == names[i]);
  const ReferenceRows body = kind_references(small_catalogue(), "body").front().fields;
  CHECK(std::count_if(body.begin(), body.end(), [](const auto& row) { return row[0] == "name"; }) == 1);
  CHECK(kind_references(small_catalogue(), "output").front().fields[1].front() != "name"); // there is only one
  CHECK_THROWS_WITH_AS(static_cast<void>(kind_references(small_catalogue(), "sprong")),
                       "error: there is no kind 'sprong' (did you mean 'spring'?)", ModelError);
}

TEST_CASE("all kinds are listed") {
  const ReferenceRows list = kinds_rows(small_catalogue());
  const std::string markdown = reference_markdown(small_catalogue());
  for (const std::string kind : {"body", "marker", "simulation", "output", "haversine", "record", "spring", "pusher", "pair"}) {
    CHECK(std::count_if(list.begin(), list.end(), [&kind](const auto& row) { return row[1] == kind; }) == 1);
    CHECK(markdown.find(kind) != std::string::npos);
  }
  CHECK(markdown.find("\"linear\" \\| \"table\"") != std::string::npos);
}

TEST_CASE("the schema follows the tables") {
  const auto schema = nlohmann::json::parse(json_schema(small_catalogue()));
  const auto& spring = schema["$defs"]["element_spring"];
  CHECK(spring["properties"]["kind"]["const"] == "spring");
  CHECK(spring["properties"]["stiffness"]["exclusiveMinimum"] == 0.0);
  CHECK(spring["properties"]["law"]["enum"][1] == "table");
  CHECK(spring["properties"]["turns"]["default"] == 3);
  CHECK(spring["properties"]["turns"]["maximum"] == 20);
  CHECK(spring["properties"]["turns"]["type"] == nlohmann::json{"integer", "string"});
  CHECK(schema["properties"]["parameters"]["additionalProperties"]["type"].size() == 3); // a number, a text, a table with range and meaning
  CHECK(spring["additionalProperties"].contains("const"));                               // no other keys
  CHECK(schema["properties"]["body"]["items"]["properties"]["position"]["default"][0] == 0.0);
  CHECK(schema["properties"].contains("pair"));
  for (const auto* entry :
       {&spring, &schema["properties"]["body"]["items"], &schema["properties"]["marker"]["items"], &schema["properties"]["part"]["items"]})
    CHECK((*entry)["properties"]["repeat"]["type"] == "integer");
  CHECK(schema["properties"]["part"]["items"]["properties"]["parameters"]["additionalProperties"]["type"].size() == 2); // a number, a text
  CHECK(!schema["properties"]["pair"]["items"]["properties"].contains("repeat"));
  CHECK(schema["properties"].contains("gravity"));
  CHECK(schema["properties"]["signal"]["items"]["properties"]["kind"]["enum"].size() == small_catalogue().signals.size());
  const auto& elements = schema["properties"]["element"]["items"];
  CHECK(elements["properties"].contains("stiffness")); // what an editor offers
  CHECK(elements["then"]["$ref"] == "#/$defs/element_" + elements["if"]["properties"]["kind"]["const"].get<std::string>());
}
