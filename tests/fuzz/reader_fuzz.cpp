// The reader of model files alone, with the made-up kinds of tests/mbd/small_catalogue.h: quickly built, and quicker than with
// all elements. What it read is written as TOML and read again.
#include "tests/fuzz/fuzz.h"

#include "mbd/io/document.h"
#include "mbd/io/reader.h"
#include "mbd/io/toml_writer.h"
#include "tests/mbd/small_catalogue.h"

using namespace steplap;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size), file = STEPLAP_FUZZ_SCENES "/given.toml";
  try {
    (void)parse_model(text, file, testing::small_catalogue());
  } catch (const ModelError& error) {
    fuzz::require_readable(error);
    return 0;
  }
  const std::string written = write_toml(parse_document(text, file).root);
  try {
    (void)parse_model(written, file, testing::small_catalogue());
  } catch (const ModelError& error) {
    std::fprintf(stderr, "%s\n%s\n", written.c_str(), error.what());
    fuzz::require(false, "a model that was read and written can be read again");
  }
  return 0;
}
