#include "mbd/run/version.h"

namespace steplap {

const char* const k_version = STEPLAP_VERSION;

} // namespace steplap
