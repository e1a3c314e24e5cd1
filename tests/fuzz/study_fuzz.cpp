// Study files. Their models are those in tests/fuzz/scenes.
#include "tests/fuzz/fuzz.h"
#include "tools/study/study_reader.h"

using namespace steplap;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    (void)study::parse_study(std::string(data, data + size), STEPLAP_FUZZ_SCENES "/given.toml");
  } catch (const ModelError& error) {
    fuzz::require_readable(error);
  } catch (const NumericalFailure&) { // joints of the model that cannot be closed with the values given
  }
  return 0;
}
