// Model files: read, compiled, joints closed.
#include "tests/fuzz/fuzz.h"

#include "mbd/analysis/assembly.h"
#include "mbd/io/presentation.h"
#include "mbd/io/reader.h"
#include "transformer/catalog.h"

using namespace steplap;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    Model model = parse_model(std::string(data, data + size), STEPLAP_FUZZ_SCENES "/given.toml", transformer_catalog());
    const auto system = compile(model);
    (void)check_presentation(model, *system);
    (void)assemble(model, *system);
  } catch (const ModelError& error) {
    fuzz::require_readable(error);
  } catch (const NumericalFailure&) { // joints that cannot be closed
  }
  return 0;
}
